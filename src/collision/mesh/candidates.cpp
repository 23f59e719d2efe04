#include "collision/mesh/candidates.h"

namespace lendulet {
namespace {

// What is spent in a step at least, of the slack: rounding.
constexpr float least_spent = 0.01f;

float gap_between(Vec3 lower, Vec3 upper, Vec3 other_lower, Vec3 other_upper) {
    return max_component(maximum(other_lower - upper, lower - other_upper));
}

// The list before, by the last digits of triangles' numbers: of two that share them one is forgotten.
class Before {
public:
    explicit Before(const MeshCandidates& c) {
        for (int i = 0; c.are_listed() && i < c.count; ++i) {
            index_[i] = c.index[i], away_[i] = c.apart[i] - c.spent;
            place_[c.index[i] % places] = static_cast<uint8_t>(i + 1);
        }
    }
    // What is left of what the triangle was away; null where it is not known.
    const float* away(uint32_t triangle) const {
        const int i = place_[triangle % places] - 1;
        return i >= 0 && index_[i] == triangle ? &away_[i] : nullptr;
    }

private:
    static constexpr uint32_t places = 256;
    uint8_t place_[places] = {};
    uint32_t index_[MeshCandidates::capacity];
    float away_[MeshCandidates::capacity];
};

}  // namespace

void MeshCandidates::find(const TriangleSurface& surface, Vec3 box_lower, Vec3 box_upper, float leeway, float slack) {
    const Before before(*this);
    const Vec3 wider{leeway, leeway, leeway};
    lower = box_lower - wider, upper = box_upper + wider;
    count = 0;
    spent = 0.0f;
    for_each_triangle(surface, lower, upper, [&](uint32_t triangle) {
        if (count >= capacity) {
            count = capacity + 1;
            return;
        }
        index[count] = triangle;
        float& away = apart[count++];
        if (const float* known = before.away(triangle)) {
            away = *known;
            return;
        }
        Vec3 p[3];
        surface.corners(triangle, p);
        const Vec3 least = minimum(minimum(p[0], p[1]), p[2]), most = maximum(maximum(p[0], p[1]), p[2]);
        away = gap_between(least, most, box_lower, box_upper) - slack;
    });
}

void MeshCandidates::move(const Placing& now, float slack) {
    // A point at r from the position moves by 2 |vec dq| |r| about that at most.
    const Quat dq = now.turn * conjugate(turn);
    const float turned = 2.0f * length(Vec3{dq.x, dq.y, dq.z}) * now.reach;
    spent += length(now.position - position) + turned + maximum(0.0f, now.margin - margin) + least_spent * slack;
    stand(now);
}

}  // namespace lendulet
