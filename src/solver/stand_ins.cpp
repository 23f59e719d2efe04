#include "solver/stand_ins.h"

namespace lendulet {
namespace {

// The sixteen contacts from `first` on, or what is left of the group.
struct StandIns {
    const SharedEnds* ends;
    int count;
    BodyState state[2 * shared_contacts];
    BodyInertia inertia[2 * shared_contacts];
    BodyStart start[2 * shared_contacts];

    StandIns(const ContactGroup& group, int first, const SolverBodies& bodies)
        : ends(group.ends + first),
          count(group.count - first < shared_contacts ? group.count - first : shared_contacts) {
        for (int i = 0; i < 2 * shared_contacts; ++i) {
            const bool there = i / 2 < count;
            const SharedEnds& e = ends[there ? i / 2 : 0];
            const auto body = static_cast<size_t>(there ? e.body[i % 2] : static_body);
            const float sharers = there ? e.sharers[i % 2] : 1.0f;
            state[i] = bodies.state[body];
            inertia[i] = bodies.inertia[body];
            start[i] = bodies.start[body];
            state[i].inverse_mass *= sharers;
            for (float& x : inertia[i].inverse) x *= sharers;
        }
    }
    BodyArrays arrays() { return {state, inertia, start}; }

    // What the stand-ins for a body have become, back to it. `from`: 1 where A is not moved.
    void merge(SolverBodies& bodies, int from) const {
        float before[2 * shared_contacts][2][3];
        for (int i = 0; i < 2 * count; ++i) {
            const BodyState& body = bodies.state[static_cast<size_t>(ends[i / 2].body[i % 2])];
            for (int d = 0; d < 3; ++d) before[i][0][d] = body.v[d], before[i][1][d] = body.w[d];
        }
        for (int i = 0; i < 2 * count; ++i) {
            if (i % 2 < from) continue;
            BodyState& body = bodies.state[static_cast<size_t>(ends[i / 2].body[i % 2])];
            const float sharers = ends[i / 2].sharers[i % 2], share = 1.0f / sharers;
            for (int d = 0; d < 3; ++d) {
                const float dv = state[i].v[d] - before[i][0][d], dw = state[i].w[d] - before[i][1][d];
                body.v[d] = sharers > 1.0f ? body.v[d] + share * dv : state[i].v[d];
                body.w[d] = sharers > 1.0f ? body.w[d] + share * dw : state[i].w[d];
            }
        }
    }
};

// Calls run(first, begin, end): the first contact, and its blocks of rows.
template <class Run>
void for_each_sixteen(const ContactGroup& group, int width, Run&& run) {
    const int blocks = (group.count + width - 1) / width;
    for (int first = 0; first < group.count; first += shared_contacts) {
        const int begin = first / width, end = begin + shared_contacts / width;
        run(first, begin, end < blocks ? end : blocks);
    }
}

void find_sharers(SharedEnds* ends, int count) {
    for (int i = 0; i < 2 * count; ++i) {
        const int32_t body = ends[i / 2].body[i % 2];
        int sharers = 0;
        for (int j = 0; j < 2 * count; ++j) sharers += ends[j / 2].body[j % 2] == body;
        ends[i / 2].sharers[i % 2] = body < reserved_bodies ? 1.0f : static_cast<float>(sharers);
    }
}

}  // namespace

void prepare_shared(const SolverKernels& kernels, const ContactGroup& group, const ContactRecord* records,
                    SolverBodies& bodies) {
    for (int i = 0; i < group.count; ++i) {
        const ContactRecord& r = records[group.order[i]];
        group.ends[i] = {{r.body_a, r.body_b}, {1.0f, 1.0f}};
    }
    for_each_sixteen(group, kernels.width, [&](int first, int begin, int end) {
        const int left = group.count - first;
        find_sharers(group.ends + first, left < shared_contacts ? left : shared_contacts);
        StandIns these(group, first, bodies);
        kernels.prepare(group, records, these.arrays(), begin, end);
    });
}

void pass_shared(const SolverKernels& kernels, SolverKernels::Pass pass, const ContactGroup& group,
                 SolverBodies& bodies, const SubstepConstants& k) {
    for_each_sixteen(group, kernels.width, [&](int first, int begin, int end) {
        StandIns these(group, first, bodies);
        pass(group, these.arrays(), k, begin, end);
        these.merge(bodies, group.fixed_a ? 1 : 0);
    });
}

}  // namespace lendulet
