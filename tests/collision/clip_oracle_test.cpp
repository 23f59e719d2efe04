// Clipped faces against Clipper (https://sourceforge.net/projects/polyclipping, in Debian libpolyclipping-dev), as the
// thesis compared them: area and corners of the intersection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "collision/clip.h"
#include "gjk_fixture.h"

#ifdef LENDULET_TEST_CLIPPER
#include <polyclipping/clipper.hpp>
#endif

namespace lendulet::gjk_test {
namespace {

#ifdef LENDULET_TEST_CLIPPER

struct Flat {
    double u, v;
};

double area(const std::vector<Flat>& p) {
    double sum = 0.0;
    for (size_t i = 0; i < p.size(); ++i) {
        const Flat &a = p[i], &b = p[(i + 1) % p.size()];
        sum += a.u * b.v - a.v * b.u;
    }
    return 0.5 * sum;
}

// A convex polygon about a point of a plane: corners on an ellipse.
Face random_face(Random& random, const Transform& t, int most) {
    Face face;
    face.count = 3 + random.integer(most - 2);
    const float long_half = random.uniform(0.3f, 1.0f), short_half = long_half * random.log_uniform(0.02f, 1.0f);
    const float start = random.uniform(0.0f, 6.0f), turn = 2.0f * pi / static_cast<float>(face.count);
    for (int i = 0; i < face.count; ++i) {
        SinCos a = sin_cos(start + turn * (static_cast<float>(i) + random.uniform(0.0f, 0.8f)));
        face.vertices[i] = t * Vec3{long_half * a.cos, short_half * a.sin, 0.0f};
        face.ids[i] = static_cast<uint16_t>(i);
    }
    face.normal = rotate(t.rotation, Vec3{0.0f, 0.0f, 1.0f});
    return face;
}

// The face seen in the plane, with its sides moved outwards by `slack`.
std::vector<Flat> in_plane(const Face& face, const ClippedFace& plane, double slack) {
    std::vector<Flat> p, out;
    for (int i = 0; i < face.count; ++i) {
        Vec3 r = face.vertices[i] - plane.origin;
        p.push_back({dot(r, plane.u), dot(r, plane.v)});
    }
    if (area(p) < 0.0) std::reverse(p.begin(), p.end());
    const size_t n = p.size();
    for (size_t i = 0; i < n && slack != 0.0; ++i) {
        const Flat &a = p[(i + n - 1) % n], &b = p[i], &c = p[(i + 1) % n];
        auto outwards = [](Flat from, Flat to) {
            double du = to.u - from.u, dv = to.v - from.v, size = std::hypot(du, dv);
            return Flat{dv / size, -du / size};
        };
        Flat m = outwards(a, b), k = outwards(b, c);
        double det = m.u * k.v - m.v * k.u, hm = m.u * b.u + m.v * b.v + slack, hk = k.u * b.u + k.v * b.v + slack;
        out.push_back({(hm * k.v - hk * m.v) / det, (hk * m.u - hm * k.u) / det});
    }
    return slack != 0.0 ? out : p;
}

std::vector<Flat> intersection(const std::vector<Flat>& a, const std::vector<Flat>& b) {
    constexpr double scale = 1e8;
    auto path = [](const std::vector<Flat>& p) {
        ClipperLib::Path out;
        for (Flat f : p)
            out.emplace_back(static_cast<ClipperLib::cInt>(std::llround(scale * f.u)),
                             static_cast<ClipperLib::cInt>(std::llround(scale * f.v)));
        return out;
    };
    ClipperLib::Clipper clipper;
    clipper.AddPath(path(a), ClipperLib::ptSubject, true);
    clipper.AddPath(path(b), ClipperLib::ptClip, true);
    ClipperLib::Paths result;
    clipper.Execute(ClipperLib::ctIntersection, result);
    std::vector<Flat> out;
    if (result.empty()) return out;
    for (const ClipperLib::IntPoint& p : result[0])
        out.push_back({static_cast<double>(p.X) / scale, static_cast<double>(p.Y) / scale});
    return out;
}

TEST(ClipOracle, AreaAndCornersAreClippers) {
    Random random(31);
    int compared = 0, empty = 0;
    double worst_area = 0.0, worst_corner = 0.0;
    for (int i = 0; i < cases(20000); ++i) {
        Transform below{{}, random.rotation()};
        // The incident face tilted by up to 0.3 rad.
        Vec3 aside{random.uniform(-0.9f, 0.9f), random.uniform(-0.9f, 0.9f), random.uniform(-0.1f, 0.1f)};
        Quat tilt = rotation_about(random.direction(), random.uniform(0.0f, 0.3f));
        Quat turn = rotation_about({0.0f, 0.0f, 1.0f}, random.uniform(0.0f, 6.0f));
        Transform above = below * Transform{aside, tilt * turn};
        Face reference = random_face(random, below, 16), incident = random_face(random, above, 16);
        ClippedFace clipped;
        clip_face(reference, incident, false, 1e9f, clipped);
        const double slack = 2e-4 * clipped.size;  // as far outside the reference face as still counts as over it
        std::vector<Flat> expected =
            intersection(in_plane(reference, clipped, slack), in_plane(incident, clipped, 0.0));
        std::vector<Flat> found;
        for (int k = 0; k < clipped.count; ++k) found.push_back({clipped.points[k].u, clipped.points[k].v});
        double expected_area = std::abs(area(expected)), found_area = std::abs(area(found));
        worst_area = std::max(worst_area, std::abs(expected_area - found_area));
        (expected_area > 1e-4 ? compared : empty) += 1;
        if (expected_area < 1e-4) continue;
        for (const Flat& e : expected) {
            double nearest = 1e9;
            for (const Flat& f : found) nearest = std::min(nearest, std::hypot(e.u - f.u, e.v - f.v));
            worst_corner = std::max(worst_corner, nearest);
        }
    }
    EXPECT_LT(worst_area, 5e-6);
    // Where two sides meet at a small angle the corner is known to the rounding of coordinates over that angle.
    EXPECT_LT(worst_corner, 1e-3);
    EXPECT_GT(compared, cases(8000));
    EXPECT_GT(empty, cases(200));
    RecordProperty("worst_area", std::to_string(worst_area));
    RecordProperty("worst_corner", std::to_string(worst_corner));
}

#else
TEST(ClipOracle, AreaAndCornersAreClippers) { GTEST_SKIP() << "built without Clipper (Debian: libpolyclipping-dev)"; }
#endif

}  // namespace
}  // namespace lendulet::gjk_test
