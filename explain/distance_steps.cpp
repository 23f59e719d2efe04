// GJK and EPA on the Minkowski difference.
#include "explain/pair.h"

namespace lendulet::explain {

void add_gjk_steps(Sequence& out, const Recorder& trace) {
    int number = 0;
    for (const Recorder::SimplexStep& s : trace.simplices) {
        const bool inside = s.points.size() == 4 || length(s.nearest) < 1e-12;
        Step step = difference_step("simplex " + std::to_string(++number),
                                    std::to_string(s.points.size()) + (s.points.size() == 1 ? " point" : " points") +
                                        text("; O is %.6g m from them", length(s.nearest)));
        if (inside) step.note = std::to_string(s.points.size()) + " points hold O: the cores overlap";
        for (size_t i = 0; i < s.points.size(); ++i)
            for (size_t k = 0; k < i; ++k) step.marks.push_back(path({s.points[k], s.points[i]}, Ink::step, 1.4));
        if (s.points.size() == 3) step.marks.push_back(face({s.points[0], s.points[1], s.points[2]}, Ink::step, 0.5));
        for (const Vec& y : s.points) step.marks.push_back(dot(y, Ink::step));
        if (s.points.size() < 4) step.marks.push_back(arrow({}, s.nearest, Ink::a, "v"));
        if (s.has_support) step.marks.push_back(dot(s.support, Ink::found, "next"));
        out.steps.push_back(std::move(step));
    }
}

void add_epa_steps(Sequence& out, const Recorder& trace) {
    int number = 0;
    for (const Recorder::PolytopeStep& s : trace.polytopes) {
        const auto& near = s.faces[static_cast<size_t>(s.nearest)];
        Vec3d n = cross(near[1] - near[0], near[2] - near[0]);
        n = (1.0 / length(n)) * n;
        const double least = dot(n, near[0]), most = dot(n, s.support);
        Step step =
            difference_step("polytope " + std::to_string(++number) + ": " + std::to_string(s.faces.size()) + " faces",
                            text("the depth is between %.6g and %.6g m", least, most));
        for (const auto& f : s.faces) step.marks.push_back(path({f[0], f[1], f[2], f[0]}, Ink::step, 0.9));
        step.marks.push_back(face({near[0], near[1], near[2]}, Ink::step, 0.6, 1.6));
        step.marks.push_back(arrow({}, least * n, Ink::a));
        step.marks.push_back(dot(s.support, Ink::found, "next"));
        out.steps.push_back(std::move(step));
    }
}

}  // namespace lendulet::explain
