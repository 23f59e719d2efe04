// What it gives to dynamic bodies, and they to it.
#include "character/step.h"

namespace lendulet {

void CharacterStep::note(BodyId body, ColliderId collider, Position point, Vec3 normal, Vec3 impulse) {
    for (int i = 0; i < contact_count; ++i) {
        CharacterContact& c = contacts[i];
        if (!(c.body == body) || !(c.collider == collider) || dot(c.normal, normal) < 0.99f) continue;
        c.impulse += impulse;
        return;
    }
    if (contact_count < 16) contacts[contact_count++] = {body, collider, point, normal, impulse};
}

// A body in its way is to go as fast as the character wants to, `velocity`. Of the impulse for that it has what its
// legs give, and where the body comes to it what its mass takes to be stopped: as two bodies that stay together, J = u
// / (1/m + K) with K of Baraff. What is missing, the body goes on with, and takes the character along.
void CharacterStep::push(Neighbour& b, Vec3 normal, Position point, Vec3 velocity, bool walks) {
    const RigidBodyRef body = static_cast<const World&>(world).get(b.body);
    const Vec3 direction = walks ? wall(normal) : normal;
    const Vec3 theirs = (1.0f / dt) * b.motion;
    const float approach = dot(theirs - velocity, direction);
    const float effectiveness = body.impulse_effectiveness(point, direction);
    if (!(approach > 0.0f) || !(effectiveness > 0.0f)) return note(b.body, b.collider, point, normal, {});
    const float own = dot(s.inertia_velocity, direction);
    const float blow =
        walks ? maximum(dot(theirs, direction), 0.0f) - maximum(own, 0.0f) : dot(theirs, direction) - own;
    const float of_mass = b.met ? 0.0f : maximum(blow, 0.0f) / (1.0f / who.mass_ + effectiveness);
    const float needed = approach / effectiveness;
    const float impulse = minimum(needed, of_mass + (walks ? strength : 0.0f));
    strength -= clamp(impulse - of_mass, 0.0f, strength);
    b.met = true;
    b.motion -= (dt * impulse * effectiveness) * direction;
    pushed += impulse * direction;
    note(b.body, b.collider, point, normal, -impulse * direction);
}

void CharacterStep::give_impulses() {
    for (int i = 0; i < contact_count; ++i) {
        const CharacterContact& c = contacts[i];
        if (!(dot(c.impulse, c.impulse) > 0.0f)) continue;
        RigidBodyRef body = world.get(c.body);
        (void)(i == loaded ? body.apply_force((1.0f / dt) * c.impulse, c.point)
                           : body.apply_impulse(c.impulse, c.point));
    }
}

}  // namespace lendulet
