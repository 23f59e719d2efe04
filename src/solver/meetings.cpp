// What a solver asks of its contacts beside their rows: which may meet in a substep, and what watched ones carry.
#include "solver/meetings.h"

#include <algorithm>

#include "solver/solver.h"

namespace lendulet {
namespace {

constexpr int blocks_per_task = 4;
constexpr int watched_per_task = 64;

int block_number(const Array<ImpactContact>& contacts) {
    return (contacts.count() + meeting_lanes - 1) / meeting_lanes;
}

}  // namespace

void Solver::find_meetings(TaskPool& tasks, const SolverBodies& bodies, const ContactRecord* records,
                           const SubstepConstants& k) {
    const int passing_from = impacts_.count() - passing_;
    auto is_asked = [&](const ImpactContact& c) {
        return !c.passes || disturbed_[static_cast<size_t>(c.a)] || disturbed_[static_cast<size_t>(c.b)];
    };
    tasks.for_each(block_number(impacts_), blocks_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            MeetingBlock& block = meetings_[static_cast<size_t>(i)];
            const int first = i * meeting_lanes;
            const ImpactContact* c = impacts_.data() + first;
            block.meets = 0;
            if (first >= passing_from &&
                std::none_of(c, c + std::min(meeting_lanes, impacts_.count() - first), is_asked))
                continue;
            if (!block.ready)
                kernels_.prepare_meetings(block, bodies, records,
                                          {impacts_.data(), first, impacts_.count(), MeetingsOf::impacts});
            kernels_.find_meetings(block, bodies, k);
        }
    });
}

void Solver::link_impacts(int bodies) {
    if (impacts_.empty()) return;
    last_impacts_.assign(static_cast<size_t>(bodies), -1);
    for (int i = 0; i < impacts_.count(); ++i) {
        const ImpactContact& c = impacts_[static_cast<size_t>(i)];
        int32_t& last = last_impacts_[static_cast<size_t>(c.b)];
        if (last >= 0 && impacts_[static_cast<size_t>(last)].a == c.a) impacts_[static_cast<size_t>(last)].next = i;
        last = i;
    }
}

void Solver::watch(const WatchList& list) {
    watched_ = list;
    if (list.count == 0) return;
    for (int g = 0; g < schedule_.groups.count(); ++g) {
        const ContactGroup& group = schedule_.groups[static_cast<size_t>(g)];
        for (int i = 0; i < group.count; ++i)
            if (WatchedContact* w = list.of(group.order[i])) w->group = g, w->place = i;
    }
}

void Solver::read_watched(const WatchedContact& w, float impulses[4]) const {
    const ContactGroup& group = schedule_.groups[static_cast<size_t>(w.group)];
    kernels_.read_impulses(group, w.place, impulses);
}

void Solver::list_foreseen(const ContactRecord* records) {
    foreseen_.clear();
    for (int i = 0; i < watched_.count; ++i) {
        const WatchedContact& w = watched_.list[watched_.first + i];
        const ContactRecord& r = records[w.record];
        if (w.speeds && w.group >= 0) foreseen_.push_back({w.record, r.body_a, r.body_b, false, false, false});
    }
    watched_meetings_.resize_unset(static_cast<size_t>(block_number(foreseen_)));
    for (MeetingBlock& block : watched_meetings_) block.ready = false;
}

void Solver::foresee_watched(TaskPool& tasks, SolverBodies& bodies, const ContactRecord* records,
                             const SubstepConstants& k) {
    const SubstepConstants wide = look_ahead(k, watched_.least_speed);
    tasks.for_each(watched_meetings_.count(), blocks_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            MeetingBlock& block = watched_meetings_[static_cast<size_t>(i)];
            const int first = i * meeting_lanes;
            if (!block.ready)
                kernels_.prepare_meetings(block, bodies, records,
                                          {foreseen_.data(), first, foreseen_.count(), MeetingsOf::all_points});
            kernels_.find_meetings(block, bodies, wide);
            for (uint32_t bits = block.meets; bits != 0; bits &= bits - 1) {
                const ImpactContact& c = foreseen_[static_cast<size_t>(first + __builtin_ctz(bits))];
                WatchedContact& w = *watched_.of(c.record);
                float held[4];
                read_watched(w, held);
                foresee_meetings(bodies, records, w, held, watched_.least_speed, k.h);
            }
        }
    });
}

void Solver::note_watched(TaskPool& tasks, SolverBodies& bodies, const ContactRecord* records, float h,
                          bool last) const {
    tasks.for_each(watched_.count, watched_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            WatchedContact& w = watched_.list[watched_.first + i];
            if (!w.follows || w.group < 0) continue;
            float impulses[4];
            read_watched(w, impulses);
            note_impulses(bodies, records, w, impulses, h, last);
        }
    });
}

}  // namespace lendulet
