// How much of a long test to do. Slow builds (sanitizers) set LENDULET_TEST_SCALE=N in the environment, which divides
// counts of random cases and steps by N.
#pragma once

#include <cstdlib>

namespace lendulet {

inline int scaled(int count, int least = 1) {
    const char* text = std::getenv("LENDULET_TEST_SCALE");
    int scale = text ? std::atoi(text) : 1;
    int reduced = scale > 1 ? count / scale : count;
    return reduced < least ? least : reduced;
}

}  // namespace lendulet
