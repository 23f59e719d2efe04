#include "bench/broad_phase/workload.h"

#include <algorithm>
#include <cmath>

namespace lendulet::bench {
namespace {

using scenes::Random;

struct Point {
    float x[3];
};

Point random_point(Random& random, float side) {
    Point p;
    for (float& x : p.x) x = random.range(0.0f, side);
    return p;
}

BroadBox box_around(const Point& centre, const Point& half, uint32_t index) {
    BroadBox box{};
    for (int d = 0; d < 3; ++d) {
        box.lower[d] = centre.x[d] - half.x[d];
        box.upper[d] = centre.x[d] + half.x[d];
    }
    box.index = index;
    return box;
}

Point random_half_extents(Random& random, float least, float most) {
    Point half;
    for (float& x : half.x) x = random.range(least, most);
    return half;
}

// Normally distributed to the eye: a sum of four even numbers, scaled to variance 1.
float bell(Random& random) {
    float sum = 0.0f;
    for (int i = 0; i < 4; ++i) sum += random.range(-1.0f, 1.0f);
    return sum * 0.8660254f;
}

// Heaps of about a thousand boxes, spread so that a box meets about four times as many others as in `uniform`.
Boxes clustered(Random& random, int count) {
    int heaps = std::max(1, count / 1000);
    float per_heap = static_cast<float>(count) / static_cast<float>(heaps);
    float spread = 0.267f * std::cbrt(per_heap);
    float side = 20.0f * spread * std::cbrt(static_cast<float>(heaps));
    std::vector<Point> centres;
    for (int i = 0; i < heaps; ++i) centres.push_back(random_point(random, side));
    Boxes boxes;
    for (int i = 0; i < count; ++i) {
        Point centre = centres[static_cast<size_t>(i % heaps)];
        for (float& x : centre.x) x += spread * bell(random);
        boxes.push_back(box_around(centre, random_half_extents(random, 0.25f, 0.5f), static_cast<uint32_t>(i)));
    }
    return boxes;
}

Boxes on_ground(Random& random, int count) {
    float side = 1.5f * std::sqrt(static_cast<float>(count) / 2.0f);
    Boxes boxes{box_around({{side / 2, -0.5f, side / 2}}, {{side, 0.5f, side}}, 0)};
    for (int i = 1; i < count; ++i) {
        Point half = random_half_extents(random, 0.25f, 0.5f), centre = random_point(random, side);
        float storey = static_cast<float>(random.next() % 3);
        centre.x[1] = half.x[1] + storey;
        boxes.push_back(box_around(centre, half, static_cast<uint32_t>(i)));
    }
    return boxes;
}

Boxes uniform(Random& random, int count, bool one_huge) {
    float side = 1.5f * std::cbrt(static_cast<float>(count));
    Boxes boxes;
    for (int i = 0; i < count; ++i) {
        Point half = random_half_extents(random, 0.25f, 0.5f), centre = random_point(random, side);
        if (one_huge && i == 0) {
            centre = {{side / 2, side / 2, side / 2}};
            half = {{side, side, side}};
        }
        boxes.push_back(box_around(centre, half, static_cast<uint32_t>(i)));
    }
    return boxes;
}

}  // namespace

std::string_view name_of(Distribution distribution) {
    switch (distribution) {
        case Distribution::uniform:
            return "uniform";
        case Distribution::clustered:
            return "clustered";
        case Distribution::ground:
            return "ground";
        case Distribution::one_huge:
            return "one-huge";
    }
    return "unknown";
}

Boxes make_boxes(Distribution distribution, int count) {
    Random random(42);
    switch (distribution) {
        case Distribution::clustered:
            return clustered(random, count);
        case Distribution::ground:
            return on_ground(random, count);
        case Distribution::uniform:
        case Distribution::one_huge:
            break;
    }
    return uniform(random, count, distribution == Distribution::one_huge);
}

Boxes make_queries(const Boxes& boxes, int count) {
    Random random(99);
    Boxes queries;
    for (int i = 0; i < count; ++i) {
        const BroadBox& near = boxes[random.next() % boxes.size()];
        Point centre, half = random_half_extents(random, 0.5f, 1.0f);
        for (int d = 0; d < 3; ++d) centre.x[d] = 0.5f * (near.lower[d] + near.upper[d]);
        queries.push_back(box_around(centre, half, static_cast<uint32_t>(i)));
    }
    return queries;
}

Motion::Motion(Distribution distribution, Boxes boxes) : boxes_(std::move(boxes)), home_(boxes_) {
    bool first_stays = distribution == Distribution::ground || distribution == Distribution::one_huge;
    first_mobile_ = first_stays && boxes_.size() > 1 ? 1 : 0;
}

std::vector<uint32_t> Motion::next_frame() {
    uint32_t mobile = static_cast<uint32_t>(boxes_.size()) - first_mobile_;
    uint32_t wanted = std::max(1u, mobile / 20);
    std::vector<uint32_t> places;
    for (uint32_t i = 0; i < wanted; ++i) places.push_back(first_mobile_ + random_.next() % mobile);
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (uint32_t place : places) move(boxes_[place], home_[place]);
    return places;
}

void Motion::move(BroadBox& box, const BroadBox& home) {
    constexpr float leash = 1.0f;  // m
    for (int d = 0; d < 3; ++d) {
        float half = 0.5f * (box.upper[d] - box.lower[d]);
        float way = random_.range(-half, half), away = box.lower[d] - home.lower[d];
        if (away * way > 0.0f && std::fabs(away) > leash) way = -way;
        box.lower[d] += way;
        box.upper[d] += way;
    }
}

}  // namespace lendulet::bench
