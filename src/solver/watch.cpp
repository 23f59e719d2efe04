#include "solver/watch.h"

#include "solver/nearing.h"

namespace lendulet {
namespace {

// A meeting is answered where less than this share of its speed is left.
constexpr float answered = 0.02f;

void take_meeting(WatchedContact& c, float speed, Vec3 normal, Vec3 place) {
    if (!(speed > c.speed)) return;
    c.speed = speed;
    c.normal = normal;
    c.place_of_hit = place;
}

// How much longer than a substep contacts are looked ahead: rows push where the speed at the end of it would close the
// gap, which is a little earlier than where the way does.
constexpr float ahead = 2.0f;

}  // namespace

SubstepConstants look_ahead(const SubstepConstants& k, float least_speed) {
    SubstepConstants wide = k;
    wide.h = ahead * k.h;
    wide.bounce_speed = least_speed;
    return wide;
}

void foresee_meetings(SolverBodies& bodies, const ContactRecord* records, WatchedContact& c, const float held[4],
                      float least_speed, float h) {
    const ContactRecord& r = records[c.record];
    Side a(bodies, r.body_a), b(bodies, r.body_b);
    for (int j = 0; j < r.point_count; ++j) {
        if (held[j] > 0.0f || r.points[j].separation >= far_separation) continue;
        const Nearing near = nearing_of(a, b, r, r.points[j], h);
        if (!(near.approach < 0.0f) || !(near.first.speed >= least_speed) || near.first.time > ahead * h) continue;
        const Vec3 way = load(b.state->dp) + near.first.time * b.now.v;
        c.nearing[j] = {near.first.speed, near.normal, way + b.now.core - r.radius_b * near.normal};
        c.follows = true;
    }
}

void note_impulses(SolverBodies& bodies, const ContactRecord* records, WatchedContact& c, const float impulses[4],
                   float h, bool last) {
    for (int j = 0; j < 4; ++j) {
        c.impulse += impulses[j];
        NearingPoint& near = c.nearing[j];
        const float speed = near.speed;
        near.speed = 0.0f;
        if (!(speed > 0.0f) || !(impulses[j] > 0.0f)) continue;
        take_meeting(c, speed, near.normal, near.place);
        if (!last) continue;
        const ContactRecord& r = records[c.record];
        Side a(bodies, r.body_a), b(bodies, r.body_b);
        c.unanswered |= nearing_of(a, b, r, r.points[j], h).approach < -answered * speed;
    }
}

void note_impact(WatchedContact& c, float speed, float impulse, Vec3 normal, Vec3 place) {
    c.follows = true;
    c.impulse += impulse;
    take_meeting(c, speed, normal, place);
}

}  // namespace lendulet
