#include "explain/sequence.h"

#include "explain/pair.h"
#include "explain/shapes.h"
#include "io/file.h"

namespace lendulet::explain {
namespace {

Result<Pair> pair_of(const Question& q) {
    Result<Placed> a = read_shape(q.a), b = read_shape(q.b);
    if (!a) return a.error();
    if (!b) return b.error();
    Result<Geometry> ga = make_geometry(a.value().shape), gb = make_geometry(b.value().shape);
    if (!ga) return ga.error();
    if (!gb) return gb.error();
    return Pair{a.value().shape, b.value().shape, ga.value(), gb.value(), inverse(a.value().place) * b.value().place};
}

Status add_steps(Sequence& out, const std::string& what, const Pair& pair, const ConvexDistance& d,
                 const Recorder& trace) {
    if (what == "clip") return add_clip_steps(out, pair, d);
    if (what == "sat") return add_sat_steps(out, pair);
    if (what == "epa" && trace.polytopes.empty())
        return Error{ErrorCode::bad_query, "explain epa: the cores of the shapes do not overlap"};
    if (what != "epa") add_gjk_steps(out, trace);
    if (what != "gjk") add_epa_steps(out, trace);
    return {};
}

}  // namespace

Result<Sequence> sequence(const Question& q) {
    const bool known =
        q.what == "gjk" || q.what == "epa" || q.what == "distance" || q.what == "clip" || q.what == "sat";
    if (!known)
        return Error{ErrorCode::unknown_name,
                     "explain: there is no \"" + printable(q.what) + "\"; there are gjk, epa, distance, clip, sat"};
    Result<SimplexSolver> solver = simplex_from_name(q.simplex);
    if (!solver) return solver.error();
    Result<Pair> read = pair_of(q);
    if (!read) return read.error();
    const Pair& pair = read.value();
    Recorder trace;
    GjkCache cold;
    const ConvexDistance d = distance({&pair.a, &pair.b, pair.b_in_a}, cold, solver.value(), 1e30f, trace);
    Sequence out;
    out.solids = solids_of(pair);
    out.steps.push_back(shapes_step(d));
    if (Status added = add_steps(out, q.what, pair, d, trace); !added) return added.error();
    return out;
}

}  // namespace lendulet::explain
