// `lendulet explain gjk|epa|distance|clip|sat A B`: what the engine does with two shapes, step by step, as pictures.
#pragma once

#include <string>
#include <vector>

#include "explain/sequence.h"

namespace lendulet::explain {

struct Options {
    Question question;
    std::string svg;      // the file; empty: explain-WHAT.svg
    bool frames = false;  // each step in a file of its own: NAME-1.svg, NAME-2.svg, ...
};

// The pictures of a sequence as SVG documents: one, or one for each step.
Result<std::vector<std::string>> draw(const Options& options);
// Draws and writes; gives the exit code 0. Errors: those of sequence(), a file that cannot be written.
Result<int> explain(const Options& options);

}  // namespace lendulet::explain
