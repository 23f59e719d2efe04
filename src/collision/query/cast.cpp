#include "collision/query/cast.h"

#include "collision/gjk_search.h"
#include "collision/query/mesh_walk.h"
#include "geometry/hull.h"

namespace lendulet {
namespace {

// Linear casts end after a handful of rounds (the distance is a convex function of the fraction and the steps are
// Newton's), grazing ones after about 30. A turning shape that slides along the other without touching takes the most.
constexpr int most_rounds = 1000;
// What is that far apart, in parts of the shape's reach, is not near in the sense of those below.
constexpr double path_slack = 1e-3;
constexpr double near_linear = 4e-6, near_turning = 5e-5, near_of_larger = 1e-7, near_of_larger_turning = 1e-6;

// One shape and its motion.
struct Mover {
    const Geometry& shape;
    const Motion& motion;
    double reach;  // no point of the core is farther from the pivot
    Vec3d spin;    // axis times angle

    Mover(const Geometry& g, const Motion& s)
        : shape(g),
          motion(s),
          reach(g.kind == GeometryKind::plane ? 0.0 : core_reach(g) + length(to_double(s.local_pivot))),
          spin(static_cast<double>(s.angle) * to_double(s.axis)) {}

    static double core_reach(const Geometry& g) {
        if (g.kind == GeometryKind::triangle)
            return maximum(length(to_double(g.triangle[0])),
                           maximum(length(to_double(g.triangle[1])), length(to_double(g.triangle[2]))));
        return static_cast<double>(bounding_radius(g)) - g.rounding;
    }
    bool turns() const { return motion.angle != 0.0f; }
    // Position of the shape's origin, where its frame is turned by `rotation`.
    Vec3d origin(double t, const Mat3d& rotation) const {
        return pivot_at(motion, t) - rotation * to_double(motion.local_pivot);
    }
    // Largest dot product of `direction` with an arm from the pivot to a point of the core.
    double extent(const Mat3d& rotation, Vec3d direction) const {
        Vec3d arm =
            rotation * (support_point(shape, transpose_multiply(rotation, direction)) - to_double(motion.local_pivot));
        return dot(direction, arm);
    }
};

struct Nearest {
    bool overlapping;     // the cores do
    double lower, upper;  // bounds of the distance between the surfaces; the lower one holds along the normal
    Vec3d normal;         // from A to B
    Vec3d on_a;           // on A's surface
};

// Two convex shapes.
class ConvexProbe {
public:
    ConvexProbe(const Mover& a, const Mover& b)
        : a_(a),
          b_(b),
          size_(core_size(a.shape) + core_size(b.shape)),
          radii_(static_cast<double>(a.shape.rounding) + b.shape.rounding),
          difference_({&a.shape, &b.shape, {{}, {}}}) {}

    Nearest at(double t) {
        place(t);
        for (int i = 0; i < simplex_.count; ++i) simplex_.set(i, difference_.point(simplex_.a[i], simplex_.b[i]));
        if (simplex_.count == 0) start();
        Search found = search(difference_, simplex_, SimplexSolver::half_space, 1e30);
        if (found.outcome == Outcome::apart && found.gap > 10.0 * certified_distance * difference_.size) {
            simplex_.count = 0;  // misled by a sliver among the remembered points
            start();
            found = search(difference_, simplex_, SimplexSolver::barycentric, 1e30);
        }
        if (found.outcome == Outcome::overlap) {
            simplex_.count = 0;
            return {true, -radii_, -radii_, {}, {}};
        }
        constexpr uint8_t all_points[4] = {0, 1, 2, 3};
        Vec3d on_a = difference_.witness_on_a(simplex_, all_points, simplex_.weight, simplex_.count);
        on_a += static_cast<double>(a_.shape.rounding) * found.direction;
        return {false, found.distance - found.gap - radii_, found.distance - radii_, rotation_a_ * found.direction,
                origin_a_ + rotation_a_ * on_a};
    }
    // How deep they overlap at the start, m, and where.
    double penetration(CastHit& hit) const {
        Transform b_in_a{to_float(difference_.translation), conjugate(a_.motion.rotation) * b_.motion.rotation};
        GjkCache cold;
        ConvexDistance d = distance({&a_.shape, &b_.shape, b_in_a}, cold, SimplexSolver::half_space, 1e30f);
        hit.normal = rotation_a_ * to_double(d.normal);
        hit.point = origin_a_ + rotation_a_ * to_double(d.point_a + a_.shape.rounding * d.normal);
        return radii_ - d.distance;
    }
    double smaller_size() const {
        return minimum(core_size(a_.shape) + a_.shape.rounding, core_size(b_.shape) + b_.shape.rounding);
    }
    double size() const { return difference_.size; }
    // Lower bound of the separation along `normal` a short fraction `step` later, without the part that grows with its
    // square: dot(n, x + step v + r + step w x r), for the point of B where it is least and of A where it is largest.
    double separation_after(double step, Vec3d normal) const {
        Vec3d turned_a = normal + step * cross(normal, a_.spin), turned_b = normal + step * cross(normal, b_.spin);
        Vec3d between = pivot_at(b_.motion, now_) - pivot_at(a_.motion, now_) +
                        step * (b_.motion.translation - a_.motion.translation);
        return dot(normal, between) - b_.extent(rotation_b_, -turned_b) - a_.extent(rotation_a_, turned_a) - radii_;
    }

private:
    void place(double t) {
        now_ = t;
        if (!placed_ || a_.turns()) rotation_a_ = exact_rotation(rotation_at(a_.motion, t));
        if (!placed_ || b_.turns()) rotation_b_ = exact_rotation(rotation_at(b_.motion, t));
        placed_ = true;
        origin_a_ = a_.origin(t, rotation_a_);
        difference_.translation = transpose_multiply(rotation_a_, b_.origin(t, rotation_b_) - origin_a_);
        difference_.rotation = {transpose_multiply(rotation_a_, rotation_b_.x),
                                transpose_multiply(rotation_a_, rotation_b_.y),
                                transpose_multiply(rotation_a_, rotation_b_.z)};
        difference_.size = size_ + largest_component(difference_.translation);
    }
    void start() {
        Vec3d centre = difference_.centre();
        if (!(largest_component(centre) > 0.0)) centre = {0.0, 1.0, 0.0};
        simplex_.add(difference_.support(-centre));
    }

    const Mover &a_, &b_;
    double size_, radii_, now_ = 0.0;
    CoreDifference difference_;
    Simplex simplex_;
    Mat3d rotation_a_{}, rotation_b_{};
    Vec3d origin_a_{};
    bool placed_ = false;
};

// A plane, which the separating plane always is.
class PlaneProbe {
public:
    PlaneProbe(const Mover& a, const Mover& b) : a_(a), b_(b) {}

    Nearest at(double t) {
        now_ = t;
        rotation_a_ = exact_rotation(rotation_at(a_.motion, t)),
        rotation_b_ = exact_rotation(rotation_at(b_.motion, t));
        normal_ = rotation_a_ * to_double(a_.shape.size);
        Vec3d lowest =
            pivot_at(b_.motion, t) + rotation_b_ * (support_point(b_.shape, transpose_multiply(rotation_b_, -normal_)) -
                                                    to_double(b_.motion.local_pivot));
        double height = dot(normal_, lowest - a_.origin(t, rotation_a_)) - a_.shape.offset;
        double separation = height - b_.shape.rounding;
        foot_ = lowest - height * normal_;
        depth_ = -separation;
        return {false, separation, separation, normal_, foot_};
    }
    double penetration(CastHit& hit) const {
        hit.normal = normal_, hit.point = foot_;
        return depth_;
    }
    double smaller_size() const { return core_size(b_.shape) + b_.shape.rounding; }
    double size() const { return smaller_size(); }
    // A plane that turns has points everywhere: nothing is known but the moment.
    double separation_after(double step, Vec3d normal) const {
        if (a_.turns()) return -1.0;
        Vec3d between = pivot_at(b_.motion, now_) - a_.origin(now_, rotation_a_) +
                        step * (b_.motion.translation - a_.motion.translation);
        Vec3d turned = normal + step * cross(normal, b_.spin);
        return dot(normal, between) - b_.extent(rotation_b_, -turned) - a_.shape.offset - b_.shape.rounding;
    }

private:
    const Mover &a_, &b_;
    double now_ = 0.0, depth_ = 0.0;
    Mat3d rotation_a_{}, rotation_b_{};
    Vec3d normal_{}, foot_{};
};

// How far the fraction may grow before the shapes can touch, given their separation along a normal. At least what the
// fastest approach of any two points allows; where one turns, a longer step is tried and kept where it is proven.
template <class Probe>
double safe_step(const Probe& probe, const Mover& a, const Mover& b, const Nearest& now, double gap, double left) {
    double speed = -dot(now.normal, b.motion.translation - a.motion.translation);
    if (!a.turns() && !b.turns()) return speed > 0.0 ? gap / speed : 2.0 * left + 1.0;
    double fastest = speed + length(cross(a.spin, now.normal)) * a.reach + length(cross(b.spin, now.normal)) * b.reach;
    if (!(fastest > 0.0)) return 2.0 * left + 1.0;
    double sure = gap / fastest;
    // Points leave their tangents by at most (angle)^2 / 2 times their distance from the pivot.
    double bend = 0.5 * (dot(a.spin, a.spin) * a.reach + dot(b.spin, b.spin) * b.reach);
    double slope = (probe.separation_after(sure, now.normal) - now.lower) / sure;  // of the separation, at most
    double root = slope + square_root(slope * slope + 4.0 * bend * gap);
    double longer = bend > 0.0 ? minimum(root / (2.0 * bend), left) : left;
    for (int i = 0; i < 4 && longer > sure; ++i, longer *= 0.7)
        if (probe.separation_after(longer, now.normal) - bend * longer * longer >= now.lower - gap) return longer;
    return sure;
}

// How fast the shapes part where they are nearest.
double parting_speed(const Mover& a, const Mover& b, const Nearest& now, double t) {
    Vec3d of_a = a.motion.translation + cross(a.spin, now.on_a - pivot_at(a.motion, t));
    Vec3d of_b = b.motion.translation + cross(b.spin, now.on_a - pivot_at(b.motion, t));
    return dot(now.normal, of_b - of_a);
}

// Shapes that touch at fraction 0 and part while one turns: the fraction at which they are clear of each other or
// approach again, by doubling; beyond the limit where they only part.
template <class Probe>
double clear_of_start(Probe& probe, const Mover& a, const Mover& b, double size, double limit) {
    double t = 1.0 / 1024.0;
    for (; t <= limit; t *= 2.0) {
        Nearest now = probe.at(t);
        if (now.overlapping || now.upper > size || !(parting_speed(a, b, now, t) > 0.0)) break;
    }
    return t;
}

template <class Probe>
bool advance(Probe& probe, const Mover& a, const Mover& b, double max_fraction, CastHit& hit) {
    bool turning = a.turns() || b.turns();
    hit = {};
    Nearest before{};
    for (double t = 0.0;; ++hit.rounds) {
        Nearest now = probe.at(t);
        double size = turning ? near_turning * probe.smaller_size() + near_of_larger_turning * probe.size()
                              : near_linear * probe.smaller_size() + near_of_larger * probe.size();
        if (hit.rounds == 0 && (now.overlapping || now.upper < 0.0)) {
            double depth = probe.penetration(hit);
            hit.fraction = 0.0;
            hit.overlapping = depth > size;
            if (hit.overlapping) return true;
            now = {false, 0.0, 0.0, hit.normal, hit.point};  // they touch: what counts is where they go
        }
        if (turning && hit.rounds == 0 && now.upper <= size && parting_speed(a, b, now, t) > 0.0) {
            t = clear_of_start(probe, a, b, size, max_fraction);
            if (t > max_fraction) return false;
            before = now;
            continue;
        }
        if (now.overlapping) now = before, now.lower = now.upper = 0.0;  // rounding: the last step ended at the surface
        double speed = -dot(now.normal, b.motion.translation - a.motion.translation);
        bool leaving = !turning && !(speed > 0.0);
        if (leaving) return false;
        if (now.upper <= size || now.lower <= 0.5 * size || hit.rounds == most_rounds) {
            // What is left of the gap is closed at the present speed, a step that is as sure as the others.
            if (!turning && now.lower > 0.0) t += now.lower / speed;
            hit.fraction = t, hit.normal = now.normal, hit.point = now.on_a;
            return t <= max_fraction;
        }
        // Aimed a little short of touching, so that there is a direction between the shapes next time.
        t += safe_step(probe, a, b, now, now.lower - 0.25 * size, max_fraction - t);
        if (t > max_fraction) return false;
        before = now;
    }
}

// Whether a one-sided triangle with this front lets through what touches it with this normal: from behind, or along an
// edge from its own plane on.
bool passes_from_behind(Vec3d normal, Vec3d front) { return dot(normal, front) < -1e-6; }

// A box or ball on its way, which a shape never leaves, seen from a mesh that does not turn.
struct SolidPath {
    Vec3d from, along, half;
    double radius;  // of the ball; negative: it is the box
    double slack;   // what stays that far apart is not hit
    const Mover& shape;
    Mat3d rotation;  // of the shape at the start, seen from the mesh

    // Whether it stays outside a plane, given with a normal of any length, up to that fraction.
    bool stays_outside(Vec3d normal, Vec3d point, double fraction, double more_slack) const {
        const Vec3d size{absolute(normal.x), absolute(normal.y), absolute(normal.z)};
        const double begin = dot(normal, from - point), end = begin + fraction * dot(normal, along);
        const double reach = radius < 0.0 ? dot(size, half) : radius * length(normal);
        return minimum(begin, end) > reach + (slack + more_slack) * (size.x + size.y + size.z);
    }
    // Whether it certainly passes by a triangle: above or below its plane, or beyond one of its sides.
    bool misses(const Vec3 (&corners)[3], Vec3 front, double fraction) const {
        const Vec3d p[3] = {to_double(corners[0]), to_double(corners[1]), to_double(corners[2])}, n = to_double(front);
        double far = 0.0;
        for (Vec3d corner : p) far = maximum(far, largest_component(corner - from));
        const double more = 8.0 * near_of_larger_turning * far;
        if (stays_outside(n, p[0], fraction, more) || stays_outside(-n, p[0], fraction, more)) return true;
        for (int i = 0; i < 3; ++i)
            if (stays_outside(cross(p[(i + 1) % 3] - p[i], n), p[i], fraction, more)) return true;
        if (radius < 0.0) return false;
        // As the shape lies at the start, and farther by how far it turns.
        const Vec3d away = dot(n, from - p[0]) < 0.0 ? -n : n;
        const double begin = dot(away, from - p[0]), end = begin + fraction * dot(away, along);
        const double turned = absolute(static_cast<double>(shape.motion.angle)) * radius;
        const double low = shape.extent(rotation, -away) + shape.shape.rounding + turned;
        return minimum(begin, end) > low + 2.0 * (slack + more);
    }
};

bool cast_triangles(const Geometry& mesh, const Motion& motion_a, const Geometry& b, const Motion& motion_b,
                    double max_fraction, CastHit& hit, bool fresh_only) {
    // B's path seen from the mesh: a box about B's pivot that holds B however it turns, and moves as B does.
    Mat3d r = exact_rotation(motion_a.rotation);
    Mover mover(b, motion_b);
    Vec3d local_a = to_double(motion_a.local_pivot),
          from = transpose_multiply(r, motion_b.pivot - motion_a.pivot) + local_a;
    Vec3d along = transpose_multiply(r, motion_b.translation - motion_a.translation);
    Quat turn = conjugate(motion_a.rotation) * motion_b.rotation;
    double reach = mover.reach + b.rounding;
    Vec3d half{reach, reach, reach};
    if (!mover.turns()) {
        CentredBox box = bounds(b, turn);
        from += to_double(box.centre) - exact_rotation(turn) * to_double(motion_b.local_pivot);
        half = to_double(box.half);
    }
    if (motion_a.angle != 0.0f) {
        // The mesh turns: B's path in its frame bends by no more than the turn times B's distance from the pivot.
        double far = length(from - local_a) + length(along) + length(half);
        double bend = absolute(static_cast<double>(motion_a.angle)) * far;
        half += Vec3d{bend, bend, bend};
    }
    bool any = false;
    double limit = max_fraction;
    const TriangleSurface surface(mesh);
    const SolidPath path{from,
                         along,
                         half,
                         mover.turns() ? reach : -1.0,
                         path_slack * reach + near_of_larger_turning * length(along),
                         mover,
                         exact_rotation(turn)};
    walk_along(surface, {from, along, half}, limit, [&](uint32_t index) {
        Vec3 corners[3];
        surface.corners(index, corners);
        if (motion_a.angle == 0.0f && path.misses(corners, surface.normal(index), limit)) return limit;
        Geometry core;
        core.kind = GeometryKind::triangle;
        core.triangle = corners;
        CastHit found;
        if (!cast_convex(core, motion_a, b, motion_b, limit, found)) return limit;
        if (fresh_only && found.overlapping) return limit;
        if (surface.one_sided()) {
            Mat3d turned = exact_rotation(rotation_at(motion_a, found.fraction));
            if (passes_from_behind(found.normal, turned * to_double(surface.normal(index)))) return limit;
        }
        auto original = static_cast<int32_t>(surface.original(index));
        bool first =
            !any || found.fraction < hit.fraction || (found.fraction == hit.fraction && original < hit.triangle);
        if (!first) return limit;
        any = true;
        hit = found;
        hit.triangle = original;
        return limit = found.fraction;
    });
    return any;
}

}  // namespace

Quat rotation_at(const Motion& motion, double fraction) {
    if (motion.angle == 0.0f || fraction == 0.0) return motion.rotation;
    return rotation_about(motion.axis, static_cast<float>(fraction * motion.angle)) * motion.rotation;
}

bool cast_convex(const Geometry& a, const Motion& motion_a, const Geometry& b, const Motion& motion_b,
                 double max_fraction, CastHit& hit) {
    Mover mover_a(a, motion_a), mover_b(b, motion_b);
    ConvexProbe probe(mover_a, mover_b);
    return advance(probe, mover_a, mover_b, max_fraction, hit);
}

bool cast_shapes(const Geometry& a, const Motion& motion_a, const Geometry& b, const Motion& motion_b,
                 double max_fraction, CastHit& hit, bool fresh_only) {
    if (has_triangles(a)) return cast_triangles(a, motion_a, b, motion_b, max_fraction, hit, fresh_only);
    bool met;
    if (a.kind == GeometryKind::plane) {
        Mover mover_a(a, motion_a), mover_b(b, motion_b);
        PlaneProbe probe(mover_a, mover_b);
        met = advance(probe, mover_a, mover_b, max_fraction, hit);
    } else {
        met = cast_convex(a, motion_a, b, motion_b, max_fraction, hit);
    }
    return met && !(fresh_only && hit.overlapping);
}

}  // namespace lendulet
