#include "solver/joint_schedule.h"

#include "lendulet/math.h"

namespace lendulet {
namespace {

// Groups of one colour differ by class and by which sides are moved.
enum Sides { both_moved, only_b_moved, only_a_moved, side_kinds };
constexpr int classes = joint_classes * side_kinds;

bool moved(const SolverBodies& bodies, int32_t i) { return bodies.state[static_cast<size_t>(i)].inverse_mass > 0.0f; }

Sides sides(const SolverBodies& bodies, const JointRecord& r) {
    if (!moved(bodies, r.body_b)) return only_a_moved;
    return moved(bodies, r.body_a) ? both_moved : only_b_moved;
}

// Empty lanes of the groups of one colour must not share a body, nor with those of contacts: reserved bodies 3 to 15
// but for the one of static bodies.
int32_t filler(int type, int side_kind) {
    int32_t f = 3 + type + (side_kind == only_a_moved ? joint_classes : 0);
    return f < static_body ? f : f + 1;
}
static_assert(3 + 2 * joint_classes < reserved_bodies);

bool presses(const ContactRecord& r) {
    for (int j = 0; j < r.point_count; ++j)
        if (r.normal_impulse[j] > 0.0f || r.points[j].separation <= 0.0f) return true;
    return false;
}

}  // namespace

uint32_t JointSchedule::root(uint32_t i) {
    while (parent_[i] != i) {
        parent_[i] = parent_[parent_[i]];
        i = parent_[i];
    }
    return i;
}

// Contacts that press make the whole group of jointed bodies theirs. Where no contact touches a jointed body, which is
// quickly seen, groups need not be found.
void JointSchedule::find_touching(const JointRecord* records, int count, ContactList contacts,
                                  const SolverBodies& bodies) {
    touched_.assign(static_cast<size_t>(bodies.count), uint8_t{0});
    any_touching = false;
    for (int i = 0; i < contacts.count; ++i) {
        const ContactRecord& r = contacts.records[contacts.list[i]];
        if (!presses(r)) continue;
        for (int32_t body : {r.body_a, r.body_b})
            if (joint_count_[static_cast<size_t>(body)] > 0)
                touched_[static_cast<size_t>(body)] = 1, any_touching = true;
    }
    if (!any_touching) return;
    parent_.resize_unset(static_cast<size_t>(bodies.count));
    for (uint32_t i = 0; i < parent_.size(); ++i) parent_[i] = i;
    for (int i = 0; i < count; ++i) {
        if (sides(bodies, records[i]) != both_moved) continue;
        uint32_t a = root(static_cast<uint32_t>(records[i].body_a)), b = root(static_cast<uint32_t>(records[i].body_b));
        if (a != b) parent_[a > b ? a : b] = a > b ? b : a;
    }
    for (uint32_t i = 0; i < parent_.size(); ++i)
        if (touched_[i]) touched_[root(i)] = 1;
    for (uint32_t i = 0; i < parent_.size(); ++i) touched_[i] = touched_[root(i)];
}

void JointSchedule::set_modes(JointRecord* records, int count, SolverBodies& bodies) {
    for (int i = 0; i < bodies.count; ++i) {
        size_t k = static_cast<size_t>(i);
        bodies.motion[k].joints = 0.0f;
        if (joint_count_[k] == 0) continue;
        bodies.motion[k].joints = touched_[k] ? 1.0f : 2.0f;
        bodies.motion[k].free = 0.0f;
    }
    for (int i = 0; i < count; ++i) {
        JointRecord& r = records[i];
        size_t a = static_cast<size_t>(r.body_a), b = static_cast<size_t>(r.body_b);
        bool split = !touched_[moved(bodies, r.body_b) ? b : a];
        bool alone = split && joint_count_[a] <= 1 && joint_count_[b] <= 1;
        uint32_t crowd = joint_count_[a] > joint_count_[b] ? joint_count_[a] : joint_count_[b];
        r.relaxation = minimum(1.0f, joint_crowd / static_cast<float>(crowd));
        r.flags = (split ? joint_split : 0u) | (alone ? joint_alone : 0u);
    }
}

void JointSchedule::colour(const JointRecord* records, int count, const SolverBodies& bodies,
                           const SolverKernels& kernels, const SolverKernels& scalar_kernels) {
    sorter_.begin(bodies.count, count, classes);
    for (int i = 0; i < count; ++i) {
        const JointRecord& r = records[i];
        Sides s = sides(bodies, r);
        sorter_.add(r.body_a, s != only_b_moved, r.body_b, s != only_a_moved,
                    static_cast<int>(r.type) * side_kinds + s);
    }
    sorter_.end();
    order.resize_unset(static_cast<size_t>(count));
    groups.clear();
    first_overflow_group = -1;
    size_t bytes = 0;
    sorter_.for_each_group([&](int colour, int c, uint32_t begin, uint32_t n) {
        bool overflows = colour == ColourSorter::overflow_colour;
        if (overflows && first_overflow_group < 0) first_overflow_group = groups.count();
        const SolverKernels& table = overflows ? scalar_kernels : kernels;
        int type = c / side_kinds, side_kind = c % side_kinds;
        JointGroup g;
        g.type = static_cast<JointClass>(type);
        g.moved_a = side_kind != only_b_moved;
        g.moved_b = side_kind != only_a_moved;
        g.filler = filler(type, side_kind);
        g.count = static_cast<int>(n);
        g.order = order.data() + begin;
        g.rows = reinterpret_cast<std::byte*>(bytes);  // an offset until the block is allocated below
        bytes += table.joints[type].row_bytes * block_count(n, table.width);
        groups.push_back(g);
    });
    if (first_overflow_group < 0) first_overflow_group = groups.count();
    rows.resize_unset(bytes);
    for (JointGroup& g : groups) g.rows = rows.data() + reinterpret_cast<size_t>(g.rows);
    sorter_.fill([&](uint32_t place, uint32_t i) { order[place] = i; });
}

void JointSchedule::build(JointRecord* records, int count, ContactList contacts, SolverBodies& bodies,
                          const SolverKernels& kernels, const SolverKernels& scalar_kernels) {
    groups.clear();
    first_overflow_group = 0;
    any_touching = false;
    if (count == 0) return;
    joint_count_.assign(static_cast<size_t>(bodies.count), 0u);
    for (int i = 0; i < count; ++i)
        for (int32_t body : {records[i].body_a, records[i].body_b})
            if (moved(bodies, body)) ++joint_count_[static_cast<size_t>(body)];
    find_touching(records, count, contacts, bodies);
    set_modes(records, count, bodies);
    colour(records, count, bodies, kernels, scalar_kernels);
}

}  // namespace lendulet
