#include "scenes/plain_shape.h"

namespace lendulet {
namespace {

struct Describe {
    PlainShape& out;
    void sizes(float a, float b = 0.0f, float c = 0.0f, float d = 0.0f) {
        out.size[0] = a, out.size[1] = b, out.size[2] = c, out.size[3] = d;
    }
    void operator()(const Sphere& s) { sizes(s.radius); }
    void operator()(const Capsule& s) { sizes(s.half_height, s.radius); }
    void operator()(const TaperedCapsule& s) { sizes(s.half_height, s.bottom_radius, s.top_radius); }
    void operator()(const Box& s) {
        sizes(s.half_extents.x, s.half_extents.y, s.half_extents.z);
        out.rounding = s.rounding;
    }
    void operator()(const Cylinder& s) { sizes(s.half_height, s.radius), out.rounding = s.rounding; }
    void operator()(const TaperedCylinder& s) {
        sizes(s.half_height, s.bottom_radius, s.top_radius), out.rounding = s.rounding;
    }
    void operator()(const Cone& s) { sizes(s.half_height, s.radius), out.rounding = s.rounding; }
    void operator()(const ConvexHull& s) { out.rounding = s.rounding(); }
    void operator()(const Plane& s) { sizes(s.normal.x, s.normal.y, s.normal.z, s.offset); }
    void operator()(const TriangleMesh&) {}
    void operator()(const HeightField&) {}
};

}  // namespace

PlainShape plain(const Shape& shape) {
    PlainShape out{static_cast<int>(shape.index()), {}, 0.0f};
    std::visit(Describe{out}, shape);
    return out;
}

const void* surface_of(const Shape& shape) {
    if (const auto* hull = std::get_if<ConvexHull>(&shape)) return &hull->data();
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) return &mesh->data();
    if (const auto* field = std::get_if<HeightField>(&shape)) return &field->data();
    return nullptr;
}

}  // namespace lendulet
