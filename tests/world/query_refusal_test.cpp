// Queries refuse what makes no sense, with ErrorCode::bad_query and a sentence that names the call.
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "world/support.h"

namespace lendulet {
namespace {

using namespace test;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

template <class T>
void expect_refused(const Result<T>& r, const char* call, const char* what) {
    ASSERT_FALSE(r.ok()) << call << ", " << what;
    EXPECT_EQ(r.error().code, ErrorCode::bad_query) << r.error().message;
    EXPECT_EQ(r.error().message.rfind(call, 0), 0u) << r.error().message;
    EXPECT_NE(r.error().message.find(what), std::string::npos) << r.error().message;
}

World one_box() {
    World world = WorldBuilder().build().value();
    world.add_static_body({.shape = Box{}}).value();
    return world;
}

TEST(QueryRefusals, Rays) {
    World world = one_box();
    const PosedShape box{Box{}, {}};
    const std::pair<Ray, const char*> bad[] = {{{.translation = {}}, "no length"},
                                               {{.origin = {nan, 0.0f, 0.0f}}, "finite"},
                                               {{.translation = {0.0f, infinity, 0.0f}}, "finite"},
                                               {{.max_fraction = -1.0f}, "max_fraction"},
                                               {{.max_fraction = nan}, "max_fraction"},
                                               {{.max_fraction = infinity}, "max_fraction"}};
    std::array<QueryHit, 4> out;
    for (const auto& [ray, what] : bad) {
        expect_refused(world.cast_ray(ray), "cast_ray", what);
        expect_refused(world.cast_ray_any(ray), "cast_ray_any", what);
        expect_refused(world.cast_ray_all(ray, out), "cast_ray_all", what);
        expect_refused(cast_ray(box, ray), "cast_ray", what);
        const Ray rays[] = {Ray{{0.0f, 5.0f, 0.0f}, {0.0f, -9.0f, 0.0f}}, ray};
        expect_refused(world.cast_rays(rays, std::span(out).first(2)), "cast_rays", "element 1");
        EXPECT_FALSE(out[0].hit);  // nothing was written
    }
    const Ray good[] = {Ray{}, Ray{}};
    expect_refused(world.cast_rays(good, std::span(out).first(1)), "cast_rays", "room for 1");
    EXPECT_TRUE(world.cast_rays({}, {}).ok());
}

TEST(QueryRefusals, CastsAndShapes) {
    World world = one_box();
    const PosedShape box{Box{}, {}};
    auto with = [](const Shape& shape) { return ShapeCast{.start = {shape, {}}, .translation = {1.0f, 0.0f, 0.0f}}; };
    ShapeCast turned = with(Box{});
    turned.start.pose.orientation = {0.0f, 0.0f, 0.0f, 2.0f};
    ShapeCast far = with(Box{});
    far.start.pose.position.y = nan;
    ShapeCast spun = with(Box{});
    spun.rotation = {0.0f, 101.0f, 0.0f};
    const std::pair<ShapeCast, const char*> bad[] = {
        {{.start = box}, "goes nowhere"},
        {{.start = box, .translation = {nan, 0.0f, 0.0f}}, "finite"},
        {{.start = box, .translation = {1.0f, 0.0f, 0.0f}, .max_fraction = -0.1f}, "max_fraction"},
        {with(Plane{}), "convex"},
        {with(wavy_ground(2, 1.0f, 0.1f)), "convex"},
        {with(Sphere{-1.0f}), "radius"},
        {with(ConvexHull{}), "ConvexHull"},
        {turned, "orientation"},
        {far, "finite"},
        {spun, "at most 100"}};
    std::array<QueryHit, 4> out;
    std::array<Proximity, 4> near;
    for (const auto& [cast, what] : bad) {
        expect_refused(world.cast_shape(cast), "cast_shape", what);
        expect_refused(world.cast_shape_any(cast), "cast_shape_any", what);
        expect_refused(world.cast_shape_all(cast, out), "cast_shape_all", what);
        expect_refused(cast_shape(box, cast), "cast_shape", what);
        const ShapeCast casts[] = {cast};
        expect_refused(world.cast_shapes(casts, std::span(out).first(1)), "cast_shapes", "element 0");
    }
    expect_refused(world.overlap_shape({Plane{}, {}}, near), "overlap_shape", "convex");
    expect_refused(world.overlap_any({Sphere{nan}, {}}), "overlap_any", "radius");
    expect_refused(world.closest(PosedShape{Plane{}, {}}, 1.0f), "closest", "convex");
    expect_refused(closest_points({Plane{}, {}}, {Plane{}, {}}), "closest_points", "convex");
    expect_refused(overlaps({Plane{}, {}}, {wavy_ground(2, 1.0f, 0.1f), {}}), "overlaps", "convex");
}

TEST(QueryRefusals, PointsBoxesAndDistances) {
    World world = one_box();
    std::array<Proximity, 4> near;
    const Position nowhere{0.0f, infinity, 0.0f};
    expect_refused(world.overlap_point(nowhere, near), "overlap_point", "finite");
    expect_refused(world.closest(nowhere, 1.0f), "closest", "finite");
    expect_refused(world.closest(Position{}, -1.0f), "closest", "max_distance");
    expect_refused(world.closest(Position{}, nan), "closest", "max_distance");
    expect_refused(world.closest(PosedShape{}, infinity), "closest", "max_distance");
    expect_refused(contains(PosedShape{}, nowhere), "contains", "finite");
    expect_refused(world.overlap_box({{0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 1.0f}}, near), "overlap_box", "above");
    expect_refused(world.overlap_box({{0.0f, nan, 0.0f}, {1.0f, 2.0f, 1.0f}}, near), "overlap_box", "finite");
}

TEST(QueryRefusals, StaleIds) {
    World world = one_box();
    BodyId gone = world.add_static_body({.shape = Sphere{}}).value();
    world.remove_body(gone).value();
    std::array<QueryHit, 1> out;
    std::array<Proximity, 1> near;
    const Ray ray[] = {Ray{}};
    for (const QueryFilter& f : {QueryFilter{.ignore_body = gone}, QueryFilter{.only_body = gone}}) {
        expect_refused(world.cast_ray(ray[0], f), "cast_ray", "no body");
        expect_refused(world.cast_rays(ray, out, f), "cast_rays", "no body");
        expect_refused(world.cast_shape({.translation = {1.0f, 0.0f, 0.0f}}, f), "cast_shape", "no body");
        expect_refused(world.closest(Position{}, 1.0f, f), "closest", "no body");
        expect_refused(world.overlap_point({}, near, f), "overlap_point", "no body");
        expect_refused(world.overlap_any({}, f), "overlap_any", "no body");
        expect_refused(world.overlap_box({}, near, f), "overlap_box", "no body");
    }
}

}  // namespace
}  // namespace lendulet
