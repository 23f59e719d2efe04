// The second module, which the page loads when it explains collisions: one function over flat bytes.
#include <cstdint>
#include <string>

#include "explain/flat.h"

using namespace lendulet::explain;

extern "C" {

// The sequence `what` (gjk, epa, distance, clip, sat) of two shapes in words: how many bytes there are at `out` (the
// form is that of explain/flat.h), which hold until the next call, or -1 - ErrorCode; then they are the sentence that
// goes with it, and end with a zero byte.
int32_t lendulet_explain(const char* what, const char* simplex, const char* a, const char* b, const char** out) {
    static std::string bytes;
    lendulet::Result<Sequence> made = sequence({what, a, b, simplex});
    bytes = made ? flat(made.value()) : made.error().message;
    *out = bytes.c_str();
    return made ? static_cast<int32_t>(bytes.size()) : -1 - static_cast<int32_t>(made.error().code);
}
}
