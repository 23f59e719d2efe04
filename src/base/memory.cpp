#include "base/memory.h"

#include <cstdio>
#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace lendulet {

namespace {

// Arrays from this size on lie on pages of their own, of this size where the system has such. A large scene touches
// some tens of megabytes all over the place in every step: thousands of small pages, more than a processor keeps
// addresses of, and each costs a fault when it is first touched.
constexpr size_t huge_page = size_t{2} << 20;

size_t alignment_for(size_t bytes) { return bytes >= huge_page ? huge_page : Memory::alignment; }

void* from_heap(size_t bytes) {
    void* memory = ::operator new (bytes, std::align_val_t{alignment_for(bytes)}, std::nothrow);
#if defined(__linux__)
    if (memory && bytes >= huge_page) madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: where refused, nothing changes
#endif
    return memory;
}

}  // namespace

void* Memory::allocate(size_t bytes) const {
    void* memory = allocate_hook ? allocate_hook(user, bytes, alignment) : from_heap(bytes);
    if (!memory) {
        std::fprintf(stderr, "lendulet: out of memory (%zu bytes)\n", bytes);
        std::abort();
    }
    return memory;
}

void Memory::free(void* memory, size_t bytes) const {
    if (free_hook) free_hook(user, memory, bytes, alignment);
    else ::operator delete (memory, std::align_val_t{alignment_for(bytes)});
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
