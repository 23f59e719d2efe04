#include "solver/joints/schedule.h"

#include <cstring>

#include "lendulet/math.h"

namespace lendulet {
namespace {

// Groups of one colour differ by class, by which sides are moved and by mode.
enum Sides { both_moved, only_b_moved, only_a_moved, side_kinds };
constexpr int modes = 2, classes = joint_classes * side_kinds * modes;

bool moved(const SolverBodies& bodies, int32_t i) { return bodies.state[static_cast<size_t>(i)].inverse_mass > 0.0f; }

Sides sides(const SolverBodies& bodies, const JointRecord& r) {
    if (!moved(bodies, r.body_b)) return only_a_moved;
    return moved(bodies, r.body_a) ? both_moved : only_b_moved;
}

// The reserved body of empty lanes: not one of contacts, nor the one of static bodies. Groups are solved one after the
// other, so those of a class may share it.
int32_t filler(int type) {
    int32_t f = 3 + type;
    return f < static_body ? f : f + 1;
}
static_assert(3 + joint_classes < reserved_bodies);

Vec3 get(const float* p) { return {p[0], p[1], p[2]}; }

// Whether a contact presses, or will within the step as the bodies move now.
bool presses(const ContactRecord& r, const SolverBodies& bodies, float dt) {
    const BodyStart &a = bodies.start[static_cast<size_t>(r.body_a)], &b = bodies.start[static_cast<size_t>(r.body_b)];
    for (int j = 0; j < r.point_count; ++j) {
        Vec3 ra = get(r.points[j].position), rb = ra - get(r.arm_offset);
        Vec3 v = (get(b.v) - get(a.v)) + (cross(get(b.w), rb) - cross(get(a.w), ra));
        if (r.normal_impulse[j] > 0.0f || r.points[j].separation + dt * minimum(dot(get(r.normal), v), 0.0f) <= 0.0f)
            return true;
    }
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

void JointSchedule::find_groups_of_bodies(const JointRecord* records, int count, const SolverBodies& bodies) {
    size_t n = static_cast<size_t>(bodies.count);
    joint_count_.assign(n, 0u);
    parent_.resize_unset(n);
    for (uint32_t i = 0; i < n; ++i) parent_[i] = i;
    for (int i = 0; i < count; ++i) {
        for (int32_t body : {records[i].body_a, records[i].body_b})
            if (moved(bodies, body)) ++joint_count_[static_cast<size_t>(body)];
        if (sides(bodies, records[i]) != both_moved) continue;
        uint32_t a = root(static_cast<uint32_t>(records[i].body_a)), b = root(static_cast<uint32_t>(records[i].body_b));
        if (a != b) parent_[a > b ? a : b] = a > b ? b : a;
    }
    jointed_.clear();
    for (uint32_t i = 0; i < n; ++i) {
        parent_[i] = root(i);
        if (joint_count_[i] > 0) jointed_.push_back(i);
    }
    touched_.assign(n, uint8_t{0});
}

// Bits of touched_: that the group has contacts that press, and while modes are set that it has changed in that.
constexpr uint8_t touches = 1, changes = 2;

// Contacts that press make the whole group of jointed bodies theirs.
void JointSchedule::find_touching(ContactList contacts, const SolverBodies& bodies) {
    touched_before_.swap(touched_);
    touched_.assign(parent_.size(), uint8_t{0});
    for (int i = 0; i < contacts.count; ++i) {
        const ContactRecord& r = contacts.records[contacts.list[i]];
        size_t a = static_cast<size_t>(r.body_a), b = static_cast<size_t>(r.body_b);
        if ((joint_count_[a] == 0 && joint_count_[b] == 0) || !presses(r, bodies, contacts.dt)) continue;
        if (joint_count_[a] > 0) touched_[parent_[a]] = touches;
        if (joint_count_[b] > 0) touched_[parent_[b]] = touches;
    }
}

void JointSchedule::set_modes(JointRecord* records, int count, const SolverBodies& bodies) {
    for (int i = 0; i < count; ++i) {
        JointRecord& r = records[i];
        size_t a = static_cast<size_t>(r.body_a), b = static_cast<size_t>(r.body_b);
        uint8_t& group = touched_[parent_[moved(bodies, r.body_b) ? b : a]];
        bool split = (group & touches) == 0;
        bool alone = split && joint_count_[a] <= 1 && joint_count_[b] <= 1;
        uint32_t crowd = joint_count_[a] > joint_count_[b] ? joint_count_[a] : joint_count_[b];
        r.relaxation = minimum(1.0f, joint_crowd / static_cast<float>(crowd));
        r.old_flags = r.flags;
        r.flags = static_cast<uint16_t>(joint_stepped | (split ? joint_split : 0) | (alone ? joint_alone : 0));
        if ((r.old_flags & joint_stepped) != 0 && ((r.old_flags ^ r.flags) & joint_split) != 0) group |= changes;
    }
}

void JointSchedule::set_bodies(SolverBodies& bodies) {
    for (uint32_t i : jointed_) {
        const uint8_t group = touched_[parent_[i]];
        BodyMotion& m = bodies.motion[i];
        m.joints =
            ((group & touches) != 0 ? joints_touching : joints_split) + ((group & changes) != 0 ? joints_change : 0.0f);
        m.free = 0.0f;
    }
}

JointGroup JointSchedule::group_of(int type, int side_kind, bool split, int count, const uint32_t* which, size_t& bytes,
                                   const JointTable& table) const {
    JointGroup g;
    g.type = static_cast<JointClass>(type);
    g.moved_a = side_kind != only_b_moved;
    g.moved_b = side_kind != only_a_moved;
    g.split = split;
    g.filler = filler(type);
    g.count = count;
    g.order = which;
    g.axes = nullptr;
    size_t blocks = block_count(static_cast<uint32_t>(count), table.width);
    g.rows = reinterpret_cast<std::byte*>(bytes);  // offsets until the block is allocated
    bytes += table.of[type].row_bytes * blocks;
    g.frames = reinterpret_cast<std::byte*>(bytes);
    bytes += table.of[type].frame_bytes * blocks;
    return g;
}

void JointSchedule::colour(const JointRecord* records, int count, const SolverBodies& bodies, const JointTable& table,
                           const JointTable& scalar_table) {
    sorter_.begin(bodies.count, count, classes);
    for (int i = 0; i < count; ++i) {
        const JointRecord& r = records[i];
        Sides s = sides(bodies, r);
        int mode = (r.flags & joint_split) != 0 ? 1 : 0;
        sorter_.add(r.body_a, s != only_b_moved, r.body_b, s != only_a_moved,
                    (static_cast<int>(r.type) * side_kinds + s) * modes + mode);
    }
    sorter_.end();
    order.resize_unset(static_cast<size_t>(count));
    groups.clear();
    first_overflow_group = -1;
    size_t bytes = 0;
    sorter_.for_each_group([&](int, int colour, int c, uint32_t begin, uint32_t n) {
        bool overflows = ColourSorter::overflows(colour);
        if (overflows && first_overflow_group < 0) first_overflow_group = groups.count();
        const uint32_t each = overflows ? 1 : n;  // those that share bodies are groups of one
        for (uint32_t first = begin; first < begin + n; first += each)
            groups.push_back(group_of(c / (side_kinds * modes), c / modes % side_kinds, c % modes == 1,
                                      static_cast<int>(each), order.data() + first, bytes,
                                      overflows ? scalar_table : table));
    });
    if (first_overflow_group < 0) first_overflow_group = groups.count();
    rows.resize_unset(bytes);
    for (JointGroup& g : groups) {
        g.rows = rows.data() + reinterpret_cast<size_t>(g.rows);
        g.frames = rows.data() + reinterpret_cast<size_t>(g.frames);
    }
    sorter_.fill([&](uint32_t place, uint32_t i) { order[place] = i; });
}

void JointSchedule::make_ready(size_t bodies, size_t joints, const JointTable& table) {
    const JointKernels& ball = table.of[static_cast<int>(JointClass::ball)];
    order.make_ready(joints);
    rows.make_ready((joints + joints / 8) * (ball.row_bytes + ball.frame_bytes) / static_cast<size_t>(table.width));
    sorter_.make_ready(bodies, joints);
    joint_count_.make_ready(bodies), jointed_.make_ready(bodies), parent_.make_ready(bodies);
    touched_.make_ready(bodies), touched_before_.make_ready(bodies);
}

bool JointSchedule::build(JointRecord* records, int count, bool same, ContactList contacts, SolverBodies& bodies,
                          const JointTable& table, const JointTable& scalar_table) {
    if (count == 0) {
        groups.clear();
        order.clear();
        first_overflow_group = 0;
        return true;
    }
    if (!same) find_groups_of_bodies(records, count, bodies);
    find_touching(contacts, bodies);
    const bool as_before = same && std::memcmp(touched_.data(), touched_before_.data(), touched_.size()) == 0;
    if (!as_before) set_modes(records, count, bodies);
    set_bodies(bodies);
    if (as_before) return false;
    for (uint8_t& group : touched_) group &= touches;
    colour(records, count, bodies, table, scalar_table);
    return true;
}

}  // namespace lendulet
