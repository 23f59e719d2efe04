// What it stands on: found, followed, and loaded with its weight.
#include "character/step.h"

namespace lendulet {

bool CharacterStep::on_dynamic(BodyId body) const {
    return body && world.alive(body) && world.get_static(body).type() == BodyType::dynamic;
}

// How fast the ground goes now where it stands: with its body, and as a belt over it.
void CharacterStep::look_at_ground() {
    s.ground_velocity = {};
    if (s.ground != CharacterGround::stands || !world.alive(s.ground_body)) return;
    const StaticBodyRef body = world.get_static(s.ground_body);
    if (body.type() != BodyType::fixed)
        s.ground_velocity = static_cast<const World&>(world).get(s.ground_body).velocity_at(s.ground_point);
    for (int i = 0; i < body.collider_count(); ++i) {
        if (!(body.collider(i) == s.ground_collider)) continue;
        const Quat turn = body.orientation() * body.collider_pose(i).rotation;
        const Vec3 belt = rotate(turn, body.material(i).surface_velocity);
        s.ground_velocity += belt - dot(belt, s.ground_normal) * s.ground_normal;
    }
}

// Looks down as far as `reach` for where it can stand, and goes down there. Bodies are where the step takes them.
void CharacterStep::find_ground(float reach) {
    const bool walked = s.ground == CharacterGround::stands;
    s.ground = CharacterGround::air;
    s.ground_body = {}, s.ground_collider = {}, s.ground_normal = {};
    if (!(reach > 0.0f)) return;
    Meeting m = around.first(shape(), -reach * up, 1.0f);
    if (!m || m.share(who.skin_) >= 1.0f) return;
    const float above = m.share(who.skin_) * reach;
    const Vec3 theirs = m.neighbour ? (1.0f / dt) * m.neighbour->motion : Vec3{};
    if (!walked && dot(s.velocity - theirs, up) > 0.01f) return;
    Vec3 normal = m.hit.normal;
    const bool stands = stands_on(m, 1.0f);
    if (!stands && above > who.skin_) return;
    s.ground_body = m.hit.body, s.ground_collider = m.hit.collider;
    s.ground_point = m.hit.point;
    s.ground = CharacterGround::steep;
    if (stands || is_held()) {
        s.ground = CharacterGround::stands;
        if (stands) s.position -= above * up;
        if (!is_level(normal)) normal = up;
    }
    s.ground_normal = normal;
    note(m.hit.body, m.hit.collider, m.hit.point, m.hit.normal, {});
}

// Between steep faces that leave no way down, as in a groove.
bool CharacterStep::is_held() {
    const Position here = s.position;
    Travel down;
    down.acts = false;
    down.walk = (-4.0f * who.skin_) * up;
    down.done = 1.0f;
    travel(down);
    const float gone = length(s.position - here);
    s.position = here;
    return gone < 1.2f * who.skin_;
}

// A dynamic body that it stands on feels its weight, and what it takes to walk as it does. The two are bodies of which
// one is told to go with `walked` against the other: J = (v2 + walked - v1) / (1/m + K), upwards no pull, level no more
// than the grip. It is a force over the step, as the weight of all that lies there. What is not given in this step
// stays in `inertia_velocity` for the next, so that all is given in the end and light bodies are not shaken.
void CharacterStep::weigh_on_ground(Vec3 walked, bool jumps) {
    const BodyId ground = s.ground_body;
    const RigidBodyRef body = static_cast<const World&>(world).get(ground);
    const Vec3 theirs = body.velocity_at(s.ground_point);
    const Vec3 gravity = world.config().gravity;
    Vec3 own = s.inertia_velocity + (1.0f / who.mass_) * pushed + dt * gravity, impulse{};
    auto exchange = [&](Vec3 target, Vec3 direction, float most) {
        const float lacks = dot(target - own, direction);
        const float effectiveness = body.impulse_effectiveness(s.ground_point, direction);
        const float j = clamp(lacks / (1.0f / who.mass_ + effectiveness), 0.0f, most);
        impulse += j * direction;
        own += (j / who.mass_) * direction;
    };
    const float unbounded = 1e30f;
    if (jumps) {
        const float lacks = maximum(dot(s.velocity - own, up), 0.0f);
        impulse = (who.mass_ * lacks) * up;
    } else {
        exchange(theirs, up, unbounded);
        const Vec3 missing = level(theirs + walked - own);
        exchange(theirs + level(walked), normalize(missing, up), who.grip_ * who.mass_ * dt * length(gravity));
    }
    loaded = contact_count < 15 ? contact_count : 15;
    contact_count = loaded + 1;
    contacts[loaded] = {ground, s.ground_collider, s.ground_point, up, -impulse};
    s.inertia_velocity = jumps ? s.velocity : own;
}

}  // namespace lendulet
