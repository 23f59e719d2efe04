// Bad input is refused with the right kind of error and changes nothing; extreme input does no harm to others.
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <limits>
#include <string>

#include "world/support.h"

namespace lendulet::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const float nan = std::nanf("");

// A world with two cubes on a floor, one of them joined to it, and a kinematic body.
struct Refusing {
    World world = WorldBuilder{}.build().value();
    BodyId floor = add_floor(world);
    BodyId cube = add_cube(world, 0.0f, 0), gone = add_cube(world, 8.0f, 0), door = add_cube(world, 4.0f, 0);
    BodyId paddle = world.add_rigid_body({.position = {-9.0f, 1.0f, 0.0f}, .kinematic = true}).value();
    JointId joint = world.add_joint(world.joint_at(JointType::hinge, floor, door, {4.0f, 0.0f, 0.0f}).value()).value();

    Refusing() {
        world.remove_body(gone).value();
        run(world, 5);
    }
};

struct Refusal {
    const char* name;
    ErrorCode code;
    std::function<Status(Refusing&)> call;
};
void PrintTo(const Refusal& r, std::ostream* out) { *out << r.name; }

template <class T>
Status status(Result<T> result) {
    return result ? Status{} : Status(result.error());
}
std::function<Status(Refusing&)> adding(RigidBodyDef def) {
    return [def](Refusing& s) { return status(s.world.add_rigid_body(def)); };
}
std::function<Status(Refusing&)> adding(StaticBodyDef def) {
    return [def](Refusing& s) { return status(s.world.add_static_body(def)); };
}
RigidBodyDef with_mass(float mass) {
    RigidBodyDef def;
    def.mass = mass;
    return def;
}
RigidBodyDef with_inertia(SymMat3 inertia) {
    RigidBodyDef def;
    def.mass = 1.0f;
    def.inertia = inertia;
    return def;
}
RigidBodyDef damped(float linear, float angular) {
    RigidBodyDef def;
    def.linear_damping = linear;
    def.angular_damping = angular;
    return def;
}
std::function<Status(Refusing&)> on_cube(std::function<Status(RigidBodyRef)> call) {
    return [call](Refusing& s) { return call(s.world.get(s.cube)); };
}
std::function<Status(Refusing&)> joining(std::function<void(JointDef&)> spoil) {
    return [spoil](Refusing& s) {
        JointDef def = s.world.joint_at(JointType::hinge, s.floor, s.cube, {0.0f, 0.0f, 0.0f}).value();
        spoil(def);
        return status(s.world.add_joint(def));
    };
}

class Refusals : public ::testing::TestWithParam<Refusal> {};

TEST_P(Refusals, NameTheErrorAndChangeNothing) {
    Refusing s;
    uint64_t before = s.world.hash();
    int bodies = s.world.body_count(), joints = s.world.joint_count();
    size_t warnings = s.world.warnings().size();
    Status result = GetParam().call(s);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, GetParam().code) << result.error().message;
    EXPECT_GT(result.error().message.size(), 15u) << "a sentence with what and where";
    EXPECT_EQ(s.world.hash(), before);
    EXPECT_EQ(s.world.body_count(), bodies);
    EXPECT_EQ(s.world.joint_count(), joints);
    EXPECT_EQ(s.world.warnings().size(), warnings);
    run(s.world, 100);
    EXPECT_TRUE(all_finite(s.world));
    EXPECT_EQ(s.world.check(), "");
    EXPECT_EQ(s.world.statistics().contained_bodies, 0);
    // And nothing hidden has changed either.
    Refusing untouched;
    run(untouched.world, 100);
    EXPECT_EQ(s.world.hash(), untouched.world.hash());
}

using enum ErrorCode;
const Refusal motion_refusals[] = {
    {"position_nan", non_finite, adding(RigidBodyDef{.position = {nan, 0.0f, 0.0f}})},
    {"position_infinite", non_finite, adding(StaticBodyDef{.position = {0.0f, infinity, 0.0f}})},
    {"position_far", out_of_world, adding(RigidBodyDef{.position = {0.0f, 3e7f, 0.0f}})},
    {"rotation_nan", non_finite, adding(RigidBodyDef{.orientation = {nan, 0.0f, 0.0f, 1.0f}})},
    {"rotation_zero", bad_rotation, adding(RigidBodyDef{.orientation = {0.0f, 0.0f, 0.0f, 0.0f}})},
    {"rotation_long", bad_rotation, adding(StaticBodyDef{.orientation = {0.0f, 0.0f, 0.0f, 1.002f}})},
    {"velocity_nan", non_finite, adding(RigidBodyDef{.velocity = {nan, 0.0f, 0.0f}})},
    {"momentum_overflows", non_finite, adding(RigidBodyDef{.velocity = {3e38f, 0.0f, 0.0f}})},
    {"angular_velocity_infinite", non_finite, adding(RigidBodyDef{.angular_velocity = {0.0f, infinity, 0.0f}})},
    {"damping_negative", bad_material, adding(damped(-1.0f, 0.0f))},
    {"damping_nan", non_finite, adding(damped(0.0f, nan))},
    {"set_pose_nan", non_finite, on_cube([](RigidBodyRef b) {
         return b.set_pose({nan, 0.0f, 0.0f}, {});
     })},
    {"set_pose_far", out_of_world, on_cube([](RigidBodyRef b) {
         return b.set_pose({2e7f, 0.0f, 0.0f}, {});
     })},
    {"set_pose_zero", bad_rotation, on_cube([](RigidBodyRef b) {
         return b.set_pose({}, {0.0f, 0.0f, 0.0f, 0.0f});
     })},
    {"set_velocity_nan", non_finite, on_cube([](RigidBodyRef b) {
         return b.set_velocity({0.0f, nan, 0.0f});
     })},
    {"set_velocity_overflow", non_finite, on_cube([](RigidBodyRef b) {
         return b.set_velocity({0.0f, 1e37f, 0.0f});
     })},
    {"set_spin_infinite", non_finite, on_cube([](RigidBodyRef b) {
         return b.set_angular_velocity({infinity, 0.0f, 0.0f});
     })},
    {"set_momentum_nan", non_finite, on_cube([](RigidBodyRef b) {
         return b.set_momentum({0.0f, nan, 0.0f});
     })},
    {"set_angular_momentum_nan", non_finite, on_cube([](RigidBodyRef b) {
         return b.set_angular_momentum({0.0f, nan, 0.0f});
     })},
    {"impulse_nan", non_finite, on_cube([](RigidBodyRef b) {
         return b.apply_impulse({0.0f, nan, 0.0f});
     })},
    {"impulse_point_nan", non_finite, on_cube([](RigidBodyRef b) {
         return b.apply_impulse({}, {nan, 0.0f, 0.0f});
     })},
    {"impulse_lever_overflows", non_finite, on_cube([](RigidBodyRef b) {
         return b.apply_impulse({0.0f, 1e30f, 0.0f}, {1e30f, 0.0f, 0.0f});
     })},
    {"angular_impulse_infinite", non_finite, on_cube([](RigidBodyRef b) {
         return b.apply_angular_impulse({infinity, 0.0f, 0.0f});
     })},
    {"force_infinite", non_finite, on_cube([](RigidBodyRef b) {
         return b.apply_force({0.0f, infinity, 0.0f});
     })},
    {"torque_nan", non_finite, on_cube([](RigidBodyRef b) {
         return b.apply_torque({0.0f, 0.0f, nan});
     })},
    {"move_to_no_time", bad_time_step, on_cube([](RigidBodyRef b) { return b.move_to({}, {}, 0.0f); })},
    {"move_to_too_fast", non_finite, on_cube([](RigidBodyRef b) {
         return b.move_to({1e6f, 0.0f, 0.0f}, {}, 1e-38f);
     })},
    {"gravity_nan", non_finite,
     [](Refusing& s) {
         return s.world.set_gravity({nan, 0.0f, 0.0f});
     }},
    {"gravity_beyond_all", bad_config,
     [](Refusing& s) {
         return s.world.set_gravity({0.0f, -1e20f, 0.0f});
     }},
    {"step_negative", bad_time_step, [](Refusing& s) { return s.world.update(-0.01f); }},
    {"step_nan", bad_time_step, [](Refusing& s) { return s.world.update(nan); }},
    {"step_infinite", bad_time_step, [](Refusing& s) { return s.world.update(infinity); }},
};

RigidBodyDef sized(Shape shape) { return {.shape = std::move(shape), .position = {0.0f, 5.0f, 0.0f}}; }

RigidBodyDef with_collider(const ColliderDef& collider) {
    static std::deque<ColliderDef> kept;  // definitions hold spans
    kept.push_back(collider);
    return {.position = {0.0f, 5.0f, 0.0f}, .colliders = {&kept.back(), 1}};
}

const Refusal body_refusals[] = {
    {"mass_zero", bad_mass, adding(with_mass(0.0f))},
    {"mass_negative", bad_mass, adding(with_mass(-1.0f))},
    {"mass_nan", bad_mass, adding(with_mass(nan))},
    {"mass_tiny", bad_mass, adding(with_mass(1e-30f))},
    {"mass_huge", bad_mass, adding(with_mass(1e30f))},
    {"density_zero", bad_mass, adding(RigidBodyDef{.density = 0.0f})},
    {"density_nan", bad_mass, adding(RigidBodyDef{.density = nan})},
    {"inertia_zero", bad_inertia, adding(with_inertia({1.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f}))},
    {"inertia_negative", bad_inertia, adding(with_inertia({1.0f, -1.0f, 1.0f, 0.0f, 0.0f, 0.0f}))},
    {"inertia_no_solid", bad_inertia, adding(with_inertia({1.0f, 1.0f, 2.1f, 0.0f, 0.0f, 0.0f}))},
    {"inertia_not_definite", bad_inertia, adding(with_inertia({1.0f, 1.0f, 1.0f, 2.0f, 0.0f, 0.0f}))},
    {"inertia_nan", bad_inertia, adding(with_inertia({1.0f, nan, 1.0f, 0.0f, 0.0f, 0.0f}))},
    {"inertia_denormal", bad_inertia, adding(with_inertia({1e-42f, 1e-42f, 1e-42f, 0.0f, 0.0f, 0.0f}))},
    {"radius_zero", bad_extent, adding(sized(Sphere{0.0f}))},
    {"radius_negative", bad_extent, adding(sized(Capsule{0.5f, -0.5f}))},
    {"radius_below_smallest", bad_extent, adding(sized(Sphere{1e-5f}))},
    {"radius_above_largest", bad_extent, adding(sized(Sphere{1e5f}))},
    {"radius_nan", non_finite, adding(sized(Cylinder{0.5f, nan}))},
    {"half_extent_zero", bad_extent, adding(sized(Box{{0.5f, 0.0f, 0.5f}}))},
    {"half_extent_static", bad_extent, adding(StaticBodyDef{.shape = Box{{0.5f, -1.0f, 0.5f}}})},
    {"hull_unbuilt", degenerate_hull, adding(sized(ConvexHull{}))},
    {"mesh_unbuilt", bad_mesh, adding(StaticBodyDef{.shape = TriangleMesh{}})},
    {"plane_moves", shape_not_dynamic, adding(sized(Plane{}))},
    {"flat_mesh_moves", shape_not_dynamic, adding(sized(wavy_ground(2, 1.0f, 0.0f)))},
    {"plane_far", out_of_world, adding(StaticBodyDef{.shape = Plane{{0.0f, 2.0f, 0.0f}, 4e7f}})},
    {"local_position_far", out_of_world, adding(with_collider({.local = {{1e20f, 0.0f, 0.0f}, {}}}))},
    {"local_position_nan", non_finite, adding(with_collider({.local = {{nan, 0.0f, 0.0f}, {}}}))},
    {"centre_of_mass_far", out_of_world, adding(RigidBodyDef{.centre_of_mass = Vec3{0.0f, 1e20f, 0.0f}})},
    {"friction_negative", bad_material, adding(RigidBodyDef{.friction = -0.1f})},
    {"friction_nan", bad_material, adding(StaticBodyDef{.friction = nan})},
    {"dynamic_friction_negative", bad_material, adding(RigidBodyDef{.dynamic_friction = -1.0f})},
    {"restitution_negative", bad_material, adding(RigidBodyDef{.restitution = -0.1f})},
    {"restitution_above_one", bad_material, adding(RigidBodyDef{.restitution = 1.1f})},
    {"stale_body", stale_id, [](Refusing& s) { return s.world.remove_body(s.gone); }},
    {"body_of_another_world", wrong_world, [](Refusing& s) { return s.world.remove_body(Refusing().cube); }},
    {"joint_of_another_world", wrong_world, [](Refusing& s) { return s.world.set_motor(Refusing().joint, {}); }},
    {"joint_to_another_world", wrong_world,
     [](Refusing& s) { return status(s.world.joint_at(JointType::ball, s.cube, Refusing().cube, {})); }},
    {"null_body", stale_id, [](Refusing& s) { return s.world.remove_body({}); }},
    {"null_joint", stale_id, [](Refusing& s) { return s.world.remove_joint({}); }},
    {"joint_to_stale", stale_id,
     [](Refusing& s) { return status(s.world.joint_at(JointType::ball, s.cube, s.gone, {})); }},
    {"joint_to_itself", bad_joint,
     [](Refusing& s) { return status(s.world.joint_at(JointType::ball, s.cube, s.cube, {})); }},
    {"joint_of_statics", no_dynamic_body,
     [](Refusing& s) { return status(s.world.joint_at(JointType::ball, s.floor, s.paddle, {})); }},
    {"joint_axis_zero", bad_joint,
     [](Refusing& s) { return status(s.world.joint_at(JointType::hinge, s.floor, s.cube, {}, {})); }},
    {"joint_axis_nan", non_finite,
     [](Refusing& s) { return status(s.world.joint_at(JointType::hinge, s.floor, s.cube, {}, {nan, 0.0f, 0.0f})); }},
    {"joint_limit_reversed", bad_joint, joining([](JointDef& d) {
         d.limit = {0.5f, -0.5f};
     })},
    {"joint_limit_nan", non_finite, joining([](JointDef& d) {
         d.limit = {nan, 0.5f};
     })},
    {"joint_frame_nan", non_finite, joining([](JointDef& d) { d.frame_a.translation.x = nan; })},
    {"joint_frame_not_unit", bad_rotation, joining([](JointDef& d) { d.frame_b.rotation.w = 3.0f; })},
    {"joint_frame_far", bad_joint, joining([](JointDef& d) { d.frame_b.translation.y = -1e30f; })},
    {"joint_limit_far", bad_joint, joining([](JointDef& d) {
         d.type = JointType::distance, d.limit = {1e9f, 1e9f};
     })},
    {"joint_travel_far", bad_joint, joining([](JointDef& d) {
         d.type = JointType::slider, d.limit = {-1e9f, -1e8f};
     })},
    {"spring_turns_too_far", bad_joint, joining([](JointDef& d) { d.spring = {.stiffness = 1.0f, .target = 100.0f}; })},
    {"set_spring_turns_too_far", bad_joint,
     [](Refusing& s) { return s.world.set_spring(s.joint, {.stiffness = 1.0f, .target = -6.3f}); }},
    {"spring_pulls_out_of_the_world", bad_joint, joining([](JointDef& d) {
         d.type = JointType::six_degrees, d.axes.linear[2].spring = {.stiffness = 1.0f, .target = 1e8f};
     })},
    {"spring_of_swing_too_far", bad_joint, joining([](JointDef& d) {
         d.type = JointType::six_degrees, d.axes.angular[1].spring = {.stiffness = 1.0f, .target = 7.0f};
     })},
    {"motor_negative", bad_joint, joining([](JointDef& d) { d.motor.max_force = -1.0f; })},
    {"set_motor_nan", non_finite, [](Refusing& s) { return s.world.set_motor(s.joint, {nan, 1.0f}); }},
};

auto name_of_case = [](const auto& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Motion, Refusals, ::testing::ValuesIn(motion_refusals), name_of_case);
INSTANTIATE_TEST_SUITE_P(Definitions, Refusals, ::testing::ValuesIn(body_refusals), name_of_case);

TEST(Refusals, OfHullsAndMeshes) {
    auto hull = [](std::vector<Vec3> points) { return ConvexHull::from_points(points).error().code; };
    EXPECT_EQ(hull({}), degenerate_hull);
    EXPECT_EQ(hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), degenerate_hull);
    EXPECT_EQ(hull({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}), degenerate_hull);
    EXPECT_EQ(hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5f, 0.2f, 0}}), degenerate_hull);
    EXPECT_EQ(hull(std::vector<Vec3>(9, Vec3{1, 2, 3})), degenerate_hull);
    EXPECT_EQ(hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, nan}}), non_finite);
    const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    auto mesh = [](std::vector<Vec3> v, std::vector<uint32_t> i) { return TriangleMesh::from_triangles(v, i); };
    EXPECT_EQ(mesh({}, {}).error().code, bad_mesh);
    EXPECT_EQ(mesh(corners, {0, 1, 7}).error().code, bad_mesh);
    EXPECT_NE(mesh(corners, {0, 1, 7}).error().message.find('7'), std::string::npos);
    EXPECT_EQ(mesh(corners, {0, 1}).error().code, bad_mesh);
    EXPECT_EQ(mesh({{0, 0, 0}, {1, 0, 0}, {0, infinity, 0}}, {0, 1, 2}).error().code, bad_mesh);
    EXPECT_EQ(mesh(corners, {0, 1, 2, 1, 1, 2}).value().dropped_triangles(), 1);
}

TEST(Refusals, OfSettings) {
    auto code = [](const WorldBuilder& b) {
        Result<World> world = b.build();
        return world ? io : world.error().code;
    };
    EXPECT_EQ(code(WorldBuilder{}.gravity({0.0f, nan, 0.0f})), non_finite);
    EXPECT_EQ(code(WorldBuilder{}.gravity({0.0f, 1e12f, 0.0f})), bad_config);
    for (int steps : {0, -1, 65}) EXPECT_EQ(code(WorldBuilder{}.solver_steps(steps)), bad_config);
    for (float speed : {0.0f, -1.0f, nan, infinity}) {
        EXPECT_EQ(code(WorldBuilder{}.rigid_separation_speed(speed)), bad_config);
        EXPECT_EQ(code(WorldBuilder{}.static_separation_speed(speed)), bad_config);
    }
    EXPECT_EQ(code(WorldBuilder{}.friction(-1.0f)), bad_config);
    EXPECT_EQ(code(WorldBuilder{}.friction(1.1e6f)), bad_config) << "no body would be taken";
    EXPECT_EQ(code(WorldBuilder{}.bounciness(1.5f)), bad_config);
    EXPECT_EQ(code(WorldBuilder{}.workers(0)), bad_config);
    EXPECT_EQ(code(WorldBuilder{}.width(3)), bad_config);
    EXPECT_EQ(code(WorldBuilder{}.broad_phase(static_cast<BroadPhaseType>(99))), bad_config);
    EXPECT_EQ(code(WorldBuilder{}.simplex(static_cast<SimplexSolver>(99))), bad_config);
    EXPECT_EQ(code(WorldBuilder{}.integrator(static_cast<Integrator>(99))), bad_config);
    EXPECT_EQ(code(WorldBuilder{}.gravity({0.0f, -1e6f, 0.0f})), io) << "strong gravity is allowed";
}

// Messages tell what was wrong, however small, large or far it is.
TEST(Refusals, NameWhatIsWrong) {
    Refusing s;
    auto says = [](const Status& status) { return status ? std::string("nothing") : status.error().message; };
    EXPECT_NE(says(adding(sized(Sphere{1e-30f}))(s)).find("is 1e-30."), std::string::npos);
    EXPECT_NE(says(adding(sized(Sphere{-1.0f}))(s)).find("is -1."), std::string::npos);
    EXPECT_NE(says(adding(sized(Sphere{3e33f}))(s)).find("is 3e+33."), std::string::npos);
    EXPECT_NE(says(adding(with_collider({.local = {{1e20f, 0.0f, 0.0f}, {}}}))(s)).find("local position is farther"),
              std::string::npos);
    EXPECT_EQ(says(s.world.remove_body({})), "remove_body: body is a null handle");
    EXPECT_EQ(says(s.world.remove_body(s.gone)), "remove_body: there is no such body any more");
    EXPECT_EQ(says(status(s.world.joint_at(JointType::ball, {}, s.cube, {}))), "joint_at: body A is a null handle");
}

// What is as far as a world lets it be is not refused, nor are bounds that bind nothing.
TEST(Refusals, StopAtTheEndOfTheWorld) {
    Refusing s;
    EXPECT_TRUE(joining([](JointDef& d) { d.frame_a.translation.x = 2e7f; })(s));
    EXPECT_TRUE(joining([](JointDef& d) { d.type = JointType::distance, d.limit = {0.0f, 3e38f}; })(s));
    EXPECT_TRUE(joining([](JointDef& d) { d.type = JointType::slider, d.limit = {-infinity, 2e7f}; })(s));
    EXPECT_TRUE(joining([](JointDef& d) { d.spring = {.stiffness = 1.0f, .target = 6.28f}; })(s));
    EXPECT_TRUE(adding(StaticBodyDef{.shape = Plane{{0.0f, 1.0f, 0.0f}, -1e7f}})(s));
    EXPECT_TRUE(WorldBuilder{}.friction(1e6f).build().value().add_rigid_body({}));
}

}  // namespace
}  // namespace lendulet::test
