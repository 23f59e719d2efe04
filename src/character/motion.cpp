// Moving on: out of overlap, along what is in the way, up steps.
#include "character/step.h"

namespace lendulet {
namespace {

constexpr int most_turns = 10;  // planes met on one way; what is left of it then is not gone

}  // namespace

void Travel::add(MotionBound bound) {
    for (int i = 0; i < count; ++i) {
        if (bounds[i].moves != bound.moves || dot(bounds[i].normal, bound.normal) < 0.99999f) continue;
        bounds[i].least = maximum(bounds[i].least, bound.least);
        return;
    }
    if (count < 12) bounds[count++] = bound;
}

void Travel::advance(Vec3 by, float share) {
    moved += by;
    for (int i = 0; i < count; ++i) bounds[i].least -= dot(bounds[i].normal, by);
    walk *= 1.0f - share, carry *= 1.0f - share;
    done += (1.0f - done) * share;
}

// Out of what stands and what it was put into, until it is a skin away from all; a tenth of the skin is not worth a
// move.
void CharacterStep::come_out() {
    QueryFilter fixed = others;
    fixed.see_kinematic = fixed.see_dynamic = false;
    for (int i = 0; i < 4; ++i) {
        Proximity found[10];
        Result<int> n = world.overlap_shape({stance().outer, shape().pose}, found, fixed);
        Travel t;
        float deepest = 0.0f;
        for (int k = 0; n && k < n.value() && k < 10; ++k) {
            deepest = maximum(deepest, -found[k].distance);
            t.add({-found[k].normal, -found[k].distance, false});
        }
        if (!(deepest > 0.1f * who.skin_)) return;
        const NearestMotion out = t.nearest({});
        Vec3 by = out.motion;
        if (!out.possible)  // between two that leave no room: to the middle
            for (int k = 0; k < t.count; ++k) by += (0.5f * t.bounds[k].least) * t.bounds[k].normal;
        s.position += by;
    }
}

// What holds a walker back where it cannot stand: upright, so that it is neither lifted nor pressed down. Ceilings
// stay.
Vec3 CharacterStep::wall(Vec3 normal) const {
    const Vec3 flat = level(normal);
    return length(flat) > 0.1f ? normalize(flat) : normal;
}

Vec3 CharacterStep::along_ground(Vec3 level_way, Vec3 normal) const {
    const float rise = dot(normal, up);
    if (!(rise > 0.05f)) return level_way;
    const Vec3 way = level_way - (dot(normal, level_way) / rise) * up;
    const float there = length(way);
    return there > 0.0f ? (length(level_way) / there) * way : way;
}

// Bodies that come nearer than the skin while it goes its way: it has to go along.
void CharacterStep::make_way(Travel& t) {
    for (Neighbour& b : around.neighbours()) {
        if (b.type == BodyType::kinematic && b.body != s.ground_body) {
            const StaticBodyRef body = world.get_static(b.body);
            uint64_t category = 0;
            for (int i = 0; i < body.collider_count(); ++i)
                if (body.collider(i) == b.collider) category = body.filter(i).category;
            if ((category & who.pushed_by_) == 0) b.motion = {};
        }
        const float gap = b.gap - who.skin_;
        const float reaches = dot(b.normal, b.motion) - gap;
        if (!(reaches > minimum(dot(b.normal, t.way()), 0.0f) + 0.1f * who.skin_)) continue;
        if (b.type == BodyType::dynamic && b.body != s.ground_body && !(t.walks && is_level(b.normal)))
            push(b, b.normal, b.point, (1.0f / dt) * t.way(), t.walks);
        const float theirs = dot(b.normal, b.motion);
        t.add({t.walks && !is_level(b.normal) ? wall(b.normal) : b.normal, theirs - gap, true, (1.0f / dt) * theirs});
    }
}

void CharacterStep::travel(Travel& t) {
    if (t.acts) make_way(t);
    for (int turn = 0; turn < most_turns; ++turn) {
        const NearestMotion nearest = t.nearest(t.way());
        t.possible = t.possible && nearest.possible;
        const Vec3 way = nearest.motion;
        if (!(length(way) > 1e-3f * who.skin_)) return;
        Meeting m = around.first(shape(), way, t.done);
        const float share = m ? m.share(who.skin_) : 1.0f;
        if (share >= 1.0f) {
            s.position += way;
            return t.advance(way, 1.0f);
        }
        const float gap = (m.hit.fraction - share) * m.approach();
        s.position += share * way;
        t.advance(share * way, share);
        // What is met nearly upright is no edge to go over, but a step.
        const bool stands = t.walks && dot(m.hit.normal, up) > 0.2f && stands_on(m, t.done);
        if (t.walks && !stands && step_up(t)) return;
        const Vec3 normal = t.walks && !stands ? wall(m.hit.normal) : m.hit.normal;
        if (t.acts) {
            if (m.neighbour && m.neighbour->type == BodyType::dynamic && !stands)
                push(*m.neighbour, m.hit.normal, m.hit.point, (1.0f / (dt * (1.0f - t.done))) * t.way(), t.walks);
            else note(m.hit.body, m.hit.collider, m.hit.point, m.hit.normal, {});
        }
        // Along level ground as fast as told; over an edge as fast ahead.
        const Vec3 ahead = level(t.walk);
        if (stands && is_level(m.hit.normal)) t.walk = along_ground(ahead, m.hit.normal);
        else if (stands) t.walk = ahead - (dot(m.hit.normal, ahead) / dot(m.hit.normal, up)) * up;
        const float theirs = m.neighbour ? dot(normal, m.neighbour->motion) : 0.0f;
        t.add({normal, (1.0f - t.done) * theirs + minimum(0.0f, who.skin_ - gap), m.neighbour != nullptr,
               (1.0f / dt) * theirs});
    }
}

// A shape that stands on an edge touches it with any normal: whether one can stand there is for the face behind it to
// say. The meeting's normal stays that of the contact.
bool CharacterStep::stands_on(Meeting& m, float done) {
    if (is_level(m.hit.normal)) return true;
    const Vec3 flat = level(m.hit.normal);
    const float height = dot(m.hit.point - s.position, up);
    if (dot(m.hit.normal, up) < 0.02f || height > who.step_height_ + who.skin_ || !(length(flat) > 1e-3f)) return false;
    const Position behind = m.hit.point - who.skin_ * normalize(flat);
    Result<QueryHit> face = around.face_at(m, behind, up, 2.0f * who.skin_, done);
    return face && face.value() && !face.value().started_inside && is_level(face.value().normal);
}

// Up, ahead and down again, if that leads on to where it can stand, and higher. Bodies count as at the end of the step.
bool CharacterStep::step_up(Travel& t) {
    const float wanted = length(level(t.walk));
    if (!(who.step_height_ > who.skin_) || !(wanted > 0.01f * who.skin_)) return false;
    // It stands a skin before the step and has to come over it, at once however short its way: it waits then until it
    // would have been there.
    const float far = maximum(wanted, 3.0f * who.skin_);
    const Vec3 ahead = (far / wanted) * level(t.walk);
    const Position before = s.position;
    auto go = [&](Vec3 way) {
        Meeting m = around.first(shape(), way, 1.0f);
        s.position += (m ? m.share(who.skin_) : 1.0f) * way;
        return m;
    };
    s.position += level(t.carry);
    const Position start = s.position;
    go((who.step_height_ + who.skin_) * up);
    const float risen = dot(s.position - start, up);
    const Position raised = s.position;
    go(ahead);
    const float gone = length(s.position - raised);
    if (risen > who.skin_ && gone > 1.5f * who.skin_) {
        Meeting m = go((-risen) * up);
        const float climbed = dot(s.position - start, up);
        // Round feet come to rest on the edge of what is higher than they are: that has to be within the step too.
        const bool low = m && dot(m.hit.point - start, up) <= who.step_height_ + who.skin_;
        if (low && climbed > 1e-3f * who.skin_ && stands_on(m, 1.0f)) {
            if (t.acts) s.ahead = maximum(gone - wanted, 0.0f);
            t.advance(minimum(wanted / gone, 1.0f) * level(s.position - start) + (start - before), 1.0f);
            return true;
        }
    }
    s.position = before;
    return false;
}

}  // namespace lendulet
