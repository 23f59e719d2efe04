// All bodies of a world as a structure of arrays, by slot. Grouped by who reads what: a step touches poses, momenta and
// masses of awake bodies; the rest is for the door.
//
// Positions and orientations are those of the principal frame: the centre of mass and the principal axes of inertia.
// The user's body frame is recovered with `principal` where it is asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/memory.h"
#include "dynamics/slots.h"
#include "lendulet/body.h"
#include "lendulet/math.h"

namespace lendulet {

inline constexpr uint32_t no_slot = ~0u;

// The conserved state. p_low and x_low are what rounding p and the position added to them (compensated summation), so
// that a body that falls or glides for minutes gains exactly m g t and v t. turn_low is what rounding the orientation
// took from it, as half a rotation vector in world axes: a top loses none of its energy by it.
struct BodyMomenta {
    Vec3 p, p_low, L, x_low, turn_low;
};

struct BodyMass {
    float mass = 0.0f, inverse_mass = 0.0f;
    Vec3 inertia, inverse_inertia;  // principal
    float anisotropy = 1.0f;        // largest over smallest principal moment
    // All moments are equal, as those of balls and cubes: the first one tells all, in any axes.
    bool round() const { return anisotropy <= 1.0f; }
    // Two are, or nearly: it turns by a closed form.
    bool symmetric() const;
};

struct BodyForces {
    Vec3 force, torque;  // held for the next step, world axes, about the centre of mass
};

// How the last substep changed velocity and L: the drift expects the same again.
struct BodyChange {
    Vec3 v, L;
};

struct BodyInfo {
    BodyType type = BodyType::fixed;
    bool asleep = false, allow_sleep = true, has_forces = false;
    bool woken = false;                      // since events were last reported
    bool capped = false, contained = false;  // in the last step: speed cut; state went non-finite and was put back
    float gravity_factor = 1.0f, linear_damping = 0.0f, angular_damping = 0.0f;
    float still_time = 0.0f;     // how long it has been slow, s
    uint32_t placed_at = 0;      // number of the step before which it was added or put somewhere by hand
    uint32_t mover_place = ~0u;  // among the bodies that a step looks at; ~0: it does not look at this one
    float radius = 0.0f;         // of a sphere about the centre of mass that holds all colliders
    float depth = 3e38f;         // of the shallowest inner core of its colliders, m
    bool massless = false;       // was added as kinematic
    bool bullet = false;         // may not pass through moving bodies either
    bool stopped = false;        // at a time of impact, in the last step
    bool altered = false;        // a static body that was moved, or one whose mass was set: see first_pose, first_mass
    uint32_t first_collider = no_slot;
    int32_t collider_count = 0;
    int32_t solver_index = 0;  // in this step's SolverBodies
    uint64_t user_data = 0;
};

struct BodyStore {
    Slots slots;
    Array<Pose> pose;            // of the principal frame
    Array<BodyMomenta> momenta;  // kinematic bodies: p holds velocity, L angular velocity
    Array<BodyMass> mass;
    Array<BodyMass> own_mass;  // of kinematic bodies that are dynamic by themselves; may be shorter
    // As they were added, of bodies that were altered since; may be shorter.
    Array<Pose> first_pose;
    Array<BodyMass> first_mass;
    Array<BodyForces> forces;
    Array<BodyChange> change;
    Array<BodyInfo> info;
    Array<Transform> principal;  // principal frame in the user's body frame
    std::vector<std::string> name;

    BodyStore(const Memory* memory, uint32_t world)
        : slots(memory, world),
          pose(memory),
          momenta(memory),
          mass(memory),
          own_mass(memory),
          first_pose(memory),
          first_mass(memory),
          forces(memory),
          change(memory),
          info(memory),
          principal(memory) {}

    uint32_t add();
    // At rest, without forces.
    void clear_motion(uint32_t slot) { momenta[slot] = {}, forces[slot] = {}, change[slot] = {}; }
    // Becomes a copy of another world's bodies, with their handles.
    void copy(const BodyStore& o);
    BodyId id(uint32_t slot) const { return {slot, slots.generation(slot)}; }
    bool alive(BodyId body) const { return slots.alive(body.index, body.generation); }
    // Pose of the user's body frame.
    Pose user_pose(uint32_t slot) const;
    void set_user_pose(uint32_t slot, Pose user);
    // v = p / m and w = R I^-1 R^T L (thesis 3.1, 3.2); the given ones for kinematic bodies.
    Vec3 velocity(uint32_t slot) const;
    Vec3 angular_velocity(uint32_t slot) const;
    // What w would be with angular momentum L.
    Vec3 angular_velocity_of(uint32_t slot, Vec3 L) const;
    SymMat3 inverse_inertia_world(uint32_t slot) const;
    // Theta w: R I R^T w.
    Vec3 inertia_times(uint32_t slot, Vec3 w) const;
    // The mass that the body has as a dynamic one; none where it was added as kinematic.
    const BodyMass& mass_as_dynamic(uint32_t slot) const {
        return info[slot].type == BodyType::kinematic && !info[slot].massless ? own_mass[slot] : mass[slot];
    }
    // What those were as the body was added, which it is that a snapshot's body has to agree with.
    const BodyMass& mass_as_added(uint32_t slot) const {
        return info[slot].altered && info[slot].type != BodyType::fixed ? first_mass[slot] : mass_as_dynamic(slot);
    }
    const Pose& pose_as_added(uint32_t slot) const {
        return info[slot].altered && info[slot].type == BodyType::fixed ? first_pose[slot] : pose[slot];
    }
    // Gives a body that has a mass another one, its velocities stay; a static body another pose. Both keep the first.
    void alter_mass(uint32_t slot, const BodyMass& other);
    void alter_pose(uint32_t slot, const Pose& other);
    // Makes a body with a mass kinematic or dynamic; its velocities stay.
    void set_type(uint32_t slot, BodyType type);
    static size_t bytes_per_body();
};

}  // namespace lendulet
