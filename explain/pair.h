// Two shapes, and what several sequences show of them.
#pragma once

#include "collision/narrow_phase.h"
#include "collision/trace.h"
#include "explain/sequence.h"
#include "lendulet/shapes.h"

namespace lendulet::explain {

struct Pair {
    Shape shape_a, shape_b;  // hulls are theirs, geometries only refer to them
    Geometry a, b;
    Transform b_in_a;
};

// A sentence of a number; `format` as for printf, with one or two %g.
std::string text(const char* format, double x, double y = 0.0);

inline constexpr int difference_solid = 2;  // after A and B
// A, B and the Minkowski difference B - A of their cores.
std::vector<Solid> solids_of(const Pair& pair);

Step shapes_step(const ConvexDistance& d);
// The difference and the origin O, to which the rest is added.
Step difference_step(std::string title, std::string note);

// The sequences. `d`: the answer that was traced.
void add_gjk_steps(Sequence& out, const Recorder& trace);
void add_epa_steps(Sequence& out, const Recorder& trace);
Status add_clip_steps(Sequence& out, const Pair& pair, const ConvexDistance& d);
Status add_sat_steps(Sequence& out, const Pair& pair);

}  // namespace lendulet::explain
