// The end of a program that asked for a value where there is an error: the one place where the core prints such
// sentences.
#include "lendulet/result.h"

#include <cstdio>
#include <cstdlib>

namespace lendulet::detail {

void fail(const Error& error) {
    std::fprintf(stderr, "lendulet: %s\n", error.message.c_str());
    std::exit(2);
}

}  // namespace lendulet::detail
