#include "collision/mesh/candidates.h"

namespace lendulet {
namespace {

// What is spent in a step at least, of the slack: rounding.
constexpr float least_spent = 0.01f;
// Of the leeway, where there are more triangles than can be listed: over fine meshes that is what still pays.
constexpr float less_leeway = 0.5f;

// The list before, by the last digits of triangles' numbers: of two that share them one is forgotten.
class Before {
public:
    explicit Before(const MeshCandidates& c) {
        for (int i = 0; c.are_listed() && i < c.count; ++i) {
            index_[i] = c.listed[i].index, away_[i] = c.listed[i].apart - c.spent;
            place_[index_[i] % places] = static_cast<uint8_t>(i + 1);
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

void MeshCandidates::find(const TriangleSurface& surface, Vec3 box_lower, Vec3 box_upper, float leeway) {
    const Before before(*this);
    spent = 0.0f;
    for (const float some : {leeway, less_leeway * leeway}) {
        const Vec3 wider{some, some, some};
        lower = box_lower - wider, upper = box_upper + wider;
        count = 0;
        for_each_triangle(surface, lower, upper, [&](uint32_t triangle) {
            if (count < capacity) listed[count++] = {triangle, 0.0f};
            else count = capacity + 1;
        });
        if (are_listed()) break;
    }
    for (int i = 0; are_listed() && i < count; ++i)
        if (const float* known = before.away(listed[i].index)) listed[i].apart = *known;
}

void MeshCandidates::move(const Placing& now, float slack) {
    // A point at r from the position moves by 2 |vec dq| |r| about that at most.
    const Quat dq = now.turn * conjugate(turn);
    const float turned = 2.0f * length(Vec3{dq.x, dq.y, dq.z}) * now.reach;
    spent += length(now.position - position) + turned + maximum(0.0f, now.margin - margin) + least_spent * slack;
    stand(now);
}

}  // namespace lendulet
