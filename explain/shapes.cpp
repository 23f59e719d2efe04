#include "explain/shapes.h"

#include <charconv>
#include <cmath>
#include <vector>

#include "io/file.h"

namespace lendulet::explain {
namespace {

std::vector<std::string> split(const std::string& text, char by) {
    std::vector<std::string> parts;
    for (size_t begin = 0; begin <= text.size();) {
        size_t end = std::min(text.find(by, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

Error bad(const std::string& text, const std::string& why) {
    return {ErrorCode::bad_query, "\"" + printable(text) + "\": " + why};
}

Result<std::vector<float>> numbers(const std::string& whole, const std::string& list, size_t count) {
    std::vector<float> out;
    for (const std::string& part : split(list, ',')) {
        float x = 0.0f;
        auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), x);
        if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(x))
            return bad(whole, "\"" + printable(part) + "\" is no number");
        out.push_back(x);
    }
    if (out.size() == count) return out;
    return bad(whole, "there must be " + std::to_string(count) + " numbers, not " + std::to_string(out.size()));
}

// Points spread over a ball by the golden angle.
std::vector<Vec3> ball_points(int count, float radius) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        float y = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        SinCos a = sin_cos(2.3999632f * static_cast<float>(i));
        float r = std::sqrt(1.0f - y * y);
        points.push_back(radius * Vec3{r * a.cos, y, r * a.sin});
    }
    return points;
}

Result<Shape> solid_of(const std::string& whole, const std::string& kind, const std::string& list) {
    struct Kind {
        const char* name;
        size_t numbers;
    };
    constexpr Kind kinds[] = {{"box", 3},  {"sphere", 1}, {"capsule", 2},        {"cylinder", 2},
                              {"cone", 2}, {"hull", 2},   {"tapered-capsule", 3}};
    for (const Kind& k : kinds) {
        if (kind != k.name) continue;
        Result<std::vector<float>> read = numbers(whole, list, k.numbers);
        if (!read) return read.error();
        const std::vector<float>& n = read.value();
        if (kind == "box") return Shape{Box{{n[0], n[1], n[2]}}};
        if (kind == "sphere") return Shape{Sphere{n[0]}};
        if (kind == "capsule") return Shape{Capsule{n[0], n[1]}};
        if (kind == "cylinder") return Shape{Cylinder{n[0], n[1]}};
        if (kind == "cone") return Shape{Cone{n[0], n[1]}};
        if (kind == "tapered-capsule") return Shape{TaperedCapsule{n[0], n[1], n[2]}};
        if (!(n[0] >= 4.0f && n[0] <= 64.0f)) return bad(whole, "a hull has 4 to 64 points");
        Result<ConvexHull> hull = ConvexHull::from_points(ball_points(static_cast<int>(n[0]), n[1]));
        if (!hull) return bad(whole, hull.error().message);
        return Shape{hull.value()};
    }
    return bad(whole, "there are box, sphere, capsule, cylinder, cone, hull and tapered-capsule");
}

}  // namespace

Result<Placed> read_shape(const std::string& text) {
    const std::vector<std::string> parts = split(text, '@');
    const size_t colon = parts[0].find(':');
    if (colon == std::string::npos || parts.size() > 3)
        return bad(text, "a shape is KIND:NUMBERS, then perhaps @X,Y,Z and @RX,RY,RZ");
    Result<Shape> shape = solid_of(text, parts[0].substr(0, colon), parts[0].substr(colon + 1));
    if (!shape) return shape.error();
    Placed placed{shape.value(), {}};
    if (parts.size() > 1) {
        Result<std::vector<float>> at = numbers(text, parts[1], 3);
        if (!at) return at.error();
        placed.place.translation = {at.value()[0], at.value()[1], at.value()[2]};
    }
    if (parts.size() > 2) {
        Result<std::vector<float>> turn = numbers(text, parts[2], 3);
        if (!turn) return turn.error();
        const Vec3 v{turn.value()[0], turn.value()[1], turn.value()[2]};
        if (length(v) > 0.0f) placed.place.rotation = rotation_about(normalize(v), length(v) * pi / 180.0f);
    }
    return placed;
}

}  // namespace lendulet::explain
