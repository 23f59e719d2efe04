// `lendulet bench scenes`: built-in scenes in this engine and in others, by turns.
#pragma once

#include <string>

#include "lendulet/result.h"

namespace lendulet::bench {

struct SceneOptions {
    std::string scenes;   // names separated by commas; empty: the default set
    std::string threads;  // thread counts separated by commas, 1 .. 64; empty: 1. Other engines run beside 1
    std::string against;  // "bullet", "none"; empty: bullet where it was built in
    std::string csv;      // file to write, empty for none
    int steps = 0;        // measured steps, 1 .. 100000; 0: what each scene is meant for
    int repeats = 3;      // rounds, 1 .. 100; the time of a step is the least of all rounds
};

// Measures and prints a table row by row. Gives the exit code, 0. Errors: an option that is not as above, an unknown
// scene, a file that cannot be written; nothing has been measured then.
Result<int> bench_scenes(const SceneOptions& options);

}  // namespace lendulet::bench
