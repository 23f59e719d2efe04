// broad_phase_pictures FOLDER: draws the pictures of docs/broad-phase.md from the structures themselves, into FOLDER
// (docs/images): aabb.svg, sweep.svg and rtree.svg.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "bench/broad_phase/workload.h"
#include "bench/pictures/projection.h"
#include "broad_phase/broad_phase.h"
#include "io/file.h"
#include "lendulet/lendulet.h"

namespace lendulet::bench {
namespace {

std::vector<BroadPhaseBox> boxes_of(BroadPhaseType type, const Boxes& boxes) {
    BroadPhase structure(type, nullptr);
    structure.set_moving(boxes.data(), static_cast<int>(boxes.size()));
    Array<BroadPhaseBox> own;
    structure.boxes(own);
    return {own.begin(), own.end()};
}

// --- a shape's AABB

Dot place(const Projection& view, Position p) {
    return view.place(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
}

// A ball or a capsule is the shadow of a thick line, a box its three nearest faces.
std::string ball_or_capsule(const Projection& view, const Pose& pose, float half_height, float radius) {
    Dot a = place(view, pose * Vec3{0, -half_height, 0}), b = place(view, pose * Vec3{0, half_height, 0});
    double width = 2.0 * view.scale * static_cast<double>(radius);
    return format(
        "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#9db7e0\" stroke-width=\"%.1f\" "
        "stroke-linecap=\"round\"/>\n",
        a.x, a.y, b.x + 0.01, b.y, width);
}

std::string turned_box(const Projection& view, const Pose& pose, Vec3 half) {
    std::string path;
    for (int i = 0; i < 8; ++i) {
        for (int bit : {1, 2, 4}) {
            if (i & bit) continue;
            auto corner = [&](int k) {
                return place(view,
                             pose * Vec3{k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z});
            };
            Dot a = corner(i), b = corner(i | bit);
            path += format("M%.1f %.1fL%.1f %.1f", a.x, a.y, b.x, b.y);
        }
    }
    return "<path d=\"" + path + "\" fill=\"none\" stroke=\"#1f4e9c\" stroke-width=\"2.2\"/>\n";
}

std::string aabb_picture() {
    World world = WorldBuilder{}.no_gravity().build().value();
    const Quat tilt = normalize(Quat{0.25f, 0.1f, 0.35f, 0.85f});
    const Pose poses[] = {{{-4.2f, 0, 0}, Quat{0, 0, 0, 1}}, {{0, 0, 0}, tilt}, {{4.2f, 0, 0}, tilt}};
    const Vec3 half{1.3f, 0.7f, 0.9f};
    const Shape shapes[] = {Sphere{1.2f}, Capsule{.half_height = 1.1f, .radius = 0.5f}, Box{half}};
    for (int i = 0; i < 3; ++i) {
        world.add_static_body({.shape = shapes[i], .position = poses[i].position, .orientation = poses[i].orientation})
            .value();
    }
    world.update(1.0f / 60).value();  // boxes are those of the last step
    Projection view{62, {400, 150}, 0.25, 0.35};
    std::string body = ball_or_capsule(view, poses[0], 0, 1.2f) + ball_or_capsule(view, poses[1], 1.1f, 0.5f) +
                       turned_box(view, poses[2], half);
    world.for_each_aabb([&](const AabbView& aabb) {
        if (!aabb.leaf) return;
        const float lower[3] = {aabb.box.lower.x, aabb.box.lower.y, aabb.box.lower.z};
        const float upper[3] = {aabb.box.upper.x, aabb.box.upper.y, aabb.box.upper.z};
        body += wire_box(view, lower, upper, "stroke=\"#c0392b\" stroke-width=\"1.6\"");
    });
    return picture(800, 310, body);
}

// --- sort-and-sweep

struct Interval {
    float from, to;
};

std::vector<Interval> intervals(const std::vector<BroadPhaseBox>& boxes, int axis) {
    std::vector<Interval> all;
    for (const BroadPhaseBox& box : boxes) all.push_back({box.lower[axis], box.upper[axis]});
    std::sort(all.begin(), all.end(), [](Interval a, Interval b) { return a.from < b.from; });
    return all;
}

int overlapping(const std::vector<Interval>& all) {
    int pairs = 0;
    for (size_t i = 0; i < all.size(); ++i) {
        for (size_t j = i + 1; j < all.size() && all[j].from <= all[i].to; ++j) ++pairs;
    }
    return pairs;
}

bool meets(const BroadPhaseBox& a, const BroadPhaseBox& b) {
    bool meet = true;
    for (int d = 0; d < 3; ++d) meet = meet && a.lower[d] <= b.upper[d] && b.lower[d] <= a.upper[d];
    return meet;
}

std::string sweep_picture() {
    scenes::Random random(5);
    Boxes given;
    for (uint32_t i = 0; i < 16; ++i) {
        float x = 0.75f * static_cast<float>(i) + random.range(-0.2f, 0.2f), y = random.range(0.0f, 1.6f);
        float w = random.range(0.25f, 0.5f), h = random.range(0.3f, 0.55f);
        given.push_back({{x - w, y - h, 0}, i, {x + w, y + h, 1}, 0});
    }
    std::vector<BroadPhaseBox> boxes = boxes_of(BroadPhaseType::sweep_1, given);
    constexpr double scale = 50, x0 = 60, y0 = 175, step = 9;
    std::string body;
    int meeting = 0;
    for (const BroadPhaseBox& box : boxes) {
        int met = -1;  // itself
        for (const BroadPhaseBox& other : boxes) met += meets(box, other);
        meeting += met;
        body += format(
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\" fill-opacity=\"0.35\" "
            "stroke=\"%s\"/>\n",
            x0 + scale * static_cast<double>(box.lower[0]), y0 - scale * static_cast<double>(box.upper[1]),
            scale * static_cast<double>(box.upper[0] - box.lower[0]),
            scale * static_cast<double>(box.upper[1] - box.lower[1]), met ? "#c0392b" : "#1f4e9c",
            met ? "#c0392b" : "#1f4e9c");
    }
    std::vector<Interval> on_x = intervals(boxes, 0), on_y = intervals(boxes, 1);
    for (size_t i = 0; i < on_x.size(); ++i) {
        double at = 230 + step * static_cast<double>(i);
        body += format(
            "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#1e8449\" stroke-width=\"5\"/>\n",
            x0 + scale * static_cast<double>(on_x[i].from), at, x0 + scale * static_cast<double>(on_x[i].to), at);
    }
    for (size_t i = 0; i < on_y.size(); ++i) {
        double at = 690 + step * static_cast<double>(i);
        body += format(
            "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#b9770e\" stroke-width=\"5\"/>\n", at,
            y0 - scale * static_cast<double>(on_y[i].from), at, y0 - scale * static_cast<double>(on_y[i].to));
    }
    int all = static_cast<int>(boxes.size() * (boxes.size() - 1) / 2);
    body += text_at({x0, 30}, format("%d boxes, %d pairs of which %d overlap (red)", static_cast<int>(boxes.size()),
                                     all, meeting / 2));
    body += text_at({x0, 400}, format("a good axis, x: %d pairs of intervals overlap", overlapping(on_x)));
    body += text_at({690, 225}, "a bad axis, y:");
    body += text_at({690, 245}, format("%d pairs overlap", overlapping(on_y)));
    return picture(860, 420, body);
}

// --- R-trees

struct Level {
    std::vector<BroadPhaseBox> nodes;
    std::string drawn;
    double all = 0.0, shared = 0.0;  // volume of all nodes, and what each two of them share, m^3
};

double volume(const float lower[3], const float upper[3]) {
    double product = 1.0;
    for (int d = 0; d < 3; ++d) product *= static_cast<double>(upper[d] - lower[d]);
    return product;
}

void add_overlaps(const Projection& view, Level& level) {
    for (size_t i = 0; i < level.nodes.size(); ++i) {
        const BroadPhaseBox& a = level.nodes[i];
        level.all += volume(a.lower, a.upper);
        for (size_t j = 0; j < i; ++j) {
            const BroadPhaseBox& b = level.nodes[j];
            if (!meets(a, b)) continue;
            float lower[3], upper[3];
            for (int d = 0; d < 3; ++d) {
                lower[d] = std::max(a.lower[d], b.lower[d]);
                upper[d] = std::min(a.upper[d], b.upper[d]);
            }
            level.shared += volume(lower, upper);
            level.drawn += solid_box(view, lower, upper, "fill=\"#c0392b\" fill-opacity=\"0.16\"");
        }
    }
}

// `above` levels over the one whose nodes hold the boxes.
Level draw_level(const Projection& view, const std::vector<BroadPhaseBox>& own, int above) {
    int deepest = 0;
    for (const BroadPhaseBox& box : own) deepest = box.leaf ? deepest : std::max(deepest, box.depth);
    Level level;
    for (const BroadPhaseBox& box : own) {
        if (!box.leaf && box.depth == deepest - above) level.nodes.push_back(box);
    }
    add_overlaps(view, level);
    for (const BroadPhaseBox& node : level.nodes)
        level.drawn += wire_box(view, node.lower, node.upper, "stroke=\"#1f4e9c\" stroke-width=\"1.3\"");
    return level;
}

std::string rtree_picture() {
    Boxes given = make_boxes(Distribution::uniform, 512);
    struct Column {
        BroadPhaseType type;
        const char* title;
    };
    const Column columns[] = {{BroadPhaseType::rtree_quadratic, "R-tree by insertion, quadratic split"},
                              {BroadPhaseType::rtree_omt, "OMT"}};
    constexpr double wide = 430, high = 425;
    std::string body;
    for (int c = 0; c < 2; ++c) {
        std::vector<BroadPhaseBox> own = boxes_of(columns[c].type, given);
        body += text_at({30 + wide * c, 28}, columns[c].title, "font-weight=\"bold\"");
        for (int row = 0; row < 2; ++row) {
            Projection view{20, {165 + wide * c, 300 + high * row}};
            Level level = draw_level(view, own, 1 - row);
            body += level.drawn;
            body += text_at({30 + wide * c, 56 + high * row},
                            format("%d nodes of %.0f m³, shared (red) %.0f m³", static_cast<int>(level.nodes.size()),
                                   level.all, level.shared));
        }
    }
    return picture(2 * wide, 2 * high + 40, body);
}

}  // namespace
}  // namespace lendulet::bench

int main(int count, char** arguments) {
    using namespace lendulet;
    if (count != 2) {
        std::fprintf(stderr, "usage: broad_phase_pictures FOLDER\n");
        return 2;
    }
    const std::string folder = std::string(arguments[1]) + "/";
    write_file(folder + "aabb.svg", bench::aabb_picture()).value();
    write_file(folder + "sweep.svg", bench::sweep_picture()).value();
    write_file(folder + "rtree.svg", bench::rtree_picture()).value();
    return 0;
}
