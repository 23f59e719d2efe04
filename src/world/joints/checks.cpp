#include "world/joints/checks.h"

#include "world/validate.h"

namespace lendulet {
namespace {

constexpr float turn = 2.0f * pi;
// m: no two places of a world are farther apart than its corners are, 2 sqrt(3) world_extent.
constexpr float most_apart = 4.0f * world_extent;

Error bad_joint(const char* call, std::string what) {
    return refused_joint(ErrorCode::bad_joint, call, std::move(what));
}

// Bounds that are finite, or infinite on their own side; `most` is the widest angle between them, 0 for lengths.
Status check_limit(const Limit& limit, const std::string& name, float most, const char* call) {
    if (limit.lower != limit.lower || limit.upper != limit.upper)
        return refused_joint(ErrorCode::non_finite, call, name + " must be numbers");
    if (limit.free()) {
        if (limit.lower == 1.0f && limit.upper == -1.0f) return {};
        return bad_joint(call,
                         name + ": lower bound " + text(limit.lower) + " is above upper bound " + text(limit.upper));
    }
    if (limit.locked() && !is_finite(limit.lower)) return bad_joint(call, name + ": cannot be locked at infinity");
    if (most == 0.0f && (limit.lower > most_apart || limit.upper < -most_apart))
        return bad_joint(call, name + ": from " + text(limit.lower) + " to " + text(limit.upper) +
                                   " m is beyond the world, which is at most " + text(most_apart) + " m across");
    if (most > 0.0f &&
        (limit.upper - limit.lower > most || absolute(limit.lower) > turn || absolute(limit.upper) > turn))
        return bad_joint(call, name + ": bounds must lie within one turn of 0 and of each other");
    return {};
}

// A coordinate that is never less than 0.
Status check_size(const Limit& limit, const std::string& name, const char* call) {
    if (!limit.free() && limit.upper < 0.0f)
        return bad_joint(call, name + ": upper bound " + text(limit.upper) + " must not be negative");
    return {};
}

Status check_axis(const JointAxis& axis, const std::string& name, float most, const char* call) {
    if (Status s = check_limit(axis.limit, "limit " + name, most, call); !s) return s;
    if (Status s = check_motor(axis.motor, call); !s) return s;
    if (Status s = check_spring(axis.spring, most > 0.0f, call); !s) return s;
    if (Status s = check_joint_friction(axis.friction, call); !s) return s;
    if (!is_finite(axis.limit_stiffness) || !is_finite(axis.limit_damping))
        return refused_joint(ErrorCode::non_finite, call, "limit " + name + ": stiffness and damping must be numbers");
    if (axis.limit_stiffness < 0.0f || axis.limit_damping < 0.0f)
        return bad_joint(call, "limit " + name + ": stiffness and damping must not be negative");
    return {};
}

bool is_used(const JointAxis& axis) {
    return !axis.limit.free() || axis.motor.max_force > 0.0f || axis.friction > 0.0f || axis.spring.stiffness > 0.0f ||
           axis.spring.damping > 0.0f;
}

Status check_several(const JointAxis& axis, const bool (&of)[3], const std::string& name, float most,
                     const char* call) {
    if (Status s = check_axis(axis, "of the " + name, most, call); !s) return s;
    if (Status s = check_size(axis.limit, "limit of the " + name, call); !s) return s;
    int count = int{of[0]} + int{of[1]} + int{of[2]};
    if (count == 1 || (count == 0 && is_used(axis)))
        return bad_joint(call, "the " + name + " must be about two or three axes, names " + std::to_string(count));
    return {};
}

Status check_six(const SixDegrees& axes, const char* call) {
    constexpr const char* names[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
        if (Status s = check_axis(axes.linear[i], std::string("along ") + names[i], 0.0f, call); !s) return s;
        if (Status s = check_axis(axes.angular[i], std::string("about ") + names[i], turn, call); !s) return s;
    }
    if (Status s = check_several(axes.distance, axes.distance_axes, "distance", 0.0f, call); !s) return s;
    return check_several(axes.swing, axes.swing_axes, "swing", turn, call);
}

}  // namespace

Error refused_joint(ErrorCode code, const char* call, std::string what) {
    return {code, std::string(call) + ": " + std::move(what)};
}

Status check_bodies(const WorldData& world, BodyId a, BodyId b, const char* call) {
    if (!world.bodies.alive(a)) return no_such(world.bodies.slots, a.generation, call, "body A");
    if (!world.bodies.alive(b)) return no_such(world.bodies.slots, b.generation, call, "body B");
    if (a == b) return bad_joint(call, "body A and body B are the same");
    auto moved = [&](BodyId id) { return world.bodies.info[id.index].type == BodyType::dynamic; };
    if (!moved(a) && !moved(b))
        return refused_joint(ErrorCode::no_dynamic_body, call,
                             "neither body is dynamic, so the joint could move nothing");
    return {};
}

Result<Transform> check_frame(const Transform& frame, const char* name, const char* call) {
    if (!is_finite(frame.translation))
        return refused_joint(ErrorCode::non_finite, call, std::string(name) + " must be finite");
    if (max_component(absolute(frame.translation)) > most_apart)
        return bad_joint(call, std::string(name) + " is farther than " + text(most_apart) + " m from its body");
    Result<Quat> q = unit_quaternion(frame.rotation, call);
    if (!q) return q.error();
    return Transform{frame.translation, q.value()};
}

Status check_motor(const Motor& motor, const char* call) {
    if (!is_finite(motor.target_velocity) || motor.max_force != motor.max_force)
        return refused_joint(ErrorCode::non_finite, call, "the motor's velocity and force must be numbers");
    if (motor.max_force < 0.0f)
        return bad_joint(call, "the motor's force is " + text(motor.max_force) + ", must not be negative");
    return {};
}

Status check_spring(const Spring& spring, bool turns, const char* call) {
    if (!is_finite(spring.stiffness) || !is_finite(spring.damping) || !is_finite(spring.target) ||
        !is_finite(spring.target_velocity) || spring.max_force != spring.max_force)
        return refused_joint(ErrorCode::non_finite, call, "the spring's values must be numbers");
    if (spring.stiffness < 0.0f || spring.damping < 0.0f || spring.max_force < 0.0f)
        return bad_joint(call, "the spring's stiffness, damping and force must not be negative");
    const float most = turns ? turn : most_apart;
    if (absolute(spring.target) > most)
        return bad_joint(call, "the spring's target is " + text(spring.target) + ", must be within " + text(most) +
                                   (turns ? " rad" : " m"));
    return {};
}

Status check_joint_friction(float friction, const char* call) {
    if (friction != friction) return refused_joint(ErrorCode::non_finite, call, "the friction must be a number");
    if (friction < 0.0f) return bad_joint(call, "the friction is " + text(friction) + ", must not be negative");
    return {};
}

Status check_rows(const JointDef& def, const char* call) {
    if (def.type != JointType::fixed && def.type != JointType::six_degrees)
        if (Status s = check_joint_friction(def.friction, call); !s) return s;
    switch (def.type) {
        case JointType::fixed:
            break;
        case JointType::ball:
            if (!(def.swing_limit >= 0.0f))
                return bad_joint(call, "swing limit is " + text(def.swing_limit) + ", must not be negative");
            return check_limit(def.twist_limit, "twist limit", turn, call);
        case JointType::hinge:
        case JointType::slider:
        case JointType::distance:
            if (Status s = check_limit(def.limit, "limit", def.type == JointType::hinge ? turn : 0.0f, call); !s)
                return s;
            if (def.type == JointType::distance)
                if (Status s = check_size(def.limit, "limit", call); !s) return s;
            if (Status s = check_motor(def.motor, call); !s) return s;
            return check_spring(def.spring, def.type == JointType::hinge, call);
        case JointType::six_degrees:
            return check_six(def.axes, call);
        default:
            return bad_joint(call, "there is no joint of type " + std::to_string(static_cast<int>(def.type)));
    }
    return {};
}

}  // namespace lendulet
