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

// A limit on several axes at once.
struct Several {
    bool present = false;
    Axis range;
    std::array<bool, 3> axes{};
};

// What they say about all six, and about several together.
struct Freedoms {
    std::array<Axis, 3> linear, angular;
    Several distance, cone;
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
    Several& several = is_linear ? f.distance : f.cone;
    if (several.present) {
        why = is_linear ? "more than one distance limit is" : "more than one limit on several angles is";
        return false;
    }
    several.present = true;
    narrow(several.range, lower, upper, limit);
    for (int axis : axes) several.axes[static_cast<size_t>(axis)] = true;
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

// A soft limit that is a lock is a spring.
void set_free_axis(const Axis& axis, double farthest, JointKind& kind) {
    if (!axis.released) {
        kind.limit = limit_of(axis, farthest);
        return;
    }
    kind.spring.stiffness = static_cast<float>(axis.stiffness);
    kind.spring.damping = static_cast<float>(axis.damping);
    kind.spring.target = static_cast<float>(0.5 * (axis.lower + axis.upper));
}

// Three free angles, a twist within bounds, or a cone.
bool is_ball(const Freedoms& f, JointKind& kind) {
    kind.type = JointType::ball;
    auto twist_about = [&](int axis) {
        kind.axis = axis;
        kind.twist_limit = limit_of(f.angular[static_cast<size_t>(axis)], 3.14159);
    };
    const int free = count_if(f.angular, &Axis::free), locked = count_if(f.angular, &Axis::locked);
    if (locked > 0) return false;
    if (f.cone.present) {
        int axis = 0, members = 0;
        for (int i = 0; i < 3; ++i) {
            if (f.cone.axes[static_cast<size_t>(i)]) ++members;
            else axis = i;
        }
        bool bare =
            members == 2 && f.cone.range.lower <= 0.0 && free >= (f.angular[static_cast<size_t>(axis)].free() ? 3 : 2);
        if (!bare) return false;
        kind.swing_limit = static_cast<float>(std::min(f.cone.range.upper, 4.0));
        twist_about(axis);
        return true;
    }
    if (free == 3) return true;
    if (free != 2) return false;
    int i = 0;
    while (f.angular[static_cast<size_t>(i)].free()) ++i;
    twist_about(i);
    return true;
}

// Whether one of the simple types has just these freedoms.
bool is_simple(const Freedoms& f, JointKind& kind) {
    if (f.distance.present || f.cone.range.soft) return false;
    for (const auto& axes : {f.linear, f.angular}) {
        for (const Axis& a : axes) {
            if (a.soft && !a.released) return false;
        }
    }
    const int linear_locked = count_if(f.linear, &Axis::locked), angular_locked = count_if(f.angular, &Axis::locked);
    int turned = 0, turned_axis = 0;
    for (int i = 0; i < 3; ++i) {
        const Axis& a = f.angular[static_cast<size_t>(i)];
        if (a.locked() && std::abs(a.lower) > 1e-4) turned_axis = i, ++turned;
    }
    if (turned > (angular_locked == 3 ? 1 : 0) || (f.cone.present && angular_locked > 0)) return false;
    if (linear_locked == 3 && angular_locked == 3 && turned == 0) {
        kind.type = JointType::fixed;
    } else if (linear_locked == 3 && angular_locked >= 2) {
        // With all three locked, the one that is turned is a hinge held at that angle.
        kind.type = JointType::hinge;
        kind.axis = turned == 1 ? turned_axis : find_if_not_locked(f.angular);
        set_free_axis(f.angular[static_cast<size_t>(kind.axis)], 3.14159, kind);
    } else if (linear_locked == 3) {
        if (!is_ball(f, kind)) return false;
    } else if (linear_locked == 2 && angular_locked == 3 && turned == 0) {
        kind.type = JointType::slider;
        kind.axis = find_if_not_locked(f.linear);
        set_free_axis(f.linear[static_cast<size_t>(kind.axis)], far, kind);
    } else {
        return false;
    }
    auto lock_offset = [&](const Axis& a) { return a.locked() ? static_cast<float>(0.5 * (a.lower + a.upper)) : 0.0f; };
    kind.offset = {lock_offset(f.linear[0]), lock_offset(f.linear[1]), lock_offset(f.linear[2])};
    return true;
}

JointAxis axis_of(const Axis& given, bool angle) {
    JointAxis axis;
    if (given.tight()) {
        axis.limit.lower = axis.limit.upper = static_cast<float>(0.5 * (given.lower + given.upper));
    } else if (angle) {
        axis.limit = limit_of(given, 3.14159);
    } else if (given.limited) {
        axis.limit = {static_cast<float>(given.lower), static_cast<float>(given.upper)};
    }
    if (given.soft && given.limited) {
        axis.limit_stiffness = static_cast<float>(given.stiffness);
        axis.limit_damping = static_cast<float>(given.damping);
    }
    return axis;
}

JointKind six_degrees(const Freedoms& f) {
    JointKind kind;
    kind.type = JointType::six_degrees;
    for (size_t i = 0; i < 3; ++i) {
        kind.axes.linear[i] = axis_of(f.linear[i], false);
        kind.axes.angular[i] = axis_of(f.angular[i], true);
    }
    if (f.distance.present) {
        kind.axes.distance = axis_of(f.distance.range, false);
        std::copy(f.distance.axes.begin(), f.distance.axes.end(), kind.axes.distance_axes);
    }
    if (f.cone.present) {
        kind.axes.swing = axis_of(f.cone.range, true);
        std::copy(f.cone.axes.begin(), f.cone.axes.end(), kind.axes.swing_axes);
    }
    return kind;
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

// Drives on axes that are not locked.
std::vector<JointDrive> read_drives(const Field& drives, const Freedoms& f, std::vector<std::string>& approximations) {
    std::vector<JointDrive> out;
    for (size_t i = 0; i < drives.size(); ++i) {
        Field field = drives.at(i);
        const std::string& type = field["type"].text();
        if (type != "linear" && type != "angular") field["type"].refuse("must be linear or angular");
        const int axis = field["axis"].index(3, "the axes");
        JointDrive drive = read_drive(field);
        const bool angular = type == "angular";
        const Axis& driven = (angular ? f.angular : f.linear)[static_cast<size_t>(axis)];
        if ((driven.locked() && !driven.soft) || (drive.stiffness == 0.0f && drive.damping == 0.0f)) continue;
        drive.axis = angular ? 3 + axis : axis;
        bool taken = std::any_of(out.begin(), out.end(), [&](const JointDrive& d) { return d.axis == drive.axis; });
        if (taken) approximations.push_back("only the first of its drives on one axis is simulated");
        else out.push_back(drive);
    }
    return out;
}

// Hinges and sliders take one drive, on their free axis, and no other spring.
bool takes(const JointKind& kind, const std::vector<JointDrive>& drives) {
    if (drives.empty()) return true;
    if (drives.size() > 1 || kind.spring.stiffness > 0.0f) return false;
    if (kind.type == JointType::hinge) return drives[0].axis == 3 + kind.axis;
    return kind.type == JointType::slider && drives[0].axis == kind.axis;
}

}  // namespace

std::optional<JointKind> joint_kind(const Field& description, std::string& why) {
    Freedoms f;
    Field limits = description["limits"];
    for (size_t i = 0; i < limits.size(); ++i) {
        if (!add_limit(limits.at(i), f, why)) return std::nullopt;
    }
    auto excludes = [](const Axis& a) { return a.lower > a.upper; };
    if (std::any_of(f.linear.begin(), f.linear.end(), excludes) ||
        std::any_of(f.angular.begin(), f.angular.end(), excludes)) {
        why = "a pair of limits that exclude each other is";
        return std::nullopt;
    }
    std::vector<std::string> approximations;
    std::vector<JointDrive> drives = read_drives(description["drives"], f, approximations);
    JointKind kind;
    Axis* sprung = only_soft_lock(f);
    if (sprung) sprung->released = true;
    if (!is_simple(f, kind) || !takes(kind, drives)) {
        if (sprung) sprung->released = false;
        kind = six_degrees(f);
    }
    kind.drives = std::move(drives);
    kind.approximations = std::move(approximations);
    return kind;
}

}  // namespace lendulet
