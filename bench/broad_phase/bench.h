// `lendulet bench broad-phase`: every broad phase of this engine beside those of others.
#pragma once

#include <string>
#include <vector>

#include "lendulet/result.h"

namespace lendulet::bench {

// Lists are of names or numbers separated by commas; empty: the default.
struct BroadPhaseOptions {
    std::string sizes;          // 1 .. 10 000 000; default 10 to 100 000, and a million for `uniform`
    std::string distributions;  // uniform, clustered, ground, one-huge; default all
    std::string modes;          // rebuild, split, refit, query; default all
    std::string structures;     // ours and the peers built in; default all
    std::string csv, svg;       // files to write, empty for none
    int repeats = 15;           // samples, 1 .. 1000; slow structures give fewer
};

// Measures and prints a table for each cell as it comes. Gives the exit code: 0, or 1 where two structures find
// different pairs, after a sentence on standard error. Errors: an option that is not as above, a file that cannot be
// written; nothing has been measured then.
Result<int> bench_broad_phase(const BroadPhaseOptions& options);

}  // namespace lendulet::bench
