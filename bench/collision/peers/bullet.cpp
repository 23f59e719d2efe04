// Bullet's distance queries (https://github.com/bulletphysics/bullet3, 3.24 in Debian 12): its expanding polytope
// solver by itself, the detector that its dispatcher uses, and rays. All margins are 0.
#include <btBulletCollisionCommon.h>

#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>

#include <limits>

#include "bench/collision/pairs.h"

namespace lendulet::bench {
namespace {

btVector3 vector_of(Vec3 v) { return {v.x, v.y, v.z}; }
btTransform transform_of(const Transform& t) {
    const Quat q = t.rotation;
    return btTransform(btQuaternion(q.x, q.y, q.z, q.w), vector_of(t.translation));
}
std::shared_ptr<btConvexShape> shape_of(const Shape& shape) {
    std::shared_ptr<btConvexShape> out;
    if (const auto* box = std::get_if<Box>(&shape)) {
        out = std::make_shared<btBoxShape>(vector_of(box->half_extents));
    } else {
        auto hull = std::make_shared<btConvexHullShape>();
        for (Vec3 v : std::get<ConvexHull>(shape).vertices()) hull->addPoint(vector_of(v), false);
        hull->recalcLocalAabb();
        out = std::move(hull);
    }
    out->setMargin(0.0f);
    return out;
}

class BulletSubject : public PairSubject {
public:
    bool takes(const PairSet&) const override { return true; }
    void load(const PairSet& set) override {
        a_.clear(), b_.clear(), pose_.clear(), shared_.clear();
        overlapping_ = set.overlapping;
        for (const ConvexCase& c : set.cases) {
            a_.push_back(shared_.of(c.a, shape_of));
            b_.push_back(shared_.of(c.b, shape_of));
            pose_.push_back(transform_of(c.b_in_a));
        }
    }

protected:
    bool overlapping_ = false;
    SharedShapes<btConvexShape> shared_;
    std::vector<std::shared_ptr<btConvexShape>> a_, b_;
    std::vector<btTransform> pose_;
};

class GjkEpa final : public BulletSubject {
public:
    std::string routine() const override { return "bullet btGjkEpaSolver2"; }
    void run(std::vector<double>& answers) override {
        const btTransform still = btTransform::getIdentity();
        for (size_t i = 0; i < a_.size(); ++i) {
            btGjkEpaSolver2::sResults r;
            const btVector3 guess = pose_[i].getOrigin();
            bool ok = overlapping_
                          ? btGjkEpaSolver2::Penetration(a_[i].get(), still, b_[i].get(), pose_[i], guess, r, false)
                          : btGjkEpaSolver2::Distance(a_[i].get(), still, b_[i].get(), pose_[i], guess, r);
            answers[i] = ok ? r.distance : failed;
        }
    }
};

class PairDetector final : public BulletSubject {
public:
    std::string routine() const override { return "bullet btGjkPairDetector"; }
    void run(std::vector<double>& answers) override {
        btVoronoiSimplexSolver simplex;
        btGjkEpaPenetrationDepthSolver depth;
        for (size_t i = 0; i < a_.size(); ++i) {
            btGjkPairDetector detector(a_[i].get(), b_[i].get(), &simplex, &depth);
            btGjkPairDetector::ClosestPointInput input;
            input.m_transformA.setIdentity();
            input.m_transformB = pose_[i];
            btPointCollector result;
            detector.getClosestPoints(input, result, nullptr);
            answers[i] = result.m_hasResult ? result.m_distance : failed;
        }
    }
};

}  // namespace

void add_bullet_subjects(PairSubjects& subjects) {
    subjects.push_back(std::make_unique<GjkEpa>());
    subjects.push_back(std::make_unique<PairDetector>());
}

std::vector<double> bullet_rays(const RayScene& scene, int repeats, std::vector<double>& fractions) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broad_phase;
    btCollisionWorld world(&dispatcher, &broad_phase, &configuration);
    std::vector<std::unique_ptr<btBoxShape>> shapes;
    std::vector<std::unique_ptr<btCollisionObject>> objects;
    for (const RayScene::Placed& box : scene.boxes) {
        shapes.push_back(std::make_unique<btBoxShape>(vector_of(box.half)));
        objects.push_back(std::make_unique<btCollisionObject>());
        objects.back()->setCollisionShape(shapes.back().get());
        objects.back()->setWorldTransform(transform_of({from_origin(box.pose.position), box.pose.orientation}));
        world.addCollisionObject(objects.back().get());
    }
    world.updateAabbs();
    broad_phase.optimize();
    fractions.assign(scene.from.size(), 2.0);
    std::vector<double> times;
    for (int round = 0; round < repeats; ++round) {
        const double start = computing_time();
        for (size_t i = 0; i < scene.from.size(); ++i) {
            const btVector3 from = vector_of(scene.from[i]), to = vector_of(scene.to[i]);
            btCollisionWorld::ClosestRayResultCallback hit(from, to);
            world.rayTest(from, to, hit);
            fractions[i] = hit.hasHit() ? hit.m_closestHitFraction : 2.0;
        }
        times.push_back((computing_time() - start) / static_cast<double>(scene.from.size()));
    }
    for (auto& object : objects) world.removeCollisionObject(object.get());
    return times;
}

}  // namespace lendulet::bench
