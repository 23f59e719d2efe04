// Sequences as SVG: each step is drawn twice, seen along z and obliquely, at one scale for all.
#pragma once

#include <string>
#include <vector>

#include "explain/sequence.h"

namespace lendulet::explain {

// One document of all steps in two columns, or one of each.
std::vector<std::string> documents(const std::string& title, const Sequence& sequence, bool frames);

}  // namespace lendulet::explain
