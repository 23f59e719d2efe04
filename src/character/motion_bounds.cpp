// The optimum of min |d - w|^2, n_i d >= b_i lies on at most three of the planes in space; it is that projection of w
// onto none, one, two or three of them which keeps all bounds and on which no plane pulls (the conditions of Karush,
// Kuhn and Tucker, sufficient since the problem is convex). There are few planes, so all sets of them are tried in
// turn: no iteration that has to converge, and the same answer next frame.
#include "character/motion_bounds.h"

namespace lendulet {
namespace {

using Vec3d = Vec3T<double>;
constexpr double flat = 1e-6;  // planes that are parallel up to this sine squared have no edge or corner

Vec3d in_double(Vec3 v) { return {v.x, v.y, v.z}; }

struct Search {
    Vec3d wanted;
    std::span<const MotionBound> bounds;
    double tolerance;
    Vec3d found{};

    Vec3d normal(size_t i) const { return in_double(bounds[i].normal); }
    // By how much the wanted motion breaks bound i.
    double excess(size_t i) const { return static_cast<double>(bounds[i].least) - dot(normal(i), wanted); }
    bool keeps_all(Vec3d d) {
        for (const MotionBound& b : bounds)
            if (dot(in_double(b.normal), d) < static_cast<double>(b.least) - tolerance) return false;
        found = d;
        return true;
    }
    bool on_plane(size_t i) { return excess(i) >= 0.0 && keeps_all(wanted + excess(i) * normal(i)); }
    bool on_edge(size_t i, size_t k) {
        const Vec3d a = normal(i), b = normal(k);
        const double c = dot(a, b), det = 1.0 - c * c;
        if (det < flat) return false;
        const double pull_a = (excess(i) - c * excess(k)) / det, pull_b = (excess(k) - c * excess(i)) / det;
        return pull_a >= 0.0 && pull_b >= 0.0 && keeps_all(wanted + pull_a * a + pull_b * b);
    }
    bool in_corner(size_t i, size_t k, size_t m) {
        const Vec3d a = normal(i), b = normal(k), c = normal(m);
        const Vec3d bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
        const double det = dot(a, bc);
        if (det * det < flat) return false;
        // The step to the corner, and its parts along the normals.
        const Vec3d step = (1.0 / det) * (excess(i) * bc + excess(k) * ca + excess(m) * ab);
        const bool pulls = dot(step, bc) * det < 0.0 || dot(step, ca) * det < 0.0 || dot(step, ab) * det < 0.0;
        return !pulls && keeps_all(wanted + step);
    }
    bool run() {
        if (keeps_all(wanted)) return true;
        const size_t n = bounds.size();
        for (size_t i = 0; i < n; ++i)
            if (on_plane(i)) return true;
        for (size_t i = 0; i < n; ++i)
            for (size_t k = i + 1; k < n; ++k)
                if (on_edge(i, k)) return true;
        for (size_t i = 0; i < n; ++i)
            for (size_t k = i + 1; k < n; ++k)
                for (size_t m = k + 1; m < n; ++m)
                    if (in_corner(i, k, m)) return true;
        return false;
    }
};

}  // namespace

NearestMotion nearest_motion(Vec3 wanted, std::span<const MotionBound> bounds) {
    float size = max_component(absolute(wanted));
    for (const MotionBound& b : bounds) size = maximum(size, absolute(b.least));
    Search all{in_double(wanted), bounds, 1e-5 * static_cast<double>(size)};
    auto result = [](const Search& s) {
        return Vec3{static_cast<float>(s.found.x), static_cast<float>(s.found.y), static_cast<float>(s.found.z)};
    };
    if (all.run()) return {result(all), true};
    MotionBound fixed[16];
    size_t count = 0;
    for (const MotionBound& b : bounds)
        if (!b.moves && count < 16) fixed[count++] = b;
    Search rest{all.wanted, {fixed, count}, all.tolerance};
    return {rest.run() ? result(rest) : Vec3{}, false};
}

}  // namespace lendulet
