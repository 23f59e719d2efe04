// Random cores, placements at a wanted distance, and the acceptance criteria for one distance query against the oracle.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/gjk.h"
#include "geometry/hull.h"
#include "oracle.h"

namespace lendulet::gjk_test {

// How many cases to try: `full` divided by LENDULET_TEST_SCALE (environment; sanitizer builds set it), at least 10.
int cases(int full);

// xorshift: the same numbers with every standard library.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
    float uniform(float lo, float hi);
    float log_uniform(float lo, float hi);
    int integer(int count);  // 0 to count - 1
    Vec3 direction();
    Quat rotation();

private:
    uint64_t state_;
};

// A core for the engine and the same for the oracle.
struct Core {
    Geometry geometry;
    std::shared_ptr<HullData> hull;
    std::shared_ptr<std::vector<Vec3>> corners;
    oracle::Body body;                      // polytopes
    std::optional<oracle::Tapered> curved;  // tapered cores
    float size = 0.0f;                      // half extent of the core in its longest direction
};
Core make_box(Vec3 half);
Core make_point();
Core make_segment(float half_height);
Core make_tapered(bool balls, float bottom_radius, float half_height, float top_radius);
// `flat`: the points span no volume, so that the oracle knows them by their corners and edges only (up to 3 points).
Core make_hull(const std::vector<Vec3>& points, bool flat = false);
Core make_triangle(Vec3 a, Vec3 b, Vec3 c);
Core random_box(Random& random, float scale);
Core random_hull(Random& random, float scale, int max_corners);
Core random_tapered(Random& random, float scale);

ConvexDistance query(const Core& a, const Core& b, const Transform& b_in_a, SimplexSolver method);
// Moves B along the normal until the cores are `wanted` apart (negative: overlap), by the engine's own answer; what the
// distance then really is, the oracle says.
Transform place(Random& random, const Core& a, const Core& b, float wanted);

inline constexpr SimplexSolver both_methods[2] = {SimplexSolver::barycentric, SimplexSolver::half_space};
inline constexpr float scales[3] = {1e-3f, 1.0f, 1e4f};

// Largest errors of a class of cases relative to S, and the first case that broke a criterion.
struct Tally {
    std::string name;
    double distance = 0, depth = 0, witness = 0, certificate = 0, normal_degrees = 0;
    double iterations = 0, expansions = 0;
    int max_iterations = 0, max_expansions = 0, count = 0, bad = 0;
    std::string first_bad;

    explicit Tally(std::string name) : name(std::move(name)) {}
    ~Tally();  // expects that nothing was bad; prints the figures where LENDULET_TEST_REPORT is set
    // Everything that can be judged without a second solver: finite, unit normal, witness points on the cores and at
    // the given distance, support gap along the normal.
    void certify(const Core& a, const Core& b, const Transform& b_in_a, const ConvexDistance& result);
    // The same, and distance, sign and normal against the oracle's answer.
    void judge(const Core& a, const Core& b, const Transform& b_in_a, const ConvexDistance& result,
               const oracle::Answer& answer);
    void fail(const std::string& what, const Core& a, const Core& b, const Transform& b_in_a, const ConvexDistance& r);
};

oracle::Pose oracle_pose(const Transform& b_in_a);
oracle::Answer oracle_answer(const Core& a, const Core& b, const Transform& b_in_a);  // polytopes
inline oracle::Vec wide(Vec3 v) { return {v.x, v.y, v.z}; }

}  // namespace lendulet::gjk_test
