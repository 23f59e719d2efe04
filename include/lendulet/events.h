// Events: what the last World::update() did, to be read after it. There are no callbacks: the world keeps a list of
// each kind until the next update().
//
// Colliders ask for events of contacts (Events in body.h); a pair of colliders reports what either of them asks for.
// Lists are ordered by the two colliders' indices, A being the collider with the smaller one, and are the same for any
// number of workers, SIMD width and broad phase. Where an update was cut into several steps, those of the first come
// first. Ids are those of the time of the event: of bodies that were removed since they are stale.
#pragma once

#include "lendulet/body.h"
#include "lendulet/joint.h"
#include "lendulet/math.h"

namespace lendulet {

// Two colliders touch when at the end of a step a point of their contact touches or overlaps, or when it carried
// something within the step: one that bounced off in the same step begins and ends in it. However many triangles of a
// mesh or height field are met, they are one contact. It begins once and ends once: when the two part, when one of them
// is removed, put elsewhere or filtered out, but not when they fall asleep. Two that touch already when they are asked
// about begin with the next step. Two that touch part where no point is nearer than a thousandth of the smaller one's
// radius, so that what trembles under its load does not come and go.
struct ContactEvent {
    BodyId body_a, body_b;
    ColliderId collider_a, collider_b;
};

// Two colliders met at a point where they carried nothing before, at least as fast as WorldConfig::hit_speed. Once a
// step for a pair, for its fastest point. One that comes so late within a step that the blow is not over with it is
// reported by the next step, as a whole.
struct ContactHit {
    BodyId body_a, body_b;
    ColliderId collider_a, collider_b;
    Position position;  // where the two surfaces met, m
    Vec3 normal;        // there, unit, from A to B
    float speed;        // at which they approached each other along the normal just before, m/s
    float impulse;      // between the two along the normal, over all points, from then to the end of the step, N s
};

// A body fell asleep or was woken, by a call or by what touched it. Ordered by body, those woken first.
struct SleepEvent {
    BodyId body;
    bool asleep;
};

// A joint broke: JointDef::break_force, break_torque. Its id is that of a removed joint now. Ordered by its index.
struct JointBreak {
    JointId joint;
    BodyId body_a, body_b;
    uint64_t user_data;  // the joint's
    Vec3 force, torque;  // which broke it: mean over the step on body B at the anchor, world axes, N and N m
};

}  // namespace lendulet
