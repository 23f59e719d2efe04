#include "solver/solver.h"

#include "base/prefetch.h"
#include "solver/impacts.h"

namespace lendulet {
namespace {

constexpr int bodies_per_task = 256;    // bodies in a chunk of a parallel loop; a multiple of 16
constexpr int contacts_per_task = 128;  // manifolds in a chunk, whatever the width

// Calls run(begin, end) on parts of a range of bodies, in whole blocks.
template <class Run>
void for_each_body_block(TaskPool& tasks, BodyRange range, Run&& run) {
    int first = range.begin / block_bodies, blocks = (range.end - range.begin + block_bodies - 1) / block_bodies;
    tasks.for_each(blocks, bodies_per_task / block_bodies,
                   [&](int begin, int end, int) { run((first + begin) * block_bodies, (first + end) * block_bodies); });
}

}  // namespace

SubstepConstants substep_constants(const SolverSettings& settings) {
    SubstepConstants k;
    k.h = settings.dt / static_cast<float>(settings.substeps);
    k.inverse_h = 1.0f / k.h;
    k.bias_rate = contact_bias * k.inverse_h;
    k.leak = contact_leak;
    k.bounce_speed = bounce_threshold_substeps * settings.gravity * k.h + 1e-3f;
    k.joints = k.moved = k.first = k.last = false;
    k.repeat_scale = k.end_scale = 1.0f;
    return k;
}

template <class Run>
void Solver::for_each_group(TaskPool& tasks, Run&& run) {
    for (int i = 0; i < schedule_.groups.count(); ++i) {
        const ContactGroup& g = schedule_.groups[static_cast<size_t>(i)];
        if (i >= schedule_.first_overflow_group) {
            run(scalar_, g, 0, g.count);
            continue;
        }
        int blocks = (g.count + kernels_.width - 1) / kernels_.width;
        int grain = contacts_per_task / kernels_.width;
        tasks.for_each(blocks, grain, [&](int begin, int end, int) { run(kernels_, g, begin, end); });
    }
}

void Solver::prepare(TaskPool& tasks, SolverBodies& bodies, const ContactRecord* records, const uint32_t* list,
                     int count, ContactExtra* extras) {
    extras_ = extras;
    schedule_.build(records, extras, list, count, bodies, kernels_, scalar_);
    bouncing_.clear();
    for (int i = 0; i < count; ++i) {
        if (i + prefetch_distance < count) prefetch(&records[list[i + prefetch_distance]].restitution);
        if (records[list[i]].restitution > 0.0f) bouncing_.push_back(list[i]);
    }
    for_each_group(tasks, [&](const SolverKernels& kernels, const ContactGroup& g, int begin, int end) {
        kernels.prepare(g, records, bodies, begin, end);
    });
}

void Solver::prepare_joints(TaskPool& tasks, SolverBodies& bodies, JointList joints, ContactList contacts,
                            JointReuse reuse) {
    joints_.prepare(tasks, bodies, joints, contacts, reuse);
}

void Solver::solve(TaskPool& tasks, const SolverSettings& settings, SolverBodies& bodies, const ContactRecord* records,
                   BodyRange range) {
    if (range.begin >= range.end) return;
    SubstepConstants k = substep_constants(settings);
    k.joints = !joints_.empty();
    for_each_body_block(tasks, range, [&](int begin, int end) { kernels_.begin_step(bodies, begin, end); });
    for (int substep = 0; substep < settings.substeps; ++substep) {
        k.first = substep == 0;
        k.last = substep == settings.substeps - 1;
        k.repeat_scale = substep == 1 ? 2.0f : 1.0f;  // the first substep began with half a kick
        k.end_scale = settings.substeps > 1 ? 0.5f : 1.0f;
        k.moved = resolve_impacts(bodies, records, {bouncing_.data(), bouncing_.count(), extras_}, k);
        for_each_body_block(tasks, range, [&](int begin, int end) { kernels_.kick(bodies, k, begin, end); });
        if (k.first)
            for_each_group(tasks, [&](const SolverKernels& kernels, const ContactGroup& g, int begin, int end) {
                kernels.warm_start(g, bodies, k, begin, end);
            });
        if (k.joints && k.first) joints_.warm_start(tasks, bodies);
        if (k.joints) joints_.biased(tasks, bodies, k);
        for_each_group(tasks, [&](const SolverKernels& kernels, const ContactGroup& g, int begin, int end) {
            kernels.solve(g, bodies, k, begin, end);
        });
        for_each_body_block(tasks, range, [&](int begin, int end) { kernels_.drift(bodies, k, begin, end); });
        if (k.joints) joints_.relax(tasks, bodies, k);
        for_each_group(tasks, [&](const SolverKernels& kernels, const ContactGroup& g, int begin, int end) {
            kernels.relax(g, bodies, k, begin, end);
        });
    }
    for_each_body_block(tasks, range, [&](int begin, int end) { kernels_.settle(bodies, begin, end); });
}

void Solver::store(TaskPool& tasks, ContactRecord* records) {
    for_each_group(tasks, [&](const SolverKernels& kernels, const ContactGroup& g, int begin, int end) {
        kernels.store(g, records, begin, end);
    });
}

}  // namespace lendulet
