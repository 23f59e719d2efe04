// The pairs of a settled pile, as a broad phase gives them: what a step asks its narrow phase.
#include <algorithm>
#include <cmath>

#include "bench/collision/pairs.h"
#include "geometry/geometry.h"
#include "scenes/scene.h"

namespace lendulet::bench {
namespace {

constexpr int settling_steps = 200;
constexpr float widening = 0.05f;  // m, of bounds

struct Bounds {
    Vec3 lower, upper;
    int32_t box;
};

Transform in_frame_of(const PlacedBox& a, const PlacedBox& b) {
    return {rotate_inverse(a.pose.orientation, b.pose.position - a.pose.position),
            conjugate(a.pose.orientation) * b.pose.orientation};
}

std::vector<Bounds> bounds_of(const std::vector<PlacedBox>& boxes) {
    std::vector<Bounds> all;
    for (const PlacedBox& box : boxes) {
        const CentredBox around = bounds(make_geometry(Box{box.half}).value(), box.pose.orientation);
        const Vec3 middle = from_origin(box.pose.position) + around.centre;
        const Vec3 half = around.half + Vec3{widening, widening, widening};
        all.push_back({middle - half, middle + half, static_cast<int32_t>(all.size())});
    }
    return all;
}

bool overlap(const Bounds& a, const Bounds& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

}  // namespace

std::vector<PlacedBox> boxes_of(const World& world) {
    std::vector<PlacedBox> boxes;
    for (int i = 0; i < world.body_count(); ++i) {
        StaticBodyRef body = world.get_static(world.body(i));
        for (int k = 0; k < body.collider_count(); ++k)
            if (const auto* box = std::get_if<Box>(&body.shape(k))) {
                Transform local = body.collider_pose(k);
                boxes.push_back({box->half_extents,
                                 {body.position() + rotate(body.orientation(), local.translation),
                                  body.orientation() * local.rotation}});
            }
    }
    return boxes;
}

PairSet make_pile_set(int bodies) {
    Scene pile = build_scene("box_pile:" + std::to_string(bodies)).value();
    for (int i = 0; i < settling_steps; ++i) pile.world.update(pile.dt).value();
    PairSet set{"box-box pile", true, {}, boxes_of(pile.world)};
    // Walls are large and few, and do not meet each other here.
    std::vector<Bounds> sorted = bounds_of(set.boxes);
    std::sort(sorted.begin(), sorted.end(), [](const Bounds& a, const Bounds& b) { return a.lower.x < b.lower.x; });
    std::vector<std::pair<int32_t, int32_t>> pairs;
    auto is_wall = [&](int32_t i) { return max_component(set.boxes[static_cast<size_t>(i)].half) > 1.0f; };
    for (size_t i = 0; i < sorted.size(); ++i)
        for (size_t k = i + 1; k < sorted.size() && sorted[k].lower.x <= sorted[i].upper.x; ++k)
            if (overlap(sorted[i], sorted[k]) && !(is_wall(sorted[i].box) && is_wall(sorted[k].box)))
                pairs.push_back(std::minmax(sorted[i].box, sorted[k].box));
    std::sort(pairs.begin(), pairs.end());
    for (auto [first, second] : pairs) {
        const PlacedBox &a = set.boxes[static_cast<size_t>(first)], &b = set.boxes[static_cast<size_t>(second)];
        ConvexCase c{Box{a.half}, Box{b.half}, in_frame_of(a, b), {}, 0.0, 0.0};
        c.moved = c.b_in_a;
        c.truth = std::min<double>(truth_of(c.a, c.b, c.b_in_a), contact_margin);
        c.truth_moved = c.truth;
        set.cases.push_back(std::move(c));
        set.a.push_back(first), set.b.push_back(second);
    }
    return set;
}

}  // namespace lendulet::bench
