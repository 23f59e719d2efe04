#include "solver/bodies.h"

namespace lendulet {

void SolverBodies::reset(int moving) {
    count = reserved_bodies + moving;
    int padded = (count + block_bodies - 1) / block_bodies * block_bodies;
    size_t size = static_cast<size_t>(padded);
    state.resize_unset(size);
    inertia.resize_unset(size);
    start.resize_unset(size);
    motion.resize_unset(size);
    place.resize_unset(size);
    blocks.resize_unset(size / block_bodies);
    for (int i = 0; i < reserved_bodies; ++i) set_at_rest(i);
    for (int i = count; i < padded; ++i) set_at_rest(i);
}

void SolverBodies::make_ready(size_t entries) {
    state.make_ready(entries), inertia.make_ready(entries), start.make_ready(entries);
    motion.make_ready(entries), place.make_ready(entries);
    blocks.make_ready(entries / block_bodies + 1);
}

void SolverBodies::set_at_rest(int body) {
    size_t i = static_cast<size_t>(body);
    state[i] = BodyState{};
    state[i].dq[3] = 1.0f;
    inertia[i] = BodyInertia{};
    start[i] = BodyStart{};
    motion[i] = BodyMotion{};
    place[i] = BodyPlace{};
    motion[i].q0[3] = 1.0f;
    motion[i].anisotropy = motion[i].free = 1.0f;
}

}  // namespace lendulet
