// `lendulet bench collision`: distance and depth queries, manifolds and rays, by themselves, beside other libraries.
#pragma once

#include <string>

#include "lendulet/result.h"

namespace lendulet::bench {

struct CollisionOptions {
    std::string csv;     // file to write, empty for none: routine,case,median_ns,worst_error,failures
    int pairs = 20000;   // of boxes in each case, 16 .. 1 000 000; of hulls a fifth
    int rays = 100000;   // 1 .. 10 000 000
    int bodies = 16000;  // of the pile that the rays meet, 1 .. 100 000
    int repeats = 9;     // rounds by turns, of which the median counts, 1 .. 1000
};

// Measures and prints the table. Gives the exit code: 1 where an answer of this engine's is wrong, else 0. Errors: an
// option that is not as above, a file that cannot be written; nothing has been measured then.
Result<int> bench_collision(const CollisionOptions& options);

}  // namespace lendulet::bench
