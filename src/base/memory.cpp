#include "base/memory.h"

#include <cstdio>
#include <cstdlib>

namespace lendulet {

void* Memory::allocate(size_t bytes) const {
    void* memory = allocate_hook ? allocate_hook(user, bytes, alignment)
                                 : ::operator new (bytes, std::align_val_t{alignment}, std::nothrow);
    if (!memory) {
        std::fprintf(stderr, "lendulet: out of memory (%zu bytes)\n", bytes);
        std::abort();
    }
    return memory;
}

void Memory::free(void* memory, size_t bytes) const {
    if (free_hook) free_hook(user, memory, bytes, alignment);
    else ::operator delete (memory, std::align_val_t{alignment});
}

#ifdef LENDULET_ASSERTIONS
namespace detail {
void assertion_failed(const char* expression, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, expression);
    std::abort();
}
}  // namespace detail
#endif

}  // namespace lendulet
