// Figures of a sequence: each step is drawn twice, seen along z and obliquely, at one scale for all.
#pragma once

#include <string>
#include <vector>

#include "lendulet/math.h"

namespace lendulet::explain {

using Vec = Vec3T<double>;
inline Vec wide(Vec3 v) { return {v.x, v.y, v.z}; }

// What is drawn in space. Colours are CSS names or #rrggbb; an empty one is not drawn.
struct Mark {
    enum class Kind { solid, face, path, dot, arrow } kind;
    std::vector<Vec> points;  // of a solid: its hull is drawn
    std::string stroke, fill;
    double width = 1.0, opacity = 1.0;
    std::string label;  // beside the last point
};

struct Step {
    std::string title, note;
    std::vector<Mark> marks;
};

inline Mark solid(std::vector<Vec> points, const char* stroke, const char* fill, double opacity) {
    return {Mark::Kind::solid, std::move(points), stroke, fill, 1.0, opacity, {}};
}
inline Mark face(std::vector<Vec> points, const char* stroke, const char* fill, double opacity, double width = 1.2) {
    return {Mark::Kind::face, std::move(points), stroke, fill, width, opacity, {}};
}
inline Mark path(std::vector<Vec> points, const char* stroke, double width = 1.2) {
    return {Mark::Kind::path, std::move(points), stroke, {}, width, 1.0, {}};
}
inline Mark dot(Vec p, const char* fill, std::string label = {}) {
    return {Mark::Kind::dot, {p}, {}, fill, 3.5, 1.0, std::move(label)};
}
inline Mark arrow(Vec from, Vec to, const char* stroke, std::string label = {}) {
    return {Mark::Kind::arrow, {from, to}, stroke, {}, 1.6, 1.0, std::move(label)};
}

// One document of all steps in two columns, or one of each.
std::vector<std::string> documents(const std::string& title, const std::vector<Step>& steps, bool frames);

}  // namespace lendulet::explain
