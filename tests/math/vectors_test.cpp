// What programs write with vectors and positions, also at compile time.
#include <gtest/gtest.h>

#include "lendulet/math.h"

namespace lendulet {
namespace {

constexpr Vec3 changed(Vec3 v) {
    v *= 6.0f;
    v /= 4.0f;
    return v / 3.0f;
}
static_assert(changed({2.0f, -4.0f, 8.0f}) == Vec3{1.0f, -2.0f, 4.0f});

constexpr Position moved(Position p, Vec3 there, Vec3 back) {
    p += there;
    p -= back;
    return p;
}
static_assert(moved({1.0f, 2.0f, 3.0f}, {4.0f, 4.0f, 4.0f}, {3.0f, 2.0f, 1.0f}) == Position{2.0f, 4.0f, 6.0f});

static_assert(Vec3{1.0f, 2.0f, 3.0f} != Vec3{1.0f, 2.0f, 4.0f});
static_assert(!(Position{1.0f, 2.0f, 3.0f} != Position{1.0f, 2.0f, 3.0f}));
static_assert(Quat{} != Quat{1.0f, 0.0f, 0.0f, 0.0f});

// Each component is divided, and not multiplied with a rounded inverse.
TEST(VectorTest, QuotientsAreThoseOfTheComponents) {
    const Vec3 v{1.0f, 7.0f, 1e-38f};
    for (float s : {3.0f, 49.0f, 0.1f, 1e-30f}) {
        const Vec3 q = v / s;
        EXPECT_EQ(q, (Vec3{v.x / s, v.y / s, v.z / s}));
    }
}

}  // namespace
}  // namespace lendulet
