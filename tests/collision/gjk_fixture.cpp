#include "gjk_fixture.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace lendulet::gjk_test {

int cases(int full) {
    const char* scale = std::getenv("LENDULET_TEST_SCALE");
    double divisor = scale ? std::atof(scale) : 1.0;
    return std::max(10, static_cast<int>(full / std::max(divisor, 1e-3)));
}

float Random::uniform(float lo, float hi) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return lo + (hi - lo) * static_cast<float>(state_ >> 40) * 0x1p-24f;
}
float Random::log_uniform(float lo, float hi) { return lo * std::pow(hi / lo, uniform(0.0f, 1.0f)); }
int Random::integer(int count) { return std::min(count - 1, static_cast<int>(uniform(0.0f, 1.0f) * count)); }
Vec3 Random::direction() {
    for (;;) {
        Vec3 v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        if (dot(v, v) > 0.01f && dot(v, v) < 1.0f) return normalize(v);
    }
}
Quat Random::rotation() {
    for (;;) {
        Quat q{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        if (dot(q, q) > 0.01f && dot(q, q) < 1.0f) return normalize(q);
    }
}

Core make_box(Vec3 half) {
    Core core;
    core.geometry.kind = GeometryKind::box;
    core.geometry.size = half;
    core.body = oracle::make_box(wide(half));
    core.size = max_component(half);
    return core;
}
Core make_point() {
    Core core;
    core.body = oracle::make_points({{}});
    return core;
}
Core make_segment(float half_height) {
    Core core;
    core.geometry.kind = GeometryKind::segment;
    core.geometry.size = {0.0f, half_height, 0.0f};
    core.body = oracle::make_points({{0, half_height, 0}, {0, -half_height, 0}});
    core.size = half_height;
    return core;
}
Core make_tapered(bool balls, float bottom_radius, float half_height, float top_radius) {
    Core core;
    core.geometry.kind = balls ? GeometryKind::tapered_capsule : GeometryKind::tapered_cylinder;
    core.geometry.size = {bottom_radius, half_height, top_radius};
    core.curved = {balls, bottom_radius, half_height, top_radius};
    core.size = std::max({bottom_radius, top_radius, half_height});
    return core;
}

Core make_hull(const std::vector<Vec3>& points, bool flat) {
    Core core;
    core.hull = std::make_shared<HullData>();
    HullData& hull = *core.hull;
    hull.vertices = points;
    hull.lower = hull.upper = points[0];
    std::vector<oracle::Vec> corners;
    for (Vec3 p : points) {
        corners.push_back(wide(p));
        hull.xs.push_back(p.x);
        hull.ys.push_back(p.y);
        hull.zs.push_back(p.z);
        hull.lower = minimum(hull.lower, p);
        hull.upper = maximum(hull.upper, p);
        hull.centroid += (1.0f / static_cast<float>(points.size())) * p;
        core.size = std::max(core.size, length(p));
    }
    while (hull.xs.size() % 16 != 0) {
        hull.xs.push_back(points.back().x);
        hull.ys.push_back(points.back().y);
        hull.zs.push_back(points.back().z);
    }
    core.body = flat ? oracle::make_points(corners) : oracle::make_hull(corners);
    core.geometry.kind = GeometryKind::hull;
    core.geometry.hull = core.hull.get();
    return core;
}

Core make_triangle(Vec3 a, Vec3 b, Vec3 c) {
    Core core;
    core.corners = std::make_shared<std::vector<Vec3>>(std::vector<Vec3>{a, b, c});
    core.geometry.kind = GeometryKind::triangle;
    core.geometry.triangle = core.corners->data();
    core.body = oracle::make_points({wide(a), wide(b), wide(c)});
    core.size = std::max({length(a), length(b), length(c)});
    return core;
}

Core random_box(Random& random, float scale) {
    auto half = [&] { return scale * random.uniform(0.25f, 1.0f); };
    return make_box({half(), half(), half()});
}
Core random_hull(Random& random, float scale, int max_corners) {
    float share = random.uniform(0.0f, 1.0f);  // mostly small hulls: the oracle's time grows with the fourth power
    int count = 4 + static_cast<int>(static_cast<float>(max_corners - 4) * share * share * share);
    Vec3 stretch{random.uniform(0.25f, 1.0f), random.uniform(0.25f, 1.0f), random.uniform(0.25f, 1.0f)};
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i)
        points.push_back(scale * random.uniform(0.6f, 1.0f) * multiply(stretch, random.direction()));
    return make_hull(points);
}
Core random_tapered(Random& random, float scale) {
    bool balls = random.integer(2) == 0;
    auto length = [&] { return scale * random.uniform(0.25f, 1.0f); };
    float bottom = length(), top = length(), half_height = length();
    int kind = random.integer(4);  // cylinders, cones of either sense, and what lies between
    if (kind == 0) top = bottom;
    if (kind == 1) top = 0.0f;
    if (kind == 2 && !balls) bottom = 0.0f;
    return make_tapered(balls, bottom, half_height, top);
}

ConvexDistance query(const Core& a, const Core& b, const Transform& b_in_a, SimplexSolver method) {
    GjkCache cache;
    return distance({&a.geometry, &b.geometry, b_in_a}, cache, method, 1e30f);
}

Transform place(Random& random, const Core& a, const Core& b, float wanted) {
    Transform t{3.0f * (a.size + b.size) * random.direction(), random.rotation()};
    float jitter = 0.3f * std::min(a.size, b.size);
    t.translation +=
        {random.uniform(-jitter, jitter), random.uniform(-jitter, jitter), random.uniform(-jitter, jitter)};
    ConvexDistance start = query(a, b, t, SimplexSolver::barycentric);
    t.translation -= (start.distance - wanted) * start.normal;
    return t;
}

oracle::Pose oracle_pose(const Transform& t) {
    return oracle::make_pose(t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w, wide(t.translation));
}
oracle::Answer oracle_answer(const Core& a, const Core& b, const Transform& b_in_a) {
    return oracle::distance(a.body, oracle::moved(b.body, oracle_pose(b_in_a)));
}

namespace {

using oracle::Real;
using oracle::Vec;

Vec turned_back(const oracle::Pose& pose, Vec d) {
    return {dot(pose.columns[0], d), dot(pose.columns[1], d), dot(pose.columns[2], d)};
}
Real support(const Core& core, Vec n) {
    return core.curved ? oracle::support(*core.curved, n) : oracle::support(core.body, n);
}
Real outside(const Core& core, Vec p) {
    if (core.curved) return std::max<Real>(0, oracle::signed_distance(*core.curved, p));
    return oracle::outside(core.body, p);
}
constexpr Real smallest_size = 1e-30L;  // S of two points at one place
bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

void Tally::fail(const std::string& what, const Core& a, const Core& b, const Transform& t, const ConvexDistance& r) {
    if (bad++ > 0) return;
    std::ostringstream text;
    text.precision(9);
    auto write = [&](const char* label, Vec3 v) { text << label << " (" << v.x << ", " << v.y << ", " << v.z << ")"; };
    text << what << " in case " << count << ": distance " << r.distance;
    write(" normal", r.normal);
    write(" size a", a.geometry.size);
    write(" size b", b.geometry.size);
    write(" translation", t.translation);
    text << " rotation (" << t.rotation.x << ", " << t.rotation.y << ", " << t.rotation.z << ", " << t.rotation.w
         << ") kinds " << static_cast<int>(a.geometry.kind) << ", " << static_cast<int>(b.geometry.kind)
         << " iterations " << r.iterations << " expansions " << r.expansions;
    first_bad = text.str();
}

void Tally::certify(const Core& a, const Core& b, const Transform& t, const ConvexDistance& r) {
    ++count;
    iterations += r.iterations;
    expansions += r.expansions;
    max_iterations = std::max(max_iterations, r.iterations);
    max_expansions = std::max(max_expansions, r.expansions);
    if (!std::isfinite(r.distance) || !finite(r.normal) || !finite(r.point_a) || !finite(r.point_b))
        return fail("not finite", a, b, t, r);
    if (!r.converged) fail("not converged", a, b, t, r);
    Vec n = wide(r.normal);
    if (std::abs(norm(n) - 1) > 1e-6L) fail("normal not of unit length", a, b, t, r);

    Real s = std::max({Real(a.size) + b.size, std::abs(Real(r.distance)), smallest_size});
    oracle::Pose pose = oracle_pose(t);
    Vec pa = wide(r.point_a), pb = wide(r.point_b);
    Real off = std::max(outside(a, pa), outside(b, turned_back(pose, pb - pose.translation)));
    // Where all directions are nearly as good (round cores with a common axis), the witness points may lie off the
    // normal.
    bool round = (a.curved || b.curved) && r.distance < 0;
    off = std::max(off, round ? std::abs(norm(pb - pa) + r.distance) : norm(pb - pa - Real(r.distance) * n));
    witness = std::max(witness, static_cast<double>(off / s));
    if (off > 4e-6L * s) fail("witness points off by " + std::to_string(double(off / s * 1e6L)) + "e-6 S", a, b, t, r);

    Real separation = dot(n, pose.translation) - support(b, Real(-1) * turned_back(pose, n)) - support(a, n);
    Real gap = std::abs(separation - r.distance);
    certificate = std::max(certificate, static_cast<double>(gap / s));
    if (gap > (r.distance >= 0 ? 2e-6L : 1e-5L) * s)
        fail("support gap " + std::to_string(double(gap / s * 1e6L)) + "e-6 S", a, b, t, r);
}

void Tally::judge(const Core& a, const Core& b, const Transform& t, const ConvexDistance& r,
                  const oracle::Answer& answer) {
    int bad_before = bad;
    certify(a, b, t, r);
    if (bad > bad_before) return;
    Real s = std::max({Real(a.size) + b.size, std::abs(answer.distance), smallest_size});
    Real error = std::abs(r.distance - answer.distance) / s;
    bool apart = answer.distance >= 0;
    (apart ? distance : depth) = std::max(apart ? distance : depth, static_cast<double>(error));
    std::string truth = " (oracle " + std::to_string(double(answer.distance / s * 1e6L)) + "e-6 S)";
    if (error > (apart ? 2e-6L : 1e-5L))
        fail("distance off by " + std::to_string(double(error * 1e6L)) + "e-6 S" + truth, a, b, t, r);
    if (std::abs(answer.distance) <= 4e-6L * s) return;  // within the band sign and normal may be either
    if (apart != (r.distance > 0)) fail("wrong sign" + truth, a, b, t, r);
    bool tie = !apart && answer.runner_up > answer.distance - 1e-4L * s;
    if (tie) return;
    Real angle = std::asin(std::min<Real>(1, norm(cross(wide(r.normal), answer.normal)))) * 57.29578L;
    if (dot(wide(r.normal), answer.normal) < 0) angle = 180;
    normal_degrees = std::max(normal_degrees, static_cast<double>(angle));
    if (angle > 0.05L) fail("normal off by " + std::to_string(double(angle)) + " degrees" + truth, a, b, t, r);
}

Tally::~Tally() {
    EXPECT_EQ(bad, 0) << name << ": " << bad << " of " << count << " bad; first: " << first_bad;
    if (std::getenv("LENDULET_TEST_REPORT"))
        std::printf(
            "%-28s %7d cases; /S: distance %.1e depth %.1e witness %.1e certificate %.1e; normal %.1e deg; GJK %.2f "
            "max "
            "%d, EPA %.2f max %d\n",
            name.c_str(), count, distance, depth, witness, certificate, normal_degrees, iterations / std::max(1, count),
            max_iterations, expansions / std::max(1, count), max_expansions);
}

}  // namespace lendulet::gjk_test
