// The joints' part of a step: their schedule and the order of their passes within a substep.
#pragma once

#include "base/tasks.h"
#include "solver/joints/schedule.h"

namespace lendulet {

// What stays of the joints from one step to the next.
struct JointReuse {
    bool same = false;   // joints and bodies are those of the last step, but for their state and for what static and
                         // kinematic bodies' sides say
    float scale = 1.0f;  // this substep over that of the last step: impulses are multiplied by it
};

// The joints of a step. Both must stay until store().
struct JointList {
    JointRecord* records;
    int count;
    JointAxesRecord* axes = nullptr;  // of six-degree joints, by JointRecord::axes
};

class JointSolver {
public:
    JointSolver(const Memory* memory, int width)
        : schedule_(memory), table_(joint_table(width)), scalar_(joint_table(1)) {}

    // Colours the joints and packs them into rows.
    void prepare(TaskPool& tasks, SolverBodies& bodies, JointList joints, ContactList contacts, JointReuse reuse);
    // Takes memory for so many joints of the largest kind but six-degree ones; before prepare().
    void make_ready(size_t bodies, size_t joints) {
        if (joints > 0) schedule_.make_ready(bodies, joints, table_);
    }
    bool empty() const { return schedule_.groups.empty(); }
    // In the first substep, after the contacts' warm start.
    void warm_start(TaskPool& tasks, SolverBodies& bodies) const;
    // Between kick and drift.
    void biased(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k) const;
    // After the drift.
    void relax(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k) const;
    void store(TaskPool& tasks) const;

    int joint_count() const { return schedule_.order.count(); }
    int overflow() const;
    size_t row_bytes() const { return schedule_.rows.size(); }

private:
    // Calls run(kernels, group, begin, end) for every group, colour after colour.
    template <class Run>
    void for_each_group(TaskPool& tasks, Run&& run) const;

    JointSchedule schedule_;
    JointRecord* records_ = nullptr;
    const JointTable& table_;
    const JointTable& scalar_;
};

}  // namespace lendulet
