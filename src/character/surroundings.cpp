#include "character/surroundings.h"

namespace lendulet {
namespace {

constexpr float touching = 1e-4f;  // share of a way by which it leads away from what it starts at, or along it

}  // namespace

Vec3 taken_by(const RigidBodyRef& body, Position p, float dt) {
    const Position centre = body.centre_of_mass();
    const Vec3 w = body.angular_velocity(), arm = p - centre;
    const float speed = length(w);
    const Vec3 moved = dt * body.velocity();
    if (!(speed > 0.0f)) return moved;
    return moved + (rotate(rotation_about(w, speed * dt), arm) - arm);
}

void Surroundings::look(const PosedShape& shape, Vec3 margin, float dt, BodyId ground, Vec3 carried) {
    QueryFilter moving = others_;
    moving.see_fixed = false;
    const Vec3 centre = from_origin(shape.pose.position);
    Proximity found[64];
    Result<int> n = world_.overlap_box({at(centre - margin), at(centre + margin)}, found, moving);
    if (!n) return;
    for (int i = 0; i < n.value() && i < 64; ++i) {
        if (find(found[i].body)) continue;
        // More than can be told apart are taken for still.
        if (count_ == 32) {
            all_still_ = true;
            return;
        }
        Neighbour& b = neighbours_[count_++];
        b = {found[i].body, world_.get_static(found[i].body).type(), {}, 0.0f, {}, {}, {}};
        QueryFilter only = moving;
        only.only_body = b.body;
        Result<Proximity> near = world_.closest(shape, 4.0f * max_component(margin), only);
        if (!near || !near.value()) {
            --count_;
            continue;
        }
        const Proximity& p = near.value();
        b.gap = p.distance, b.normal = -p.normal, b.point = p.point_b, b.collider = p.collider;
        b.motion = b.body == ground ? carried : taken_by(world_.get(b.body), b.point, dt);
        all_still_ = all_still_ && dot(b.motion, b.motion) == 0.0f;
    }
}

Neighbour* Surroundings::find(BodyId body) {
    for (Neighbour& b : neighbours())
        if (b.body == body) return &b;
    return nullptr;
}

// The cast tells one collider at fraction 0, so where the shape leads away from that, all that it meets are asked for.
Meeting Surroundings::first_of(const PosedShape& shape, Vec3 way, const QueryFilter& filter) const {
    if (!(max_component(absolute(way)) > 1e-9f)) return {};
    const float whole = length(way), stretch = 1.0f + beyond_ / whole;
    const ShapeCast cast{.start = shape, .translation = stretch * way};
    auto counts = [&](const QueryHit& h) {
        return dot(way, h.normal) < (h.fraction > 0.0f ? 0.0f : -touching * whole);
    };
    auto meeting = [&](QueryHit hit) {
        hit.fraction *= stretch;
        return Meeting{hit, nullptr, way};
    };
    Result<QueryHit> hit = world_.cast_shape(cast, filter);
    if (!hit || !hit.value()) return {};
    if (counts(hit.value())) return meeting(hit.value());
    QueryHit all[16];
    Result<int> n = world_.cast_shape_all(cast, all, filter);
    for (int i = 0; n && i < n.value() && i < 16; ++i)
        if (counts(all[i])) return meeting(all[i]);
    return {};
}

Meeting Surroundings::first(const PosedShape& shape, Vec3 way, float done) {
    QueryFilter filter = others_;
    if (all_still_) {
        Meeting m = first_of(shape, way, filter);
        if (m) m.neighbour = find(m.hit.body);
        return m;
    }
    filter.see_kinematic = filter.see_dynamic = false;
    Meeting best = first_of(shape, way, filter);
    filter = others_;
    for (Neighbour& b : neighbours()) {
        filter.only_body = b.body;
        const PosedShape seen{shape.shape, {shape.pose.position - done * b.motion, shape.pose.orientation}};
        Meeting m = first_of(seen, way - (1.0f - done) * b.motion, filter);
        if (!m || (best && best.hit.fraction <= m.hit.fraction)) continue;
        best = m;
        best.neighbour = &b;
        best.hit.point += (done + (1.0f - done) * m.hit.fraction) * b.motion;
    }
    return best;
}

Result<QueryHit> Surroundings::face_at(const Meeting& meeting, Position point, Vec3 up, float depth, float done) const {
    QueryFilter filter = others_;
    filter.only_body = meeting.hit.body;
    if (meeting.neighbour && !all_still_) point -= done * meeting.neighbour->motion;
    return world_.cast_ray({point + depth * up, (-2.0f * depth) * up}, filter);
}

}  // namespace lendulet
