// Faces that look at each other: the clipping of one by the other's sides, and the axes that separate boxes.
#include "explain/pair.h"

namespace lendulet::explain {
namespace {

std::vector<Vec> lifted(const ClippedFace& c, const std::vector<Vec3>& polygon) {
    std::vector<Vec> out;
    for (Vec3 p : polygon) out.push_back(wide(c.origin + p.x * c.u + p.y * c.v + p.z * c.normal));
    return out;
}

Step clip_step(const Recorder::ClipStep& c, const std::vector<Vec>& frame, const std::vector<Vec>& polygon) {
    Step step{c.side < 0 ? "the faces" : "side " + std::to_string(c.side + 1),
              std::to_string(polygon.size()) + " corners of the incident face",
              {}};
    step.marks = {solid(0, Ink::a, 0.4, true), solid(1, Ink::b, 0.4, true), face(frame, Ink::a, 0.4),
                  face(polygon, Ink::step, 0.6, 1.6)};
    if (c.side >= 0) {
        auto k = static_cast<size_t>(c.side);
        step.marks.push_back(path({frame[k], frame[(k + 1) % frame.size()]}, Ink::found, 2.6));
    }
    for (const Vec& corner : polygon) step.marks.push_back(dot(corner, Ink::step));
    return step;
}

// Both shapes' shadows on an axis through the origin of A.
Step sat_step(const Sequence& s, const std::string& name, Vec3 axis, float separation, bool chosen) {
    Step step{name + (chosen ? ": the axis of the contact" : ""), text("separation %.6g m", separation), {}};
    step.marks = {solid(0, Ink::a, 0.4), solid(1, Ink::b, 0.4)};
    const Vec n = wide(axis);
    auto shadow = [&](const std::vector<Vec>& points, double beside, Ink ink) {
        double low = 1e300, high = -1e300;
        for (const Vec& q : points) low = std::min(low, dot(n, q)), high = std::max(high, dot(n, q));
        const Vec off = beside * wide(perpendicular(axis));
        step.marks.push_back(path({low * n + off, high * n + off}, ink, chosen ? 4.5 : 3.0));
    };
    shadow(s.solids[0].corners, 0.03, Ink::a);
    shadow(s.solids[1].corners, -0.03, Ink::b);
    return step;
}

struct Axis {
    std::string name;
    Vec3 n;
};

// The fifteen axes of two boxes, without those of parallel edges.
std::vector<Axis> axes_of(const Pair& p) {
    const Vec3 units[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    const char* letters[3] = {"x", "y", "z"};
    std::vector<Axis> axes;
    for (int i = 0; i < 3; ++i) axes.push_back({std::string("face ") + letters[i] + " of A", units[i]});
    for (int k = 0; k < 3; ++k)
        axes.push_back({std::string("face ") + letters[k] + " of B", rotate(p.b_in_a.rotation, units[k])});
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            Vec3 n = cross(units[i], rotate(p.b_in_a.rotation, units[k]));
            if (length(n) > 1e-3f)
                axes.push_back({std::string("edge ") + letters[i] + " of A, " + letters[k] + " of B", normalize(n)});
        }
    return axes;
}

}  // namespace

// Which shape's face is the reference, and the clipping of the other's.
Status add_clip_steps(Sequence& out, const Pair& p, const ConvexDistance& d) {
    Face a = best_face(p.a, d.normal), b = best_face(p.b, rotate_inverse(p.b_in_a.rotation, -d.normal));
    transform_face(p.b_in_a, b);
    const bool from_b = b.count >= 3 && (a.count < 3 || -dot(b.normal, d.normal) > dot(a.normal, d.normal));
    const Face &reference = from_b ? b : a, &incident = from_b ? a : b;
    if (reference.count < 3 || incident.count < 2)
        return Error{ErrorCode::bad_query, "explain clip: the shapes do not meet with a face and a face or an edge"};
    Recorder recorder;
    ClippedFace clipped;
    clip_face(reference, incident, from_b, 1e9f, clipped, recorder);
    if (recorder.clips.empty())
        return Error{ErrorCode::bad_query, "explain clip: the faces that look at each other do not overlap"};
    const std::vector<Vec> frame = lifted(clipped, recorder.reference);
    for (const Recorder::ClipStep& c : recorder.clips)
        out.steps.push_back(clip_step(c, frame, lifted(clipped, c.polygon)));
    FacePoint kept[max_clipped_points];
    for (int i = 0; i < clipped.count; ++i) kept[i] = clipped.points[i];
    const int count = reduce_points(kept, clipped.count);
    Step last = out.steps.back();
    last.title = "the manifold";
    last.note = std::to_string(count) + " points are kept";
    for (int i = 0; i < count; ++i)
        last.marks.push_back(dot(wide(clipped.point(kept[i], kept[i].separation)), Ink::found, std::to_string(i + 1)));
    out.steps.push_back(std::move(last));
    // Best seen from above the reference face.
    out.axes = {wide(clipped.origin), wide(clipped.u), wide(clipped.v), wide(clipped.normal)};
    return {};
}

Status add_sat_steps(Sequence& out, const Pair& p) {
    if (!is_sharp_box(p.a) || !is_sharp_box(p.b))
        return Error{ErrorCode::bad_query, "explain sat: both shapes must be boxes"};
    PairCache cache;
    Manifold m;
    const int found = collide({&p.a, &p.b, {}, p.b_in_a.rotation, p.b_in_a.translation, 1e3f}, cache, {}, &m, 1);
    for (const Axis& axis : axes_of(p)) {
        const Vec3 n = dot(axis.n, p.b_in_a.translation) < 0.0f ? -axis.n : axis.n;
        const Vec3 in_b = rotate_inverse(p.b_in_a.rotation, -n);
        float separation =
            dot(n, p.b_in_a.translation) - dot(in_b, support_core(p.b, in_b)) - dot(n, support_core(p.a, n));
        out.steps.push_back(
            sat_step(out, axis.name, n, separation, found == 1 && absolute(dot(n, m.normal)) > 0.99999f));
    }
    return {};
}

}  // namespace lendulet::explain
