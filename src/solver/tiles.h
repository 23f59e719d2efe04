// How a range of packed bodies is cut into tiles that about fit into the second-level cache with their constraints (1.6
// kB a body with three contacts). One thread takes a tile through all that needs nothing from other tiles, from loop to
// loop the same one if it comes in time: few barriers, and few lines that go from core to core.
//
// Where tiles end depends on the bodies alone, never on the number of workers: results must not show it.
#pragma once

#include <cstdint>

#include "solver/bodies.h"

namespace lendulet {

inline constexpr int tile_bodies = 512;  // places in a tile; a multiple of block_bodies

struct Tiles {
    BodyRange range{0, 0};
    int count = 1;

    // All bodies as one tile.
    Tiles() = default;
    // Few bodies are one tile. The range is one that TilePlaces filled.
    explicit Tiles(BodyRange bodies) : range(bodies) {
        const int places = bodies.end - bodies.begin;
        if (places > 2 * tile_bodies) count = (places + tile_bodies - 1) / tile_bodies;
    }
    int of(int32_t body) const { return (body - range.begin) / tile_bodies; }
    // That of two bodies, of which one may be a reserved one; `count` where they are of two or all is one tile.
    int of(int32_t a, int32_t b) const {
        if (count == 1) return 1;
        if (a < reserved_bodies) return of(b);
        if (b < reserved_bodies) return of(a);
        return of(a) == of(b) ? of(a) : count;
    }
    BodyRange bodies(int tile) const {
        if (count == 1) return range;
        const int begin = range.begin + tile * tile_bodies, end = begin + tile_bodies;
        return {begin, end < range.end ? end : range.end};
    }
    // The place at the end of each tile that no body has: what empty lanes of its rows name, so that two threads never
    // write to the same one.
    int32_t filler(int tile) const { return bodies(tile).end - 1; }
};

// Places for bodies, one after the other from `begin` on, a multiple of block_bodies. Leaves out those that are
// fillers.
class TilePlaces {
public:
    TilePlaces(int begin, int bodies) : begin_(begin), next_(begin) {
        const int room = tile_bodies - 1, rest = bodies % room;
        tiled_ = round_up(bodies) > 2 * tile_bodies;
        end_ = begin + (tiled_ ? bodies / room * tile_bodies + (rest > 0 ? round_up(rest + 1) : 0) : round_up(bodies));
    }
    int take() {
        if (tiled_ && is_filler(next_)) ++next_;
        return next_++;
    }
    int end() const { return end_; }
    // Calls visit(place) for all places that no body has; after the last take().
    template <class Visit>
    void for_each_empty(Visit&& visit) const {
        if (tiled_)
            for (int i = begin_ + tile_bodies - 1; i < next_; i += tile_bodies) visit(i);
        for (int i = next_; i < end_; ++i) visit(i);
    }

private:
    static int round_up(int n) { return (n + block_bodies - 1) / block_bodies * block_bodies; }
    bool is_filler(int place) const { return (place - begin_) % tile_bodies == tile_bodies - 1; }

    int begin_, next_, end_;
    bool tiled_;
};

}  // namespace lendulet
