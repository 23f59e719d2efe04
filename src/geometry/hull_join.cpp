#include "geometry/hull_polygons.h"

namespace lendulet {

namespace {

using Vec3d = Vec3T<double>;
constexpr uint32_t none = ~0u;

double absolute_value(double a) { return a < 0.0 ? -a : a; }

// A surface of linked half edges whose faces are joined one edge at a time. Every step leaves a closed surface of
// convex faces behind, so it can stop anywhere.
class Joiner {
public:
    Joiner(std::span<const LatticePoint> points, const TriangleSurface& surface, double tolerance)
        : points_(points), tolerance_(tolerance), origin_(surface.corner), twin_(surface.twin) {
        auto edges = static_cast<uint32_t>(origin_.size());
        next_.resize(edges), previous_.resize(edges), face_.resize(edges);
        for (uint32_t e = 0; e < edges; ++e) {
            next_[e] = e % 3 == 2 ? e - 2 : e + 1;
            previous_[e] = e % 3 == 0 ? e + 2 : e - 1;
            face_[e] = e / 3;
        }
        for (uint32_t t = 0; t < surface.triangle_count(); ++t) {
            normals_.push_back(triangle_normal(points, surface, t));
            edge_of_.push_back(3 * t);
        }
        joined_.resize(surface.triangle_count(), false);
        region_.resize(surface.triangle_count(), none);
    }

    PolygonSurface run() {
        for (uint32_t face : triangles_by_area(normals_))
            if (edge_of_[face] != none && !joined_[face] && !join_region(face)) grow(face);
        return write();
    }

private:
    Vec3d at(uint32_t edge) const { return to_double(points_[origin_[edge]]); }

    // Whether the corner behind `edge` lies in the plane of a face and the face's normal agrees.
    bool coplanar(uint32_t edge, Vec3d origin, Vec3d normal) const {
        return dot(normal, normals_[face_[edge]].unit) >= same_face_cosine &&
               absolute_value(dot(normal, at(next_[next_[edge]]) - origin)) <= 2.0 * tolerance_;
    }

    // Joins all triangles in one plane with the face at once, if together they make a convex polygon. Taken one by one
    // they might not: three triangles around one in the middle of a hexagon.
    bool join_region(uint32_t face) {
        Vec3d origin = at(edge_of_[face]), normal = normals_[face].unit;
        std::vector<uint32_t> members{face}, doors;
        region_[face] = face;
        for (size_t i = 0; i < members.size(); ++i) {
            for (uint32_t e = 3 * members[i]; e < 3 * members[i] + 3; ++e) {
                uint32_t twin = twin_[e], other = face_[twin];
                if (region_[other] == face || joined_[other] || !coplanar(twin, origin, normal)) continue;
                region_[other] = face;
                members.push_back(other);
                doors.push_back(e);
            }
        }
        if (doors.empty() || !outline_is_convex(members, face)) return false;
        for (uint32_t e : doors) edge_of_[face] = join(e);
        for (uint32_t m : members) joined_[m] = true;
        return true;
    }

    bool outline_is_convex(const std::vector<uint32_t>& members, uint32_t region) const {
        auto inside = [&](uint32_t edge) { return region_[face_[edge]] == region && !joined_[face_[edge]]; };
        uint32_t borders = 0, start = none;
        for (uint32_t t : members)
            for (uint32_t e = 3 * t; e < 3 * t + 3; ++e)
                if (!inside(twin_[e])) start = e, ++borders;
        if (borders != members.size() + 2) return false;  // Euler: not a disc, or corners lie inside of it
        uint32_t steps = 0, straight = 0, e = start;
        do {
            uint32_t out = next_[e];
            while (inside(twin_[out])) out = next_[twin_[out]];
            Junction j = junction(e, out);
            if (!junction_fits(j, normals_[region].unit)) return false;
            if (j.only_two_faces) ++straight;
            e = out;
            ++steps;
        } while (e != start && steps <= borders);
        return steps == borders && straight <= 1;
    }

    // Takes in neighbours until none fits, going around the outline.
    void grow(uint32_t face) {
        Vec3d origin = at(edge_of_[face]);
        uint32_t edge = edge_of_[face], start = edge;
        do {
            if (fits(edge, origin)) {
                joined_[face] = joined_[face_[twin_[edge]]] = true;
                edge = start = previous_[join(edge)];
                edge_of_[face] = edge;
            } else {
                edge = next_[edge];
            }
        } while (edge != start);
    }

    // How the corner at the start of half edge e of face A fares when A and the face B behind e become one: with
    // neighbours before and after in the joined outline, and the edges `in` and `out` that lead there.
    struct Junction {
        uint32_t in, out;
        bool only_two_faces;  // nothing but A, B and one more face meets here: the corner goes
    };
    Junction junction(uint32_t in, uint32_t out) const { return {in, out, next_[twin_[out]] == twin_[in]}; }

    bool junction_fits(const Junction& j, Vec3d normal) const {
        Vec3d before = at(j.in), corner = at(j.out), after = at(next_[j.out]);
        Vec3d line = after - before;
        double length = __builtin_sqrt(dot(line, line));
        if (!(length > 0.0)) return false;
        Vec3d turn = cross(corner - before, after - corner);
        if (!j.only_two_faces) return dot(turn, normal) >= -tolerance_ * length;
        uint32_t other = twin_[j.in];
        bool triangle = next_[next_[next_[other]]] == other;
        return !triangle && __builtin_sqrt(dot(turn, turn)) <= tolerance_ * length;
    }

    // Whether the face behind `edge` can be joined to the face of `edge`, whose plane goes through `origin`.
    bool fits(uint32_t edge, Vec3d origin) const {
        uint32_t face = face_[edge], twin = twin_[edge], other = face_[twin];
        Vec3d normal = normals_[face].unit;
        if (dot(normal, normals_[other].unit) < same_face_cosine) return false;
        for (uint32_t e = next_[next_[twin]]; e != twin; e = next_[e])
            if (absolute_value(dot(normal, at(e) - origin)) > 2.0 * tolerance_) return false;
        for (uint32_t e = next_[twin]; e != twin; e = next_[e])
            if (face_[twin_[e]] == face)
                return false;  // they share a second edge: joined, they would enclose something
        Junction a = junction(previous_[edge], next_[twin]), b = junction(previous_[twin], next_[edge]);
        if (a.only_two_faces && b.only_two_faces) return false;  // of two triangles, two corners would be left
        return junction_fits(a, normal) && junction_fits(b, normal);
    }

    // Removes `edge` and its twin; returns a half edge of the joined face.
    uint32_t join(uint32_t edge) {
        uint32_t face = face_[edge], twin = twin_[edge];
        edge_of_[face_[twin]] = none;
        Junction a = junction(previous_[edge], next_[twin]), b = junction(previous_[twin], next_[edge]);
        for (uint32_t e = next_[twin]; e != twin; e = next_[e]) face_[e] = face;
        link(a.in, a.out);
        link(b.in, b.out);
        if (a.only_two_faces) straighten(a);
        if (b.only_two_faces) straighten(b);
        return a.in;
    }
    void link(uint32_t in, uint32_t out) {
        next_[in] = out;
        previous_[out] = in;
    }
    // Takes a corner of two faces out of both: `in` then leads to where `out` led.
    void straighten(const Junction& j) {
        uint32_t back = twin_[j.out], gone = twin_[j.in];
        link(j.in, next_[j.out]);
        link(back, next_[gone]);
        twin_[j.in] = back;
        twin_[back] = j.in;
        if (edge_of_[face_[back]] == gone) edge_of_[face_[back]] = back;
    }

    // Newell's normal of the outline, the mean of all corners. A narrow strip can tip it over, and its plane would cut
    // the hull elsewhere; then the normal of the seed triangle stands, whose plane has the whole hull behind it.
    Vec3d final_normal(uint32_t face) const {
        uint32_t start = edge_of_[face];
        Vec3d sum{}, origin = at(start), seed = normals_[face].unit;
        for (uint32_t e = start; next_[e] != start; e = next_[e]) sum += cross(at(e) - origin, at(next_[e]) - origin);
        double norm = __builtin_sqrt(dot(sum, sum));
        if (!(norm > 0.0)) return seed;
        Vec3d mean = (1.0 / norm) * sum, turn = mean - seed;
        constexpr auto size = static_cast<double>(int64_t{1} << lattice_bits);
        return __builtin_sqrt(dot(turn, turn)) * size <= tolerance_ ? mean : seed;
    }

    PolygonSurface write() const {
        PolygonSurface out;
        std::vector<uint32_t> number(origin_.size(), none), taken;
        for (uint32_t face = 0; face < edge_of_.size(); ++face) {
            uint32_t start = edge_of_[face], e = start;
            if (start == none) continue;
            out.first.push_back(static_cast<uint32_t>(out.origin.size()));
            out.normal.push_back(final_normal(face));
            do {
                number[e] = static_cast<uint32_t>(out.origin.size());
                out.origin.push_back(origin_[e]);
                taken.push_back(e);
                e = next_[e];
            } while (e != start);
        }
        out.first.push_back(static_cast<uint32_t>(out.origin.size()));
        for (uint32_t e : taken) out.twin.push_back(number[twin_[e]]);
        return out;
    }

    std::span<const LatticePoint> points_;
    double tolerance_;
    std::vector<uint32_t> origin_, twin_, next_, previous_, face_;  // by half edge
    std::vector<uint32_t> edge_of_;                                 // by face; none: joined to another
    std::vector<TriangleNormal> normals_;                           // of the triangle that the face grew from
    std::vector<bool> joined_;                                      // by triangle: part of a larger face
    std::vector<uint32_t> region_;                                  // by triangle: where it was last thought to belong
};

}  // namespace

PolygonSurface join_coplanar(std::span<const LatticePoint> points, const TriangleSurface& surface, double tolerance) {
    return Joiner(points, surface, tolerance).run();
}

}  // namespace lendulet
