// How many substeps an island takes, by what choose_substeps() has found that it carries and how it moves.
#pragma once

#include "world/world_data.h"

namespace lendulet {

inline constexpr float first_reserve =
    4.0f;  // of loads that are guessed: what is built at rest shall not begin by swinging
// Of every so many contacts, in order of pairs, one is a sample of how its island moves.
inline constexpr int contacts_per_sample = 4;

// Whether body b moves against another one with that velocity: by more than what would carry it up by a part of its
// size.
inline bool is_stirred(const IslandLoad& b, Vec3 other, float gravity) {
    constexpr float part = 3e-3f;
    return length_squared(b.velocity - other) > (2.0f * part) * gravity * b.radius;
}

// Hard islands without joints in which nothing moves faster rest, and leave substeps out, m/s: what a fall of 10 us
// gives (docs/solver.md, What rests). 0 where nothing may: surfaces that run could do so more slowly.
inline float rest_speed(const WorldData& world) {
    return world.has_extras ? 0.0f : 1e-5f * length(world.config.gravity);
}

// A cube's edge from its diagonal.
inline float size_of(float radius) { return 1.15f * radius; }

// Sets the class of a root, and whether it flows. Its class goes up at once for loads that are known, soon for those
// that are felt, and down one at a time and with patience. `substeps`: the setting.
void decide_substeps(IslandLoad& root, float gravity, float dt, int substeps);

}  // namespace lendulet
