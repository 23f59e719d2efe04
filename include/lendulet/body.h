// Bodies: how they are described, and the short-lived views through which they are read and changed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "lendulet/math.h"
#include "lendulet/result.h"
#include "lendulet/shapes.h"

namespace lendulet {

// Handles: zero is null; a handle of a removed object is detected, also when its slot is used again.
struct BodyId {
    uint32_t index = 0, generation = 0;
    explicit operator bool() const { return generation != 0; }
    bool operator==(const BodyId&) const = default;
};
struct ColliderId {
    uint32_t index = 0, generation = 0;
    explicit operator bool() const { return generation != 0; }
    bool operator==(const ColliderId&) const = default;
};
struct JointId {
    uint32_t index = 0, generation = 0;
    explicit operator bool() const { return generation != 0; }
    bool operator==(const JointId&) const = default;
};

enum class BodyType : uint8_t { fixed, kinematic, dynamic };  // `fixed` is a static body (`static` is a keyword)

// How the coefficients of two touching materials become one. Where the two materials disagree, the rule that comes
// first in this list wins (as KHR_physics_rigid_bodies orders them).
enum class CombineRule : uint8_t { average, minimum, maximum, multiply };

// Surface of a collider. Unset values are the world's defaults.
struct Material {
    std::optional<float>
        static_friction{};  // >= 0; a contact sticks while the tangential impulse it needs is <= this * N
    std::optional<float> dynamic_friction{};  // >= 0; otherwise it slides with this * N against the sliding direction
    std::optional<float> restitution{};       // 0 (dead) .. 1 (elastic)
    // What resists rolling, as the arm of the normal force, m, >= 0: turning about axes in the contact's plane meets at
    // most the torque rolling_friction * N, so that a rolling ball slows by 5/7 g rolling_friction / radius. Combined
    // by friction_combine, of which only `multiply` makes no sense for lengths.
    float rolling_friction = 0.0f;
    // The same for turning about the contact's normal, beside what friction over several points resists.
    float spinning_friction = 0.0f;
    // Share of the slip at an impact that turns round, 0 (it stops at most) .. 1 (a superball), as far as friction
    // allows. In impacts that bounce only. Combined by restitution_combine.
    float tangential_restitution = 0.0f;
    // How fast the surface itself runs over its body, in the collider's frame, m/s: a conveyor belt's, a treadmill's.
    // Friction carries along what touches it, as fast as the part of this vector that lies in the contact's plane; the
    // belt's body feels the reaction. Of two such surfaces the difference counts.
    Vec3 surface_velocity{};
    CombineRule friction_combine = CombineRule::average;
    CombineRule restitution_combine = CombineRule::maximum;
};

// Which colliders meet: both must find the other's category in their mask. Colliders with the same non-zero group never
// collide (a ragdoll's parts, a chain's links).
struct CollisionFilter {
    uint64_t category = 1, mask = ~uint64_t{0};
    uint32_t group = 0;
};

// What is reported of a collider's contacts, see events.h. Triggers report who comes and goes under `contacts`.
enum class Events : uint8_t { none = 0, contacts = 1, hits = 2, all = 3 };
constexpr Events operator|(Events a, Events b) {
    return static_cast<Events>(static_cast<uint8_t>(a) | static_cast<uint8_t>(b));
}

// A shape on a body.
struct ColliderDef {
    Shape shape{};
    Transform local{};  // from the body's frame to the shape's
    Material material{};
    // For meshes and height fields whose triangles have materials (TriangleOptions): the table that these choose from,
    // copied. Must have a place for each of them. Empty: all triangles have `material`.
    std::span<const Material> materials{};
    CollisionFilter filter{};
    float density = 1000.0f;  // kg/m^3, > 0; ignored where the body's mass is given
    bool is_trigger = false;  // reports overlaps, neither pushes nor adds mass
    Events events = Events::none;
    uint64_t user_data = 0;
};

// A body that forces move. One shape (`shape`), or several (`colliders`, which then replaces `shape` and the material
// fields beside it).
struct RigidBodyDef {
    Shape shape = Sphere{};
    Position position{};  // of the body's frame, m
    Quat orientation{};
    Vec3 velocity{};                          // of the centre of mass, m/s
    Vec3 angular_velocity{};                  // world frame, rad/s
    float density = 1000.0f;                  // kg/m^3, > 0
    std::optional<float> friction{};          // static and dynamic alike; unset: the world's default
    std::optional<float> dynamic_friction{};  // unset: `friction`
    std::optional<float> restitution{};
    float rolling_friction = 0.0f, spinning_friction = 0.0f, tangential_restitution = 0.0f;  // see Material
    Vec3 surface_velocity{};                                                                 // see Material
    CollisionFilter filter{};
    Events events = Events::none;  // of `shape`
    std::span<const ColliderDef> colliders{};

    // Mass properties; what is unset follows from shapes and densities.
    std::optional<float> mass{};           // kg, 1e-9 .. 1e12; scales the inertia unless that is given too
    std::optional<Vec3> centre_of_mass{};  // body frame, m
    std::optional<SymMat3> inertia{};      // about the centre of mass, body axes, kg m^2
    float linear_damping = 0.0f;           // 1/s, >= 0: velocity decays as exp(-damping t)
    float angular_damping = 0.0f;          // 1/s, >= 0: likewise the angular velocity
    float gravity_factor = 1.0f;           // times the world's gravity; any finite number, 0: weightless
    bool allow_sleep = true;
    bool kinematic = false;  // moves with its given velocities, is not pushed by anything
    // Never passes through other dynamic bodies, however fast; no body passes through static and kinematic ones in any
    // case (unless WorldBuilder::continuous(false)). For few, small and fast bodies.
    bool bullet = false;
    uint64_t user_data = 0;
    std::string_view name{};  // copied; at most 255 bytes are kept
};

// A body that never moves.
struct StaticBodyDef {
    Shape shape = Box{};
    Position position{};
    Quat orientation{};
    std::optional<float> friction{};
    std::optional<float> dynamic_friction{};
    std::optional<float> restitution{};
    float rolling_friction = 0.0f, spinning_friction = 0.0f, tangential_restitution = 0.0f;  // see Material
    Vec3 surface_velocity{};                                                                 // see Material
    CollisionFilter filter{};
    Events events = Events::none;  // of `shape`
    std::span<const ColliderDef> colliders{};
    uint64_t user_data = 0;
    std::string_view name{};
};

class World;
struct WorldData;

// What is the same for bodies that move and bodies that do not. Views are cheap, hold no data and live as long as their
// body and its world: a view of a removed body ends the program with a sentence, as a stale id does. So does the number
// of a collider that the body has not, but for collider(). Every reading call is const and may run on several threads
// while no step and no writing call runs.
class StaticBodyRef {
public:
    BodyId id() const;
    BodyType type() const;
    Position position() const;  // of the body's frame, m
    Quat orientation() const;   // body frame to world
    Quat rotation() const { return orientation(); }
    Pose pose() const { return {position(), orientation()}; }  // pose() * p: where the point p of its frame is
    Mat3 rotation_matrix() const;
    std::string_view name() const;  // empty where none was given
    uint64_t user_data() const;
    int collider_count() const;
    const Shape& shape(int collider = 0) const;
    Transform collider_pose(int collider = 0) const;  // from the body's frame to the shape's
    bool is_trigger(int collider = 0) const;
    const CollisionFilter& filter(int collider = 0) const;
    const Material& material(int collider = 0) const;  // as given
    Events events(int collider = 0) const;
    ColliderId collider(int index = 0) const;  // null where there are not so many
    Aabb aabb() const;                         // of all colliders, without margin

protected:
    friend class World;
    StaticBodyRef(WorldData& world, BodyId id) : world_(&world), id_(id) {}
    uint32_t slot() const;  // of a body that there still is
    WorldData* world_;
    BodyId id_;
};

// A body that moves. State is momentum p and angular momentum L; velocities are derived.
class RigidBodyRef : public StaticBodyRef {
public:
    float mass() const;               // kg; infinity for a kinematic body
    float inverse_mass() const;       // 1/kg; 0 for a kinematic body
    Position centre_of_mass() const;  // world, m
    SymMat3 inverse_inertia() const;  // world axes, about the centre of mass, 1/(kg m^2)
    Vec3 momentum() const;            // p, kg m/s
    Vec3 angular_momentum() const;    // L about the centre of mass, world axes, kg m^2/s
    Vec3 velocity() const;            // v = p / m, of the centre of mass, m/s
    Vec3 angular_velocity() const;    // w = R I^-1 R^T L, world axes, rad/s
    float kinetic_energy() const;     // J
    float potential_energy() const;   // -m g.x, zero at the world's origin, J
    float energy() const { return kinetic_energy() + potential_energy(); }

    // Velocity of the body's material at a world point: v + w x (point - x). (thesis 3.3.2)
    Vec3 velocity_at(Position point) const;
    // Change of the local velocity at `point` along the unit vector `direction` per unit impulse along it:
    // T^-1(u) = u . [u / m + (I^-1 ((point - x) x u)) x (point - x)], 1/kg. (thesis 3.3.2, from Baraff)
    float impulse_effectiveness(Position point, Vec3 direction) const;

    // Writing calls. Each gives an error and changes nothing where an argument is not finite, and wakes the body. Of
    // kinematic bodies momenta, impulses, forces and torques do nothing: they have velocities alone.
    Status set_pose(Position position, Quat orientation);  // quaternions within 1e-3 of unit length are normalised
    Status set_velocity(Vec3 velocity);
    Status set_angular_velocity(Vec3 angular_velocity);
    Status set_momentum(Vec3 momentum);
    Status set_angular_momentum(Vec3 angular_momentum);
    Status apply_impulse(Vec3 impulse, Position point);  // N s at a world point: p += J, L += (point - x) x J
    Status apply_impulse(Vec3 impulse);                  // at the centre of mass
    Status apply_angular_impulse(Vec3 angular_impulse);  // N m s
    // N, held during the next step. A spring of the program's own, computed from where things are when the step begins,
    // gains energy so (explicit Euler); given as the impulse dt * force it acts before the step moves anything and
    // keeps it (symplectic Euler, docs/integrators.md).
    Status apply_force(Vec3 force, Position point);
    Status apply_force(Vec3 force);
    Status apply_torque(Vec3 torque);  // N m, held during the next step
    // Kinematic bodies: velocities such that the body arrives at this pose after a step of `dt`.
    Status move_to(Position position, Quat orientation, float dt);

    // Makes a body that was added as dynamic kinematic, and dynamic again: it goes on with the velocities that it has,
    // forces on it end. Between kinematic and static ones its contacts end and its joints rest. Errors: bad_mass (it
    // was added as kinematic and has no mass), bad_collider (BodyType::fixed), non_finite (it is too fast for its
    // mass).
    Status set_type(BodyType type);
    // Another mass, kg, 1e-9 .. 1e12, of a body that was added as dynamic: cargo that is loaded, fuel that is burnt.
    // The moments of inertia change in proportion, the centre of mass and the velocities stay, momenta follow.
    // Snapshots hold it. Wakes what touches it. Errors: non_finite (not finite, or too fast for that mass), bad_mass
    // (out of range; the body was added as kinematic), bad_inertia (moments of inertia that have no inverse). On an
    // error nothing has changed.
    Status set_mass(float mass);
    // As in RigidBodyDef, from the next step on. Errors: non_finite, bad_material (a negative damping); nothing has
    // changed then. Kinematic bodies keep these for nothing.
    Status set_damping(float linear, float angular);  // 1/s
    Status set_gravity_factor(float factor);
    void set_bullet(bool bullet);
    void set_allow_sleep(bool allow);
    float linear_damping() const;
    float angular_damping() const;
    float gravity_factor() const;
    bool bullet() const;
    bool allow_sleep() const;

    bool asleep() const;
    void wake();

private:
    friend class World;
    using StaticBodyRef::StaticBodyRef;
};

}  // namespace lendulet
