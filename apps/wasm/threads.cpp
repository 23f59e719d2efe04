// What the module with threads has beside the C interface. Its memory is shared: each of the page's workers makes an
// instance of the module over the same memory, gives it a stack of its own, and lends itself to the engine.
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "base/crew.h"

// The C library was compiled for one thread. The engine's loops ask it for nothing that it keeps: they take no memory
// (docs/threads.md), and what else has static data is called by the thread that steps. All the same the heap has a
// lock, for what a host may do beside a step; who waits for it spins, since a page's own thread must not sleep.
namespace {

std::atomic<bool> heap_taken{false};

struct HeapLock {
    HeapLock() {
        while (heap_taken.exchange(true, std::memory_order_acquire)) {}
    }
    ~HeapLock() { heap_taken.store(false, std::memory_order_release); }
    HeapLock(const HeapLock&) = delete;
    HeapLock& operator=(const HeapLock&) = delete;
};

}  // namespace

extern "C" {

void* __real_malloc(size_t size);
void* __real_calloc(size_t count, size_t size);
void* __real_realloc(void* old, size_t size);
void* __real_aligned_alloc(size_t alignment, size_t size);
int __real_posix_memalign(void** out, size_t alignment, size_t size);
void __real_free(void* memory);

[[clang::export_name("malloc")]] void* __wrap_malloc(size_t size) {
    HeapLock lock;
    return __real_malloc(size);
}
void* __wrap_calloc(size_t count, size_t size) {
    HeapLock lock;
    return __real_calloc(count, size);
}
void* __wrap_realloc(void* old, size_t size) {
    HeapLock lock;
    return __real_realloc(old, size);
}
void* __wrap_aligned_alloc(size_t alignment, size_t size) {
    HeapLock lock;
    return __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** out, size_t alignment, size_t size) {
    HeapLock lock;
    return __real_posix_memalign(out, alignment, size);
}
[[clang::export_name("free")]] void __wrap_free(void* memory) {
    HeapLock lock;
    __real_free(memory);
}

// For an instance of its own over the module's memory, with a stack of its own: works as thread `number`, 1 to 63, in
// the steps of worlds with more workers than that, and does not return. Numbers are given out once; the thread that
// steps is number 0. Threads may come at any time: without them a step does everything itself, with the same bits.
void lendulet_lend_thread(int32_t number) { lendulet::Crew::common().lend(number); }

// To be called where lendulet_lend_thread() has ended by a trap: a step that waits for the thread ends by one as well.
void lendulet_thread_stopped() { lendulet::Crew::common().stopped(); }

}  // extern "C"
