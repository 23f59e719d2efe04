// Threads that the program around the engine has started and lends to it, where the engine cannot start any: in
// WebAssembly a page's workers. All pools of a program share one crew, so that worlds come and go without threads that
// do. It uses nothing but atomic numbers, and the thread that steps a world never sleeps, which a page's own must not:
// it does what nobody else has begun and waits for no more than the chunks that others hold. So a crew whose threads
// are late, few or none at all is a slower one and no other.
#pragma once

#include "base/shared_loop.h"

namespace lendulet {

class Crew {
public:
    static constexpr int most = 64;  // workers, the thread that steps included

    constexpr Crew() : loop_(workers_) {}
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;
    // The one of this program.
    static Crew& common();

    // Does loops as worker `number`, 1 to most - 1, which nobody else is at the same time; sleeps where there are none
    // for it. Returns after dismiss().
    void lend(int number);
    void dismiss();
    // A lent thread has ended where it must not, in the middle of a loop; ends the program, for what it had begun
    // nobody can finish.
    void stopped() { stopped_.store(true, std::memory_order_release); }

    // body(begin, end, worker) for all chunks, worker < workers; returns when all are done. One loop at a time is
    // shared: a second thread that comes meanwhile, or a loop within a loop, does its own alone.
    void run(int workers, int count, int grain, SharedLoop::Run run, void* context);

private:
    struct alignas(64) Bed {
        std::atomic<uint32_t> asleep{0};
    };

    bool sleep(int number, uint32_t seen);
    void wake(int number);

    SharedLoop::Worker workers_[most];
    Bed beds_[most];
    SharedLoop loop_;
    std::atomic<uint32_t> calls_{0};  // loops so far
    std::atomic<bool> busy_{false}, dismissed_{false}, stopped_{false};
};

}  // namespace lendulet
