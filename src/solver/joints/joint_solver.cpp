#include "solver/joints/joint_solver.h"

namespace lendulet {
namespace {

constexpr int joints_per_task = 128;  // in a chunk, whatever the width

JointConstants constants(const SubstepConstants& k) {
    JointConstants c;
    c.h = k.h;
    c.inverse_h = k.inverse_h;
    c.first = k.first;
    c.scale = k.first ? 1.0f : k.repeat_scale;
    c.share = k.first ? 0.5f : 1.0f;
    return c;
}

}  // namespace

template <class Run>
void JointSolver::for_each_group(TaskPool& tasks, Run&& run) const {
    for (int i = 0; i < schedule_.groups.count(); ++i) {
        const JointGroup& g = schedule_.groups[static_cast<size_t>(i)];
        size_t type = static_cast<size_t>(g.type);
        if (i >= schedule_.first_overflow_group) {
            run(scalar_.of[type], g, 0, 1);
            continue;
        }
        int blocks = static_cast<int>(block_count(static_cast<uint32_t>(g.count), table_.width));
        tasks.share(blocks, joints_per_task / table_.width,
                    [&](int begin, int end, int) { run(table_.of[type], g, begin, end); });
    }
}

void JointSolver::prepare(TaskPool& tasks, SolverBodies& bodies, JointList joints, ContactList contacts,
                          JointReuse reuse) {
    records_ = joints.records;
    bool fresh = schedule_.build(joints.records, joints.count, reuse.same, contacts, bodies, table_, scalar_);
    for (JointGroup& g : schedule_.groups) g.axes = joints.axes;
    for_each_group(tasks, [&](const JointKernels& kernels, const JointGroup& g, int begin, int end) {
        if (fresh || !g.moved_a || !g.moved_b) kernels.load(g, records_, fresh, begin, end);
        kernels.prepare(g, bodies, reuse.scale, begin, end);
    });
}

void JointSolver::warm_start(TaskPool& tasks, SolverBodies& bodies) const {
    for_each_group(tasks, [&](const JointKernels& kernels, const JointGroup& g, int begin, int end) {
        kernels.warm_start(g, bodies, JointConstants{}, begin, end);
    });
}

void JointSolver::biased(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k) const {
    const JointConstants c = constants(k);
    for_each_group(tasks, [&](const JointKernels& kernels, const JointGroup& g, int begin, int end) {
        kernels.biased(g, bodies, c, begin, end);
    });
}

// Groups that are split need it at the end of a step alone.
void JointSolver::relax(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k) const {
    JointConstants c = constants(k);
    c.first = false;
    c.scale = k.end_scale;
    c.share = 0.5f;
    for_each_group(tasks, [&](const JointKernels& kernels, const JointGroup& g, int begin, int end) {
        if (!g.split || k.last) kernels.relax(g, bodies, c, begin, end);
    });
}

void JointSolver::store(TaskPool& tasks) const {
    for_each_group(tasks, [&](const JointKernels& kernels, const JointGroup& g, int begin, int end) {
        kernels.store(g, records_, begin, end);
    });
}

int JointSolver::overflow() const {
    int sum = 0;
    for (int i = schedule_.first_overflow_group; i < schedule_.groups.count(); ++i)
        sum += schedule_.groups[static_cast<size_t>(i)].count;
    return sum;
}

}  // namespace lendulet
