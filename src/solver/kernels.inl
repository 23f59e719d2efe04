// The one source of all wide kernels. Included by one unit per instruction set, which defines LENDULET_KERNEL_SPACE:
// the namespace that keeps the copies apart, so that the linker can never give a unit the code of a wider machine.
#include <type_traits>

#include "math/turned.h"
#include "math/wide/gather.h"
#include "math/wide/wide.h"
#include "solver/kernels.h"

namespace lendulet::LENDULET_KERNEL_SPACE {
namespace {

#include "solver/contact_rows.inl"

#include "solver/contact_motion.inl"

#include "solver/round_limit.inl"

#include "solver/contact_passes.inl"

#include "solver/rolling.inl"

#include "solver/turn.inl"

#include "solver/body_rows.inl"

#include "solver/meetings.inl"

template <int W>
void prepare_group(const ContactGroup& g, const ContactRecord* records, const BodyArrays& bodies, int begin, int end) {
    if (g.points == 1) prepare_rows<W, 1>(g, records, bodies, begin, end);
    else if (g.points == 2) prepare_rows<W, 2>(g, records, bodies, begin, end);
    else prepare_rows<W, 4>(g, records, bodies, begin, end);
    if (!g.rolling) return;
    if (g.points == 1) prepare_rolling<W, 1>(g, bodies, begin, end);
    else if (g.points == 2) prepare_rolling<W, 2>(g, bodies, begin, end);
    else prepare_rolling<W, 4>(g, bodies, begin, end);
}
template <int W, bool warm>
void roll_group(const ContactGroup& g, const BodyArrays& bodies, int begin, int end) {
    if (g.points == 1) run_rolling<W, 1, warm>(g, bodies, begin, end);
    else if (g.points == 2) run_rolling<W, 2, warm>(g, bodies, begin, end);
    else run_rolling<W, 4, warm>(g, bodies, begin, end);
}
template <int W, Pass pass>
void pass_group(const ContactGroup& g, const BodyArrays& bodies, const SubstepConstants& k, int begin, int end) {
    if (pass != Pass::relax && g.rolling) roll_group<W, pass == Pass::warm_start>(g, bodies, begin, end);
    if (g.points == 1) run_pass<W, 1, pass>(g, bodies, k, begin, end);
    else if (g.points == 2) run_pass<W, 2, pass>(g, bodies, k, begin, end);
    else run_pass<W, 4, pass>(g, bodies, k, begin, end);
}
template <int W>
void store_group(const ContactGroup& g, ContactRecord* records, int begin, int end) {
    if (g.points == 1) store_rows<W, 1>(g, records, begin, end);
    else if (g.points == 2) store_rows<W, 2>(g, records, begin, end);
    else store_rows<W, 4>(g, records, begin, end);
    if (!g.rolling) return;
    if (g.points == 1) store_rolling<W, 1>(g, begin, end);
    else if (g.points == 2) store_rolling<W, 2>(g, begin, end);
    else store_rolling<W, 4>(g, begin, end);
}
template <int W, int P>
void read_row(const ContactGroup& g, int place, float impulses[4]) {
    const auto& row = reinterpret_cast<const ContactRow<W, P>*>(g.rows)[place / W];
    for (int j = 0; j < P; ++j) {
        float lanes[W];
        store_wide(lanes, row.p[j].impulse);
        impulses[j] = lanes[place % W];
    }
}
template <int W>
void read_group(const ContactGroup& g, int place, float impulses[4]) {
    for (int j = 0; j < 4; ++j) impulses[j] = 0.0f;
    if (g.points == 1) read_row<W, 1>(g, place, impulses);
    else if (g.points == 2) read_row<W, 2>(g, place, impulses);
    else read_row<W, 4>(g, place, impulses);
}

template <int W>
constexpr SolverKernels make_kernels() {
    SolverKernels k{};
    k.width = W;
    k.row_bytes[0] = sizeof(ContactRow<W, 1>);
    k.row_bytes[1] = sizeof(ContactRow<W, 2>);
    k.row_bytes[2] = sizeof(ContactRow<W, 4>);
    k.rolling_bytes = sizeof(RollingRow<W>);
    k.prepare = prepare_group<W>;
    k.warm_start = pass_group<W, Pass::warm_start>;
    k.solve = pass_group<W, Pass::solve>;
    k.relax = pass_group<W, Pass::relax>;
    k.store = store_group<W>;
    k.read_impulses = read_group<W>;
    k.begin_step = begin_bodies<W>;
    k.kick = kick_bodies<W>;
    k.drift = drift_bodies<W>;
    k.settle = settle_bodies<W>;
    k.prepare_meetings = prepare_meetings<W>;
    k.find_meetings = find_meetings<W>;
    return k;
}

}  // namespace
}  // namespace lendulet::LENDULET_KERNEL_SPACE
