#include "solver/joint_solver.h"

namespace lendulet {
namespace {

constexpr int joints_per_task = 128;  // in a chunk, whatever the width
constexpr int blocks_per_task = 16;   // of 16 bodies

}  // namespace

template <class Run>
void JointSolver::for_each_group(TaskPool& tasks, Run&& run) const {
    for (int i = 0; i < schedule_.groups.count(); ++i) {
        const JointGroup& g = schedule_.groups[static_cast<size_t>(i)];
        size_t type = static_cast<size_t>(g.type);
        if (i >= schedule_.first_overflow_group) {
            run(scalar_->joints[type], g, 0, g.count);
            continue;
        }
        int blocks = static_cast<int>(block_count(static_cast<uint32_t>(g.count), kernels_->width));
        tasks.for_each(blocks, joints_per_task / kernels_->width,
                       [&](int begin, int end, int) { run(kernels_->joints[type], g, begin, end); });
    }
}

void JointSolver::pass(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k,
                       JointKernels::Pass JointKernels::*which) const {
    for_each_group(tasks, [&](const JointKernels& kernels, const JointGroup& g, int begin, int end) {
        (kernels.*which)(g, bodies, k, begin, end);
    });
}

void JointSolver::book(TaskPool& tasks, SolverBodies& bodies, Booking what) const {
    if (!schedule_.any_touching) return;
    tasks.for_each((bodies.count + 15) / 16, blocks_per_task,
                   [&](int begin, int end, int) { kernels_->book_joints(bodies, what, begin * 16, end * 16); });
}

void JointSolver::prepare(TaskPool& tasks, SolverBodies& bodies, JointRecord* records, int count, ContactList contacts,
                          const SolverKernels& kernels, const SolverKernels& scalar_kernels) {
    records_ = records;
    kernels_ = &kernels;
    scalar_ = &scalar_kernels;
    schedule_.build(records, count, contacts, bodies, kernels, scalar_kernels);
    for_each_group(tasks, [&](const JointKernels& joint_kernels, const JointGroup& g, int begin, int end) {
        joint_kernels.prepare(g, records_, bodies, begin, end);
    });
}

void JointSolver::after_contact_warm_start(TaskPool& tasks, SolverBodies& bodies) {
    book(tasks, bodies, Booking::contacts_warm);
}

void JointSolver::biased(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k) {
    pass(tasks, bodies, k, &JointKernels::warm_start);
    pass(tasks, bodies, k, &JointKernels::solve);
    book(tasks, bodies, Booking::joints_solved);
}

void JointSolver::relax(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k) {
    pass(tasks, bodies, k, &JointKernels::warm_relax);
    pass(tasks, bodies, k, &JointKernels::relax);
    book(tasks, bodies, Booking::joints_relaxed);
}

void JointSolver::store(TaskPool& tasks) {
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
