// Stage 0: what the user asked for, cut to what single precision can simulate. The solver then never sees a velocity or
// an acceleration whose square overflows, so one absurd body cannot spoil those that it touches.
#include "world/world_data.h"

namespace lendulet {
namespace {

// Length without overflow on the way.
float safe_length(Vec3 v) {
    float m = max_component(absolute(v));
    return m > 1e-30f ? m * length((1.0f / m) * v) : 0.0f;
}

// L, or the shorter one along it with which the body turns at `most` rad/s.
Vec3 limited_spin(const BodyStore& bodies, uint32_t slot, Vec3 L, float most) {
    float size = max_component(absolute(L));
    if (!(1.8f * size * max_component(bodies.mass[slot].inverse_inertia) > most)) return L;  // 1.8 > sqrt(3)
    Vec3 unit = (1.0f / size) * L;
    float spin = safe_length(bodies.angular_velocity_of(slot, unit));
    return size * spin > most ? (most / spin) * unit : L;
}

}  // namespace

Vec3 limited(Vec3 v, float most) {
    constexpr float largest = 1e38f;
    float size = max_component(absolute(v));
    if (!(1.8f * size > most)) return v;
    v = {clamp(v.x, -largest, largest), clamp(v.y, -largest, largest), clamp(v.z, -largest, largest)};
    float total = safe_length(v);
    return total > most ? most * ((1.0f / total) * v) : v;
}

Vec3 acceleration(const WorldData& world, uint32_t slot, float dt) {
    const BodyStore& b = world.bodies;
    Vec3 a = b.info[slot].gravity_factor * world.config.gravity + b.mass[slot].inverse_mass * b.forces[slot].force;
    return limited(a, 2.0f * max_speed / dt);
}

Vec3 torque(const WorldData& world, uint32_t slot, float dt) {
    return limited_spin(world.bodies, slot, world.bodies.forces[slot].torque, 2.0f * max_angular_speed / dt);
}

bool cap_speed(BodyStore& bodies, uint32_t slot) {
    BodyMomenta& m = bodies.momenta[slot];
    const BodyMass& mass = bodies.mass[slot];
    // Nearly all are slow, and neither square overflows unless they are not.
    const float inverse = mass.inverse_mass, turning = max_component(mass.inverse_inertia);
    if (inverse * inverse * length_squared(m.p) <= max_speed * max_speed &&
        turning * turning * length_squared(m.L) <= max_angular_speed * max_angular_speed)
        return false;
    bool capped = false;
    float size = max_component(absolute(m.p));
    if (1.8f * size * mass.inverse_mass > max_speed) {
        Vec3 unit = (1.0f / size) * m.p;
        float speed = length(unit) * mass.inverse_mass;
        if (size * speed > max_speed) m.p = (max_speed / speed) * unit, m.p_low = {}, capped = true;
    }
    Vec3 L = limited_spin(bodies, slot, m.L, max_angular_speed);
    if (!(L == m.L)) m.L = L, capped = true;
    return capped;
}

void limit_motion(WorldData& world) {
    BodyStore& bodies = world.bodies;
    for (uint32_t slot : world.movers.bodies) {
        BodyInfo& info = bodies.info[slot];
        info.capped = info.type == BodyType::dynamic && cap_speed(bodies, slot);
        if (info.type != BodyType::kinematic) continue;
        BodyMomenta& m = bodies.momenta[slot];  // a kinematic body's velocities
        m.p = limited(m.p, max_speed);
        m.L = limited(m.L, max_angular_speed);
        world.movers.leaving |= !(length_squared(m.p) + length_squared(m.L) > 0.0f);  // after this step
    }
}

}  // namespace lendulet
