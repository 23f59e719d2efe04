#include "solver/solver.h"

#include <cmath>

#include "solver/impacts.h"
#include "solver/stand_ins.h"

namespace lendulet {
namespace {

constexpr int bodies_per_task = 256;   // bodies in a chunk of a parallel loop; a multiple of 16
constexpr int contacts_per_part = 64;  // the fewest contacts of a colour that are worth a part of a loop
// Fewer contacts, joints and bodies in all are solved on one thread: a pass is some ten loops, which then take a
// microsecond each, and two threads took a quarter longer for them than one.
constexpr int fewest_shared = 2500;
// Substeps after which it is first asked whether all bodies rest; then after twice as many, and so on.
constexpr int first_look = 4;

// Calls run(begin, end) on parts of a range of bodies, in whole blocks.
template <class Run>
void for_each_body_block(TaskPool& tasks, BodyRange range, Run&& run) {
    int first = range.begin / block_bodies, blocks = (range.end - range.begin + block_bodies - 1) / block_bodies;
    tasks.for_each(blocks, bodies_per_task / block_bodies,
                   [&](int begin, int end, int) { run((first + begin) * block_bodies, (first + end) * block_bodies); });
}

bool exceeds(const BodyBlock::Lanes (&x)[3], const BodyBlock::Lanes (&start)[3], float most) {
    bool any = false;
    for (int k = 0; k < 3; ++k)
        for (int l = 0; l < block_bodies; ++l) any |= std::fabs(start[k][l] + x[k][l]) > most;
    return any;
}

bool exceeds(const float (&x)[3], const float (&start)[3], float most) {
    bool any = false;
    for (int k = 0; k < 3; ++k) any |= std::fabs(start[k] + x[k]) > most;
    return any;
}

// Whether the last substep left all bodies slow, by the velocities that they moved by and by those that they ended
// with.
bool all_rest(const SolverBodies& bodies, BodyRange range, float most) {
    for (int i = range.begin; i < range.end; i += block_bodies) {
        const BodyBlock& b = bodies.blocks[static_cast<size_t>(i / block_bodies)];
        if (exceeds(b.v_ref, b.start_v, most) || exceeds(b.w_ref, b.start_w, most)) return false;
        for (int l = 0; l < block_bodies; ++l) {
            const BodyState& x = bodies.state[static_cast<size_t>(i + l)];
            const BodyStart& start = bodies.start[static_cast<size_t>(i + l)];
            if (exceeds(x.v, start.v, most) || exceeds(x.w, start.w, most)) return false;
        }
    }
    return true;
}

}  // namespace

SubstepConstants substep_constants(const SolverSettings& settings) {
    SubstepConstants k;
    k.h = settings.dt / static_cast<float>(settings.substeps);
    k.inverse_h = 1.0f / k.h;
    k.bias_rate = contact_bias * k.inverse_h;
    k.leak = contact_leak;
    k.bounce_speed = bounce_threshold_substeps * settings.gravity * k.h + 1e-3f;
    k.still_drift = settings.gravity * k.h * k.h;
    k.joints = k.moved = k.first = k.last = false;
    k.substeps_so_far = k.repeat_scale = k.end_scale = 1.0f;
    return k;
}

bool Solver::is_small(int bodies) const {
    return schedule_.order.count() + joints_.joint_count() + bodies < fewest_shared;
}

bool Solver::may_rest(const SolverSettings& settings, int substep) const {
    return settings.rest_speed > 0.0f && joints_.empty() && substep >= first_look && (substep & (substep - 1)) == 0;
}

template <class Run>
void Solver::run_groups(int first, int last, Run&& run) const {
    for (int i = first; i < last; ++i) {
        const ContactGroup& g = schedule_.groups[static_cast<size_t>(i)];
        run(g, 0, static_cast<int>(block_count(static_cast<uint32_t>(g.count), kernels_.width)));
    }
}

template <class Run>
void Solver::for_each_between(TaskPool& tasks, Run&& run) const {
    int first = schedule_.first_group(schedule_.tiles.count);
    for (int last : schedule_.colour_ends) {
        const ContactGroup* groups = schedule_.groups.data() + first;
        int blocks = 0;
        for (int i = first; i < last; ++i)
            blocks += static_cast<int>(block_count(static_cast<uint32_t>(groups[i - first].count), kernels_.width));
        if (groups->shares || tasks.sharing() == 1) {
            run_groups(first, last, run);
        } else {
            // Of every group of the colour the same share: a worker meets the same bodies in all groups and colours.
            const int parts = tasks.parts(blocks, contacts_per_part / kernels_.width);
            tasks.for_each(parts, 1, [&](int begin, int end, int) {
                for (int i = first; i < last; ++i) {
                    const ContactGroup& g = groups[i - first];
                    const auto n = static_cast<int>(block_count(static_cast<uint32_t>(g.count), kernels_.width));
                    const int from = n * begin / parts, to = n * end / parts;
                    if (from < to) run(g, from, to);
                }
            });
        }
        first = last;
    }
}

template <class Run>
void Solver::for_each_group(TaskPool& tasks, Run&& run) const {
    const int tiles = schedule_.tiles.count;
    tasks.for_each(tiles, 1, [&](int begin, int end, int) {
        run_groups(schedule_.first_group(begin), schedule_.last_group(end - 1), run);
    });
    for_each_between(tasks, run);
}

template <class Run>
void Solver::for_each_tile(TaskPool& tasks, BodyRange range, Run&& run) const {
    const Tiles& tiles = schedule_.tiles;
    if (tiles.count == 1) {
        for_each_body_block(tasks, range, [&](int begin, int end) { run(0, BodyRange{begin, end}); });
        return;
    }
    tasks.for_each(tiles.count, 1, [&](int begin, int end, int) {
        for (int tile = begin; tile < end; ++tile) run(tile, tiles.bodies(tile));
    });
}

void Solver::pass_group(const ContactGroup& g, int begin, int end, SolverBodies& bodies, const SubstepConstants& k,
                        Pass pass) const {
    if (g.shares) pass_shared(kernels_, pass, g, bodies, k);
    else pass(g, BodyArrays::of(bodies), k, begin, end);
}

void Solver::pass_tile(int tile, SolverBodies& bodies, const SubstepConstants& k, Pass pass) const {
    run_groups(schedule_.first_group(tile), schedule_.last_group(tile),
               [&](const ContactGroup& g, int begin, int end) { pass_group(g, begin, end, bodies, k, pass); });
}

void Solver::pass_between(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k, Pass pass) const {
    for_each_between(tasks,
                     [&](const ContactGroup& g, int begin, int end) { pass_group(g, begin, end, bodies, k, pass); });
}

size_t Solver::schedule(ColourSorter& sorter, const SolverBodies& bodies, const ContactEnds* ends, const uint32_t* list,
                        ContactCount count, const ContactCut& cut, ContactExtra* extras) {
    extras_ = extras;
    schedule_.build(sorter, ends, extras, list, count.rows, bodies, cut, kernels_);
    impacts_.clear();
    for (int i = 0; i < count.all; ++i) {
        // In a crowd what carries a load goes on by rows.
        if (!ends[i].bounces || (ends[i].crowded && !ends[i].idle && !ends[i].passes)) continue;
        impacts_.push_back({list[i], ends[i].a, ends[i].b, ends[i].passes, ends[i].held, ends[i].crowded});
    }
    link_impacts(bodies.count);
    meetings_.resize_unset((impacts_.size() + meeting_lanes - 1) / meeting_lanes);
    passing_ = count.all - count.rows;
    return schedule_.row_bytes;
}

void Solver::prepare(TaskPool& tasks, SolverBodies& bodies, const ContactRecord* records, std::byte* rows,
                     float impulse_unit) {
    schedule_.place_rows(rows, records, impulse_unit);
    const TaskPool::Alone alone(tasks, is_small(bodies.count));
    for_each_group(tasks, [&](const ContactGroup& g, int begin, int end) {
        if (g.shares) prepare_shared(kernels_, g, records, bodies);
        else kernels_.prepare(g, records, BodyArrays::of(bodies), begin, end);
    });
}

void Solver::prepare_joints(TaskPool& tasks, SolverBodies& bodies, JointList joints, ContactList contacts,
                            JointReuse reuse) {
    joints_.prepare(tasks, bodies, joints, contacts, reuse);
    impact_joints_.begin_step(joints);
}

// In every pass what lies between tiles comes before what lies within them; so contacts with what is not moved, which
// are the last of their tile, come last of all. A tile's relax pass therefore stands before the next substep's kick,
// and its solve before the drift, each with no barrier between.
void Solver::solve(TaskPool& tasks, const SolverSettings& settings, SolverBodies& bodies, const ContactRecord* records,
                   BodyRange range) {
    rested_ = false;
    if (range.begin >= range.end) return;
    const TaskPool::Alone alone(tasks, is_small(range.end - range.begin));
    const Pass warm_start = kernels_.warm_start, solve = kernels_.solve, relax = kernels_.relax;
    SubstepConstants k = substep_constants(settings);
    k.joints = !joints_.empty();
    for_each_tile(tasks, range, [&](int, BodyRange r) { kernels_.begin_step(bodies, r.begin, r.end); });
    for (MeetingBlock& block : meetings_) block.ready = false;
    if (watched_.count > 0) list_foreseen(records);
    if (passing_ > 0) disturbed_.assign(static_cast<size_t>(bodies.count), 0);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        const SubstepConstants before = k;
        k.first = substep == 0;
        k.substeps_so_far = static_cast<float>(substep + 1);
        k.last = substep == settings.substeps - 1;
        k.repeat_scale = substep == 1 ? 2.0f : 1.0f;  // the first substep began with half a kick
        k.end_scale = settings.substeps > 1 ? 0.5f : 1.0f;
        // Impacts and who watches look at all bodies at once, which the relax pass must have left.
        const bool looks = may_rest(settings, substep);
        bool relaxed = k.first;
        if (!relaxed && (!impacts_.empty() || watched_.count > 0 || looks)) {
            for_each_tile(tasks, range, [&](int tile, BodyRange) { pass_tile(tile, bodies, before, relax); });
            relaxed = true;
        }
        if (watched_.count > 0 && !k.first) note_watched(tasks, bodies, records, k.h, false);
        rested_ = looks && all_rest(bodies, range, settings.rest_speed);
        if (rested_) {  // those who watch are told of every substep
            for (int left = substep + 1; left < settings.substeps && watched_.count > 0; ++left)
                note_watched(tasks, bodies, records, k.h, false);
            break;
        }
        if (!impacts_.empty()) {
            if (passing_ > 0 && !k.first) mark_disturbed(bodies, range, disturbed_.data());
            find_meetings(tasks, bodies, records, k);
            const ImpactList list{impacts_.data(),
                                  impacts_.count(),
                                  meetings_.data(),
                                  extras_,
                                  passing_ > 0 ? disturbed_.data() : nullptr,
                                  watched_,
                                  k.joints ? &impact_joints_ : nullptr};
            k.moved = resolve_impacts(bodies, records, list, k, substep);
        }
        if (watched_.count > 0) foresee_watched(tasks, bodies, records, k);
        for_each_tile(tasks, range, [&](int tile, BodyRange r) {
            if (!relaxed) pass_tile(tile, bodies, before, relax);
            kernels_.kick(bodies, k, r.begin, r.end);
            if (k.first) pass_tile(tile, bodies, k, warm_start);
        });
        if (k.first) pass_between(tasks, bodies, k, warm_start);
        if (k.joints && k.first) joints_.warm_start(tasks, bodies);
        if (k.joints) joints_.biased(tasks, bodies, k);
        pass_between(tasks, bodies, k, solve);
        for_each_tile(tasks, range, [&](int tile, BodyRange r) {
            pass_tile(tile, bodies, k, solve);
            kernels_.drift(bodies, k, r.begin, r.end);
        });
        if (k.joints) joints_.relax(tasks, bodies, k);
        pass_between(tasks, bodies, k, relax);
    }
    for_each_tile(tasks, range, [&](int tile, BodyRange r) {
        if (!rested_) pass_tile(tile, bodies, k, relax);
        kernels_.settle(bodies, r.begin, r.end);
    });
    if (watched_.count > 0) note_watched(tasks, bodies, records, k.h, true);
}

void Solver::coast(TaskPool& tasks, const SolverSettings& settings, SolverBodies& bodies, BodyRange range) const {
    if (range.begin >= range.end) return;
    SubstepConstants k = substep_constants({settings.dt, 1, settings.gravity});
    k.first = k.last = true;
    for_each_body_block(tasks, range, [&](int begin, int end) {
        kernels_.begin_step(bodies, begin, end);
        kernels_.kick(bodies, k, begin, end);
        kernels_.drift(bodies, k, begin, end);
        kernels_.settle(bodies, begin, end);
    });
}

void Solver::store(TaskPool& tasks, const SolverBodies& bodies, ContactRecord* records) {
    const TaskPool::Alone alone(tasks, is_small(bodies.count));
    for_each_group(tasks, [&](const ContactGroup& g, int begin, int end) { kernels_.store(g, records, begin, end); });
    const int first = impacts_.count() - passing_;
    tasks.for_each(passing_, contacts_per_part, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i)
            follow_passing(bodies, records[impacts_[static_cast<size_t>(first + i)].record]);
    });
}

}  // namespace lendulet
