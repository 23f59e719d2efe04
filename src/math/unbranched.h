// Writing what may have to be written without a branch: the value goes to its place in any case, and the place after it
// is moved on by one or by nothing. Compilers tend to see through that and to branch after all, which costs more than
// the whole test where the condition is as good as a toss of a coin.
#pragma once

#include <cstddef>

#include "lendulet/math.h"

namespace lendulet {

// 1 or 0, as a number whose origin the compiler does not know.
LENDULET_FORCE_INLINE size_t one_if(bool condition) {
    size_t one = condition;
    asm("" : "+r"(one));
    return one;
}

}  // namespace lendulet
