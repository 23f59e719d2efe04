// The choice of four points of many.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "collision/clip.h"

namespace lendulet::test {
namespace {

// Corners of a regular polygon of radius 1, named by their numbers.
std::vector<FacePoint> polygon(int corners) {
    std::vector<FacePoint> points;
    for (int k = 0; k < corners; ++k) {
        const float angle = 2.0f * pi * static_cast<float>(k) / static_cast<float>(corners);
        points.push_back({std::cos(angle), std::sin(angle), 0.0f, static_cast<uint32_t>(k)});
    }
    return points;
}
std::set<uint32_t> chosen(std::vector<FacePoint> points, const CarriedPoints& carried) {
    const int count = thin_points(points.data(), static_cast<int>(points.size()), carried);
    std::set<uint32_t> names;
    for (int i = 0; i < count; ++i) names.insert(points[static_cast<size_t>(i)].id);
    return names;
}

// A disc that trembles is a little deeper here, then there; what carries it stays, though others would span more.
TEST(ThinPoints, ThoseThatCarriedAreChosenAgain) {
    const CarriedPoints carried{{2, 6, 9, 13}, 4};
    const std::set<uint32_t> names(carried.ids, carried.ids + 4);
    for (uint32_t deepest : names) {
        std::vector<FacePoint> points = polygon(16);
        points[deepest].separation = -0.01f;
        EXPECT_EQ(chosen(points, carried), names) << deepest;
        EXPECT_NE(chosen(points, {}), names) << deepest;
    }
}

// The deepest is always among them.
TEST(ThinPoints, TheDeepestIsNeverLeftOut) {
    const CarriedPoints carried{{2, 6, 9, 13}, 4};
    for (uint32_t deepest = 0; deepest < 16; ++deepest) {
        std::vector<FacePoint> points = polygon(16);
        points[deepest].separation = -0.01f;
        const std::set<uint32_t> names = chosen(points, carried);
        EXPECT_TRUE(names.contains(deepest));
        EXPECT_EQ(names.size(), 4u);
        const auto again = std::count_if(carried.ids, carried.ids + 4, [&](uint32_t id) { return names.contains(id); });
        EXPECT_GE(again, 2) << deepest;
    }
}

}  // namespace
}  // namespace lendulet::test
