#include "solver/bodies.h"

namespace lendulet {

void SolverBodies::reset(int moving) {
    count = reserved_bodies + moving;
    size_t padded = (static_cast<size_t>(count) + 15) / 16 * 16;
    state.resize_unset(padded);
    inertia.resize_unset(padded);
    start.resize_unset(padded);
    motion.resize_unset(padded);
    blocks.resize_unset(padded / block_bodies);
    auto at_rest = [&](size_t i) {
        state[i] = BodyState{};
        state[i].dq[3] = 1.0f;
        inertia[i] = BodyInertia{};
        start[i] = BodyStart{};
        motion[i] = BodyMotion{};
        motion[i].q0[3] = 1.0f;
        motion[i].anisotropy = motion[i].free = 1.0f;
    };
    for (size_t i = 0; i < reserved_bodies; ++i) at_rest(i);
    for (size_t i = static_cast<size_t>(count); i < padded; ++i) at_rest(i);
}

}  // namespace lendulet
