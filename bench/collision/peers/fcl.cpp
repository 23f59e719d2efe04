// FCL (https://github.com/flexible-collision-library/fcl, 0.7 in Debian 12, double precision): distance, and depth as
// its collision routines give it.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <limits>

#include "bench/collision/pairs.h"

namespace lendulet::bench {
namespace {

fcl::Transform3d transform_of(const Transform& t) {
    fcl::Transform3d out = fcl::Transform3d::Identity();
    const Quat q = t.rotation;
    out.linear() = fcl::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
    out.translation() = fcl::Vector3d(t.translation.x, t.translation.y, t.translation.z);
    return out;
}

std::shared_ptr<fcl::CollisionGeometryd> shape_of(const Shape& shape) {
    if (const auto* box = std::get_if<Box>(&shape)) {
        const Vec3 h = box->half_extents;
        return std::make_shared<fcl::Boxd>(2.0 * h.x, 2.0 * h.y, 2.0 * h.z);
    }
    const auto& hull = std::get<ConvexHull>(shape);
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (Vec3 v : hull.vertices()) vertices->push_back({v.x, v.y, v.z});
    auto faces = std::make_shared<std::vector<int>>();
    const std::vector<uint32_t> triangles = hull.triangles();
    for (size_t i = 0; i < triangles.size(); i += 3) {
        faces->push_back(3);
        for (size_t k = 0; k < 3; ++k) faces->push_back(static_cast<int>(triangles[i + k]));
    }
    return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(triangles.size() / 3), faces);
}

class Fcl final : public PairSubject {
public:
    std::string routine() const override { return "fcl distance, collide"; }
    bool takes(const PairSet&) const override { return true; }
    void load(const PairSet& set) override {
        overlapping_ = set.overlapping;
        apart_ = set.is_pile() ? contact_margin : failed;
        a_.clear(), b_.clear(), pose_.clear(), shared_.clear();
        for (const ConvexCase& c : set.cases) {
            a_.push_back(shared_.of(c.a, shape_of));
            b_.push_back(shared_.of(c.b, shape_of));
            pose_.push_back(transform_of(c.b_in_a));
        }
    }
    void run(std::vector<double>& answers) override {
        const fcl::Transform3d still = fcl::Transform3d::Identity();
        for (size_t i = 0; i < a_.size(); ++i) {
            if (overlapping_) {
                fcl::CollisionRequestd request(1, true);
                fcl::CollisionResultd result;
                fcl::collide(a_[i].get(), still, b_[i].get(), pose_[i], request, result);
                answers[i] = result.isCollision() ? -std::abs(result.getContact(0).penetration_depth) : apart_;
            } else {
                fcl::DistanceRequestd request(true);
                request.distance_tolerance = 1e-9;
                fcl::DistanceResultd result;
                answers[i] = fcl::distance(a_[i].get(), still, b_[i].get(), pose_[i], request, result);
            }
        }
    }

private:
    bool overlapping_ = false;
    double apart_ = failed;
    SharedShapes<fcl::CollisionGeometryd> shared_;
    std::vector<std::shared_ptr<fcl::CollisionGeometryd>> a_, b_;
    std::vector<fcl::Transform3d> pose_;
};

}  // namespace

void add_fcl_subjects(PairSubjects& subjects) { subjects.push_back(std::make_unique<Fcl>()); }

}  // namespace lendulet::bench
