// Asks a small world what is where: rays, casts, overlaps, closest points, and many rays at once.
#include <array>
#include <cstdio>
#include <vector>

#include "lendulet/lendulet.h"

using namespace lendulet;

int main() {
    World world = WorldBuilder().build().value();
    world.add_static_body({.shape = Plane{}, .name = "ground"}).value();
    BodyId crate = world.add_rigid_body({.shape = Box{}, .position = {0.0f, 3.0f, 0.0f}, .name = "crate"}).value();
    BodyId walker = world.add_rigid_body({.shape = Capsule{0.6f, 0.3f}, .position = {3.0f, 0.9f, 0.0f}}).value();
    for (int i = 0; i < 120; ++i) world.update(1.0f / 60.0f).value();

    // What is below this point?
    QueryHit hit = world.cast_ray({.origin = {0.2f, 10.0f, 0.1f}, .translation = {0.0f, -20.0f, 0.0f}}).value();
    if (hit) std::printf("below: %s at y = %.3f\n", world.get_static(hit.body).name().data(), hit.point.y);

    // How far can the walker go to the left?
    ShapeCast step{.start = {Capsule{0.6f, 0.29f}, {world.get(walker).position(), {}}},
                   .translation = {-5.0f, 0.0f, 0.0f}};
    QueryHit stop = world.cast_shape(step, {.ignore_body = walker, .see_fixed = false}).value();
    std::printf("free way: %.3f m\n", 5.0f * stop.fraction);

    // What is within a ball, and which body is nearest to a point?
    std::array<Proximity, 8> near;
    int count = world.overlap_shape({Sphere{4.0f}, {}}, near).value();
    Proximity nearest = world.closest(Position{0.0f, 2.0f, 0.0f}, 10.0f).value();
    std::printf("in the ball: %d; nearest: %.3f m away%s\n", count, nearest.distance,
                nearest.body == crate ? ", the crate" : "");

    // A fan of rays in one call.
    std::vector<Ray> rays;
    for (int i = 0; i < 1000; ++i)
        rays.push_back({{-2.0f + 0.004f * static_cast<float>(i), 5.0f, 0.0f}, {0.0f, -10.0f, 0.0f}});
    std::vector<QueryHit> hits(rays.size());
    world.cast_rays(rays, hits).value();
    int on_crate = 0;
    for (const QueryHit& h : hits) on_crate += h.body == crate;
    std::printf("%d of %zu rays meet the crate\n", on_crate, rays.size());
}
