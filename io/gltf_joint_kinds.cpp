#include "io/gltf_joint_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lendulet {

namespace {

constexpr double far = 1e4;          // m; stands for a missing bound of a slider
constexpr double lock_slack = 1e-6;  // m or rad; a range this small is a lock

// What the limits say about one axis alone.
struct Axis {
    bool limited = false, soft = false;
    bool released = false;  // a soft lock that is taken as a spring on an axis without limits
    double lower = -INFINITY, upper = INFINITY;
    double stiffness = 0.0, damping = 0.0;
    bool tight() const { return limited && upper - lower <= lock_slack; }
    bool locked() const { return tight() && !released; }
    bool free() const { return !limited; }
    bool ranged() const { return limited && !tight(); }
};

// What they say about all six, and about two swing angles together.
struct Freedoms {
    std::array<Axis, 3> linear, angular;
    bool cone = false;
    int cone_axis = 0;
    double cone_angle = 0.0;
    std::vector<std::string> approximations;
};

std::vector<int> read_axes(const Field& list) {
    if (list.size() < 1 || list.size() > 3) list.refuse("must list 1 to 3 axes");
    std::vector<int> axes;
    for (size_t i = 0; i < list.size(); ++i) {
        int axis = list.at(i).index(3, "the axes");
        if (std::find(axes.begin(), axes.end(), axis) != axes.end()) list.refuse("lists an axis twice");
        axes.push_back(axis);
    }
    return axes;
}

// Narrows an axis by one more limit.
void narrow(Axis& axis, double lower, double upper, const Field& limit) {
    axis.limited = true;
    axis.lower = std::max(axis.lower, lower);
    axis.upper = std::min(axis.upper, upper);
    if (Field stiffness = limit["stiffness"]) {
        axis.soft = true;
        axis.stiffness = stiffness.number();
        axis.damping = limit["damping"].number_or(0.0);
    }
}

// Limits on several axes at once measure a distance or an angle, so they are locks where its maximum is 0.
bool add_limit(const Field& limit, Freedoms& f, std::string& why) {
    bool is_linear = limit["linearAxes"].present();
    if (is_linear == limit["angularAxes"].present()) limit.refuse("must have either linearAxes or angularAxes");
    std::vector<int> axes = read_axes(limit[is_linear ? "linearAxes" : "angularAxes"]);
    Field minimum = limit["min"], maximum = limit["max"];
    if (!minimum && !maximum) return true;
    double lower = minimum.number_or(-INFINITY), upper = maximum.number_or(INFINITY);
    if (lower > upper) limit.refuse("has a min greater than its max");
    Field stiffness = limit["stiffness"];
    if (stiffness && stiffness.number() < 0.0) stiffness.refuse("must not be negative");
    if (limit["damping"].number_or(0.0) < 0.0) limit["damping"].refuse("must not be negative");
    if (stiffness && stiffness.number() == 0.0) return true;  // a limit that no force keeps
    auto& all = is_linear ? f.linear : f.angular;
    if (axes.size() == 1) {
        narrow(all[static_cast<size_t>(axes[0])], lower, upper, limit);
        return true;
    }
    if (lower <= 0.0 && upper == INFINITY) return true;  // a distance is never less than 0
    if (upper <= lock_slack) {
        for (int axis : axes) narrow(all[static_cast<size_t>(axis)], 0.0, 0.0, limit);
        return true;
    }
    if (is_linear || axes.size() == 3 || lower > 0.0 || f.cone) {
        why = is_linear ? "distance limits on several axes are" : "its limits on several angles are";
        return false;
    }
    f.cone = true;
    f.cone_axis = 3 - axes[0] - axes[1];
    f.cone_angle = upper;
    return true;
}

int count_if(const std::array<Axis, 3>& axes, bool (Axis::*is)() const) {
    return static_cast<int>(std::count_if(axes.begin(), axes.end(), [&](const Axis& a) { return (a.*is)(); }));
}
int find_if_not_locked(const std::array<Axis, 3>& axes) {
    return static_cast<int>(std::find_if(axes.begin(), axes.end(), [](const Axis& a) { return !a.locked(); }) -
                            axes.begin());
}

// The bounds of an axis as a Limit, missing ones replaced by `farthest`; free where they leave all of that.
Limit limit_of(const Axis& axis, double farthest) {
    if (!axis.limited || (axis.lower <= -farthest && axis.upper >= farthest)) return {};
    return {static_cast<float>(std::clamp(axis.lower, -farthest, farthest)),
            static_cast<float>(std::clamp(axis.upper, -farthest, farthest))};
}

// A soft limit that is a lock is a spring; hard engine limits stand for other soft limits.
void set_free_axis(const Axis& axis, double farthest, JointKind& kind) {
    if (axis.released) {
        kind.spring.stiffness = static_cast<float>(axis.stiffness);
        kind.spring.damping = static_cast<float>(axis.damping);
        kind.spring.target = static_cast<float>(0.5 * (axis.lower + axis.upper));
        return;
    }
    if (axis.soft) kind.approximations.push_back("its soft limit is simulated as a hard one");
    kind.limit = limit_of(axis, farthest);
}

bool ball_kind(const Freedoms& f, JointKind& kind, std::string& why) {
    kind.type = JointType::ball;
    int ranged = count_if(f.angular, &Axis::ranged), free = count_if(f.angular, &Axis::free);
    auto twist_about = [&](int axis) {
        kind.axis = axis;
        kind.twist_limit = limit_of(f.angular[static_cast<size_t>(axis)], 3.14159);
    };
    if (f.cone) {
        for (int i = 0; i < 3; ++i) {
            if (i != f.cone_axis && f.angular[static_cast<size_t>(i)].limited) {
                why = "a cone with limits inside it is";
                return false;
            }
        }
        kind.swing_limit = static_cast<float>(f.cone_angle);
        twist_about(f.cone_axis);
        return true;
    }
    if (free == 3) return true;
    if (free == 2) {
        int i = 0;
        while (f.angular[static_cast<size_t>(i)].free()) ++i;
        twist_about(i);
        return true;
    }
    if (free == 0 && ranged == 2) {
        // A universal joint with two bounded angles: a cone about the third axis, as wide as the wider of the two.
        int i = 0;
        while (!f.angular[static_cast<size_t>(i)].locked()) ++i;
        twist_about(i);
        double widest = 0.0;
        for (const Axis& a : f.angular) {
            if (a.ranged()) widest = std::max({widest, std::abs(a.lower), std::abs(a.upper)});
        }
        kind.swing_limit = static_cast<float>(std::min(widest, 4.0));
        kind.approximations.push_back("its two bounded angles are simulated as one cone");
        return true;
    }
    why = "its combination of angle limits is";
    return false;
}

bool classify(const Freedoms& f, JointKind& kind, std::string& why) {
    int linear_locked = count_if(f.linear, &Axis::locked), angular_locked = count_if(f.angular, &Axis::locked);
    bool turned = false;
    for (const Axis& a : f.angular) turned |= a.locked() && std::abs(a.lower) > 1e-4;
    if (turned && angular_locked != 3) {
        why = "locking an angle away from 0 is";
        return false;
    }
    if (linear_locked == 3 && angular_locked == 3 && !turned) {
        kind.type = JointType::fixed;
    } else if (linear_locked == 3 && angular_locked >= 2 && !f.cone) {
        // With all three locked, the one that is turned is a hinge held at that angle.
        kind.type = JointType::hinge;
        kind.axis = find_if_not_locked(f.angular);
        int away = 0;
        for (int i = 0; i < 3; ++i) {
            if (angular_locked == 3 && std::abs(f.angular[static_cast<size_t>(i)].lower) > 1e-4) kind.axis = i, ++away;
        }
        if (away > 1) {
            why = "locking several angles away from 0 is";
            return false;
        }
        set_free_axis(f.angular[static_cast<size_t>(kind.axis)], 3.14159, kind);
    } else if (linear_locked == 3) {
        if (!ball_kind(f, kind, why)) return false;
    } else if (linear_locked == 2 && angular_locked == 3 && !turned) {
        kind.type = JointType::slider;
        kind.axis = find_if_not_locked(f.linear);
        set_free_axis(f.linear[static_cast<size_t>(kind.axis)], far, kind);
    } else {
        why = linear_locked == 2 ? "turning and sliding at once is" : "moving along more than one axis is";
        return false;
    }
    auto lock_offset = [&](const Axis& a) { return a.locked() ? static_cast<float>(0.5 * (a.lower + a.upper)) : 0.0f; };
    kind.offset = {lock_offset(f.linear[0]), lock_offset(f.linear[1]), lock_offset(f.linear[2])};
    for (int i = 0; i < 3; ++i) {
        bool is_hinge_axis = kind.type == JointType::hinge && i == kind.axis;
        const Axis &l = f.linear[static_cast<size_t>(i)], &a = f.angular[static_cast<size_t>(i)];
        if ((l.soft && l.locked()) || (a.soft && a.locked() && !is_hinge_axis)) {
            kind.approximations.push_back("its soft locks are simulated as hard ones");
            break;
        }
    }
    return true;
}

// The one lock that is soft, null where there are more or none: the free axis of a hinge or slider with a spring, if
// the other axes are as they should be.
Axis* only_soft_lock(Freedoms& f) {
    Axis* found = nullptr;
    int count = 0;
    for (auto* axes : {&f.linear, &f.angular}) {
        for (Axis& a : *axes) {
            if (a.tight() && a.soft) found = &a, ++count;
        }
    }
    return count == 1 ? found : nullptr;
}

JointDrive read_drive(const Field& field) {
    JointDrive drive;
    drive.stiffness = static_cast<float>(field["stiffness"].number_or(0.0));
    drive.damping = static_cast<float>(field["damping"].number_or(0.0));
    if (drive.stiffness < 0.0f) field["stiffness"].refuse("must not be negative");
    if (drive.damping < 0.0f) field["damping"].refuse("must not be negative");
    drive.position = static_cast<float>(field["positionTarget"].number_or(0.0));
    drive.velocity = static_cast<float>(field["velocityTarget"].number_or(0.0));
    if (Field force = field["maxForce"]) drive.max_force = static_cast<float>(force.number());
    if (drive.max_force < 0.0f) field["maxForce"].refuse("must not be negative");
    const std::string& mode = field["mode"].text();
    if (mode != "force" && mode != "acceleration") field["mode"].refuse("must be force or acceleration");
    drive.acceleration = mode == "acceleration";
    return drive;
}

// Drives on the free axis are kept, those on a locked one do nothing, others are named.
void add_drives(const Field& drives, const Freedoms& f, JointKind& kind) {
    for (size_t i = 0; i < drives.size(); ++i) {
        Field field = drives.at(i);
        const std::string& type = field["type"].text();
        if (type != "linear" && type != "angular") field["type"].refuse("must be linear or angular");
        int axis = field["axis"].index(3, "the axes");
        JointDrive drive = read_drive(field);
        bool is_free_axis = axis == kind.axis && ((type == "angular" && kind.type == JointType::hinge) ||
                                                  (type == "linear" && kind.type == JointType::slider));
        const Axis& driven = (type == "linear" ? f.linear : f.angular)[static_cast<size_t>(axis)];
        if (is_free_axis && !kind.drive) kind.drive = drive;
        else if (is_free_axis) kind.approximations.push_back("only the first of its drives on one axis is simulated");
        else if (!driven.locked()) kind.approximations.push_back("its drive on a ball joint is not simulated");
    }
}

}  // namespace

std::optional<JointKind> joint_kind(const Field& description, std::string& why) {
    Freedoms f;
    Field limits = description["limits"];
    for (size_t i = 0; i < limits.size(); ++i) {
        if (!add_limit(limits.at(i), f, why)) return std::nullopt;
    }
    JointKind kind;
    bool contradiction = false;
    for (const auto& axes : {f.linear, f.angular}) {
        for (const Axis& a : axes) contradiction |= a.lower > a.upper;
    }
    if (contradiction) {
        why = "a pair of limits that exclude each other is";
        return std::nullopt;
    }
    bool is_sprung = false;
    if (Axis* sprung = only_soft_lock(f)) {
        sprung->released = true;
        std::string ignored;
        is_sprung = classify(f, kind, ignored) && kind.spring.stiffness > 0.0f;
        sprung->released = is_sprung;
        if (!is_sprung) kind = {};
    }
    if (!is_sprung && !classify(f, kind, why)) return std::nullopt;
    add_drives(description["drives"], f, kind);
    return kind;
}

}  // namespace lendulet
