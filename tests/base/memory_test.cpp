// Arrays: what is in them stays as they grow, on the heap and through a hook, and always begins at a cache line.
#include <gtest/gtest.h>

#include <cstdlib>

#include "base/memory.h"

namespace lendulet::test {
namespace {

struct HookedHeap {
    long live = 0, calls = 0;

    Memory memory() {
        return {this,
                [](void* user, size_t bytes, size_t alignment) {
                    auto& heap = *static_cast<HookedHeap*>(user);
                    heap.live += static_cast<long>(bytes), ++heap.calls;
                    return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
                },
                [](void* user, void* memory, size_t bytes, size_t) {
                    static_cast<HookedHeap*>(user)->live -= static_cast<long>(bytes);
                    std::free(memory);
                }};
    }
};

template <class T>
bool at_cache_line(const Array<T>& array) {
    return reinterpret_cast<uintptr_t>(array.data()) % Memory::alignment == 0;
}

// Two arrays by turns, so that neither can always be enlarged where it is; to sizes that the heap gives pages of their
// own.
void grow_by_turns(const Memory* memory) {
    Array<uint32_t> numbers(memory), others(memory);
    size_t capacity = 0;
    for (uint32_t i = 0; i < 600'000; ++i) {
        numbers.push_back(i);
        if (i % 3 == 0) others.push_back(~i);
        if (numbers.capacity() == capacity) continue;
        capacity = numbers.capacity();
        ASSERT_TRUE(at_cache_line(numbers) && at_cache_line(others)) << capacity;
        for (uint32_t k = 0; k <= i; ++k) ASSERT_EQ(numbers[k], k) << "of " << capacity;
    }
    for (uint32_t k = 0; k < others.size(); ++k) ASSERT_EQ(others[k], ~(3 * k));
}

TEST(Arrays, KeepWhatIsInThemOnTheHeap) { grow_by_turns(nullptr); }

TEST(Arrays, KeepWhatIsInThemThroughAHook) {
    HookedHeap heap;
    const Memory memory = heap.memory();
    grow_by_turns(&memory);
    EXPECT_GT(heap.calls, 20);
    EXPECT_EQ(heap.live, 0);
}

TEST(Arrays, RoomTakenAheadHoldsWhatWasThere) {
    Array<uint64_t> array;
    for (uint64_t i = 0; i < 100; ++i) array.push_back(i * i);
    array.make_ready(50'000);
    ASSERT_GE(array.capacity(), 50'000u);
    const uint64_t* data = array.data();
    for (uint64_t i = 100; i < 50'000; ++i) array.push_back(i * i);
    EXPECT_EQ(array.data(), data);
    for (uint64_t i = 0; i < 50'000; ++i) ASSERT_EQ(array[i], i * i);
}

TEST(Arrays, ThatGetNoMemoryEndTheProgramWithASentence) {
    const Memory none{nullptr, [](void*, size_t, size_t) -> void* { return nullptr; },
                      [](void*, void*, size_t, size_t) {}};
    Array<int> array(&none);
    EXPECT_EXIT(array.push_back(1), ::testing::ExitedWithCode(2), "lendulet: out of memory .* bytes");
}

}  // namespace
}  // namespace lendulet::test
