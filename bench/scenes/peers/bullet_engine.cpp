// Bullet, as the benchmark sees it: its default solver (sequential impulses, 10 iterations, split impulse), its default
// tree broad phase, its default margins. Debian builds it without its own threads, so it runs on one.
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <variant>

#include "bench/scenes/engine.h"

namespace lendulet::bench {
namespace {

using scenes::SceneBody;
using scenes::SceneDescription;
using scenes::SceneJoint;

btVector3 vector_of(Vec3 v) { return {v.x, v.y, v.z}; }
btQuaternion quaternion_of(Quat q) { return {q.x, q.y, q.z, q.w}; }
btTransform transform_of(const Transform& t) {
    return btTransform(quaternion_of(t.rotation), vector_of(t.translation));
}
btTransform transform_of(const Pose& p) {
    return btTransform(quaternion_of(p.orientation), vector_of(from_origin(p.position)));
}

// A shape of Bullet's, about the centre of mass where that is not the shape's own origin.
struct BuiltShape {
    std::unique_ptr<btCollisionShape> shape;
    Vec3 centre;
};

// Bullet's shape for one of ours; null for those without a counterpart, which no built-in scene uses.
class ShapeBuilder {
public:
    explicit ShapeBuilder(const SceneDescription& scene) : scene_(scene) {}

    BuiltShape operator()(const Sphere& s) { return {std::make_unique<btSphereShape>(s.radius), {}}; }
    BuiltShape operator()(const Capsule& s) {
        return {std::make_unique<btCapsuleShape>(s.radius, 2.0f * s.half_height), {}};
    }
    BuiltShape operator()(const Box& s) { return {std::make_unique<btBoxShape>(vector_of(s.half_extents)), {}}; }
    BuiltShape operator()(const Cylinder& s) {
        return {std::make_unique<btCylinderShape>(btVector3(s.radius, s.half_height, s.radius)), {}};
    }
    BuiltShape operator()(const Plane& s) {
        return {std::make_unique<btStaticPlaneShape>(vector_of(s.normal), s.offset), {}};
    }
    BuiltShape operator()(const ConvexHull& s) {
        Vec3 centre = mass_properties(s, 1.0f).centre;
        auto hull = std::make_unique<btConvexHullShape>();
        for (Vec3 vertex : s.vertices()) hull->addPoint(vector_of(vertex - centre), false);
        hull->recalcLocalAabb();
        return {std::move(hull), centre};
    }
    BuiltShape operator()(const TriangleMesh& s) {
        for (const scenes::SceneMesh& mesh : scene_.meshes)
            if (&mesh.mesh.data() == &s.data()) return triangles(mesh.vertices, mesh.indices);
        return {};
    }
    // Its own height fields divide cells elsewhere: it gets the same triangles.
    BuiltShape operator()(const HeightField& s) { return triangles(s.vertices(), s.triangles()); }
    template <class Other>
    BuiltShape operator()(const Other&) {
        return {};
    }

private:
    BuiltShape triangles(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& indices) {
        Triangles& t = triangles_.emplace_back();
        t.indices.assign(indices.begin(), indices.end());
        t.vertices = vertices;
        t.array = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(t.indices.size() / 3), t.indices.data(), static_cast<int>(3 * sizeof(int)),
            static_cast<int>(t.vertices.size()), &t.vertices[0].x, static_cast<int>(sizeof(Vec3)));
        return {std::make_unique<btBvhTriangleMeshShape>(t.array.get(), true), {}};
    }

    struct Triangles {
        std::vector<Vec3> vertices;
        std::vector<int> indices;
        std::unique_ptr<btTriangleIndexVertexArray> array;
    };
    const SceneDescription& scene_;
    std::vector<Triangles> triangles_;
};

bool same(const Shape& a, const Shape& b) {
    if (a.index() != b.index()) return false;
    if (auto* box = std::get_if<Box>(&a)) return box->half_extents == std::get<Box>(b).half_extents;
    if (auto* ball = std::get_if<Sphere>(&a)) return ball->radius == std::get<Sphere>(b).radius;
    if (auto* hull = std::get_if<ConvexHull>(&a)) return &hull->data() == &std::get<ConvexHull>(b).data();
    if (auto* capsule = std::get_if<Capsule>(&a)) {
        const Capsule& other = std::get<Capsule>(b);
        return capsule->radius == other.radius && capsule->half_height == other.half_height;
    }
    return false;
}

// Bodies of one group do not meet; the group is kept in the user index.
struct GroupFilter final : btOverlapFilterCallback {
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
        if ((a->m_collisionFilterGroup & b->m_collisionFilterMask) == 0) return false;
        if ((b->m_collisionFilterGroup & a->m_collisionFilterMask) == 0) return false;
        int group = static_cast<btCollisionObject*>(a->m_clientObject)->getUserIndex2();
        return group == 0 || group != static_cast<btCollisionObject*>(b->m_clientObject)->getUserIndex2();
    }
};

class BulletEngine final : public Engine, private scenes::SceneDriver {
public:
    explicit BulletEngine(const SceneDescription& scene)
        : scene_(scene),
          hook_(scene.before_step),
          shape_builder_(scene_),
          dispatcher_(&configuration_),
          world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
        world_.setGravity(vector_of(scene_.gravity));
        world_.getPairCache()->setOverlapFilterCallback(&filter_);
    }
    ~BulletEngine() override {
        for (const auto& joint : joints_) world_.removeConstraint(joint.get());
        for (const Body& body : bodies_) world_.removeRigidBody(body.rigid.get());
    }

    // False where a shape is missing or a body has several colliders and moves freely.
    bool build() {
        for (const SceneBody& body : scene_.bodies)
            if (!add(body)) return false;
        for (const SceneJoint& joint : scene_.joints) add(joint);
        return true;
    }

    std::string_view name() const override { return "bullet"; }
    void step(int number) override {
        if (hook_) hook_(*this, number);
        world_.stepSimulation(scene_.dt, 0);
    }
    Pose pose(int body) const override {
        const Body& b = bodies_[static_cast<size_t>(body)];
        const btTransform& t = b.rigid->getWorldTransform();
        btQuaternion q = t.getRotation();
        Quat orientation{q.x(), q.y(), q.z(), q.w()};
        Position centre{t.getOrigin().x(), t.getOrigin().y(), t.getOrigin().z()};
        return {centre - rotate(orientation, b.centre), orientation};
    }
    int contact_points() const override {
        int count = 0;
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
            count += dispatcher_.getManifoldByIndexInternal(i)->getNumContacts();
        }
        return count;
    }

private:
    struct Body {
        std::unique_ptr<btDefaultMotionState> motion;
        std::unique_ptr<btRigidBody> rigid;
        Vec3 centre;  // of mass, in the body's frame of the description
    };
    struct CachedShape {
        Shape shape;
        BuiltShape built;
    };

    void move_to(int body, const Pose& pose) override {
        bodies_[static_cast<size_t>(body)].motion->setWorldTransform(transform_of(pose));
    }
    void set_velocity(int body, Vec3 velocity) override {
        bodies_[static_cast<size_t>(body)].rigid->setLinearVelocity(vector_of(velocity));
    }

    // Equal shapes are shared, as a user of Bullet would.
    const BuiltShape& shape_for(const Shape& shape) {
        for (const auto& cached : shapes_)
            if (same(cached->shape, shape)) return cached->built;
        shapes_.push_back(std::make_unique<CachedShape>(CachedShape{shape, std::visit(shape_builder_, shape)}));
        return shapes_.back()->built;
    }

    btCollisionShape* compound_of(const SceneBody& body) {
        auto compound = std::make_unique<btCompoundShape>();
        for (const ColliderDef& collider : body.colliders) {
            const BuiltShape& part = shape_for(collider.shape);
            if (!part.shape) return nullptr;
            compound->addChildShape(transform_of(collider.local), part.shape.get());
        }
        compounds_.push_back(std::move(compound));
        return compounds_.back().get();
    }

    bool add(const SceneBody& def) {
        bool dynamic = def.type == BodyType::dynamic, single = def.colliders.size() == 1;
        if (dynamic && !single) return false;
        Body& body = bodies_.emplace_back();
        btCollisionShape* shape = nullptr;
        if (single) {
            const BuiltShape& built = shape_for(def.colliders[0].shape);
            shape = built.shape.get();
            body.centre = built.centre;
        } else {
            shape = compound_of(def);
        }
        if (shape == nullptr) return false;
        const ColliderDef& surface = def.colliders[0];
        float mass = 0.0f;
        btVector3 inertia(0, 0, 0);
        if (dynamic) {
            mass = def.mass.value_or(mass_properties(surface.shape, surface.density).mass);
            shape->calculateLocalInertia(mass, inertia);
        }
        Pose pose{def.position + rotate(def.orientation, body.centre), def.orientation};
        body.motion = std::make_unique<btDefaultMotionState>(transform_of(pose));
        btRigidBody::btRigidBodyConstructionInfo info(mass, body.motion.get(), shape, inertia);
        // Bullet multiplies the coefficients of the two bodies.
        info.m_friction = std::sqrt(surface.material.static_friction.value_or(scene_.friction));
        info.m_restitution = std::sqrt(surface.material.restitution.value_or(scene_.restitution));
        body.rigid = std::make_unique<btRigidBody>(info);
        start(*body.rigid, def);
        world_.addRigidBody(body.rigid.get());
        return true;
    }

    void start(btRigidBody& rigid, const SceneBody& def) {
        rigid.setLinearVelocity(vector_of(def.velocity));
        rigid.setAngularVelocity(vector_of(def.angular_velocity));
        rigid.setUserIndex2(static_cast<int>(def.colliders[0].filter.group));
        if (def.type == BodyType::kinematic)
            rigid.setCollisionFlags(rigid.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        if (def.type != BodyType::fixed && !(scene_.about_sleep && def.allow_sleep))
            rigid.setActivationState(DISABLE_DEACTIVATION);
    }

    void add(const SceneJoint& def) {
        const SceneBody& a = scene_.bodies[static_cast<size_t>(def.body_a)];
        const SceneBody& b = scene_.bodies[static_cast<size_t>(def.body_b)];
        btRigidBody& rigid_a = *bodies_[static_cast<size_t>(def.body_a)].rigid;
        btRigidBody& rigid_b = *bodies_[static_cast<size_t>(def.body_b)].rigid;
        auto frame_in = [&](const SceneBody& body, Vec3 local_axis) {
            Quat world = rotation_between(local_axis, normalize(def.axis));
            Pose pose{body.position, body.orientation};
            return btTransform(quaternion_of(conjugate(body.orientation) * world),
                               vector_of(to_local(pose, def.anchor)));
        };
        std::unique_ptr<btTypedConstraint> joint;
        if (def.type == JointType::hinge) {
            Vec3 z{0.0f, 0.0f, 1.0f};
            auto hinge = std::make_unique<btHingeConstraint>(rigid_a, rigid_b, frame_in(a, z), frame_in(b, z));
            if (!def.limit.free()) hinge->setLimit(def.limit.lower, def.limit.upper);
            joint = std::move(hinge);
        } else if (def.swing_limit <= pi) {
            Vec3 x{1.0f, 0.0f, 0.0f};
            auto cone = std::make_unique<btConeTwistConstraint>(rigid_a, rigid_b, frame_in(a, x), frame_in(b, x));
            cone->setLimit(def.swing_limit, def.swing_limit, def.twist_limit.upper);
            joint = std::move(cone);
        } else {
            btVector3 in_a = vector_of(to_local({a.position, a.orientation}, def.anchor));
            btVector3 in_b = vector_of(to_local({b.position, b.orientation}, def.anchor));
            joint = std::make_unique<btPoint2PointConstraint>(rigid_a, rigid_b, in_a, in_b);
        }
        world_.addConstraint(joint.get(), true);
        joints_.push_back(std::move(joint));
    }

    const SceneDescription& scene_;
    std::function<void(scenes::SceneDriver&, int)> hook_;  // a copy: hooks keep their own random state
    ShapeBuilder shape_builder_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broad_phase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_;
    GroupFilter filter_;
    std::vector<std::unique_ptr<CachedShape>> shapes_;
    std::vector<std::unique_ptr<btCompoundShape>> compounds_;
    std::vector<Body> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

}  // namespace

std::unique_ptr<Engine> make_bullet(const SceneDescription& description, const EngineSettings& settings,
                                    std::string* why) {
    if (settings.threads > 1) {
        *why = "Bullet runs on one thread here.";
        return nullptr;
    }
    auto engine = std::make_unique<BulletEngine>(description);
    if (engine->build()) return engine;
    *why = "Bullet has no counterpart for a shape of this scene.";
    return nullptr;
}

}  // namespace lendulet::bench
