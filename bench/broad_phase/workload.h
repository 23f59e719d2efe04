// What broad phases are measured on: boxes in four arrangements, frames in which a few of them move, and boxes to ask
// for. The same numbers on every machine.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "broad_phase/box.h"
#include "scenes/random.h"

namespace lendulet::bench {

using Boxes = std::vector<BroadBox>;

// uniform: half extents 0.25 .. 0.5 m, centres anywhere in a cube of side 1.5 N^(1/3) m: about half a pair for each
// box. clustered: the same boxes in Gaussian heaps of a thousand, three times as dense. ground: the same boxes lying up
// to three high on one wide floor. one_huge: uniform, with one box around all the others.
enum class Distribution : uint8_t { uniform, clustered, ground, one_huge };
inline constexpr Distribution all_distributions[] = {Distribution::uniform, Distribution::clustered,
                                                     Distribution::ground, Distribution::one_huge};
std::string_view name_of(Distribution);

// Box i has index i. Where one box is unlike the others, it is box 0.
Boxes make_boxes(Distribution, int count);

// Boxes to ask for: half extents 0.5 .. 1 m about the centres of boxes chosen at random.
Boxes make_queries(const Boxes& boxes, int count);

// Boxes that move a little from frame to frame: each frame 5 % of them (at least one) by up to half their extent along
// each axis; who has strayed 1 m from home turns back. The wide box of `ground` and `one_huge` stays.
class Motion {
public:
    Motion(Distribution distribution, Boxes boxes);

    const Boxes& boxes() const { return boxes_; }
    // Makes the next frame and gives the places of the boxes that moved, ascending.
    std::vector<uint32_t> next_frame();

private:
    void move(BroadBox& box, const BroadBox& home);

    scenes::Random random_{7};
    Boxes boxes_, home_;
    uint32_t first_mobile_;
};

}  // namespace lendulet::bench
