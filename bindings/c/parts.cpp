// The C interface: parts as shapes, and questions that are asked with one.
#include <algorithm>

#include "bindings/c/handle.h"

using namespace lendulet;
using namespace lendulet::c;

namespace {

Status set_given_shape(const lendulet_world& world, const lendulet_part& p, const char* call, Shape& out) {
    const size_t index = static_cast<size_t>(p.mesh);
    const bool there = p.mesh >= 0 && index < world.given.size();
    if ((p.type == LENDULET_HULL && there && std::holds_alternative<ConvexHull>(world.given[index])) ||
        (p.type == LENDULET_MESH && there && std::holds_alternative<TriangleMesh>(world.given[index]))) {
        out = world.given[index];
        return {};
    }
    return Error{ErrorCode::bad_mesh, std::string(call) + ": there is no such hull or mesh"};
}

Result<PosedShape> posed(const lendulet_world& world, const lendulet_part& part, const char* call) {
    PosedShape at;
    at.pose = {position(part.position), rotation(part.orientation)};
    if (Status s = set_shape(world, part, call, at.shape); !s) return s.error();
    return at;
}

}  // namespace

namespace lendulet::c {

Status set_shape(const lendulet_world& world, const lendulet_part& p, const char* call, Shape& out) {
    const float *s = p.size, r = p.rounding;
    switch (p.type) {
        case LENDULET_SPHERE:
            out = Sphere{s[0]};
            return {};
        case LENDULET_CAPSULE:
            out = Capsule{s[0], s[1]};
            return {};
        case LENDULET_TAPERED_CAPSULE:
            out = TaperedCapsule{s[0], s[1], s[2]};
            return {};
        case LENDULET_BOX:
            out = Box{vector(s), r};
            return {};
        case LENDULET_CYLINDER:
            out = Cylinder{s[0], s[1], r};
            return {};
        case LENDULET_TAPERED_CYLINDER:
            out = TaperedCylinder{s[0], s[1], s[2], r};
            return {};
        case LENDULET_CONE:
            out = Cone{s[0], s[1], r};
            return {};
        case LENDULET_PLANE:
            out = Plane{vector(s), s[3]};
            return {};
        default:
            return set_given_shape(world, p, call, out);
    }
}

lendulet_result put_hit(const Result<QueryHit>& hit, lendulet_hit& out) {
    if (!hit) return refuse(hit.error());
    out = {};
    if (!hit.value()) return 0;
    out.body = number_of(hit.value().body);
    out.fraction = hit.value().fraction;
    put(out.point, hit.value().point);
    put(out.normal, hit.value().normal);
    return 1;
}

}  // namespace lendulet::c

extern "C" {

lendulet_result lendulet_cast_ray(const lendulet_world* world, const float origin[3], const float translation[3],
                                  lendulet_hit* out) {
    if (!world || !origin || !translation || !out) return refuse_null("cast_ray");
    return put_hit(world->scene.world.cast_ray({position(origin), vector(translation)}), *out);
}

lendulet_result lendulet_cast_shape(const lendulet_world* world, const lendulet_part* part, const float translation[3],
                                    lendulet_hit* out) {
    if (!world || !part || !translation || !out) return refuse_null("cast_shape");
    Result<PosedShape> start = posed(*world, *part, "cast_shape");
    if (!start) return refuse(start.error());
    return put_hit(world->scene.world.cast_shape({.start = start.value(), .translation = vector(translation)}), *out);
}

lendulet_result lendulet_read_overlaps(lendulet_world* world, const lendulet_part* part, const lendulet_body** out) {
    if (!world || !part || !out) return refuse_null("read_overlaps");
    Result<PosedShape> shape = posed(*world, *part, "read_overlaps");
    if (!shape) return refuse(shape.error());
    std::vector<Proximity> found(32);
    for (;;) {
        Result<int> count = world->scene.world.overlap_shape(shape.value(), found);
        if (!count) return refuse(count.error());
        const bool fits = static_cast<size_t>(count.value()) <= found.size();
        found.resize(static_cast<size_t>(count.value()));
        if (fits) break;
    }
    world->overlaps.clear();
    for (const Proximity& p : found) {
        const lendulet_body body = number_of(p.body);
        if (std::find(world->overlaps.begin(), world->overlaps.end(), body) == world->overlaps.end())
            world->overlaps.push_back(body);
    }
    return give(world->overlaps, out);
}

}  // extern "C"
