// `lendulet explain gjk|epa|clip|sat A B`: what the engine does with two shapes, step by step, as pictures.
#pragma once

#include <string>
#include <vector>

#include "lendulet/options.h"
#include "lendulet/result.h"
#include "lendulet/shapes.h"

namespace lendulet::explain {

struct Placed {
    Shape shape;
    Transform place;
};

// "box:0.5,0.4,0.3" or with a place and a turn (axis times angle in degrees): "box:0.5,0.4,0.3@1.2,0.1,0@0,0,30". There
// are box:X,Y,Z (half extents), sphere:R, capsule:H,R, cylinder:H,R, cone:H,R, tapered-capsule:H,R,R and hull:N,R (N
// points on a ball). Error bad_query with a sentence.
Result<Placed> read_shape(const std::string& text);

struct Options {
    std::string what;  // gjk, epa, clip, sat
    std::string a, b;
    std::string simplex = "half-space";  // or barycentric
    std::string svg;                     // the file; empty: explain-WHAT.svg
    bool frames = false;                 // each step in a file of its own: NAME-1.svg, NAME-2.svg, ...
};

// The pictures of a sequence as SVG documents: one, or one for each step.
Result<std::vector<std::string>> draw(const Options& options);
// Draws and writes; gives the exit code 0. Errors: a name or shape that is not known, shapes for which there is nothing
// to see (a depth where there is no overlap), a file that cannot be written.
Result<int> explain(const Options& options);

}  // namespace lendulet::explain
