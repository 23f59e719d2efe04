#include "collision/mesh/candidates.h"

#include <cstring>

namespace lendulet {
namespace {

// What rounding errs is far below a step.
uint8_t step_below(float x) { return static_cast<uint8_t>(static_cast<int>(clamp(x - 1.0f, 0.0f, 255.0f))); }
uint8_t step_above(float x) { return static_cast<uint8_t>(static_cast<int>(clamp(x + 2.0f, 0.0f, 255.0f))); }

using Steps = Wide<uint8_t, 16>;

Steps load(const uint8_t* p) {
    Steps s;
    std::memcpy(&s, p, sizeof s);
    return s;
}

}  // namespace

Vec3 MeshCandidates::steps_per_metre() const {
    Vec3 d = upper - lower;
    return {255.0f / d.x, 255.0f / d.y, 255.0f / d.z};
}

void MeshCandidates::find(const TriangleSurface& surface, Vec3 box_lower, Vec3 box_upper, float leeway) {
    const Vec3 wider{leeway, leeway, leeway};
    lower = box_lower - wider, upper = box_upper + wider;
    count = 0;
    const Vec3 scale = steps_per_metre();
    for_each_triangle(surface, lower, upper, [&](uint32_t triangle) {
        if (count >= capacity) {
            count = capacity + 1;
            return;
        }
        Vec3 p[3];
        surface.corners(triangle, p);
        const Vec3 least = multiply(minimum(minimum(p[0], p[1]), p[2]) - lower, scale);
        const Vec3 most = multiply(maximum(maximum(p[0], p[1]), p[2]) - lower, scale);
        for (int k = 0; k < 3; ++k) {
            low[k][count] = step_below(component(least, k));
            high[k][count] = step_above(component(most, k));
        }
        index[count++] = triangle;
    });
}

int MeshCandidates::near(Vec3 box_lower, Vec3 box_upper, uint32_t (&out)[capacity]) const {
    const Vec3 scale = steps_per_metre();
    const Vec3 least = multiply(box_lower - lower, scale), most = multiply(box_upper - lower, scale);
    int found = 0;
    for (int first = 0; first < count; first += 16) {
        Steps meet = Steps{} + uint8_t{1};
        for (int k = 0; k < 3; ++k) {
            const Steps from = Steps{} + step_below(component(least, k)), to = Steps{} + step_above(component(most, k));
            meet &= static_cast<Steps>(load(low[k] + first) <= to) & static_cast<Steps>(load(high[k] + first) >= from);
        }
        const int left = count - first < 16 ? count - first : 16;
        for (int i = 0; i < left; ++i) {
            out[found] = index[first + i];
            found += meet[i];
        }
    }
    return found;
}

}  // namespace lendulet
