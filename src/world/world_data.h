// Everything a world owns. The stages of a step are free functions over it, listed in step.cpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/broad_phase.h"
#include "dynamics/body_store.h"
#include "dynamics/collider_store.h"
#include "dynamics/joint_store.h"
#include "lendulet/world.h"
#include "solver/bodies.h"
#include "solver/contact.h"
#include "solver/joints/joint.h"
#include "solver/solver.h"
#include "world/body_lanes/kernels.h"
#include "world/continuous.h"
#include "world/events.h"
#include "world/limits.h"
#include "world/movers.h"
#include "world/narrow/kernels.h"
#include "world/pairs.h"
#include "world/queries/scene.h"
#include "world/seams.h"
#include "world/snapshot/removed.h"

namespace lendulet {

// Lists of one chunk of pairs on its way through the narrow phase, one a worker.
struct NarrowScratch {
    MotionBatch motion;
    RefreshBatch kept;
    BoxLists<batch_capacity, 16> boxes;
    RoundBatch segments, box_balls;
    uint32_t tested[MotionBatch::room];   // pairs of `motion`
    uint32_t boxed[batch_capacity];       // pairs of `boxes`
    uint32_t rounded[2][batch_capacity];  // pairs of `segments` and of `box_balls`
    int contact_points;                   // those that touch or overlap, and the deepest overlap, m
    float max_penetration;
};

// Islands take 1, 2, 4, 8 or 16 times the substeps of the setting, each class being a part of the solver's arrays;
// those that flow, see substeps.cpp, take half of them and are a part of their own.
inline constexpr int substep_classes = 5, flow_part = substep_classes, solver_parts = substep_classes + 1;
// How many substeps of its own a part takes in one of the setting.
inline float substep_multiple(int part) { return part == flow_part ? 0.5f : static_cast<float>(1 << part); }

// What a body's island carries, see substeps.cpp; sums are with the root of WorldData::load_parent.
struct alignas(64) IslandLoad {
    // Of the body itself, which is what most contacts read.
    uint64_t step = 0;  // one more than the steps before the one that this entry is of
    Vec3 velocity;
    float inverse_mass = 0.0f, radius = 0.0f;
    float carried = 0.0f;                 // its mass and that of what new contacts put on it, kg
    float settled = 0.0f;                 // how far it is put down for that, m
    float lowest = 0.0f, highest = 0.0f;  // positions along gravity, times gravity; of a root its island's
    uint8_t before = 0;                   // class in the step before
    uint8_t waited = 0;                   // steps since when fewer substeps would do
    uint8_t pressed = 0;                  // steps since when it feels loads that take more
    uint8_t substeps = 0;                 // class
    uint8_t calm = 0;  // steps for which it has been slow, at most calm_steps, or `rested`; `slow`: for so many
    bool meets_moving = false;  // has a contact with another dynamic body
    bool meets_fixed = false;   // has one with what constraints do not move
    bool in_group = false;      // in one of WorldData::joint_groups
    bool held = false;          // rests on a contact that carries already
    bool slept = false;         // sleeps, and goes on from here when it wakes
    bool moves = false, slow = false;
    bool touches = false;  // is in contact
    bool still = false;    // it rested and still does; of a root, all of its island: see rest_speed()
    // Of a root's island.
    alignas(64) int contacts = 0;
    int samples = 0, stirred = 0;           // contacts looked at, and those whose bodies move against each other
    float sampled_sinking = 0.0f;           // sum over samples of load ratio per size, each at least one weight
    float sinking = 0.0f, buckling = 0.0f;  // greatest load ratio of its contacts, per size and per size cubed
    float felt_sinking = 0.0f, felt_buckling = 0.0f;  // the same of what the last step's impulses tell
    uint8_t least = 0;                                // class that its joints ask for
    bool tied = false;   // to other joints or a kinematic body in motion: takes the setting's substeps
    bool rests = false;  // one of its bodies is slow
    bool jointed = false;
    bool flows = false;  // takes half of the setting's
    bool decided = false;
};
static_assert(sizeof(IslandLoad) == 128);

// The bodies of a contact's A and B, by slot. Where one of them is not moved by constraints, it is A. Beside them what
// those who go through all contacts one by one want to know of its record: see choose_substeps().
struct TouchingBodies {
    uint32_t a, b;
    float impulse = 0.0f;  // along the normal, of the last substep, N s
    bool fixed_a;
    bool a_above = false;  // gravity presses A on B
    bool bounces = false;  // with a restitution, or is swift
    bool elastic = false;  // loses next to no energy by that
    bool swift = false;    // see contact_swift
    bool held = false;     // all points carried something in the last step
    bool passes = false;   // see contact_passes; not where forces may move the bodies otherwise
    uint8_t kind = 0;      // see contact_kind()
};

// A new contact on which `upper` rests; `lower` is no_slot where that is static. See first_loads.cpp.
struct FirstLoad {
    float height;  // times gravity
    uint32_t upper, lower, record;
    TouchingBodies bodies;
};

// A body with joints, by slot, and the one that it was reached from: an index in its group, or -1.
struct JointedBody {
    uint32_t slot;
    int32_t parent;
};

// Jointed bodies that need more substeps, see joint_groups.cpp.
struct JointGroupLoad {
    int first, count, joints;  // bodies in WorldData::jointed_bodies
    float sinking;             // as in IslandLoad, of two bodies under half the load each
    uint8_t least;
};

// Two slots of bodies.
struct BodyPair {
    uint32_t a, b;
};

// Stretches of the packed bodies, the active contacts and the active joints that are solved together.
struct SolverPart {
    BodyRange bodies;
    int body_count;  // without empty places
    ContactCut cut;
    int first_contact, contact_count;  // those that pass last
    int row_count;                     // of the others
    int first_joint, joint_count;
};

struct WorldData {
    // `number`: of the world among all built, 1 to 255, which its handles carry.
    WorldData(const WorldConfig& settings, uint32_t number);

    WorldConfig config;
    Memory memory;
    TaskPool tasks;
    BodyStore bodies;
    ColliderStore colliders;
    JointStore joints;
    Removed removed;

    // Bounds of colliders, by whether their bodies are static, with the collider's slot as index. Boxes of bodies that
    // rest stay as they are.
    BroadPhase broad_phase;
    Array<BroadBox> moving_boxes, fixed_boxes, fixed_boxes_before;
    Array<uint32_t> box_place;      // by collider: its place there; no_box: none yet
    Array<uint32_t> changed_boxes;  // places among the moving boxes that are not as the broad phase knows them
    Array<uint8_t> renewed;         // by place among the colliders of movers
    Array<uint32_t> forgotten;      // colliders whose moving box is gone since the broad phase was last told
    int known_boxes = 0;            // moving boxes that it has
    bool fixed_changed = true;      // static colliders came, went or moved
    bool all_pairs_sought = true;   // it has to find all pairs, not only those that begin and end
    Array<BoxPair> box_pairs;       // all pairs, or those that begin
    Array<BoxPair> ended_pairs;
    PairTable pairs;
    Array<BodyPair> rejoined;    // bodies between which a joint came or went
    Array<uint32_t> refiltered;  // colliders that may meet others than before
    Movers movers;
    RestingContacts resting;
    Array<uint8_t> at_rest;      // by collider: its body is no mover
    bool pairs_to_rest = false;  // some listed pairs may have no mover left

    EventData events;
    ContinuousData continuous;
    QueryScene query_scene;  // what queries search, brought up to date by the first of them after a change

    Array<ShapeFrame> frames;  // what the narrow phase reads of colliders, by slot
    const NarrowKernels& narrow_kernels;
    const BodyKernels& body_kernels;
    Array<NarrowScratch> narrow_scratch;  // one a worker

    // Manifolds, kept in place from step to step: each pair has its own stretch.
    Array<ContactRecord> records;
    Array<FoundSeparations> found_separations;  // by record
    Array<ContactExtra> extras;                 // by record, where `has_extras`
    bool has_extras = false;        // some material resists rolling or spinning, has tangential restitution or runs
    Array<uint16_t> deep_contacts;  // by solver body: room for limit_recovery()
    Array<uint32_t> eased;          // records whose overlap is so deep that it may be undone more slowly than is set
    Array<uint32_t> touching;       // records with points of listed pairs, in order
    Array<TouchingBodies> touching_bodies;  // ... and their bodies, within a step
    Array<uint32_t> active;  // those of them that are solved, by class of substeps: at least one body awake
    Array<TouchingBodies> active_bodies;  // in the order of `touching`
    Array<ContactEnds> active_ends;       // in the order of `active`
    Array<uint32_t> unsorted;             // room to sort both by class
    Array<ContactEnds> unsorted_ends;
    int awake_points = 0;            // of listed pairs: points that touch or overlap
    float awake_penetration = 0.0f;  // ... and the deepest overlap, m
    Array<Overlap> overlaps;         // those of pairs at rest first
    // Joints that are solved, kept while they and the awake bodies stay the same.
    Array<uint32_t> active_joints;  // slots, by class of substeps and then in creation order
    Array<JointRecord> joint_records;
    Array<JointAxesRecord> joint_axes;         // of those of them whose rows are data
    Array<uint32_t> fixed_joints;              // records with a side on a body that is not packed
    Array<uint32_t> joint_bodies;              // the awake bodies that the records name, ...
    int joint_bodies_ends[solver_parts] = {};  // ... and where their classes end among the packed ones
    bool joints_changed = true;                // a joint came, went or was set

    // Groups of jointed bodies that need more substeps, with their bodies one after the other.
    Array<JointGroupLoad> joint_groups;
    Array<JointedBody> jointed_bodies;
    Array<uint32_t> jointed_seen;  // room to find them, by body slot
    Array<float> jointed_mass;
    Array<uint32_t> jointed_roots;
    bool joint_groups_changed = true;  // a joint came or went

    // This step's awake bodies, packed for the solver.
    Array<uint32_t> awake;  // slots, by class of substeps and then in order of slots
    SolverBodies solver_bodies;
    Array<IslandLoad> island_loads;  // by body slot
    Array<uint32_t> load_parent;     // union-find over body slots
    Array<uint32_t> loaded;          // slots of those of this step: bodies in contact and those of joint groups
    Array<FirstLoad> first_loads;    // of this step
    SolverPart parts[solver_parts];
    BodyRange alone{0, 0};   // bodies behind them that nothing acts on but gravity: they take the step at once
    int hard_bodies = 0;     // of classes above the setting's
    int flowing_bodies = 0;  // of islands that flow
    int rested_bodies = 0;   // of hard islands that left substeps out
    bool has_packed_kinematic = false;  // some packed bodies are moved by hand
    ScheduleRoom schedule_room;
    size_t expected = 0;          // colliders for whose contacts there is room, see expect_contacts()
    bool contacts_given = false;  // World::reserve() was told how many: none are expected
    Solver solvers[solver_parts];
    Array<uint32_t> island_parent;  // union-find over body slots
    Array<float> island_still;
    Array<BodyPair> touched_sleepers;  // (who touches, sleeping body)
    SeamList seams;
    Array<uint32_t> waking;

    float last_h = 0.0f;    // substep that the impulses of listed pairs belong to, s
    float joints_h = 0.0f;  // the same of the records of joints
    bool in_step = false;
    bool went_alone = false;  // the last step was done on one thread, see step.cpp
    double time = 0.0;
    uint64_t steps = 0;
    StepStatistics statistics{};
    std::vector<std::string> warnings;
};

// The stages of a step, in order; each reads what those before it left.
void settle_movers(WorldData& world);
void limit_motion(WorldData& world);
void update_bounds(WorldData& world, float dt);
void find_box_pairs(WorldData& world);
// The collider's box as the broad phase has it.
const BroadBox& box_of(const WorldData& world, uint32_t collider);
void match_pairs(WorldData& world);
// Takes room for the contacts of so many moving colliders, before there are any.
void expect_contacts(WorldData& world, size_t colliders);
// The same for all pairs with meshes that there is room for.
void expect_mesh_contacts(WorldData& world);
void find_contacts(WorldData& world, float dt);
void silence_seams(WorldData& world);
// Tells by their flags which manifolds of a pair with a mesh the others silence, as long as they are kept.
inline constexpr uint32_t contact_covered = 4;  // beside the flags that the solver reads
void mark_covered(WorldData& world, ColliderPair& p);
void update_islands(WorldData& world, float dt);
// Gives the solvers the contacts that events ask for; when they are scheduled and have their rows.
void watch_contacts(WorldData& world);
void find_joint_groups(WorldData& world);
void choose_substeps(WorldData& world, float dt);
// Takes a contact between bodies at rest that has carried nothing, if its upper body rests on it. A may be static.
void offer_first_load(WorldData& world, uint32_t record, const TouchingBodies& bodies, bool both);
// Sets the impulses of what was offered; `weight`: what a substep of gravity gives to 1 kg, N s.
void guess_first_loads(WorldData& world, float weight);
// Gives every awake body its place in the solver's arrays; after choose_substeps().
void place_bodies(WorldData& world, float dt);
// How the contacts of each class are divided; these are sorted and know their places.
void cut_contacts(WorldData& world);
void pack_contacts(WorldData& world);
void pack_bodies(WorldData& world, float dt);
// Bodies that many others push out of deep overlaps are pushed by each with a share; after pack_contacts().
void limit_recovery(WorldData& world, float dt);
// What the solver wants of contacts whose materials have more than friction and restitution; after pack_contacts().
void pack_extras(WorldData& world, float dt);
// Returns what the solver may keep of the last step.
JointReuse pack_joints(WorldData& world, float h);
void unpack_bodies(WorldData& world, float dt, bool forces_end);
// Puts back and stops the islands of the bodies that are marked as contained; from unpack_bodies().
void contain_islands(WorldData& world);
void stop_at_impacts(WorldData& world, float dt);
// Makes events of what the step did.
void report_events(WorldData& world);
void finish_step(WorldData& world, float dt);
// Removes joints that bore too much in the step that is finished.
void break_joints(WorldData& world);

// The place of WorldData::alone, behind all parts.
inline constexpr int alone_part = solver_parts;
// After the solve: which bodies rested, so that most of their substeps were left out.
void note_rest(WorldData& world);
// 0 .. solver_parts - 1 or alone_part, for a body that is about to be packed; after choose_substeps().
int part_for(WorldData& world, uint32_t slot, float dt);
// Whether a contact bounces in an island so large that blows are not followed through it from body to body; those that
// lose next to no energy are in larger ones.
bool is_crowded(const WorldData& world, const TouchingBodies& bodies);

// Mixes all warm-start impulses of joints into a hash, in creation order.
uint64_t hash_joints(const WorldData& world, uint64_t start);
// What a joint was last given, solved now or not.
JointImpulses joint_impulses(const WorldData& world, uint32_t slot);
// Of a joint whose rows are data: these, with the impulses that they were last given.
JointAxesInfo joint_axes_impulses(const WorldData& world, uint32_t slot);
// Without taking impulses from the records of joints.
void forget_joint_records(WorldData& world);
// Removes the joints of a body that is about to be removed.
void remove_joints_of(WorldData& world, uint32_t body);

// The body takes part in the steps from now on; or not any more, as it is about to be removed.
void add_mover(WorldData& world, uint32_t slot);
void remove_mover(WorldData& world, uint32_t slot);
// Sets what the narrow phase reads of colliders, by slot, whose bodies are taken as not moving within the step.
void set_frames(WorldData& world, const Array<uint32_t>& colliders);
// Whether two colliders whose boxes overlap are a pair.
bool wanted(const WorldData& world, const BoxPair& p);
// A new pair of two colliders, with what does not change while it lasts; its number.
uint32_t begin_pair(WorldData& world, const BoxPair& colliders);
// Sets a pair aside with its impulses, brings it back, ends it; the latter also between steps.
void rest_pair(WorldData& world, uint32_t number);
void wake_pair(WorldData& world, uint32_t number);
void end_pair(WorldData& world, uint32_t number);
void forget_pair(WorldData& world, uint32_t number);
// Takes pairs that have ended or come to rest off the list.
void rest_pairs(WorldData& world);
// The deepest overlap among pairs at rest, m.
float deepest_at_rest(WorldData& world);
// Contacts and overlaps of the listed pairs, in their order, for later stages and callers.
void list_contacts(WorldData& world);

// What a collider reports from now on.
void set_asks(WorldData& world, uint32_t collider, Events events);
// Makes a body kinematic or dynamic, but for its pairs.
void set_body_type(WorldData& world, uint32_t slot, BodyType type);
// Whom a collider meets, and what it is made of; contacts are told of the latter by the caller.
void set_collider_filter(WorldData& world, uint32_t collider, const CollisionFilter& filter);
void set_collider_material(WorldData& world, uint32_t collider, const Material& material);
// For events: a pair is about to end, a body is about to wake.
void note_ended(WorldData& world, const ColliderPair& pair);
void note_woken(WorldData& world, uint32_t slot);
// Empties the lists that the user reads.
void clear_events(EventData& events);

// Wakes a body; those of its island wake with it in the next step.
void wake_body(WorldData& world, uint32_t slot);
// Wakes what touched a body in the last step: it goes away.
void wake_touching(WorldData& world, uint32_t slot);

// What gravity, forces and torques do to a body, cut to what takes it to twice the greatest speed within `dt`.
Vec3 acceleration(const WorldData& world, uint32_t slot, float dt);
Vec3 torque(const WorldData& world, uint32_t slot, float dt);
// v, or the shorter vector of length `most` along it; finite, also where v is not.
Vec3 limited(Vec3 v, float most);
// Cuts p and L to the greatest speeds below; true where one was too large.
bool cap_speed(BodyStore& bodies, uint32_t slot);

}  // namespace lendulet
