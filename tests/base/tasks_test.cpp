// The loops of workers: every index once, whatever the sizes, the number of workers and how late they come.
#include "base/tasks.h"

#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace lendulet {
namespace {

// How often a loop visited each index.
template <class Loop>
std::vector<int> visits(int count, Loop&& loop) {
    std::vector<std::atomic<int>> seen(static_cast<size_t>(count));
    loop([&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) seen[static_cast<size_t>(i)].fetch_add(1, std::memory_order_relaxed);
    });
    return {seen.begin(), seen.end()};
}

TEST(TaskPool, VisitsEveryIndexOnce) {
    for (int workers : {1, 2, 3, 8}) {
        TaskPool pool(workers);
        TaskPool::Session session(pool);
        for (int count : {0, 1, 2, 7, 64, 1000})
            for (int grain : {1, 3, 64, 5000}) {
                const std::vector<int> once(static_cast<size_t>(count), 1);
                EXPECT_EQ(visits(count, [&](auto body) { pool.for_each(count, grain, body); }), once)
                    << workers << ' ' << count << ' ' << grain;
                EXPECT_EQ(visits(count, [&](auto body) { pool.share(count, grain, body); }), once)
                    << workers << ' ' << count << ' ' << grain;
            }
    }
}

// Loops that follow each other at once, of other lengths each time: a worker that comes late to one must not take a
// piece of the next for one of it.
TEST(TaskPool, LateWorkersTakeNothingTwice) {
    TaskPool pool(4);
    TaskPool::Session session(pool);
    std::vector<int> values(97);
    int64_t expected = 0;
    for (int loop = 0; loop < 20000; ++loop) {
        const int count = 1 + loop * 31 % 97;
        pool.for_each(count, 1 + loop % 3, [&](int begin, int end, int) {
            for (int i = begin; i < end; ++i) ++values[static_cast<size_t>(i)];
        });
        expected += count;
    }
    int64_t sum = 0;
    for (int v : values) sum += v;
    EXPECT_EQ(sum, expected);
}

TEST(TaskPool, WorksOutsideASessionToo) {
    TaskPool pool(3);
    for (int loop = 0; loop < 50; ++loop) {
        EXPECT_EQ(visits(40, [&](auto body) { pool.for_each(40, 1, body); }), std::vector<int>(40, 1));
        if (loop % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));  // they fall asleep
    }
}

TEST(TaskPool, WorkersHaveNumbersOfTheirOwn) {
    TaskPool pool(3);
    TaskPool::Session session(pool);
    std::atomic<int> inside[3] = {};
    std::atomic<bool> shared{false};
    for (int loop = 0; loop < 200; ++loop)
        pool.for_each(30, 1, [&](int, int, int worker) {
            ASSERT_TRUE(worker >= 0 && worker < 3);
            if (inside[worker].fetch_add(1) != 0) shared = true;
            inside[worker].fetch_sub(1);
        });
    EXPECT_FALSE(shared.load());
}

}  // namespace
}  // namespace lendulet
