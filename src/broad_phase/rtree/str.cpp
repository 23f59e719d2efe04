#include "broad_phase/rtree/str.h"

namespace lendulet {

namespace {

constexpr int node_size = 8;

constexpr int ceil_divide(int a, int b) { return (a + b - 1) / b; }

// Smallest n with n^power >= x.
int root_above(int x, int power) {
    for (int n = 1;; ++n) {
        int64_t p = 1;
        for (int i = 0; i < power; ++i) p *= n;
        if (p >= x) return n;
    }
}

// Cuts into consecutive runs of `run` along an axis, the last one shorter.
void cut_into_runs(BoxCentre* centres, int count, int run, int axis) {
    int runs = ceil_divide(count, run);
    if (runs < 2) return;
    int half = runs / 2 * run;
    select_smallest(centres, count, half, axis);
    cut_into_runs(centres, half, run, axis);
    cut_into_runs(centres + half, count - half, run, axis);
}

// Tiles by the axes from `axis` on.
void tile(BoxCentre* centres, int count, int axis) {
    int nodes = ceil_divide(count, node_size);
    int run = axis == 2 ? node_size : node_size * ceil_divide(nodes, root_above(nodes, 3 - axis));
    cut_into_runs(centres, count, run, axis);
    if (axis == 2) return;
    for (int begin = 0; begin < count; begin += run) {
        tile(centres + begin, count - begin < run ? count - begin : run, axis + 1);
    }
}

}  // namespace

void str_tile(BoxCentre* centres, int count) { tile(centres, count, 0); }

}  // namespace lendulet
