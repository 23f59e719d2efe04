// Balls, capsules and boxes by closed forms, and shapes on a mesh and on a height field of the same hills.
#include <cmath>

#include "bench/collision/pairs.h"
#include "collision/narrow_phase.h"
#include "collision/query/proximity.h"
#include "scenes/description.h"
#include "scenes/random.h"

namespace lendulet::bench {
namespace {

using scenes::Random;

struct Placement {
    Quat rotation_a, rotation_b;
    Vec3 offset;
};

double deepest_of(const Manifold* manifolds, int count) {
    double least = 1e30;
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < manifolds[k].count; ++i) least = std::min<double>(least, manifolds[k].points[i].separation);
    return least;
}

// Distance of the surfaces by the query, which is exact.
double nearness_of(const Geometry& a, const Geometry& b, const Placement& p) {
    Nearness n;
    bool convex_last = !has_triangles(b);
    PlacedPair pair = convex_last ? PlacedPair{&a, &b, p.rotation_a, p.rotation_b, to_double(p.offset)}
                                  : PlacedPair{&b, &a, p.rotation_b, p.rotation_a, to_double(-p.offset)};
    return nearness(pair, 1e9, n) ? n.distance : 1e9;
}

// `judged`: the deepest point is the distance or depth.
void measure(const char* name, const Shape& shape_a, const Shape& shape_b, const std::vector<Placement>& places,
             int repeats, bool judged, CollisionRows& rows) {
    const Geometry a = make_geometry(shape_a).value(), b = make_geometry(shape_b).value();
    std::vector<double> times, answers(places.size());
    for (int round = 0; round < repeats; ++round) {
        const double start = computing_time();
        for (size_t i = 0; i < places.size(); ++i) {
            const Placement& p = places[i];
            PairCache cache;
            Manifold out[max_mesh_manifolds];
            int count = collide({&a, &b, p.rotation_a, p.rotation_b, p.offset, contact_margin}, cache, {}, out,
                                max_mesh_manifolds);
            answers[i] = deepest_of(out, count);
        }
        times.push_back((computing_time() - start) / static_cast<double>(places.size()));
    }
    CollisionRow row{"lendulet manifold, single", name, median_of(times), judged ? 0.0 : -1.0, 0, true};
    for (size_t i = 0; judged && i < places.size(); ++i) {
        double truth = nearness_of(a, b, places[i]);
        if (truth > 0.99 * contact_margin && answers[i] > 1e9) continue;
        double error = std::abs(truth - answers[i]);
        if (!(error <= 1e-3)) ++row.failures;
        else row.worst_error = std::max(row.worst_error, error);
    }
    rows.push_back(row);
}

std::vector<Placement> near_contact(const Shape& a, const Shape& b, int count) {
    const Geometry ga = make_geometry(a).value(), gb = make_geometry(b).value();
    Random random;
    std::vector<Placement> places;
    for (int i = 0; i < count; ++i) {
        Placement p{random.rotation(), random.rotation(), {}};
        Vec3 away{random.range(-1.0f, 1.0f), random.range(-1.0f, 1.0f), random.range(-1.0f, 1.0f)};
        p.offset = 5.0f * normalize(away + Vec3{1e-3f, 0.0f, 0.0f});
        Nearness n;
        if (!nearness({&ga, &gb, p.rotation_a, p.rotation_b, to_double(p.offset)}, 1e9, n)) continue;
        p.offset = p.offset - static_cast<float>(n.distance - random.range(-0.02f, 0.02f)) * to_float(n.normal);
        places.push_back(p);
    }
    return places;
}

// Lying on the hills, or up to a centimetre above or below.
std::vector<Placement> on_surface(const Shape& ground, const Shape& shape, int count) {
    const Geometry g = make_geometry(ground).value(), s = make_geometry(shape).value();
    Random random;
    std::vector<Placement> places;
    for (int i = 0; i < count; ++i) {
        Placement p{{}, random.rotation(), {random.range(-40.0f, 40.0f), 8.0f, random.range(-40.0f, 40.0f)}};
        Nearness n;
        for (int round = 0; round < 20; ++round) {
            if (!nearness({&g, &s, {}, p.rotation_b, to_double(p.offset)}, 1e9, n) || n.distance < 0.01) break;
            p.offset.y -= static_cast<float>(n.distance);
        }
        p.offset.y -= random.range(-0.005f, 0.005f);
        places.push_back(p);
    }
    return places;
}

Shape ground_of(const char* scene) {
    return scenes::describe_scene(scene).value().bodies.front().colliders.front().shape;
}

}  // namespace

void measure_kinds(int pairs, int repeats, CollisionRows& rows) {
    const Shape ball = Sphere{0.4f}, capsule = Capsule{0.4f, 0.3f}, box = Box{{0.5f, 0.4f, 0.3f}};
    struct Pair {
        const char* name;
        const Shape &a, &b;
    };
    for (const Pair& p :
         {Pair{"ball-ball", ball, ball}, Pair{"ball-capsule", ball, capsule}, Pair{"capsule-capsule", capsule, capsule},
          Pair{"ball-box", ball, box}, Pair{"capsule-box", capsule, box}})
        measure(p.name, p.a, p.b, near_contact(p.a, p.b, pairs), repeats, true, rows);
    const int on_ground = pairs / 10 > 16 ? pairs / 10 : 16;
    for (const char* scene : {"mesh_terrain:1", "height_field:1"}) {
        const Shape ground = ground_of(scene);
        const std::string surface = std::string(scene).substr(0, std::string(scene).find(':'));
        for (const Pair& p : {Pair{"ball", ball, ball}, Pair{"capsule", capsule, capsule}, Pair{"box", box, box}})
            measure((std::string(p.name) + "-" + surface).c_str(), ground, p.a, on_surface(ground, p.a, on_ground),
                    repeats, false, rows);
    }
}

}  // namespace lendulet::bench
