// ConvexHull::from_points: checks, the lattice, the hull's triangles, and HullData from its polygons.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "geometry/hull.h"
#include "geometry/hull_mass.h"
#include "geometry/hull_polygons.h"
#include "geometry/quickhull.h"
#include "lendulet/shapes.h"

namespace lendulet {

namespace {

using Vec3d = Vec3T<double>;
constexpr uint32_t none = ~0u;
constexpr uint32_t most_vertices = 65535;
constexpr float largest_coordinate = 1e5f, smallest_size = 1e-4f;  // m

// All as fractions of the largest extent of the points. Rounding of coordinates makes plane faces uneven by a few 6e-8
// of the distance from the origin; what stands out by less than `corner_tolerance` is that, or of no consequence.
constexpr double flat_fraction = 2e-6;  // thinner than this is flat
constexpr double least_tolerance = 3e-7, most_tolerance = 1e-6;
constexpr double face_tolerance_factor = 3.0;  // corners of one face lie in its plane within 3 corner tolerances

Error error(ErrorCode code, const std::string& text) { return {code, "ConvexHull: " + text}; }

// The first reason to refuse the points, or an empty message.
Error check_points(std::span<const Vec3> points, float rounding) {
    if (!(rounding - rounding == 0.0f)) return error(ErrorCode::non_finite, "rounding is not finite.");
    if (rounding < 0.0f || rounding > 1e4f)
        return error(ErrorCode::bad_extent, "rounding must lie between 0 and 1e4 m.");
    for (size_t i = 0; i < points.size(); ++i) {
        float largest = max_component(absolute(points[i]));
        Vec3 zero = points[i] - points[i];
        if (!(zero == Vec3{})) return error(ErrorCode::non_finite, "point " + std::to_string(i) + " is not finite.");
        if (largest > largest_coordinate) {
            return error(ErrorCode::bad_extent, "point " + std::to_string(i) + " has a coordinate beyond 1e5 m.");
        }
    }
    if (points.size() < 4) {
        return error(ErrorCode::degenerate_hull,
                     "four points are needed, but there are " + std::to_string(points.size()) + ".");
    }
    return {ErrorCode::degenerate_hull, {}};
}

Error flat_error(Rank rank) {
    const char* what = rank == Rank::point ? "coincide" : rank == Rank::line ? "lie on one line" : "lie in one plane";
    return error(ErrorCode::degenerate_hull, std::string("all points ") + what + ".");
}

struct Limits {
    Vec3 lower, upper;
};
Limits limits_of(std::span<const Vec3> points) {
    Limits r{points[0], points[0]};
    for (Vec3 p : points) r = {minimum(r.lower, p), maximum(r.upper, p)};
    return r;
}

// The points on a lattice of 2^40 steps along their largest extent, and tolerances in its units.
struct Lattice {
    std::vector<LatticePoint> points;
    double corner_tolerance, face_tolerance, flat;
};
Lattice make_lattice(std::span<const Vec3> points, Limits limits) {
    Vec3d lower{limits.lower.x, limits.lower.y, limits.lower.z};
    double size = 0.0, reach = 0.0;
    for (int k = 0; k < 3; ++k) {
        double low = component(limits.lower, k), high = component(limits.upper, k);
        size = high - low > size ? high - low : size;
        reach += -low > high ? -low : high;
    }
    constexpr auto steps = static_cast<double>(int64_t{1} << lattice_bits);
    double tolerance = 3.0 * 0x1p-24 * reach / size;
    tolerance = tolerance < least_tolerance ? least_tolerance : tolerance > most_tolerance ? most_tolerance : tolerance;
    Lattice lattice{{}, tolerance * steps, face_tolerance_factor * tolerance * steps, flat_fraction * steps};
    double scale = steps / size;
    auto whole = [&](double a) { return static_cast<int64_t>(scale * a + 0.5); };
    lattice.points.reserve(points.size());
    for (Vec3 p : points) lattice.points.push_back({whole(p.x - lower.x), whole(p.y - lower.y), whole(p.z - lower.z)});
    return lattice;
}

// The hull's triangles. Each pass leaves out corners that only rounding made; what then stands out of the new hull by
// more than the tolerance comes back in, so that the passes cannot drift.
Rank build_surface(const Lattice& lattice, TriangleSurface& surface) {
    std::vector<double> slack(lattice.points.size(), lattice.corner_tolerance);
    Rank rank = quickhull(lattice.points, slack, lattice.flat, surface);
    if (rank != Rank::space) return rank;
    size_t corners = surface.triangle_count() / 2 + 2;  // Euler
    for (int pass = 0; pass < 4; ++pass) {
        std::vector<uint32_t> kept = essential_corners(lattice.points, surface, lattice.face_tolerance);
        if (kept.size() == corners) break;
        constexpr double always = 1.0;
        slack.assign(lattice.points.size(), lattice.face_tolerance);
        for (uint32_t v : kept) slack[v] = always;
        TriangleSurface simpler;
        if (quickhull(lattice.points, slack, lattice.flat, simpler) != Rank::space) break;
        surface = std::move(simpler);
        if (surface.triangle_count() / 2 + 2 == corners) break;
        corners = surface.triangle_count() / 2 + 2;
    }
    return rank;
}

// Position along a curve that keeps neighbours together (Morton 1966): the bits of the coordinates interleaved.
uint64_t morton_code(LatticePoint p) {
    auto spread = [](int64_t a) {
        uint64_t x = static_cast<uint64_t>(a) >> (lattice_bits - 20) & 0x1fffff;
        x = (x | x << 32) & 0x1f00000000ffff;
        x = (x | x << 16) & 0x1f0000ff0000ff;
        x = (x | x << 8) & 0x100f00f00f00f00f;
        x = (x | x << 4) & 0x10c30c30c30c30c3;
        return (x | x << 2) & 0x1249249249249249;
    };
    return spread(p.x) | spread(p.y) << 1 | spread(p.z) << 2;
}

// The points that are corners, in the order in which the hull will hold them.
std::vector<uint32_t> corners_in_order(const PolygonSurface& polygons, std::span<const LatticePoint> points) {
    std::vector<uint32_t> corners(polygons.origin);
    std::sort(corners.begin(), corners.end());  // order: total, equal numbers are the same
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    if (corners.size() > scanned_vertices) {
        std::vector<std::pair<uint64_t, uint32_t>> keyed;
        for (uint32_t c : corners) keyed.push_back({morton_code(points[c]), c});
        std::sort(keyed.begin(), keyed.end());  // order: total, no index comes twice
        for (size_t i = 0; i < keyed.size(); ++i) corners[i] = keyed[i].second;
    }
    return corners;
}

void set_lanes(const std::vector<Vec3>& values, std::vector<float>& xs, std::vector<float>& ys,
               std::vector<float>& zs) {
    size_t padded = (values.size() + 15) / 16 * 16;
    xs.resize(padded), ys.resize(padded), zs.resize(padded);
    for (size_t i = 0; i < padded; ++i) {
        Vec3 v = i < values.size() ? values[i] : values.back();
        xs[i] = v.x, ys[i] = v.y, zs[i] = v.z;
    }
}

// The slack covers the rounding of a dot product of three terms, below 3 * 2^-23 of the sum of their sizes, twice.
void make_clusters(HullData& hull) {
    if (hull.vertices.size() <= scanned_vertices) return;
    HullClusters& c = hull.clusters;
    c.count = static_cast<uint32_t>((hull.vertices.size() + 15) / 16);
    std::vector<Vec3> centres, halves;
    for (size_t first = 0; first < hull.vertices.size(); first += 16) {
        size_t count = std::min<size_t>(16, hull.vertices.size() - first);
        Limits box = limits_of({&hull.vertices[first], count});
        Vec3 size = maximum(absolute(box.lower), absolute(box.upper));
        centres.push_back(0.5f * (box.lower + box.upper));
        halves.push_back(0.5f * (box.upper - box.lower) + 1e-6f * size);
    }
    set_lanes(centres, c.centre.xs, c.centre.ys, c.centre.zs);
    set_lanes(halves, c.half.xs, c.half.ys, c.half.zs);
}

// See HullData::outlines.
void make_outline(HullData& hull, HullFace& face) {
    Vec3 u = perpendicular(face.normal), v = cross(face.normal, u);
    face.outline = static_cast<uint32_t>(hull.outlines.size());
    for (int k = 0; k < 32; ++k) {
        SinCos angle = sin_cos(static_cast<float>(k) * (pi / 16.0f));
        Vec3 d = angle.cos * u + angle.sin * v;
        uint32_t best = hull.edges[face.first_edge].origin;
        for (uint32_t e = face.first_edge; e < face.first_edge + face.edge_count; ++e) {
            uint32_t origin = hull.edges[e].origin;
            if (dot(hull.vertices[origin], d) > dot(hull.vertices[best], d)) best = origin;
        }
        bool repeated = hull.outlines.size() > face.outline &&
                        (best == hull.outlines.back() || best == hull.outlines[face.outline]);
        if (!repeated) hull.outlines.push_back(best);
    }
    face.outline_count = static_cast<uint32_t>(hull.outlines.size()) - face.outline;
}

// normal.p rounded up, so that no corner of the face lies in front of its plane.
float offset_above(Vec3 normal, Vec3 p) {
    double exact = dot(Vec3d{normal.x, normal.y, normal.z}, Vec3d{p.x, p.y, p.z});
    auto rounded = static_cast<float>(exact);
    return rounded < exact ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

void make_faces(HullData& hull, const PolygonSurface& polygons) {
    std::vector<Vec3> normals;
    for (uint32_t f = 0; f < polygons.face_count(); ++f) {
        Vec3d n = polygons.normal[f];
        HullFace face{};
        face.normal = normalize(Vec3{static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
        face.first_edge = polygons.first[f];
        face.edge_count = polygons.first[f + 1] - face.first_edge;
        face.offset = -std::numeric_limits<float>::infinity();
        for (uint32_t e = face.first_edge; e < face.first_edge + face.edge_count; ++e) {
            hull.edges[e].face = f;
            face.offset = maximum(offset_above(face.normal, hull.vertices[hull.edges[e].origin]), face.offset);
        }
        if (face.edge_count > 32) make_outline(hull, face);
        hull.faces.push_back(face);
        normals.push_back(face.normal);
    }
    set_lanes(normals, hull.normals.xs, hull.normals.ys, hull.normals.zs);
}

std::shared_ptr<const HullData> assemble(std::span<const Vec3> points, const Lattice& lattice,
                                         const PolygonSurface& polygons) {
    auto data = std::make_shared<HullData>();
    HullData& hull = *data;
    std::vector<uint32_t> corners = corners_in_order(polygons, lattice.points), number(points.size(), none);
    for (uint32_t i = 0; i < corners.size(); ++i) {
        number[corners[i]] = i;
        hull.vertices.push_back(points[corners[i]]);
        hull.radius = maximum(length(hull.vertices.back()), hull.radius);
    }
    hull.vertex_edge.assign(corners.size(), none);
    for (uint32_t e = 0; e < polygons.origin.size(); ++e) {
        uint32_t vertex = number[polygons.origin[e]];
        hull.edges.push_back({vertex, polygons.twin[e], 0});
        if (hull.vertex_edge[vertex] == none) hull.vertex_edge[vertex] = e;
    }
    set_lanes(hull.vertices, hull.xs, hull.ys, hull.zs);
    make_clusters(hull);
    make_faces(hull, polygons);
    Limits limits = limits_of(hull.vertices);
    hull.lower = limits.lower, hull.upper = limits.upper;
    hull.dropped_points = static_cast<int>(points.size() - corners.size());
    set_hull_mass(hull);
    return data;
}

}  // namespace

Result<ConvexHull> ConvexHull::from_points(std::span<const Vec3> points, float rounding) {
    Error refused = check_points(points, rounding);
    if (!refused.message.empty()) return refused;
    Limits limits = limits_of(points);
    float size = max_component(limits.upper - limits.lower);
    if (size == 0.0f) return flat_error(Rank::point);
    if (size < smallest_size) return error(ErrorCode::bad_extent, "the points lie within less than 1e-4 m.");

    Lattice lattice = make_lattice(points, limits);
    TriangleSurface surface;
    Rank rank = build_surface(lattice, surface);
    if (rank != Rank::space) return flat_error(rank);
    PolygonSurface polygons = join_coplanar(lattice.points, surface, lattice.face_tolerance);
    if (polygons.face_count() < 4) polygons = join_coplanar(lattice.points, surface, 0.0);
    size_t vertices = polygons.origin.size() / 2 + 2 - polygons.face_count();  // Euler: V = E + 2 - F
    if (vertices > most_vertices) {
        return error(ErrorCode::too_many_vertices,
                     "it has " + std::to_string(vertices) + " corners, but at most 65535 are possible.");
    }
    ConvexHull hull;
    hull.data_ = assemble(points, lattice, polygons);
    hull.rounding_ = rounding;
    return hull;
}

std::span<const Vec3> ConvexHull::vertices() const {
    return data_ ? std::span<const Vec3>(data_->vertices) : std::span<const Vec3>();
}

std::vector<uint32_t> ConvexHull::triangles() const {
    std::vector<uint32_t> indices;
    if (!data_) return indices;
    auto corner = [&](const HullFace& f, uint32_t i) { return data_->edges[f.first_edge + i].origin; };
    for (const HullFace& f : data_->faces)
        for (uint32_t i = 2; i < f.edge_count; ++i)
            for (uint32_t k : {0u, i - 1, i}) indices.push_back(corner(f, k));
    return indices;
}

int ConvexHull::face_count() const { return data_ ? static_cast<int>(data_->faces.size()) : 0; }

}  // namespace lendulet
