#include "character/step.h"

namespace lendulet {

namespace {

// Of the angles between a unit vector and the axes.
Vec3 sines_of(Vec3 u) {
    auto sine = [](float cosine) { return square_root(maximum(1.0f - cosine * cosine, 0.0f)); };
    return {sine(u.x), sine(u.y), sine(u.z)};
}

}  // namespace

QueryFilter CharacterStep::others_of(const Character& c) {
    QueryFilter filter;
    filter.collision = c.filter_;
    filter.ignore_body = c.state_.body;
    return filter;
}

CharacterStep::CharacterStep(Character& c, World& w, const CharacterMove& m, float step)
    : who(c),
      world(w),
      move(m),
      dt(step),
      s(c.state_),
      up(c.up()),
      others(others_of(c)),
      around(w, others, 2.0f * c.skin_),
      strength(c.push_force_ * step) {}

// What is in the way takes what leads into it, and gives what it has itself.
Vec3 Travel::after(Vec3 velocity, float near) const {
    MotionBound touched[12];
    size_t n = 0;
    for (int i = 0; i < count; ++i)
        if (bounds[i].least > -near) touched[n++] = {bounds[i].normal, bounds[i].speed, bounds[i].moves};
    return nearest_motion(velocity, {touched, n}).motion;
}

void CharacterStep::run() {
    const Vec3 drive = world.config().gravity + move.acceleration;
    const bool stood = s.ground == CharacterGround::stands && world.alive(s.ground_body);
    const bool jumps = stood && (move.jump > 0.0f || dot(drive, up) > 0.0f);
    come_out();
    look_at_ground();

    // The way that it wants to go. On the ground it is taken along rigidly, from where it will have walked to.
    Travel t;
    t.walks = stood && !jumps;
    Vec3 walked = level(move.velocity);
    if (stood && s.ahead > 0.0f) {
        const float way = dt * length(walked), waits = minimum(s.ahead, way);
        walked *= way > 0.0f ? 1.0f - waits / way : 0.0f;
        s.ahead -= waits;
    }
    Vec3 falling = s.velocity;
    if (t.walks) {
        t.walk = dt * along_ground(walked, s.ground_normal);
        t.carry = dt * s.ground_velocity;
        if (world.get_static(s.ground_body).type() != BodyType::fixed) {
            const RigidBodyRef body = static_cast<const World&>(world).get(s.ground_body);
            const Vec3 belt = s.ground_velocity - body.velocity_at(s.ground_point);
            t.carry = taken_by(body, s.position + t.walk, dt) + dt * belt;
        }
    } else {
        Vec3 push = move.acceleration;
        if (s.ground == CharacterGround::steep)
            push -= minimum(dot(push, wall(s.ground_normal)), 0.0f) * wall(s.ground_normal);
        if (jumps) falling = s.ground_velocity + walked + move.jump * up;
        t.walk = dt * falling + (0.5f * dt * dt) * (world.config().gravity + push);  // the parabola, whatever dt
        falling += dt * (world.config().gravity + push);
    }
    // Half as far again as it is wide: what comes from farther off in one step is met in the next.
    const float more = length(t.way()) + 0.5f * stance().across + 4.0f * who.skin_;
    const float high = maximum(stance().reach, absolute(stance().centre) + who.step_height_) + more;
    const float wide = stance().across + more;
    const Vec3 upright = absolute(up), flat = sines_of(up);
    around.look(shape(), high * upright + wide * flat, dt, t.walks ? s.ground_body : BodyId{}, t.carry);

    const Vec3 ground_velocity = s.ground_velocity;
    const BodyId ground = s.ground_body;
    travel(t);
    s.squeezed = !t.possible;
    s.velocity = t.walks ? (1.0f / dt) * t.moved : t.after(falling, 0.1f * who.skin_);
    if (on_dynamic(s.ground_body) && (t.walks || jumps)) weigh_on_ground(level(s.velocity - ground_velocity), jumps);
    // Who was struck late in the step has not gone far, but is as fast as what struck it.
    else s.inertia_velocity = t.after(s.velocity, 0.1f * who.skin_);
    find_ground(t.walks ? who.step_height_ + who.skin_ : jumps ? 0.0f : 2.0f * who.skin_);
    // What one ground has not felt yet is not for another.
    if (t.walks && !(s.ground_body == ground)) s.inertia_velocity = s.velocity;
    look_at_ground();
}

}  // namespace lendulet
