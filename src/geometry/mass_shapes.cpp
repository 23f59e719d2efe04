// Mass properties of every shape, from its geometry.
//
// All shapes but boxes and hulls are solids of revolution about y, whose outline is made of lines and circular arcs,
// also when they are rounded. Their integrals are taken by a Gauss rule that is exact for lines and right to the last
// digits of double precision for arcs, so one formula serves ball, capsule, cylinder, cone and what lies between.
#include "geometry/geometry.h"
#include "geometry/hull_mass.h"
#include "geometry/mass.h"
#include "geometry/mesh.h"

namespace lendulet {

namespace {

using Vec3d = Vec3T<double>;
constexpr double pi_double = 3.14159265358979323846;

Vec3 to_float(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

MassProperties diagonal(double mass, double centre_y, Vec3d inertia) {
    Vec3 i = to_float(inertia);
    return {static_cast<float>(mass), {0.0f, static_cast<float>(centre_y), 0.0f}, {i.x, i.y, i.z, 0.0f, 0.0f, 0.0f}};
}

// Abscissas and weights of the Gauss-Legendre rule of 16 points on [-1, 1]; the other half mirrors them. Exact for
// polynomials up to degree 31.
constexpr double gauss[8][2] = {{0.9894009349916499, 0.027152459411754096}, {0.9445750230732326, 0.062253523938647894},
                                {0.8656312023878318, 0.09515851168249279},  {0.755404408355003, 0.12462897125553388},
                                {0.6178762444026438, 0.14959598881657674},  {0.45801677765722737, 0.16915651939500254},
                                {0.2816035507792589, 0.18260341504492358},  {0.09501250983763744, 0.1894506104550685}};

template <class Function>
void integrate(double from, double to, Function visit) {
    double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    for (const double(&g)[2] : gauss) {
        visit(middle - half * g[0], half * g[1]);
        visit(middle + half * g[0], half * g[1]);
    }
}

// Sums over slices of a solid of revolution: discs of radius r and thickness dy.
struct Revolution {
    double r2 = 0.0, r2y = 0.0, r2yy = 0.0, r4 = 0.0;

    void slice(double y, double r, double dy) {
        double s = r * r;
        r2 += s * dy;
        r2y += s * y * dy;
        r2yy += s * y * y * dy;
        r4 += s * s * dy;
    }
    void line(double y0, double r0, double y1, double r1) {
        integrate(0.0, 1.0,
                  [&](double t, double dt) { slice(y0 + t * (y1 - y0), r0 + t * (r1 - r0), dt * (y1 - y0)); });
    }
    // An arc about (radius, y), from and to given by tan of half the angle above the horizontal: with t = tan(a / 2),
    // sin a = 2 t / (1 + t^2) and cos a = (1 - t^2) / (1 + t^2).
    void arc(double y, double radius, double arc_radius, double from, double to) {
        integrate(from, to, [&](double t, double dt) {
            double d = 1.0 / (1.0 + t * t), cosine = (1.0 - t * t) * d;
            slice(y + arc_radius * 2.0 * t * d, radius + arc_radius * cosine, arc_radius * cosine * 2.0 * d * dt);
        });
    }
    // A disc of mass m and radius r has the moments m r^2 / 2 about its axis and m r^2 / 4 about a diameter.
    MassProperties at(double density) const {
        double mass = density * pi_double * r2, centre = r2y / r2;
        double axial = density * pi_double * 0.5 * r4;
        double across = density * pi_double * (0.25 * r4 + r2yy) - mass * centre * centre;
        return diagonal(mass, centre, {across, axial, across});
    }
};

double half_tangent(double sine, double cosine) { return sine / (1.0 + cosine); }

MassProperties ball(double y, double radius, double density) {
    Revolution solid;
    solid.arc(y, 0.0, radius, -1.0, 0.0);
    solid.arc(y, 0.0, radius, 0.0, 1.0);
    return solid.at(density);
}

// The convex hull of two balls about y = -h and y = h. The line that touches both does so at the angle whose sine is
// (bottom - top) / (2 h).
MassProperties two_balls(double bottom, double h, double top, double density) {
    double sine = (bottom - top) / (2.0 * h);
    if (sine >= 1.0) return ball(-h, bottom, density);
    if (sine <= -1.0) return ball(h, top, density);
    double cosine = __builtin_sqrt((1.0 - sine) * (1.0 + sine)), t = half_tangent(sine, cosine);
    Revolution solid;
    solid.arc(-h, 0.0, bottom, -1.0, t);
    solid.line(-h + bottom * sine, bottom * cosine, h + top * sine, top * cosine);
    solid.arc(h, 0.0, top, t, 1.0);
    return solid.at(density);
}

// A truncated cone grown by a ball: between two arcs about its rims lies its side, moved outwards.
MassProperties rounded_cone(double bottom, double h, double top, double rounding, double density) {
    double taper = bottom - top, norm = __builtin_sqrt(4.0 * h * h + taper * taper);
    double sine = taper / norm, cosine = 2.0 * h / norm, t = half_tangent(sine, cosine);
    double dy = rounding * sine, dr = rounding * cosine;
    Revolution solid;
    if (rounding > 0.0) solid.arc(-h, bottom, rounding, -1.0, t);
    solid.line(-h + dy, bottom + dr, h + dy, top + dr);
    if (rounding > 0.0) solid.arc(h, top, rounding, t, 1.0);
    return solid.at(density);
}

// Second moment in x of the box with half extents (a, b, c) grown by a ball of radius r, by the parts of the sum
// (Steiner): the box, six slabs on its faces, four quarters of a cylinder along each direction, eight eighths of a
// ball.
double second_moment(double a, double b, double c, double r) {
    double aa = a * a, grown = a + r, r2 = r * r, r3 = r2 * r;
    double box = 8.0 * a * b * c * aa / 3.0;
    double slabs = 8.0 * b * c * (grown * grown * grown - aa * a) / 3.0 + 8.0 * a * (b + c) * r * aa / 3.0;
    double along = pi_double * r2 * 2.0 * a * aa / 3.0;
    double across = 2.0 * (b + c) * (pi_double * r2 * aa + 8.0 * a * r3 / 3.0 + pi_double * r2 * r2 / 4.0);
    double corners = pi_double * (4.0 * r3 * aa / 3.0 + a * r2 * r2 + 4.0 * r3 * r2 / 15.0);
    return box + slabs + along + across + corners;
}

MassProperties rounded_box(Vec3 half, double r, double density) {
    double a = half.x, b = half.y, c = half.z;
    double volume = 8.0 * a * b * c + 8.0 * (a * b + b * c + c * a) * r + 2.0 * pi_double * (a + b + c) * r * r +
                    4.0 / 3.0 * pi_double * r * r * r;
    double x = second_moment(a, b, c, r), y = second_moment(b, c, a, r), z = second_moment(c, a, b, r);
    return diagonal(density * volume, 0.0, {density * (y + z), density * (z + x), density * (x + y)});
}

// A rounded hull has the volume V + S r + M r^2 + 4/3 pi r^3 with the surface S and the integrated mean curvature M of
// the hull (Steiner). Its centre is taken to be that of the hull, and its inertia that of the hull scaled along each
// axis to the rounded extents, with the right mass: exact where the rounding is 0, within a few per cent otherwise.
MassProperties rounded_hull(const HullData& hull, double r, double density) {
    SymMat3T<double> unit{hull.unit_inertia.xx, hull.unit_inertia.yy, hull.unit_inertia.zz,
                          hull.unit_inertia.xy, hull.unit_inertia.xz, hull.unit_inertia.yz};
    double volume = hull.volume;
    if (r > 0.0) {
        HullSurface surface = hull_surface(hull);
        double grown = volume + r * (surface.area + r * (surface.mean_curvature + r * (4.0 / 3.0 * pi_double)));
        Vec3 half = 0.5f * (hull.upper - hull.lower);
        Vec3d s{1.0 + r / half.x, 1.0 + r / half.y, 1.0 + r / half.z};
        // Second moments from inertia and back: the moment in x is (yy + zz - xx) / 2.
        double trace = 0.5 * (unit.xx + unit.yy + unit.zz), to_mass = grown / volume;
        double x = s.x * s.x * (trace - unit.xx), y = s.y * s.y * (trace - unit.yy), z = s.z * s.z * (trace - unit.zz);
        unit = {to_mass * (y + z),
                to_mass * (z + x),
                to_mass * (x + y),
                to_mass * s.x * s.y * unit.xy,
                to_mass * s.x * s.z * unit.xz,
                to_mass * s.y * s.z * unit.yz};
        volume = grown;
    }
    auto scaled = [&](double a) { return static_cast<float>(density * a); };
    return {scaled(volume),
            hull.centroid,
            {scaled(unit.xx), scaled(unit.yy), scaled(unit.zz), scaled(unit.xy), scaled(unit.xz), scaled(unit.yz)}};
}

}  // namespace

MassProperties mass_properties(const Geometry& g, float density) {
    double bottom = g.size.x, h = g.size.y, top = g.size.z, r = g.rounding;
    switch (g.kind) {
        case GeometryKind::point:
            return ball(0.0, r, density);
        case GeometryKind::segment:
        case GeometryKind::tapered_capsule:
            return two_balls(bottom + r, h, top + r, density);
        case GeometryKind::box:
            return rounded_box(g.size, r, density);
        case GeometryKind::tapered_cylinder:
            return rounded_cone(bottom, h, top, r, density);
        case GeometryKind::hull:
            return rounded_hull(*g.hull, r, density);
        case GeometryKind::mesh:
            return g.hull ? rounded_hull(*g.hull, 0.0, density) : MassProperties{};
        case GeometryKind::triangle:
        case GeometryKind::plane:
        case GeometryKind::height_field:
            break;
    }
    return {};
}

MassProperties mass_properties(const Shape& shape, float density) {
    Result<Geometry> geometry = make_geometry(shape);
    return geometry ? mass_properties(geometry.value(), density) : MassProperties{};
}

}  // namespace lendulet
