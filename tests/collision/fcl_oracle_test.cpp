// Distances and depths beside FCL (https://github.com/flexible-collision-library/fcl, in Debian libfcl-dev), in double.
// Apart the two agree. Overlapping, FCL prefers faces of boxes, and of hulls it finds the least depth in six cases of
// ten only: ours is certified in every case, and FCL must never find a shorter way out.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "gjk_fixture.h"

#ifdef LENDULET_TEST_FCL
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#endif

namespace lendulet::gjk_test {
namespace {

#ifdef LENDULET_TEST_FCL

std::shared_ptr<fcl::CollisionGeometryd> shape_of(const Core& core) {
    const Geometry& g = core.geometry;
    if (g.kind == GeometryKind::box) return std::make_shared<fcl::Boxd>(2.0 * g.size.x, 2.0 * g.size.y, 2.0 * g.size.z);
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (Vec3 v : g.hull->vertices) vertices->push_back({v.x, v.y, v.z});
    auto faces = std::make_shared<std::vector<int>>();
    for (const oracle::Body::Triangle& t : core.body.triangles) {
        faces->push_back(3);
        for (int k : t.corner) faces->push_back(k);
    }
    return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(core.body.triangles.size()), faces);
}

fcl::Transform3d transform_of(const Transform& t) {
    fcl::Transform3d out = fcl::Transform3d::Identity();
    const Quat q = t.rotation;
    out.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
    out.translation() = fcl::Vector3d(t.translation.x, t.translation.y, t.translation.z);
    return out;
}

// How often FCL agrees; ours is certified in every case.
struct Agreement {
    int same = 0, other = 0;
    void count(double ours, double theirs, double size) {
        (std::abs(ours - theirs) <= 2e-5 * size ? same : other) += 1;
    }
    double share() const { return static_cast<double>(same) / std::max(1, same + other); }
};

template <class MakeCore>
void compare(const char* name, int count, double least_apart, double least_overlapping, MakeCore make_core) {
    Random random(41);
    Tally tally(name);
    Agreement apart, overlapping;
    int shallower = 0;  // ways out that FCL finds and we do not
    const fcl::Transform3d still = fcl::Transform3d::Identity();
    for (int i = 0; i < count; ++i) {
        Core a = make_core(random), b = make_core(random);
        float wanted = i % 2 == 0 ? random.log_uniform(1e-3f, 2.0f) : -random.uniform(1e-3f, 0.3f);
        Transform t = place(random, a, b, wanted);
        ConvexDistance ours = query(a, b, t, SimplexSolver::half_space);
        tally.certify(a, b, t, ours);
        auto fa = shape_of(a), fb = shape_of(b);
        if (ours.distance > 0.0f) {
            fcl::DistanceRequestd request(true);
            request.distance_tolerance = 1e-9;
            fcl::DistanceResultd result;
            double theirs = fcl::distance(fa.get(), still, fb.get(), transform_of(t), request, result);
            apart.count(ours.distance, theirs, 2.0);
        } else {
            fcl::CollisionRequestd request(1, true);
            fcl::CollisionResultd result;
            fcl::collide(fa.get(), still, fb.get(), transform_of(t), request, result);
            double depth = result.isCollision() ? std::abs(result.getContact(0).penetration_depth) : 0.0;
            overlapping.count(ours.distance, -depth, 2.0);
            shallower += depth < -ours.distance - 2e-5 * 2.0;
        }
    }
    EXPECT_GE(apart.share(), least_apart) << name;
    EXPECT_GE(overlapping.share(), least_overlapping) << name;
    EXPECT_EQ(shallower, 0) << name;
    if (std::getenv("LENDULET_TEST_REPORT"))
        std::printf("%s: FCL agrees in %d of %d apart, %d of %d overlapping, %d shallower\n", name, apart.same,
                    apart.same + apart.other, overlapping.same, overlapping.same + overlapping.other, shallower);
}

TEST(FclOracle, BoxesAgree) {
    compare("boxes beside FCL", cases(10000), 0.999, 0.8, [](Random& random) { return random_box(random, 1.0f); });
}

TEST(FclOracle, HullsAgree) {
    compare("hulls beside FCL", cases(2000), 0.999, 0.4, [](Random& random) { return random_hull(random, 1.0f, 32); });
}

#else
TEST(FclOracle, BoxesAgree) { GTEST_SKIP() << "built without FCL (Debian: libfcl-dev)"; }
#endif

}  // namespace
}  // namespace lendulet::gjk_test
