// Joints whose rows are data, as the solver wants them.
#include "world/joints/records.h"

namespace lendulet {
namespace {

constexpr int driven_distance = static_cast<int>(Coordinate::distance);

static_assert(joint_axes == joint_coordinates && distance_row == driven_distance &&
              swing_row == static_cast<int>(Coordinate::swing));

uint8_t bits_of(const bool (&axes)[3]) {
    return static_cast<uint8_t>((axes[0] ? 1 : 0) | (axes[1] ? 2 : 0) | (axes[2] ? 4 : 0));
}

void lock(JointAxis& axis, float at) {
    axis = {};
    axis.limit = {at, at};
}

bool hard(const JointAxis& axis) { return axis.limit_stiffness == 0.0f && axis.limit_damping == 0.0f; }
bool locked(const JointAxis& axis) { return axis.limit.locked() && hard(axis); }
bool driven(const JointAxis& axis) {
    return axis.motor.max_force > 0.0f || axis.friction > 0.0f || axis.spring.stiffness > 0.0f ||
           axis.spring.damping > 0.0f;
}

// A distance or angle of several axes that may not grow is a lock of each of them; it is never below 0 by itself.
void simplify_several(JointAxesInfo& rows, int row, uint8_t axes, int first) {
    JointAxis& several = rows.row[row];
    if (several.limit.free()) return;
    if (several.limit.upper == 0.0f && hard(several)) {
        for (int i = 0; i < 3; ++i)
            if ((axes >> i & 1) != 0) lock(rows.row[first + i], 0.0f);
        several = {};
    } else if (several.limit.lower <= 0.0f) {
        several.limit.lower = -std::numeric_limits<float>::infinity();
    }
}

void put_axis(JointAxisRecord& r, const JointAxis& axis) {
    r.lower = axis.limit.free() ? -unlimited : maximum(axis.limit.lower, -unlimited);
    r.upper = axis.limit.free() ? unlimited : minimum(axis.limit.upper, unlimited);
    r.limit_stiffness = axis.limit_stiffness;
    r.limit_damping = axis.limit_damping;
    const Motor motor = axis.motor.max_force > 0.0f ? axis.motor : Motor{0.0f, axis.friction};
    r.motor_velocity = motor.target_velocity;
    r.motor_force = minimum(motor.max_force, unlimited);
    r.stiffness = axis.spring.stiffness;
    r.damping = axis.spring.damping;
    r.target = axis.spring.target;
    r.target_velocity = axis.spring.target_velocity;
    r.spring_force = minimum(axis.spring.max_force, unlimited);
}

}  // namespace

bool rows_are_data(const JointInfo& j) {
    if (j.type == JointType::distance || j.type == JointType::six_degrees) return true;
    return (j.type == JointType::hinge || j.type == JointType::slider) && j.spring.stiffness == 0.0f &&
           j.spring.damping > 0.0f && j.spring.target_velocity != 0.0f;
}

int driven_row(JointType type) {
    return type == JointType::hinge    ? static_cast<int>(Coordinate::about_x)
           : type == JointType::slider ? static_cast<int>(Coordinate::x)
                                       : driven_distance;
}

SixDegrees coordinates_of(const JointAxesInfo& rows) {
    SixDegrees axes;
    for (int i = 0; i < 3; ++i) {
        axes.linear[i] = rows.row[i];
        axes.angular[i] = rows.row[3 + i];
        axes.distance_axes[i] = (rows.distance_axes >> i & 1) != 0;
        axes.swing_axes[i] = (rows.swing_axes >> i & 1) != 0;
    }
    axes.distance = rows.row[distance_row];
    axes.swing = rows.row[swing_row];
    return axes;
}

JointAxesInfo rows_of(const JointDef& def) {
    JointAxesInfo rows;
    if (def.type == JointType::six_degrees) {
        for (int i = 0; i < 3; ++i) {
            rows.row[i] = def.axes.linear[i];
            rows.row[3 + i] = def.axes.angular[i];
        }
        rows.row[distance_row] = def.axes.distance;
        rows.row[swing_row] = def.axes.swing;
        rows.distance_axes = bits_of(def.axes.distance_axes);
        rows.swing_axes = bits_of(def.axes.swing_axes);
        return rows;
    }
    if (def.type == JointType::distance) rows.distance_axes = 7;
    else
        for (int i = 0; i < 6; ++i) lock(rows.row[i], 0.0f);
    JointAxis& axis = rows.row[driven_row(def.type)];
    axis.limit = def.limit;
    axis.motor = def.motor;
    axis.spring = def.spring;
    axis.friction = def.friction;
    return rows;
}

JointAxesRecord axes_record(const JointAxesInfo& given, float scale) {
    JointAxesInfo rows = given;
    simplify_several(rows, distance_row, rows.distance_axes, 0);
    simplify_several(rows, swing_row, rows.swing_axes, 3);
    JointAxesRecord r{};
    r.distance_axes = rows.distance_axes;
    r.swing_axes = rows.swing_axes;
    for (int i = 0; i < joint_axes; ++i) {
        const JointAxis& axis = rows.row[i];
        put_axis(r.axis[i], axis);
        r.axis[i].limit = scale * rows.limit[i];
        r.axis[i].motor = scale * rows.motor[i];
        r.axis[i].spring = scale * rows.spring[i];
        if (i < 6 && locked(axis)) {
            r.locked = static_cast<uint8_t>(r.locked | 1 << i);
            r.held_at[i] = axis.limit.lower;
        } else if (!axis.limit.free() || driven(axis)) {
            r.used = static_cast<uint8_t>(r.used | 1 << i);
        }
    }
    return r;
}

}  // namespace lendulet
