// Rays into a settled pile of boxes: the batched call, the single one, and Bullet's.
#include <cmath>
#include <cstdio>

#include "bench/collision/pairs.h"
#include "lendulet/world.h"
#include "scenes/random.h"
#include "scenes/scene.h"

namespace lendulet::bench {
namespace {

using scenes::Random;

template <class Run>
double time_of(size_t rays, Run&& run) {
    const double start = computing_time();
    run();
    return (computing_time() - start) / static_cast<double>(rays);
}

// From points above the pile, within its container, through points in it.
void make_rays(const World& world, int count, std::vector<Ray>& rays, RayScene& scene) {
    Vec3 lower{1e9f, 1e9f, 1e9f}, upper = -lower;
    for (int i = 0; i < world.body_count(); ++i) {
        StaticBodyRef body = world.get_static(world.body(i));
        if (body.type() == BodyType::fixed) continue;
        lower = minimum(lower, from_origin(body.position()));
        upper = maximum(upper, from_origin(body.position()));
    }
    const Vec3 middle = 0.5f * (lower + upper), half = 0.5f * (upper - lower);
    Random random;
    auto within = [&](float scale) {
        float x = random.range(-scale, scale), y = random.range(-scale, scale), z = random.range(-scale, scale);
        return middle + multiply(half, Vec3{x, y, z});
    };
    for (int i = 0; i < count; ++i) {
        Vec3 from = within(0.95f), to = within(0.95f);
        from.y = upper.y + 1.0f + absolute(from.y);
        rays.push_back({at(from), 1.5f * (to - from), 1.0f});
        scene.from.push_back(from);
        scene.to.push_back(from + rays.back().translation);
    }
}

}  // namespace

void measure_rays(int count, int bodies, int repeats, CollisionRows& rows) {
    Scene pile = build_scene("box_pile:" + std::to_string(bodies)).value();
    for (int i = 0; i < 240; ++i) pile.world.update(pile.dt).value();
    std::vector<Ray> rays;
    RayScene scene;
    make_rays(pile.world, count, rays, scene);
    scene.boxes = boxes_of(pile.world);
    std::vector<QueryHit> hits(rays.size()), single(rays.size());
    std::vector<double> batched_times, single_times;
    for (int round = 0; round < repeats; ++round) {
        batched_times.push_back(time_of(rays.size(), [&] { pile.world.cast_rays(rays, hits).value(); }));
        single_times.push_back(time_of(rays.size(), [&] {
            for (size_t i = 0; i < rays.size(); ++i) single[i] = pile.world.cast_ray(rays[i]).value();
        }));
    }
    long different = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        different += hits[i].hit != single[i].hit || hits[i].fraction != single[i].fraction;
        scene.fractions.push_back(hits[i] ? hits[i].fraction : 2.0);
    }
    const std::string name = "ray, pile of " + std::to_string(bodies);
    rows.push_back({"lendulet cast_rays", name, median_of(batched_times), -1.0, different, true});
    rows.push_back({"lendulet cast_ray", name, median_of(single_times), -1.0, different, true});
    std::vector<double> fractions;
    std::vector<double> times = bullet_rays(scene, repeats, fractions);
    if (times.empty()) return;
    CollisionRow row{"bullet rayTest", name, median_of(times), 0.0, 0, false};
    for (size_t i = 0; i < rays.size(); ++i) {
        double off = std::abs(fractions[i] - scene.fractions[i]) * length(rays[i].translation);
        if (!(off <= 1e-2)) ++row.failures;
        else row.worst_error = std::max(row.worst_error, off);
    }
    rows.push_back(row);
}

}  // namespace lendulet::bench
