// The part of a line inside each solid that has a closed form.
#include "collision/query/ray.h"
#include "geometry/hull.h"

namespace lendulet {
namespace {

constexpr double infinite = infinite_fraction;

// Keeps of the chord what lies in [enter, leave]; the normal is that of the later entry.
void cut(Chord& chord, double enter, double leave, Vec3d normal) {
    if (enter > chord.enter) chord.enter = enter, chord.normal = normal;
    chord.leave = minimum(chord.leave, leave);
}

// Cuts by the half space dot(normal, p) <= offset; false where all of the chord is outside.
bool cut_by_plane(const LocalRay& line, Vec3d normal, double offset, Chord& chord) {
    double height = offset - dot(normal, line.origin), along = dot(normal, line.translation);
    if (along == 0.0) return height >= 0.0;
    double t = height / along;
    if (along < 0.0) cut(chord, t, infinite, normal);
    else chord.leave = minimum(chord.leave, t);
    return chord.enter <= chord.leave;
}

// The line once more with its origin at the point nearest to the shape's centre, so that squares of large distances do
// not swallow the radius. `shift` is what must be added to fractions.
LocalRay near_centre(const LocalRay& line, double& shift) {
    shift = -dot(line.origin, line.translation) / dot(line.translation, line.translation);
    return {line.origin + shift * line.translation, line.translation, 0.0};
}

// Where A t^2 + 2 B t + C <= 0 within the chord, for a quadric that the chord cuts to a convex piece.
bool cut_by_quadratic(double a, double b, double c, Chord& chord, bool& entered) {
    double enter = chord.enter, leave = chord.leave;
    double discriminant = b * b - a * c;
    if (a > 0.0) {
        if (discriminant < 0.0) return false;
        double q = b > 0.0 ? -b - square_root(discriminant) : -b + square_root(discriminant);
        double t0 = q / a, t1 = q != 0.0 ? c / q : t0;
        enter = maximum(enter, minimum(t0, t1));
        leave = minimum(leave, maximum(t0, t1));
    } else if (a < 0.0) {
        // Inside before the first root or after the second: the two sheets of a cone, of which the chord has one.
        if (discriminant > 0.0) {
            double q = b > 0.0 ? -b - square_root(discriminant) : -b + square_root(discriminant);
            double t0 = q / a, t1 = q != 0.0 ? c / q : t0;
            double first = minimum(t0, t1), second = maximum(t0, t1);
            if (enter <= first) leave = minimum(leave, first);
            else enter = maximum(enter, second);
        }
    } else if (b != 0.0) {
        double t = -c / (2.0 * b);
        if (b > 0.0) leave = minimum(leave, t);
        else enter = maximum(enter, t);
    } else if (c > 0.0) {
        return false;
    }
    entered = enter > chord.enter;
    chord.enter = enter, chord.leave = leave;
    return enter <= leave;
}

}  // namespace

bool chord_of_ball(const LocalRay& line, Vec3d centre, double radius, Chord& chord) {
    double shift;
    LocalRay r = near_centre({line.origin - centre, line.translation, 0.0}, shift);
    double left = radius * radius - dot(r.origin, r.origin);
    if (left < 0.0) return false;
    double half = square_root(left / dot(r.translation, r.translation));
    chord = {shift - half, shift + half, (1.0 / radius) * (r.origin - half * r.translation)};
    return true;
}

// The side is x^2 + z^2 = (middle + slope y)^2.
bool chord_of_frustum(const LocalRay& line, double bottom, double top, double bottom_radius, double top_radius,
                      Chord& chord) {
    double shift;
    LocalRay r = near_centre(line, shift);
    chord = {-infinite, infinite, {}};
    if (!cut_by_plane(r, {0.0, 1.0, 0.0}, top, chord) || !cut_by_plane(r, {0.0, -1.0, 0.0}, -bottom, chord))
        return false;
    double slope = (top_radius - bottom_radius) / (top - bottom), middle = bottom_radius - slope * bottom;
    Vec3d o = r.origin, d = r.translation;
    double radius_at = middle + slope * o.y, widening = slope * d.y;
    double a = d.x * d.x + d.z * d.z - widening * widening;
    double b = o.x * d.x + o.z * d.z - widening * radius_at;
    double c = o.x * o.x + o.z * o.z - radius_at * radius_at;
    bool side = false;
    if (!cut_by_quadratic(a, b, c, chord, side)) return false;
    if (side) {
        Vec3d p = o + chord.enter * d;
        Vec3d n{p.x, -slope * (middle + slope * p.y), p.z};
        double size = length(n);
        // At the tip there is no normal: against the line is one of those between which it lies.
        chord.normal = size > 1e-12 * (absolute(middle) + absolute(slope)) ? (1.0 / size) * n : (-1.0 / length(d)) * d;
    }
    chord.enter += shift, chord.leave += shift;
    return true;
}

// The union of both balls and of the frustum between the circles along which their common tangents touch them.
bool chord_of_two_balls(const LocalRay& line, double half_height, double bottom_radius, double top_radius,
                        Chord& chord) {
    Chord part;
    bool any = false;
    auto add = [&] {
        if (!any || part.enter < chord.enter) chord.enter = part.enter, chord.normal = part.normal;
        chord.leave = any ? maximum(chord.leave, part.leave) : part.leave;
        any = true;
    };
    if (chord_of_ball(line, {0.0, -half_height, 0.0}, bottom_radius, part)) add();
    if (top_radius > 0.0 && chord_of_ball(line, {0.0, half_height, 0.0}, top_radius, part)) add();
    double sine = (bottom_radius - top_radius) / (2.0 * half_height);
    if (absolute(sine) >= 1.0) return any;  // one ball holds the other
    double cosine = square_root((1.0 - sine) * (1.0 + sine));
    if (chord_of_frustum(line, -half_height + sine * bottom_radius, half_height + sine * top_radius,
                         cosine * bottom_radius, cosine * top_radius, part))
        add();
    return any;
}

bool chord_of_hull(const LocalRay& line, const HullData& hull, Chord& chord) {
    chord = {-infinite, infinite, {}};
    for (const HullFace& face : hull.faces)
        if (!cut_by_plane(line, to_double(face.normal), face.offset, chord)) return false;
    return true;
}

}  // namespace lendulet
