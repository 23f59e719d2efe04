// What the collision algorithms do with two shapes, step by step, as marks in space: made from the engine's own traces,
// for whoever draws them (picture.h as SVG, the viewer's page in three dimensions).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lendulet/math.h"
#include "lendulet/result.h"

namespace lendulet::explain {

using Vec = Vec3T<double>;
inline Vec wide(Vec3 v) { return {v.x, v.y, v.z}; }

// What a mark stands for; whoever draws has a colour for each.
enum class Ink : uint8_t { origin, difference, a, b, step, found };

// A convex body that marks show: its corners, and triangles of their hull, counter-clockwise from outside; none where
// it is flat. Of curved bodies the corners are many points of their surface.
struct Solid {
    std::vector<Vec> corners;
    std::vector<uint32_t> triangles;
    bool curved = false;
};

// What is drawn in space, in the frame of A.
struct Mark {
    enum class Kind : uint8_t { solid, face, path, dot, arrow } kind;
    Ink ink;
    std::vector<Vec> points;  // of a face, a path, a dot, an arrow
    int solid = -1;           // which of the sequence's
    bool faint = false;       // a solid that others are shown in front of
    double width = 1.0, opacity = 1.0;
    std::string label;  // beside the last point
};

struct Step {
    std::string title, note;
    std::vector<Mark> marks;
};

// The first two solids are A and B; the first step shows both.
struct Sequence {
    std::vector<Solid> solids;
    std::vector<Step> steps;
    std::array<Vec, 4> axes{
        Vec{}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};  // origin, x, y, z of a good view
};

inline Mark solid(int which, Ink ink, double opacity, bool faint = false) {
    return {Mark::Kind::solid, ink, {}, which, faint, 1.0, opacity, {}};
}
inline Mark face(std::vector<Vec> points, Ink ink, double opacity, double width = 1.2) {
    return {Mark::Kind::face, ink, std::move(points), -1, false, width, opacity, {}};
}
inline Mark path(std::vector<Vec> points, Ink ink, double width = 1.2) {
    return {Mark::Kind::path, ink, std::move(points), -1, false, width, 1.0, {}};
}
inline Mark dot(Vec p, Ink ink, std::string label = {}) {
    return {Mark::Kind::dot, ink, {p}, -1, false, 3.5, 1.0, std::move(label)};
}
inline Mark arrow(Vec from, Vec to, Ink ink, std::string label = {}) {
    return {Mark::Kind::arrow, ink, {from, to}, -1, false, 1.6, 1.0, std::move(label)};
}

// `what`: gjk, epa, distance (both, one after the other), clip or sat; shapes as read_shape takes them; `simplex`:
// half-space or barycentric. Errors: a name or shape that is not known, shapes for which there is nothing to see (a
// depth where there is no overlap).
struct Question {
    std::string what, a, b;
    std::string simplex = "half-space";
};
Result<Sequence> sequence(const Question& question);

}  // namespace lendulet::explain
