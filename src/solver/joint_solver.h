// The joints' part of a step: their schedule and the order of their passes within a substep.
#pragma once

#include "base/tasks.h"
#include "solver/joint_schedule.h"

namespace lendulet {

class JointSolver {
public:
    explicit JointSolver(const Memory* memory) : schedule_(memory) {}

    // Colours the joints and packs them into rows. `records` must stay until store().
    void prepare(TaskPool& tasks, SolverBodies& bodies, JointRecord* records, int count, ContactList contacts,
                 const SolverKernels& kernels, const SolverKernels& scalar_kernels);
    bool empty() const { return schedule_.groups.empty(); }
    // In the first substep, between the contacts' warm start and biased().
    void after_contact_warm_start(TaskPool& tasks, SolverBodies& bodies);
    // Warm start and biased pass.
    void biased(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k);
    // After the drift.
    void relax(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k);
    void store(TaskPool& tasks);

    int joint_count() const { return schedule_.order.count(); }
    int overflow() const;
    size_t row_bytes() const { return schedule_.rows.size(); }

private:
    // Calls run(kernels, group, begin, end) for every group, colour after colour.
    template <class Run>
    void for_each_group(TaskPool& tasks, Run&& run) const;
    void pass(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k,
              JointKernels::Pass JointKernels::*which) const;
    void book(TaskPool& tasks, SolverBodies& bodies, Booking what) const;

    JointSchedule schedule_;
    JointRecord* records_ = nullptr;
    const SolverKernels* kernels_ = nullptr;
    const SolverKernels* scalar_ = nullptr;
};

}  // namespace lendulet
