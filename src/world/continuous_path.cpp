#include "world/continuous_path.h"

namespace lendulet {
namespace {

constexpr float full_turn = 2.0f * pi;
constexpr float most = 1.01f;  // makes up for rounding where something is computed from above

// How far the body turned at most, from what the solver has at hand. One that spun by less than half a turn has turned
// by the angle between its orientations, which is at most pi times the sine of its half.
float most_turn_of(const WorldData& world, uint32_t body, float dt) {
    const auto index = static_cast<size_t>(world.bodies.info[body].solver_index);
    const BodyState& state = world.solver_bodies.state[index];
    const BodyStart& start = world.solver_bodies.start[index];
    Vec3 spin = Vec3{start.w[0], start.w[1], start.w[2]} + 0.5f * Vec3{state.w[0], state.w[1], state.w[2]};
    float sine = length(Vec3{state.dq[0], state.dq[1], state.dq[2]});
    float at_most = absolute(spin.x) + absolute(spin.y) + absolute(spin.z);
    return most * (dt * at_most < 3.0f ? minimum(pi * sine, full_turn) : full_turn);
}

}  // namespace

bool is_still(const WorldData& world, uint32_t body) { return world.bodies.info[body].solver_index < reserved_bodies; }

size_t place_of(const WorldData& world, uint32_t body) {
    return static_cast<size_t>(world.bodies.info[body].solver_index - reserved_bodies);
}

BodyPath path_of(const WorldData& world, uint32_t body, float dt) {
    const BodyStore& bodies = world.bodies;
    BodyPath path{bodies.pose[body], bodies.pose[body]};
    if (is_still(world, body)) return path;
    const size_t place = place_of(world, body);
    path.start = world.continuous.start[place];
    Quat turn = path.end.orientation * conjugate(path.start.orientation);
    const float* before = world.solver_bodies.start[place + reserved_bodies].w;
    Vec3 v{turn.x, turn.y, turn.z}, w = bodies.angular_velocity(body);
    w = 0.5f * (Vec3{before[0], before[1], before[2]} + w);
    if (dot(v, w) < 0.0f) v = -v, turn.w = -turn.w;
    float half_sine = length(v);
    path.axis = half_sine > 1e-6f ? (1.0f / half_sine) * v : normalize(w);
    path.angle = 2.0f * arc_tangent2(half_sine, turn.w);  // in [0, 2 pi], along w
    // Both ends do not tell of full turns between, or whether it was the short way round: the spin does.
    float spun = world.continuous.fraction[place] * dt * length(w), turns = (spun - path.angle) / full_turn;
    path.angle += full_turn * static_cast<float>(static_cast<int>(turns + (turns < 0.0f ? -0.5f : 0.5f)));
    return path;
}

float reach_of(const BodyPath& path, float radius) {
    return length(path.end.position - path.start.position) + minimum(absolute(path.angle), full_turn) * radius;
}

float most_reach_of(const WorldData& world, uint32_t body, float dt) {
    const BodyInfo& info = world.bodies.info[body];
    const float* dp = world.solver_bodies.state[static_cast<size_t>(info.solver_index)].dp;
    return most * length(Vec3{dp[0], dp[1], dp[2]}) + most_turn_of(world, body, dt) * info.radius;
}

Carrier carrier_of(const WorldData& world, uint32_t body, const BodyPath& path) {
    return {path, rotation_about(path.axis, path.angle), is_still(world, body), body};
}

float most_reach_against(const WorldData& world, uint32_t body, const Carrier& carrier, float dt) {
    const BodyPath& path = carrier.path;
    const Position start = world.continuous.start[place_of(world, body)].position,
                   end = world.bodies.pose[body].position;
    const float turn = absolute(path.angle);
    if (turn > 1.0f) return 3e38f;
    const Vec3 arm = rotate(carrier.turn, start - path.start.position);
    const Position carried = path.end.position + arm;
    // The carrier's velocity there changes its direction by `turn`: by half of that from its mean at most.
    const float bend = 0.5f * turn * length(carried - start);
    return most * (length(end - carried) + bend) +
           (most * turn + most_turn_of(world, body, dt)) * world.bodies.info[body].radius;
}

Motion motion_of(const WorldData& world, uint32_t collider, const BodyPath& path, Position origin) {
    const Transform& local = world.colliders.local[collider];
    Motion m;
    m.pivot = to_double(path.start.position - origin);
    m.rotation = path.start.orientation * local.rotation;
    m.local_pivot = rotate_inverse(local.rotation, -local.translation);
    m.translation = to_double(path.end.position - path.start.position);
    bool centred_ball = world.colliders.geometry[collider].kind == GeometryKind::point && local.translation == Vec3{};
    if (!centred_ball && absolute(path.angle) > 1e-5f) m.axis = path.axis, m.angle = path.angle;
    return m;
}

Pose pose_at(const BodyPath& path, double t) {
    auto f = static_cast<float>(t);
    return {path.start.position + f * (path.end.position - path.start.position),
            normalize(rotation_about(path.axis, f * path.angle) * path.start.orientation)};
}

}  // namespace lendulet
