// The world: bodies, joints and their simulation. WorldBuilder collects settings, build() checks them all.
//
// Threads: a world is one object; writing calls (add, remove, update, setters) must not overlap with any other call on
// it. Const calls may run on several threads at once between writing calls. Task and allocator hooks are called on the
// thread that calls update(), tasks themselves on whatever thread the hook chooses. There are no other callbacks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "lendulet/body.h"
#include "lendulet/events.h"
#include "lendulet/joint.h"
#include "lendulet/options.h"
#include "lendulet/query.h"

namespace lendulet {

// Memory of a world comes from here; the default is the heap (malloc). `allocate` must give memory aligned to
// `alignment` (a power of two up to 64) or null, which ends the program with a sentence and exit code 2.
struct AllocatorHook {
    void* user = nullptr;
    void* (*allocate)(void* user, size_t bytes, size_t alignment) = nullptr;
    void (*free)(void* user, void* memory, size_t bytes, size_t alignment) = nullptr;
};

// Runs the world's loops on the user's own threads: must call run(context, begin, end, worker) over disjoint ranges
// that cover [0, count), with worker < workers and never the same worker number at the same time, and return when all
// are done. Results never depend on how the range was cut.
struct TaskHook {
    void* user = nullptr;
    int workers = 0;
    void (*parallel_for)(void* user, int count, int grain, void (*run)(void* context, int begin, int end, int worker),
                         void* context) = nullptr;
};

// Every setting of a world; WorldBuilder fills it in.
struct WorldConfig {
    Vec3 gravity{0.0f, -9.81f, 0.0f};  // m/s^2
    // Substeps per step, 1 .. 64. Small islands under heavy load take up to 16 times as many, large ones in motion
    // half, where that is a whole number of at least 4 (docs/solver.md).
    int solver_steps = 8;
    float rigid_separation_speed = 3.0f;   // m/s: fastest that overlap between two rigid bodies is undone
    float static_separation_speed = 3.0f;  // m/s: the same against static and kinematic bodies
    float friction = 0.5f;                 // default static and dynamic coefficient, 0 .. 1e6
    float restitution = 0.0f;              // default bounciness, 0 .. 1
    BroadPhaseType broad_phase = BroadPhaseType::wide_tree;
    SimplexSolver simplex = SimplexSolver::half_space;
    Integrator integrator = Integrator::momentum;
    int workers = 1;  // threads including the caller's, 1 .. 64
    int width = 0;    // SIMD lanes 1, 4, 8 or 16, or the most below that this machine has; 0: the most
    bool allow_sleep = true;
    bool continuous = true;  // fast bodies are stopped where they would pass through static and kinematic ones
    float hit_speed = 1.0f;  // slower meetings are no hits (ContactHit), m/s, >= 0; no result depends on it
    // So many of the bodies, and as many of the joints, that were removed last are remembered, so that snapshots of
    // before can bring them back; 0 .. 16 777 216. Each is about 1 kB, beside the hulls and meshes that it holds on to.
    int kept_removed = 4096;
    AllocatorHook allocator{};
    TaskHook tasks{};
};

// One point of a contact between two colliders.
struct ContactPoint {
    Position position;     // half way between the two surfaces, m
    float separation;      // m, negative = overlap
    float normal_impulse;  // of the last substep, as one of dt / solver_steps, N s
};

// A contact: up to four points with one normal. None at a seam of a floor that is made up of several pieces, where
// another contact holds the body above this one.
struct Contact {
    BodyId body_a, body_b;
    ColliderId collider_a, collider_b;
    Vec3 normal;            // unit, from A to B
    Vec3 friction_impulse;  // on B, as ContactPoint::normal_impulse, N s
    int point_count;
    ContactPoint points[4];
    int32_t triangle;  // number of the mesh's or height field's triangle, -1 where none is involved
};

// Two colliders, one of them a trigger, that overlap.
struct Overlap {
    BodyId trigger_body, other_body;
    ColliderId trigger, other;
};

// A node box or leaf box of the broad phase.
struct AabbView {
    Aabb box;
    int depth;  // 0: root; for structures without levels all boxes have depth 0
    bool leaf;
};

// Hit of a ray on a collider's bounding box (for the shapes themselves see World::cast_ray).
struct BoxHit {
    BodyId body;
    ColliderId collider;
    float fraction;  // of the ray's length at which it enters the box, 0 where it starts inside
};

enum class Stage : uint8_t { bounds, broad_phase, pairs, narrow_phase, islands, prepare, solve, finish, count };
std::string_view name_of(Stage);

// What the last step did.
struct StepStatistics {
    double stage_ms[static_cast<int>(Stage::count)];
    double total_ms;
    int bodies, awake_bodies, pairs, manifolds, contact_points, colours, overflow_manifolds, joints;
    int hard_bodies;        // awake bodies of islands that took more substeps than are set (docs/solver.md)
    int flowing_bodies;     // ... and of large islands in motion, which took half of them
    int rested_bodies;      // of the former those that rested, so that most substeps were left out
    float max_penetration;  // deepest overlap after the step, m
    int capped_bodies;      // bodies whose speed was cut to the limit
    int contained_bodies;   // bodies that were put back and stopped: the state of one in their island went non-finite
    int stopped_bodies;     // fast bodies that were put where they met what they would have passed through
    size_t bytes_per_body, bytes_per_manifold;
};

struct Momentum {
    double linear[3];   // kg m/s
    double angular[3];  // about the world's origin, kg m^2/s
};

// For World::reserve(). Counts of 0 to 16 777 216; contacts = 0: three for every body, and room for more that is not
// touched.
struct Capacity {
    int bodies = 0;    // moving ones, with one collider each
    int contacts = 0;  // pairs of colliders near each other
    int joints = 0;
};

// A world that was moved from can be assigned to and destroyed; any other call ends the program with a sentence.
class World {
public:
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;
    ~World();

    // --- bodies and joints
    // Errors: non_finite, bad_rotation, bad_mass, bad_inertia, bad_extent, bad_material, bad_collider,
    // shape_not_dynamic, out_of_world. On an error nothing has changed.
    Result<BodyId> add_rigid_body(const RigidBodyDef& def);
    Result<BodyId> add_static_body(const StaticBodyDef& def);
    // Removes the body with its colliders and joints. A snapshot of before brings them back, as long as they are among
    // those remembered (WorldConfig::kept_removed). Errors: stale_id, wrong_world.
    Status remove_body(BodyId id);
    // Puts any body somewhere, static ones too: as RigidBodyRef::set_pose() for one that moves. Quaternions within 1e-3
    // of unit length are normalised. What touches the body, what it comes to lie in and what is joined to it wakes; its
    // contacts end and begin anew, with overlap undone as any other, and nothing is carried along: what is to carry
    // others is a kinematic body. Snapshots hold where it is. Cost: O(static colliders) in the next step, so this is
    // for now and then. Errors: stale_id, wrong_world, non_finite, bad_rotation, out_of_world. On an error nothing has
    // changed.
    Status set_pose(BodyId id, Position position, Quat orientation);
    // Another number of the user's own for a body; snapshots do not hold it. Errors: stale_id, wrong_world.
    Status set_user_data(BodyId id, uint64_t user_data);
    // Errors: stale_id, wrong_world, bad_joint, no_dynamic_body, non_finite.
    Result<JointId> add_joint(const JointDef& def);
    Status remove_joint(JointId id);
    // Another motor or spring from the next step on: of a hinge, slider or distance joint, or of one coordinate of a
    // six-degree joint. A spring whose target is set again and again is a servo. Wakes the joint's bodies.
    // Errors: stale_id, wrong_world, non_finite, bad_joint (a joint or coordinate without such, a negative force,
    // stiffness or damping). On an error nothing has changed.
    Status set_motor(JointId id, Motor motor);
    Status set_motor(JointId id, Coordinate coordinate, Motor motor);
    Status set_spring(JointId id, Spring spring);
    Status set_spring(JointId id, Coordinate coordinate, Spring spring);
    // Another friction from the next step on (JointDef::friction): of a hinge, slider, distance or ball joint, or of
    // one coordinate of a six-degree joint; N m or N, >= 0. Wakes the joint's bodies. Errors: stale_id, wrong_world,
    // non_finite (not a number), bad_joint (a joint or coordinate without such, a negative one). On an error nothing
    // has changed.
    Status set_friction(JointId id, float friction);
    Status set_friction(JointId id, Coordinate coordinate, float friction);
    // Other bounds from the next step on: of a hinge, slider or distance joint, of one coordinate of a six-degree
    // joint, or of a ball joint: its twist (Coordinate::about_x) and its cone (Coordinate::swing, whose upper bound is
    // the half angle). Wakes the joint's bodies. Errors: stale_id, wrong_world, non_finite, bad_joint (a joint or
    // coordinate without such, bounds that add_joint() would refuse). On an error nothing has changed.
    Status set_limit(JointId id, Limit limit);
    Status set_limit(JointId id, Coordinate coordinate, Limit limit);
    // Whom a collider meets, what it is made of, and what it reports from the next step on. Wakes its body and those
    // that touch it or may do so now. A pair that is filtered out ends; where one begins that overlaps, overlap is
    // undone as any other. Errors: stale_id, wrong_world; of materials bad_material, and bad_collider where triangles
    // have materials of their own; of events bad_collider (bits that are none). On an error nothing has changed.
    Status set_filter(ColliderId id, const CollisionFilter& filter);
    Status set_material(ColliderId id, const Material& material);
    Status set_events(ColliderId id, Events events);
    // A joint's frames on its two bodies from one frame in the world (x axis along `axis`).
    Result<JointDef> joint_at(JointType type, BodyId a, BodyId b, Position anchor,
                              Vec3 axis = {1.0f, 0.0f, 0.0f}) const;

    // False for handles of removed bodies, colliders and joints and for those of other worlds.
    bool alive(BodyId id) const;
    bool alive(ColliderId id) const;
    bool alive(JointId id) const;
    // Views; a stale id, or get() on a static body, ends the program with a sentence: ask alive() where it may be
    // stale.
    RigidBodyRef get(BodyId id);
    const RigidBodyRef get(BodyId id) const;
    StaticBodyRef get_static(BodyId id) const;  // any body
    JointState joint(JointId id) const;
    // The joint as it was defined, with the motors, springs, friction and bounds that it has now.
    JointDef joint_def(JointId id) const;

    // Takes memory ahead for worlds of so many bodies, contacts and joints, and touches it: the first steps then need
    // not wait for the system to hand it out, which can take several times as long as they. A hint: all of them may
    // become more, and results are the same without. For use before the first body is added, or any time later.
    // Errors: bad_config (a count below 0 or above 16 777 216), locked.
    Status reserve(const Capacity& capacity);

    // --- simulation
    // Advances by dt seconds (0 .. 1000; longer steps than 1 s are cut into equal ones of at most 1 s). dt = 0 does
    // nothing.
    // Errors: bad_time_step.
    Status update(float dt);
    Status set_gravity(Vec3 gravity);
    // WorldConfig::hit_speed from the next step on. Errors: bad_config.
    Status set_hit_speed(float speed);
    const WorldConfig& config() const;
    const StepStatistics& statistics() const;
    double time() const;  // seconds simulated
    uint64_t step_count() const;

    // --- snapshots
    // All that a world's future depends on but shapes, masses as added and settings: poses, momenta, forces, sleep,
    // what setters have changed of bodies, colliders and joints, joints' impulses, contacts and what the narrow phase
    // keeps of them, gravity, time. Equal states give equal bytes. About 100 bytes a body and 250 a contact; O(n).
    std::vector<uint8_t> snapshot() const;
    // Goes back to a snapshot of this world, or of one that was built alike (bodies, joints, settings that results
    // depend on; another number of workers, width or broad phase will do): from there on it computes the same bits.
    // Bodies and joints added since are removed again; those removed since are alive again, under the ids that they
    // had, as far as this world remembers them (WorldConfig::kept_removed). Names and user data of those come as they
    // were when removed. Statistics stay those of the last step. O(n).
    // Errors: bad_snapshot (truncated, altered, another version), wrong_world (of a world with other bodies, or a body
    // or joint of it was removed too long ago), locked. On an error nothing has changed.
    Status restore(std::span<const uint8_t> snapshot);
    // Forgets what was removed and lets go of its memory and its share in hulls and meshes: restore() refuses snapshots
    // with bodies and joints that are not alive now.
    void forget_removed();
    // A second world in the same state, which goes its own way: left alone, the two compute the same bits. Handles of
    // this world name the same bodies, colliders and joints there, and hulls and meshes are shared. Hooks for memory
    // and tasks are the same. query_boxes(), nearest_box() and for_each_aabb() find nothing there before its first
    // step. O(n). Error: locked.
    Result<World> fork() const;
    // The same with other settings: materials that were given no friction or bounciness of their own get the new ones.
    // Bodies that rest wake where gravity changes or sleep ends. Errors: those of WorldBuilder::build(), locked.
    Result<World> fork(const WorldConfig& settings) const;

    // --- iteration; all in creation order
    int body_count() const;
    int joint_count() const;
    BodyId body(int index) const;  // 0 .. body_count() - 1
    // Bodies that may be elsewhere than before the last update(): those that moved in its last step, with those that it
    // put to sleep, and the dynamic and kinematic ones that were added, placed or woken since. Whoever draws need copy
    // the poses of no others, but of all after restore(). Writes as many as fit, returns how many there are. O(what
    // moves).
    int moved_bodies(std::span<BodyId> out) const;
    JointId joint_id(int index) const;
    // Contacts of the last step, ordered by colliders, and after them those among bodies at rest as these came to rest:
    // the same for every broad phase and number of workers. Where a body is removed the last of either kind takes the
    // place of one that goes.
    int contact_count() const;
    Contact contact(int index) const;
    // The colour in which the solver took each contact of the last step, by index: contacts of one colour share no body
    // that they move. -1: not solved, since it rests or its bodies bounce and pass by each other in this step. O(n).
    std::vector<int> contact_colours() const;
    // A number that the bodies of an island had in common in the last step: those that touch or are joined and move.
    // -1 for bodies that rest, for static and for kinematic ones.
    int64_t island(BodyId id) const;
    // Triggers, of the last step; those at rest first. The list stays as it is until the next update() or restore(),
    // whatever is removed or filtered out meanwhile: alive() tells whom it names that is gone.
    std::span<const Overlap> overlaps() const;

    // --- events (see events.h): what the last update() did. Empty after restore() and in a fork, until the next one.
    std::span<const ContactEvent> contact_begins() const;
    std::span<const ContactEvent> contact_ends() const;
    std::span<const ContactHit> contact_hits() const;
    // Who came into a trigger and who left it, as of where all were when the step began, as overlaps().
    std::span<const Overlap> trigger_begins() const;
    std::span<const Overlap> trigger_ends() const;
    // Of all bodies, whether they ask or not.
    std::span<const SleepEvent> sleep_events() const;
    std::span<const JointBreak> joint_breaks() const;

    // Calls visit(AabbView) for every leaf and node box of the broad phase.
    template <class Visit>
    void for_each_aabb(Visit&& visit) const {
        visit_aabbs(
            [](void* context, const AabbView& view) { (*static_cast<std::remove_reference_t<Visit>*>(context))(view); },
            const_cast<void*>(static_cast<const void*>(&visit)));
    }
    // These two see the boxes of the last step: each holds its collider through that whole step. Colliders added since
    // are not found yet, removed ones no more. Colliders whose bounding boxes overlap `box`, at most `capacity`, in
    // collider order; returns how many there are.
    int query_boxes(const Aabb& box, ColliderId* out, int capacity) const;
    // Nearest collider box that the segment from `origin` along `translation` meets. Error: bad_query.
    Result<BoxHit> nearest_box(Position origin, Vec3 translation) const;
    BodyId body_of(ColliderId id) const;

    // --- queries (see query.h): exact, of the present. Errors: bad_query, see there.
    // The first collider that the ray or the cast shape meets; of several at the same fraction the one with the
    // smallest id. A hit with `hit` false where there is none.
    Result<QueryHit> cast_ray(const Ray& ray, const QueryFilter& filter = {}) const;
    Result<QueryHit> cast_shape(const ShapeCast& cast, const QueryFilter& filter = {}) const;
    // Whether there is any; as soon as one is found.
    Result<bool> cast_ray_any(const Ray& ray, const QueryFilter& filter = {}) const;
    Result<bool> cast_shape_any(const ShapeCast& cast, const QueryFilter& filter = {}) const;
    // Every collider on the way with its first hit, by fraction, then by id. Writes as many as fit, returns how many
    // there are.
    Result<int> cast_ray_all(const Ray& ray, std::span<QueryHit> out, const QueryFilter& filter = {}) const;
    Result<int> cast_shape_all(const ShapeCast& cast, std::span<QueryHit> out, const QueryFilter& filter = {}) const;
    // out[i] = cast_ray(rays[i]), to the last bit, on the world's workers; likewise for casts. Both spans have the same
    // length. These count as writing calls. On an error, which names the place in the array, nothing is written.
    Status cast_rays(std::span<const Ray> rays, std::span<QueryHit> out, const QueryFilter& filter = {});
    Status cast_shapes(std::span<const ShapeCast> casts, std::span<QueryHit> out, const QueryFilter& filter = {});

    // The collider nearest to a convex shape or a point, no farther than `max_distance` (>= 0); of those that overlap
    // it, the deepest; of equal ones the smallest id. A is the shape, B the collider.
    Result<Proximity> closest(const PosedShape& shape, float max_distance, const QueryFilter& filter = {}) const;
    Result<Proximity> closest(Position point, float max_distance, const QueryFilter& filter = {}) const;
    // Every collider that a convex shape overlaps or touches, with the depth, by id. Writes as many as fit, returns how
    // many there are.
    Result<int> overlap_shape(const PosedShape& shape, std::span<Proximity> out, const QueryFilter& filter = {}) const;
    Result<bool> overlap_any(const PosedShape& shape, const QueryFilter& filter = {}) const;
    // The same for a box along the world's axes, which may be flat.
    Result<int> overlap_box(const Aabb& box, std::span<Proximity> out, const QueryFilter& filter = {}) const;
    // Every solid that holds the point, by id; meshes and height fields hold none.
    Result<int> overlap_point(Position point, std::span<Proximity> out, const QueryFilter& filter = {}) const;

    // --- whole-world figures
    double kinetic_energy() const;    // J
    double potential_energy() const;  // J, against gravity from the origin
    Momentum momentum() const;
    // Hash of all poses, p, L and warm-start impulses: equal for any number of workers, SIMD width, broad phase and
    // compiler, x86-64, 64-bit ARM and WebAssembly.
    uint64_t hash() const;
    std::span<const std::string> warnings() const;  // such as meshes that collide as hulls
    // Verifies the internal structures; used by tests. Empty where all is well, else a sentence.
    std::string check() const;

private:
    friend class WorldBuilder;
    explicit World(std::unique_ptr<WorldData> data);
    WorldData& data() const;
    void visit_aabbs(void (*visit)(void*, const AabbView&), void* context) const;
    std::unique_ptr<WorldData> data_;
};

// Collects settings by name; build() checks them and gives a World or the first error (bad_config, non_finite).
class WorldBuilder {
public:
    WorldBuilder() = default;
    // Begins with the settings of another world.
    explicit WorldBuilder(const WorldConfig& config) : config_(config) {}
    WorldBuilder& no_gravity() { return gravity({}); }
    WorldBuilder& down_gravity(float g) { return gravity({0.0f, -g, 0.0f}); }  // m/s^2 along -y
    WorldBuilder& gravity(Vec3 g) { return config_.gravity = g, *this; }
    WorldBuilder& solver_steps(int n) { return config_.solver_steps = n, *this; }
    WorldBuilder& rigid_separation_speed(float v) { return config_.rigid_separation_speed = v, *this; }
    WorldBuilder& static_separation_speed(float v) { return config_.static_separation_speed = v, *this; }
    WorldBuilder& no_friction() { return friction(0.0f); }
    WorldBuilder& friction(float mu) { return config_.friction = mu, *this; }
    WorldBuilder& no_bounciness() { return bounciness(0.0f); }
    WorldBuilder& max_bounciness() { return bounciness(1.0f); }
    WorldBuilder& bounciness(float e) { return config_.restitution = e, *this; }
    WorldBuilder& broad_phase(BroadPhaseType type) { return config_.broad_phase = type, *this; }
    WorldBuilder& simplex(SimplexSolver solver) { return config_.simplex = solver, *this; }
    WorldBuilder& integrator(Integrator integrator) { return config_.integrator = integrator, *this; }
    WorldBuilder& workers(int n) { return config_.workers = n, *this; }
    WorldBuilder& width(int lanes) { return config_.width = lanes, *this; }
    WorldBuilder& sleep(bool allow) { return config_.allow_sleep = allow, *this; }
    WorldBuilder& continuous(bool on) { return config_.continuous = on, *this; }
    WorldBuilder& hit_speed(float v) { return config_.hit_speed = v, *this; }
    WorldBuilder& kept_removed(int count) { return config_.kept_removed = count, *this; }
    WorldBuilder& allocator(AllocatorHook hook) { return config_.allocator = hook, *this; }
    WorldBuilder& tasks(TaskHook hook) { return config_.tasks = hook, *this; }
    const WorldConfig& config() const { return config_; }
    Result<World> build() const;

private:
    WorldConfig config_;
};

}  // namespace lendulet
