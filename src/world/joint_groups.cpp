// Which groups of jointed bodies iteration would leave slack at the world's setting of substeps: known from the joints
// and the masses alone, so it is found only when joints come or go. choose_substeps() gives such groups more substeps.
//
// A joint under the weight of `carried` gives way by (leak / bias) g h^2 carried (1 / m_A + 1 / m_B), see
// docs/solver.md. In a tree what it carries is the mass of all bodies beyond it, seen from the body that hangs on
// something fixed, or from the heaviest one. Short closed loops are mechanisms, which are to follow their laws: errors
// of their joints add up. Long ones, as bridges, hang like trees that are cut where ways from what is fixed meet.
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int most_joints = 256;      // of a group: direct cost of more substeps, in proportion to joints
constexpr int most_loop_joints = 32;  // of a mechanism
constexpr int short_loop = 8;         // joints a loop on average, of a mechanism
constexpr float slack_load = 12.0f;   // carried mass over the reduced mass of two bodies; 0.3 mm at 8 substeps of 60 Hz
constexpr uint8_t loop_class = 2;     // four times the setting's substeps
constexpr float taut = 4.0f;          // what holds a long loop is no weight but the tension of a flat catenary

struct GroupCount {
    int inner = 0, anchors = 0;  // joints between two bodies of the group, and to others
    uint32_t heaviest = 0;
};

bool dynamic(const WorldData& world, uint32_t slot) { return world.bodies.info[slot].type == BodyType::dynamic; }

uint32_t other_body(const JointInfo& j, uint32_t slot) { return j.body_a == slot ? j.body_b : j.body_a; }

void begin_list(WorldData& world, uint32_t root, uint32_t mark) {
    world.jointed_bodies.push_back({root, -1});
    world.jointed_seen[root] = mark;
}

// Appends all bodies that joints connect with those of the list from `first` on, nearest first, each with the place of
// the one before it.
void collect(WorldData& world, size_t first, uint32_t mark) {
    Array<JointedBody>& list = world.jointed_bodies;
    Array<uint32_t>& seen = world.jointed_seen;
    for (size_t i = first; i < list.size(); ++i) {
        const uint32_t slot = list[i].slot;
        world.joints.for_each_of(slot, [&](uint32_t joint) {
            uint32_t next = other_body(world.joints.info[joint], slot);
            if (!dynamic(world, next) || seen[next] == mark) return;
            seen[next] = mark;
            list.push_back({next, static_cast<int32_t>(i - first)});
        });
    }
}

bool is_anchor(const WorldData& world, uint32_t joint, uint32_t slot) {
    return !dynamic(world, other_body(world.joints.info[joint], slot));
}

GroupCount count(const WorldData& world, size_t first) {
    GroupCount c;
    const Array<JointedBody>& list = world.jointed_bodies;
    c.heaviest = list[first].slot;
    for (size_t i = first; i < list.size(); ++i) {
        const uint32_t slot = list[i].slot;
        if (world.bodies.mass[slot].inverse_mass < world.bodies.mass[c.heaviest].inverse_mass) c.heaviest = slot;
        world.joints.for_each_of(slot, [&](uint32_t joint) {
            if (is_anchor(world, joint, slot)) ++c.anchors;
            else ++c.inner;
        });
    }
    c.inner /= 2;  // seen from both bodies
    return c;
}

// Makes the list of a group anew from the bodies that hang on something fixed, or from the heaviest.
void list_from_roots(WorldData& world, size_t first, const GroupCount& c, uint32_t mark) {
    Array<JointedBody>& list = world.jointed_bodies;
    Array<uint32_t>& roots = world.jointed_roots;
    roots.clear();
    for (size_t i = first; i < list.size(); ++i) {
        bool hangs = false;
        world.joints.for_each_of(list[i].slot,
                                 [&](uint32_t joint) { hangs = hangs || is_anchor(world, joint, list[i].slot); });
        if (hangs) roots.push_back(list[i].slot);
    }
    if (roots.empty()) roots.push_back(c.heaviest);
    list.resize_unset(first);
    for (uint32_t root : roots) begin_list(world, root, mark);
    collect(world, first, mark);
}

// Greatest load of the joints of such a list, per size of the bodies.
void measure(WorldData& world, JointGroupLoad& g, bool anchored) {
    const JointedBody* list = world.jointed_bodies.data() + g.first;
    Array<float>& carried = world.jointed_mass;
    carried.resize_unset(static_cast<size_t>(g.count));
    for (int i = 0; i < g.count; ++i) carried[static_cast<size_t>(i)] = world.bodies.mass[list[i].slot].mass;
    for (int i = g.count - 1; i >= 0; --i) {
        const int parent = list[i].parent;
        const float mass = carried[static_cast<size_t>(i)];
        float inverse = world.bodies.mass[list[i].slot].inverse_mass, radius = world.bodies.info[list[i].slot].radius;
        if (parent < 0 && !anchored) continue;
        if (parent >= 0) {
            carried[static_cast<size_t>(parent)] += mass;
            inverse += world.bodies.mass[list[parent].slot].inverse_mass;
            radius = minimum(radius, world.bodies.info[list[parent].slot].radius);
        }
        if (mass * inverse > slack_load) g.sinking = maximum(g.sinking, mass * inverse / (1.15f * radius));
    }
}

}  // namespace

void find_joint_groups(WorldData& world) {
    if (!world.joint_groups_changed) return;
    world.joint_groups_changed = false;
    world.joint_groups.clear();
    world.jointed_bodies.clear();
    world.jointed_seen.assign(world.bodies.slots.capacity(), 0u);
    uint32_t mark = 0;
    for (uint32_t joint : world.joints.slots.order()) {
        const JointInfo& j = world.joints.info[joint];
        uint32_t any = dynamic(world, j.body_a) ? j.body_a : j.body_b;
        if (world.jointed_seen[any] != 0) continue;
        const size_t first = world.jointed_bodies.size();
        begin_list(world, any, ++mark);
        collect(world, first, mark);
        GroupCount c = count(world, first);
        JointGroupLoad g{static_cast<int>(first), world.jointed_bodies.count() - static_cast<int>(first),
                         c.inner + c.anchors, 0.0f, 0};
        const int loops = g.joints - g.count + (c.anchors == 0 ? 1 : 0);
        if (loops > 0 && g.joints <= most_loop_joints && g.joints <= short_loop * loops) {
            g.least = loop_class;
        } else if (g.joints <= most_joints) {
            list_from_roots(world, first, c, ++mark);
            measure(world, g, c.anchors > 0);
            if (loops > 0) g.sinking *= taut;
        }
        if (g.least > 0 || g.sinking > 0.0f) world.joint_groups.push_back(g);
        else world.jointed_bodies.resize_unset(first);
    }
}

}  // namespace lendulet
