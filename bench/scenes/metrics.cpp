#include "bench/scenes/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace lendulet::bench {
namespace {

constexpr float least_overlap = 1e-4f;  // m: pairs below it count as touching

// Separating axes of two boxes: the six face normals and the nine cross products of edges. The least overlap of their
// projections is the depth (Gottschalk, Lin, Manocha, "OBBTree", SIGGRAPH 1996).
float box_overlap(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b) {
    Mat3 ra = rotation_matrix(pose_a.orientation), rb = rotation_matrix(pose_b.orientation);
    const Vec3 axes_a[3] = {ra.x, ra.y, ra.z}, axes_b[3] = {rb.x, rb.y, rb.z};
    Vec3 distance = pose_b.position - pose_a.position;
    float depth = std::numeric_limits<float>::max();
    auto test = [&](Vec3 axis) {
        float size = length(axis);
        if (size < 1e-3f) return;  // parallel edges give no axis of their own
        float reach = -std::fabs(dot(axis, distance));
        for (int i = 0; i < 3; ++i) {
            reach += component(a.half_extents, i) * std::fabs(dot(axis, axes_a[i]));
            reach += component(b.half_extents, i) * std::fabs(dot(axis, axes_b[i]));
        }
        depth = std::fmin(depth, reach / size);
    };
    for (int i = 0; i < 3 && depth > 0.0f; ++i) {
        test(axes_a[i]);
        test(axes_b[i]);
    }
    for (int i = 0; i < 9 && depth > 0.0f; ++i) test(cross(axes_a[i / 3], axes_b[i % 3]));
    return depth;
}

struct Segment {
    Position from, to;
};

// Least distance of two segments (Ericson, Real-Time Collision Detection, 5.1.9).
float segment_distance(const Segment& a, const Segment& b) {
    Vec3 da = a.to - a.from, db = b.to - b.from, r = a.from - b.from;
    float aa = dot(da, da), bb = dot(db, db), ab = dot(da, db), ar = dot(da, r), br = dot(db, r);
    float determinant = aa * bb - ab * ab;
    float s = determinant > 1e-9f ? clamp((ab * br - ar * bb) / determinant, 0.0f, 1.0f) : 0.0f;
    float t = bb > 1e-9f ? (ab * s + br) / bb : 0.0f;
    if (t < 0.0f) {
        t = 0.0f;
        s = aa > 1e-9f ? clamp(-ar / aa, 0.0f, 1.0f) : 0.0f;
    } else if (t > 1.0f) {
        t = 1.0f;
        s = aa > 1e-9f ? clamp((ab - ar) / aa, 0.0f, 1.0f) : 0.0f;
    }
    return length((a.from + s * da) - (b.from + t * db));
}

// Balls and capsules as segments with a radius; negative radius: neither.
float radius_of(const Shape& shape) {
    if (auto* ball = std::get_if<Sphere>(&shape)) return ball->radius;
    if (auto* capsule = std::get_if<Capsule>(&shape)) return capsule->radius;
    return -1.0f;
}

Segment core_of(const Shape& shape, const Pose& pose) {
    float half = 0.0f;
    if (auto* capsule = std::get_if<Capsule>(&shape)) half = capsule->half_height;
    return {pose * Vec3{0.0f, -half, 0.0f}, pose * Vec3{0.0f, half, 0.0f}};
}

// Of the smallest ball about the origin that holds the shape; 0 for shapes that are not measured.
float reach_of(const Shape& shape) {
    if (auto* box = std::get_if<Box>(&shape)) return length(box->half_extents);
    if (auto* capsule = std::get_if<Capsule>(&shape)) return capsule->half_height + capsule->radius;
    return maximum(radius_of(shape), 0.0f);
}

struct Solid {
    const Shape* shape;
    Pose pose;
    float reach;
    uint32_t group;  // solids of one group may overlap
};

std::vector<Solid> measured_solids(const scenes::SceneDescription& scene, const std::vector<Pose>& poses) {
    std::vector<Solid> solids;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        const scenes::SceneBody& body = scene.bodies[i];
        if (body.type != BodyType::dynamic || body.colliders.size() != 1) continue;
        Vec3 p = from_origin(poses[i].position);
        float reach = reach_of(body.colliders[0].shape);
        if (reach > 0.0f && std::isfinite(p.x + p.y + p.z))
            solids.push_back({&body.colliders[0].shape, poses[i], reach, body.colliders[0].filter.group});
    }
    return solids;
}

}  // namespace

float overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
    auto *box_a = std::get_if<Box>(&a), *box_b = std::get_if<Box>(&b);
    if (box_a && box_b) return box_overlap(*box_a, pose_a, *box_b, pose_b);
    float radius_a = radius_of(a), radius_b = radius_of(b);
    if (radius_a < 0.0f || radius_b < 0.0f) return -1.0f;
    return radius_a + radius_b - segment_distance(core_of(a, pose_a), core_of(b, pose_b));
}

// Candidates by a sweep along x over intervals of each solid's reach.
Penetration penetration(const scenes::SceneDescription& scene, const std::vector<Pose>& poses) {
    std::vector<Solid> solids = measured_solids(scene, poses);
    std::sort(solids.begin(), solids.end(),
              [](const Solid& a, const Solid& b) { return a.pose.position.x - a.reach < b.pose.position.x - b.reach; });
    std::vector<float> depths;
    for (size_t i = 0; i < solids.size(); ++i) {
        const Solid& a = solids[i];
        for (size_t j = i + 1; j < solids.size(); ++j) {
            const Solid& b = solids[j];
            if (b.pose.position.x - b.reach > a.pose.position.x + a.reach) break;
            if (length(b.pose.position - a.pose.position) > a.reach + b.reach) continue;
            if (a.group != 0 && a.group == b.group) continue;
            float depth = overlap(*a.shape, a.pose, *b.shape, b.pose);
            if (depth > least_overlap) depths.push_back(depth);
        }
    }
    Penetration result;
    if (depths.empty()) return result;
    std::sort(depths.begin(), depths.end());
    for (float depth : depths) result.mean += depth;
    result.mean /= static_cast<double>(depths.size());
    result.p99 = depths[static_cast<size_t>(0.99 * static_cast<double>(depths.size() - 1))];
    result.max = depths.back();
    result.pairs = static_cast<int>(depths.size());
    return result;
}

JointError joint_error(const scenes::SceneDescription& scene, const std::vector<Pose>& poses) {
    JointError result;
    auto anchor_on = [&](int index, Position anchor) {
        size_t i = static_cast<size_t>(index);
        const scenes::SceneBody& body = scene.bodies[i];
        return poses[i] * to_local({body.position, body.orientation}, anchor);
    };
    for (const scenes::SceneJoint& joint : scene.joints) {
        double gap = length(anchor_on(joint.body_a, joint.anchor) - anchor_on(joint.body_b, joint.anchor));
        result.mean += gap / static_cast<double>(scene.joints.size());
        result.max = std::fmax(result.max, gap);
    }
    return result;
}

Drift drift(const scenes::SceneDescription& scene, const std::vector<Pose>& before_last,
            const std::vector<Pose>& last) {
    Drift result;
    int moving = 0;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        if (scene.bodies[i].type != BodyType::dynamic) continue;
        Vec3 way = last[i].position - scene.bodies[i].position;
        double speed = length(last[i].position - before_last[i].position) / scene.dt;
        if (!std::isfinite(speed)) {
            ++result.not_finite;
            continue;
        }
        ++moving;
        result.mean_speed += speed;
        result.sideways = std::fmax(result.sideways, std::hypot(way.x, way.z));
        result.last_sinks = -way.y;
        result.lowest_way = std::fmin(result.lowest_way, way.y);
        result.highest_way = std::fmax(result.highest_way, way.y);
    }
    if (moving > 0) result.mean_speed /= moving;
    return result;
}

bool stands(const scenes::SceneDescription& scene, const Drift& drift) {
    constexpr double away = 0.5, escaped = 100.0;  // m
    if (drift.not_finite > 0 || drift.lowest_way < -escaped || drift.highest_way > escaped) return false;
    bool built_to_stand = false;
    for (const char* kind : {"stack", "large_pyramid", "many_pyramids", "mass_ratio"})
        built_to_stand = built_to_stand || scene.name.starts_with(kind);
    return !built_to_stand || (drift.sideways < away && drift.lowest_way > -away && drift.highest_way < away);
}

}  // namespace lendulet::bench
