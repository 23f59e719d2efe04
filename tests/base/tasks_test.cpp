// The loops of workers: every index once, whatever the sizes, the number of workers and how late they come.
#include "base/tasks.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/crew.h"

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

TEST(TaskPool, WhatIsDoneAloneIsDoneByTheCaller) {
    TaskPool pool(3);
    TaskPool::shares_all = false;
    auto loops = [&] {
        int calls = 0;
        const std::thread::id caller = std::this_thread::get_id();
        pool.for_each(1000, 1, [&](int begin, int end, int worker) {
            ++calls;  // of one thread, or the thread sanitizer tells
            EXPECT_TRUE(begin == 0 && end == 1000 && worker == 0);
            EXPECT_EQ(std::this_thread::get_id(), caller);
        });
        return calls;
    };
    {
        const TaskPool::Alone shared(pool, false);
        EXPECT_EQ(pool.sharing(), 3);
        const TaskPool::Alone alone(pool, true);
        EXPECT_EQ(pool.sharing(), 1);
        EXPECT_EQ(pool.workers(), 3);
        const TaskPool::Alone again(pool, false);
        EXPECT_EQ(pool.sharing(), 1);
        const TaskPool::Session session(pool);
        EXPECT_EQ(loops(), 1);
        EXPECT_EQ(pool.parts(1000, 1), 2);
    }
    EXPECT_EQ(pool.sharing(), 3);
    EXPECT_EQ(visits(1000, [&](auto body) { pool.for_each(1000, 1, body); }), std::vector<int>(1000, 1));
    TaskPool::shares_all = true;
    const TaskPool::Alone alone(pool, true);
    EXPECT_EQ(pool.sharing(), 3);
}

TEST(TaskPool, EachWorkerHasAsManyParts) {
    const TaskPool pool(3);
    EXPECT_EQ(pool.parts(10, 20), 1);
    EXPECT_EQ(pool.parts(40, 20), 2);
    EXPECT_EQ(pool.parts(60, 20), 3);
    EXPECT_EQ(pool.parts(100, 20), 3);
    EXPECT_EQ(pool.parts(120, 20), 6);
    EXPECT_EQ(pool.parts(100000, 20), 6);
}

// In loops of one size everybody keeps to his stretch, and takes from others what they do not come for.
TEST(TaskPool, StretchesStayWithTheirWorkersUnlessThoseAreLate) {
    TaskPool pool(2);
    TaskPool::Session session(pool);
    std::atomic<int> strange{0};
    constexpr int loops = 200;
    for (int loop = 0; loop < loops; ++loop) {
        std::atomic<int> inside{0};
        pool.for_each(2, 1, [&](int begin, int, int worker) {
            strange += begin != worker;
            ++inside;  // both come, or one gives up waiting
            for (int looks = 0; inside.load() < 2 && looks < 2000; ++looks) std::this_thread::yield();
        });
    }
    // On a machine with one free core the caller takes nearly all.
    if (std::thread::hardware_concurrency() > 1) {
        EXPECT_LT(strange.load(), loops / 2);
    }
    std::atomic<int> by_caller{0};
    pool.for_each(64, 1, [&](int, int, int worker) {
        if (worker == 0) ++by_caller;
        else std::this_thread::sleep_for(std::chrono::milliseconds(20));
    });
    EXPECT_GT(by_caller.load(), 32);
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

// Threads that lend themselves to a crew until it is dismissed.
class Lent {
public:
    explicit Lent(Crew& crew) : crew_(crew) {}
    ~Lent() {
        crew_.dismiss();
        for (std::thread& t : threads_) t.join();
    }
    void add(int number) {
        threads_.emplace_back([this, number] { crew_.lend(number); });
    }

private:
    Crew& crew_;
    std::vector<std::thread> threads_;
};

template <class Body>
void run(Crew& crew, int workers, int count, int grain, Body body) {
    crew.run(
        workers, count, grain, [](void* c, int b, int e, int w) { (*static_cast<Body*>(c))(b, e, w); }, &body);
}

TEST(Crew, SeveralThreadsVisitEveryIndexOnceHoweverManyCome) {
    Crew crew;
    Lent lent(crew);
    for (int threads = 1; threads <= 4; ++threads) {
        for (int workers : {1, 2, 3, 8})
            for (int count : {1, 7, 64, 1000})
                for (int grain : {1, 3, 64, 5000}) {
                    const std::vector<int> once(static_cast<size_t>(count), 1);
                    EXPECT_EQ(visits(count, [&](auto body) { run(crew, workers, count, grain, body); }), once)
                        << threads << ' ' << workers << ' ' << count << ' ' << grain;
                }
        lent.add(threads);
    }
}

// Worlds of different numbers of workers take turns, as forks do: a worker beyond those of a loop must take nothing.
TEST(Crew, SeveralThreadsLateToALoopOfFewerWorkersTakeNothing) {
    Crew crew;
    Lent lent(crew);
    for (int number = 1; number < 4; ++number) lent.add(number);
    std::atomic<bool> strangers{false};
    std::vector<int> values(97);
    int64_t expected = 0, sum = 0;
    for (int loop = 0; loop < 20000; ++loop) {
        const int count = 1 + loop * 31 % 97, workers = 1 + loop % 4;
        run(crew, workers, count, 1 + loop % 3, [&](int begin, int end, int worker) {
            if (worker < 0 || worker >= workers) strangers = true;
            for (int i = begin; i < end; ++i) ++values[static_cast<size_t>(i)];
        });
        expected += count;
    }
    for (int v : values) sum += v;
    EXPECT_EQ(sum, expected);
    EXPECT_FALSE(strangers.load());
}

TEST(Crew, ThreadsThatSleepAreWoken) {
    Crew crew;
    Lent lent(crew);
    lent.add(1);
    for (int loop = 0; loop < 10; ++loop) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        // Ends only where both are there at the same time.
        std::atomic<int> there{0};
        run(crew, 2, 2, 1, [&](int, int, int) {
            ++there;
            while (there < 2) std::this_thread::yield();
        });
        EXPECT_EQ(there, 2);
    }
}

TEST(Crew, LoopsWithinLoopsAndOfOtherThreadsAreDoneAlone) {
    Crew crew;
    Lent lent(crew);
    lent.add(1);
    std::atomic<int> visited{0};
    auto loops = [&] {
        for (int loop = 0; loop < 200; ++loop)
            run(crew, 2, 10, 1, [&](int begin, int end, int) {
                for (int i = begin; i < end; ++i) run(crew, 2, 3, 1, [&](int b, int e, int) { visited += e - b; });
            });
    };
    std::thread other(loops);
    loops();
    other.join();
    EXPECT_EQ(visited, 2 * 200 * 10 * 3);
}

}  // namespace
}  // namespace lendulet
