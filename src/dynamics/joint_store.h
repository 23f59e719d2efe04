// All joints of a world, by slot, and which bodies they hang on.
//
// Frames are those on the bodies' principal frames (centre of mass, principal axes), as the solver wants them. The
// joints of each body form a list, so that a removed body takes its joints along and two bodies' joints are found
// quickly.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/memory.h"
#include "dynamics/slots.h"
#include "lendulet/joint.h"

namespace lendulet {

inline constexpr uint32_t no_joint_link = ~0u;

struct JointInfo {
    JointType type = JointType::fixed;
    bool collide_connected = false;
    uint32_t body_a = 0, body_b = 0;  // slots
    Transform frame_a{}, frame_b{};   // joint frame in each body's principal frame
    Limit limit{};
    Motor motor{};
    Spring spring{};
    float friction = 0.0f;  // N m or N, at most
    float swing_limit = 4.0f;
    Limit twist_limit{};
    int32_t axes = -1;  // six_degrees and distance: index in JointStore::axes
    float break_force = std::numeric_limits<float>::infinity(), break_torque = std::numeric_limits<float>::infinity();
    uint64_t user_data = 0;
    // What drives the one coordinate, or a ball joint about all axes.
    Motor drive() const {
        if (type == JointType::ball) return {0.0f, friction};
        return motor.max_force > 0.0f ? motor : Motor{0.0f, friction};
    }
    bool breaks() const { return minimum(break_force, break_torque) < std::numeric_limits<float>::infinity(); }
};

// The rows of a joint whose rows are data, and what the solver leaves of each: impulses on B, N s and N m s.
struct JointAxesInfo {
    JointAxis row[joint_coordinates];
    uint8_t distance_axes = 0, swing_axes = 0;  // bits
    float limit[joint_coordinates]{}, motor[joint_coordinates]{}, spring[joint_coordinates]{};
};

// What the solver leaves of a joint: impulses on B of the last substep. Linear ones along world axes (sliders: y and z
// of the joint frame), angular ones along the joint frame's y, z and x axes, each as many as the joint locks; N s and
// N m s; those of a ball joint are its friction's, along world axes. While a joint is solved, the world holds them in
// its JointRecord.
struct JointImpulses {
    float linear[3]{}, angular[3]{};
    float limit[2]{};  // of the limited coordinate, or of a ball joint's swing and twist
    float motor = 0.0f;
    float spring = 0.0f;
    uint16_t flags = 0;             // the solver's: what part of a substep they stand for
    Vec3 impulse, angular_impulse;  // all of them, world axes, the step's mean
    float h = 0.0f;                 // that substep, s; 0: the joint has not been solved yet
};

struct JointStore {
    Slots slots;
    Array<JointInfo> info;
    Array<JointImpulses> impulses;
    Array<int32_t> record;      // index of its JointRecord while it is solved, or -1
    Array<JointAxesInfo> axes;  // by JointInfo::axes
    std::vector<std::string> name;

    JointStore(const Memory* memory, uint32_t world)
        : slots(memory, world),
          info(memory),
          impulses(memory),
          record(memory),
          axes(memory),
          next_(memory),
          first_(memory),
          free_axes_(memory) {}

    // A new joint; hangs it on both bodies. `rows` of joints that have such, else null.
    uint32_t add(const JointInfo& joint, const JointAxesInfo* rows, std::string_view name);
    void remove(uint32_t slot);
    // One that was removed is about to be alive again, then its bodies are told by hang_all().
    void put(uint32_t slot, const JointInfo& joint, const JointAxesInfo* rows, std::string_view name);
    // Makes the lists of the bodies anew.
    void hang_all();
    // Becomes a copy of another world's joints, with their handles; none of them is being solved.
    void copy(const JointStore& o);
    JointId id(uint32_t slot) const { return {slot, slots.generation(slot)}; }
    bool alive(JointId joint) const { return slots.alive(joint.index, joint.generation); }
    int count() const { return slots.count(); }
    int breakable() const { return breakable_; }

    // The youngest joint of a body, or no_joint_link.
    uint32_t first_of(uint32_t body) const {
        return body < first_.size() && first_[body] != no_joint_link ? first_[body] / 2 : no_joint_link;
    }
    // Calls visit(joint) for every joint of a body, the youngest first.
    template <class Visit>
    void for_each_of(uint32_t body, Visit&& visit) const {
        if (body >= first_.size()) return;
        for (uint32_t link = first_[body]; link != no_joint_link; link = next_[link]) visit(link / 2);
    }
    // Whether a joint between these bodies keeps their colliders from meeting. Cost: the joints of
    // the body that has fewer.
    bool keeps_apart(uint32_t a, uint32_t b) const;

private:
    // A link is 2 * joint + side; lists lead from each body through its links, youngest first.
    void hang(uint32_t body, uint32_t link);
    void unhang(uint32_t body, uint32_t link);

    int breakable_ = 0;         // how many may break
    Array<uint32_t> next_;      // by link
    Array<uint32_t> first_;     // by body
    Array<int32_t> free_axes_;  // places in `axes` that no joint has
};

}  // namespace lendulet
