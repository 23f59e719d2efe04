#include "base/memory.h"

#include <cstdio>
#include <cstdlib>

namespace lendulet {
namespace {

// With the exit code of detail::fail(), and at once: what would be tidied up might need memory too.
[[noreturn]] void out_of_memory(size_t bytes) {
    std::fprintf(stderr, "lendulet: out of memory (%zu bytes)\n", bytes);
    std::_Exit(2);
}

// The heap aligns for plain types only, and aligned memory cannot be enlarged. So blocks are longer than asked for, and
// what is handed out begins at their next cache line; the byte before it says how far into the block that is.
size_t shift_of(const void* block) {
    return Memory::alignment - reinterpret_cast<uintptr_t>(block) % Memory::alignment;
}

void* align(void* block) {
    const size_t shift = shift_of(block);
    auto* memory = static_cast<unsigned char*>(block) + shift;
    memory[-1] = static_cast<unsigned char>(shift);
    return memory;
}

void* block_of(void* memory) {
    auto* bytes = static_cast<unsigned char*>(memory);
    return bytes - bytes[-1];
}

void* enlarge_on_heap(void* old, size_t used, size_t bytes) {
    const size_t shift = old ? static_cast<unsigned char*>(old)[-1] : 0;
    void* block = std::realloc(old ? block_of(old) : nullptr, bytes + Memory::alignment);
    if (!block) out_of_memory(bytes);
    if (used > 0 && shift_of(block) != shift) {
        auto* start = static_cast<unsigned char*>(block);
        std::memmove(start + shift_of(block), start + shift, used);
    }
    return align(block);
}

}  // namespace

void* Memory::allocate(size_t bytes) const {
    if (!allocate_hook) return enlarge_on_heap(nullptr, 0, bytes);
    void* memory = allocate_hook(user, bytes, alignment);
    if (!memory) out_of_memory(bytes);
    return memory;
}

void* Memory::enlarge(void* old, size_t old_bytes, size_t used, size_t bytes) const {
    // The heap does not know what is used and may copy all.
    if (!allocate_hook && 2 * used >= old_bytes) return enlarge_on_heap(old, used, bytes);
    void* memory = allocate(bytes);
    if (used > 0) std::memcpy(memory, old, used);
    if (old) free(old, old_bytes);
    return memory;
}

void Memory::free(void* memory, size_t bytes) const {
    if (allocate_hook) free_hook(user, memory, bytes, alignment);
    else if (memory) std::free(block_of(memory));
}

#ifdef LENDULET_ASSERTIONS
namespace detail {
void assertion_failed(const char* expression, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, expression);
    std::abort();
}
}  // namespace detail
#endif

namespace {

constexpr Memory heap{};

}  // namespace

void* Memory::grow(const Memory* memory, void* old, size_t element, size_t size, size_t& capacity, size_t wanted) {
    constexpr size_t least = 16;
    const size_t before = capacity, half_more = before + before / 2;
    capacity = wanted > half_more ? wanted : half_more;
    if (capacity < least) capacity = least;
    return (memory ? *memory : heap).enlarge(old, before * element, size * element, capacity * element);
}

void Memory::release(const Memory* memory, void* old, size_t bytes) { (memory ? *memory : heap).free(old, bytes); }

}  // namespace lendulet
