// Bullet's distance queries and manifolds of boxes (https://github.com/bulletphysics/bullet3, 3.24 in Debian 12): its
// expanding polytope solver by itself, the detectors that its dispatcher uses, the whole of what that does for two
// boxes, and rays. All margins are 0.
#include <btBulletCollisionCommon.h>

#include <BulletCollision/CollisionDispatch/btBoxBoxDetector.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
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
    bool takes(const PairSet& set) const override { return !set.is_pile(); }
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

// Manifolds of boxes. They have points where the boxes overlap, not within a margin.
class Boxes : public BulletSubject {
public:
    bool takes(const PairSet& set) const override {
        return set.overlapping && std::holds_alternative<Box>(set.cases[0].a);
    }
    double allowed() const override { return is_pile_ ? contact_margin : 1e-2; }
    void load(const PairSet& set) override {
        BulletSubject::load(set);
        is_pile_ = set.is_pile();
    }

protected:
    double none() const { return is_pile_ ? contact_margin : failed; }
    const btBoxShape& box(const std::shared_ptr<btConvexShape>& shape) const {
        return static_cast<const btBoxShape&>(*shape);
    }
    bool is_pile_ = false;
};

struct DeepestPoint final : btDiscreteCollisionDetectorInterface::Result {
    btScalar depth = 1e30f;
    int count = 0;
    void setShapeIdentifiersA(int, int) override {}
    void setShapeIdentifiersB(int, int) override {}
    void addContactPoint(const btVector3&, const btVector3&, btScalar d) override {
        depth = d < depth ? d : depth;
        ++count;
    }
};

class BoxDetector final : public Boxes {
public:
    std::string routine() const override { return "bullet btBoxBoxDetector"; }
    void run(std::vector<double>& answers) override {
        for (size_t i = 0; i < a_.size(); ++i) {
            btBoxBoxDetector detector(&box(a_[i]), &box(b_[i]));
            btDiscreteCollisionDetectorInterface::ClosestPointInput input;
            input.m_transformA.setIdentity();
            input.m_transformB = pose_[i];
            DeepestPoint result;
            detector.getClosestPoints(input, result, nullptr);
            answers[i] = result.count > 0 ? result.depth : none();
        }
    }
};

// The detector with the manifold that the pair keeps from one step to the next.
class BoxAlgorithm final : public Boxes {
public:
    ~BoxAlgorithm() override { release(); }
    std::string routine() const override { return "bullet btBoxBoxCollisionAlgorithm, warm"; }
    void load(const PairSet& set) override {
        release();
        Boxes::load(set);
        objects_.assign(2 * a_.size(), btCollisionObject());
        for (size_t i = 0; i < a_.size(); ++i) {
            objects_[2 * i].setCollisionShape(a_[i].get());
            objects_[2 * i + 1].setCollisionShape(b_[i].get());
            objects_[2 * i + 1].setWorldTransform(pose_[i]);
            const btCollisionObjectWrapper a = wrapped(2 * i), b = wrapped(2 * i + 1);
            algorithms_.push_back(dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS));
        }
    }
    void rewind() override {
        std::vector<double> first(a_.size());
        run(first);
    }
    void run(std::vector<double>& answers) override {
        for (size_t i = 0; i < a_.size(); ++i) {
            const btCollisionObjectWrapper a = wrapped(2 * i), b = wrapped(2 * i + 1);
            btManifoldResult result(&a, &b);
            algorithms_[i]->processCollision(&a, &b, dispatch_, &result);
            const btPersistentManifold* m = result.getPersistentManifold();
            btScalar depth = 1e30f;
            for (int k = 0; k < m->getNumContacts(); ++k) depth = btMin(depth, m->getContactPoint(k).getDistance());
            answers[i] = m->getNumContacts() > 0 ? depth : none();
        }
    }

private:
    btCollisionObjectWrapper wrapped(size_t i) const {
        const btCollisionObject& o = objects_[i];
        return {nullptr, o.getCollisionShape(), &o, o.getWorldTransform(), -1, -1};
    }
    void release() {
        for (btCollisionAlgorithm* algorithm : algorithms_) {
            algorithm->~btCollisionAlgorithm();
            dispatcher_.freeCollisionAlgorithm(algorithm);
        }
        algorithms_.clear();
    }
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDispatcherInfo dispatch_;
    std::vector<btCollisionObject> objects_;
    std::vector<btCollisionAlgorithm*> algorithms_;
};

}  // namespace

void add_bullet_subjects(PairSubjects& subjects) {
    subjects.push_back(std::make_unique<GjkEpa>());
    subjects.push_back(std::make_unique<PairDetector>());
    subjects.push_back(std::make_unique<BoxDetector>());
    subjects.push_back(std::make_unique<BoxAlgorithm>());
}

std::vector<double> bullet_rays(const RayScene& scene, int repeats, std::vector<double>& fractions) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broad_phase;
    btCollisionWorld world(&dispatcher, &broad_phase, &configuration);
    std::vector<std::unique_ptr<btBoxShape>> shapes;
    std::vector<std::unique_ptr<btCollisionObject>> objects;
    for (const PlacedBox& box : scene.boxes) {
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
