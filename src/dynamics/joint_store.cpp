#include "dynamics/joint_store.h"

namespace lendulet {

uint32_t JointStore::add(const JointInfo& joint, const JointAxesInfo* rows, std::string_view joint_name) {
    uint32_t slot = slots.add();
    size_t n = slots.capacity();
    info.resize(n);
    impulses.resize(n);
    record.resize(n, -1);
    next_.resize(2 * n, no_joint_link);
    if (name.size() < n) name.resize(n);
    put(slot, joint, rows, joint_name);
    hang(joint.body_a, 2 * slot);
    hang(joint.body_b, 2 * slot + 1);
    return slot;
}

void JointStore::put(uint32_t slot, const JointInfo& joint, const JointAxesInfo* rows, std::string_view joint_name) {
    info[slot] = joint;
    info[slot].axes = -1;
    if (rows) {
        if (free_axes_.empty()) free_axes_.push_back(static_cast<int32_t>(axes.size())), axes.push_back(*rows);
        info[slot].axes = free_axes_.back();
        free_axes_.pop_back();
        axes[static_cast<size_t>(info[slot].axes)] = *rows;
    }
    breakable_ += joint.breaks();
    impulses[slot] = {};
    record[slot] = -1;
    name[slot] = std::string(joint_name);
}

void JointStore::hang_all() {
    for (uint32_t& link : first_) link = no_joint_link;
    for (uint32_t slot : slots.order()) {
        hang(info[slot].body_a, 2 * slot);
        hang(info[slot].body_b, 2 * slot + 1);
    }
}

void JointStore::remove(uint32_t slot) {
    unhang(info[slot].body_a, 2 * slot);
    unhang(info[slot].body_b, 2 * slot + 1);
    if (info[slot].axes >= 0) free_axes_.push_back(info[slot].axes);
    breakable_ -= info[slot].breaks();
    name[slot].clear();
    slots.remove(slot);
}

void JointStore::copy(const JointStore& o) {
    slots.copy(o.slots);
    breakable_ = o.breakable_;
    copy_array(o.info, info);
    copy_array(o.impulses, impulses);
    record.assign(o.record.size(), -1);
    copy_array(o.next_, next_);
    copy_array(o.first_, first_);
    copy_array(o.axes, axes);
    copy_array(o.free_axes_, free_axes_);
    name = o.name;
}

void JointStore::hang(uint32_t body, uint32_t link) {
    if (first_.size() <= body) first_.resize(body + 1, no_joint_link);
    next_[link] = first_[body];
    first_[body] = link;
}

void JointStore::unhang(uint32_t body, uint32_t link) {
    uint32_t* at = &first_[body];
    while (*at != link) at = &next_[*at];
    *at = next_[link];
}

bool JointStore::keeps_apart(uint32_t a, uint32_t b) const {
    if (a >= first_.size() || b >= first_.size()) return false;
    // Both lists at once, until the shorter one ends: a static body may carry thousands of joints.
    uint32_t from_a = first_[a], from_b = first_[b];
    auto joins = [&](uint32_t link, uint32_t other) {
        const JointInfo& joint = info[link / 2];
        return (link % 2 == 0 ? joint.body_b : joint.body_a) == other && !joint.collide_connected;
    };
    while (from_a != no_joint_link && from_b != no_joint_link) {
        if (joins(from_a, b) || joins(from_b, a)) return true;
        from_a = next_[from_a];
        from_b = next_[from_b];
    }
    return false;
}

}  // namespace lendulet
