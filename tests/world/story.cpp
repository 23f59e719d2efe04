#include "world/story.h"

#include <cmath>

namespace lendulet::test {
namespace {

TriangleMesh rough_mesh(RandomNumbers& numbers) {
    constexpr uint32_t n = 12;
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i <= n; ++i)
        for (uint32_t k = 0; k <= n; ++k)
            vertices.push_back(
                {0.8f * static_cast<float>(i) - 5.0f, numbers.in(-0.3f, 0.3f), 0.8f * static_cast<float>(k) - 5.0f});
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t k = 0; k < n; ++k) {
            const uint32_t p = i * (n + 1) + k;
            for (uint32_t v : {p, p + 1, p + n + 2, p, p + n + 2, p + n + 1}) indices.push_back(v);
            if ((i + k) % 5 == 0)
                for (uint32_t v : {p, p, p + 1}) indices.push_back(v);
        }
    const auto first = static_cast<uint32_t>(vertices.size());
    for (Vec3 v : {Vec3{0.0f, 1.0f, 0.0f}, Vec3{1e-5f, 1.0f, 0.0f}, Vec3{3.0f, 1.2f, 0.1f}}) vertices.push_back(v);
    for (uint32_t v : {first, first + 1, first + 2}) indices.push_back(v);
    return TriangleMesh::from_triangles(vertices, indices).value();
}

HeightField rough_field(RandomNumbers& numbers) {
    std::vector<float> heights(20 * 20);
    for (float& h : heights) h = numbers.in(-0.5f, 0.5f);
    HeightFieldDef def;
    def.columns = def.rows = 20;
    def.heights = heights;
    def.cell_x = def.cell_z = 0.7f;
    return HeightField::from_heights(def).value();
}

// Points in a box, which is flat for some.
ConvexHull random_hull(RandomNumbers& numbers, int kind) {
    const Vec3 size{0.5f, kind == 1 ? 0.02f : 0.4f, kind == 2 ? 0.02f : 0.4f};
    std::vector<Vec3> points;
    for (int i = 0; i < 8 + 6 * kind; ++i) points.push_back(multiply(size, numbers.vector(1.0f)));
    return ConvexHull::from_points(points, kind == 3 ? 0.05f : 0.0f).value();
}

}  // namespace

Story::Story(uint32_t seed, StoryCast cast) : numbers_{seed * 7919u + 1u}, cast_(cast) {
    for (int kind = 0; kind < 4; ++kind) hulls_.push_back(random_hull(numbers_, kind));
}

void Story::begin(World& world) {
    world.add_static_body({.shape = Plane{}, .restitution = 0.2f}).value();
    world.add_static_body({.shape = rough_mesh(numbers_), .position = {8.0f, 0.5f, 0.0f}}).value();
    world.add_static_body({.shape = rough_field(numbers_), .position = {-16.0f, 0.5f, -7.0f}}).value();
}

Shape Story::shape() {
    const float a = numbers_.in(0.1f, 0.5f), b = numbers_.in(0.1f, 0.4f), c = numbers_.in(0.1f, 0.4f);
    switch (one_of(9)) {
        case 0:
            return Sphere{a};
        case 1:
            return Box{{a, b, c}, once_in(3) ? 0.03f : 0.0f};
        case 2:
            return Capsule{a, 0.2f};
        case 3:
            return Cylinder{b, a};
        case 4:
            return Cone{b, a};
        case 5:
            return TaperedCapsule{a, 0.2f, 0.1f};
        case 6:
            return TaperedCylinder{0.2f, a, 0.1f, 0.02f};
        default:
            return hulls_[static_cast<size_t>(one_of(4))];
    }
}

void Story::add_body(World& world) {
    const float x = numbers_.in(-12.0f, 12.0f), y = numbers_.in(1.5f, 4.0f), z = numbers_.in(-5.0f, 5.0f);
    RigidBodyDef def{.position = {x, y, z},
                     .orientation = numbers_.turn(),
                     .velocity = numbers_.vector(3.0f),
                     .angular_velocity = numbers_.vector(5.0f)};
    std::vector<ColliderDef> colliders;
    if (once_in(4)) {
        const int count = 2 + one_of(3);
        for (int i = 0; i < count; ++i) {
            ColliderDef part{.shape = shape()};
            part.local.translation = numbers_.vector(0.4f);
            part.is_trigger = i > 0 && once_in(5);
            colliders.push_back(part);
        }
        def.colliders = colliders;
    } else {
        def.shape = shape();
    }
    if (once_in(4)) def.restitution = 0.7f;
    if (once_in(6)) def.rolling_friction = 0.02f;
    if (cast_.kinematic && once_in(12)) {
        def.kinematic = true;
        def.velocity = multiply(Vec3{1.0f, 0.0f, 1.0f}, numbers_.vector(1.0f));
    } else if (cast_.extremes && once_in(8)) {
        def.mass = std::exp2(numbers_.in(-12.0f, 14.0f));
    } else if (cast_.extremes && once_in(12)) {
        def.bullet = true;
        def.velocity = numbers_.vector(150.0f);
    }
    bodies_.push_back(world.add_rigid_body(def).value());
}

// Between bodies that are near each other, with the frames as they lie.
void Story::add_joint(World& world) {
    constexpr JointType types[] = {JointType::fixed,  JointType::ball,     JointType::hinge,
                                   JointType::slider, JointType::distance, JointType::six_degrees};
    const JointType type = types[one_of(cast_.six_degrees ? 6 : 5)];
    const BodyId a = bodies_[static_cast<size_t>(one_of(static_cast<int>(bodies_.size())))];
    const Vec3 aside = numbers_.vector(0.3f), axis = numbers_.vector(1.0f);
    const float stiffness = numbers_.in(10.0f, 500.0f), speed = numbers_.in(-2.0f, 2.0f);
    const bool limited = once_in(2), driven = cast_.driven && once_in(3), sprung = cast_.driven && once_in(3);
    const bool collide = once_in(2);
    BodyId b{};
    float nearest = 3.0f;
    for (BodyId other : bodies_) {
        const float distance = length(world.get(other).position() - world.get(a).position());
        if (other != a && distance < nearest) nearest = distance, b = other;
    }
    if (b == BodyId{}) return;
    Result<JointDef> made = world.joint_at(type, a, b, world.get(a).position() + aside, {axis.x, axis.y, 1.5f});
    if (!made) return;
    JointDef def = made.value();
    def.collide_connected = collide;
    if (type == JointType::distance) def.frame_a = def.frame_b = {}, def.limit = {0.0f, nearest + 0.1f};
    else if (type == JointType::hinge || type == JointType::slider)
        def.limit = limited ? Limit{-0.5f, 0.5f} : Limit{-2, 2};
    if (type == JointType::ball && limited) def.swing_limit = 0.6f, def.twist_limit = {-0.4f, 0.4f};
    if (driven) def.motor = {speed, 50.0f};
    if (driven && type == JointType::ball) def.friction = 0.1f * stiffness;
    if (sprung)
        def.spring = {.stiffness = stiffness, .damping = 5.0f, .target = type == JointType::distance ? 1.0f : 0};
    if (type == JointType::six_degrees) {
        def.motor = {}, def.spring = {}, def.limit = {};
        for (int k = 0; k < 3; ++k) def.axes.linear[k].limit = k == 0 ? Limit{-0.3f, 0.3f} : Limit{0.0f, 0.0f};
        def.axes.angular[0].limit = limited ? Limit{-0.2f, 0.4f} : Limit{0.0f, 0.0f};
        if (driven) def.axes.angular[1].motor = {speed, 20.0f};
        if (sprung) def.axes.angular[2].spring = {.stiffness = stiffness, .damping = 2.0f};
    }
    if (Result<JointId> joint = world.add_joint(def)) joints_.push_back(joint.value());
}

// Another motor or spring for a joint that takes it.
void Story::drive(World& world) {
    const JointId id = joints_[static_cast<size_t>(one_of(static_cast<int>(joints_.size())))];
    const float speed = numbers_.in(-3.0f, 3.0f), stiffness = numbers_.in(10.0f, 1000.0f);
    if (world.joint(id).type == JointType::six_degrees) {
        world.set_motor(id, Coordinate::about_y, {speed, 30.0f}).value();
        return;
    }
    if (world.joint(id).type == JointType::ball)
        world.set_friction(id, speed > 0.0f ? 0.01f * stiffness : 0.0f).value();
    if (once_in(2)) (void)world.set_motor(id, {speed, 100.0f});
    else (void)world.set_spring(id, {.stiffness = stiffness, .damping = 3.0f, .target = 0.5f});
}

void Story::disturb(World& world) {
    const auto i = static_cast<size_t>(one_of(static_cast<int>(bodies_.size())));
    RigidBodyRef body = world.get(bodies_[i]);
    const Vec3 push = numbers_.vector(2.0f);
    const float x = numbers_.in(-12.0f, 12.0f), z = numbers_.in(-5.0f, 5.0f);
    switch (one_of(6)) {
        case 0:
            world.remove_body(bodies_[i]).value();
            bodies_.erase(bodies_.begin() + static_cast<ptrdiff_t>(i));
            std::erase_if(joints_, [&](JointId j) { return !world.alive(j); });
            break;
        case 1:
            if (joints_.empty()) break;
            world.remove_joint(joints_.back()).value();
            joints_.pop_back();
            break;
        case 2:
            body.set_pose({x, 2.0f, z}, {}).value();
            break;
        case 3:
            if (body.type() == BodyType::kinematic) body.move_to({x, 1.0f, z}, {}, 1.0f).value();
            break;
        case 4:
            if (once_in(4)) world.set_gravity({push.x, -9.81f, push.z}).value();
            break;
        default:
            if (body.type() == BodyType::dynamic) body.apply_impulse(body.mass() * push).value();
    }
}

void Story::go_on(World& world) {
    const int what = one_of(6);
    if (what < 3 || bodies_.size() < 10) add_body(world);
    else if (what == 3) add_joint(world);
    else if (what == 4 && cast_.driven && !joints_.empty()) drive(world);
    else if (what == 5 && cast_.driven) disturb(world);
}

void Story::go_on(World& world, float dt) {
    go_on(world);
    world.update(dt).value();
}

}  // namespace lendulet::test
