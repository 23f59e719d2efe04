#include "base/crew.h"

#include <cstdlib>

namespace lendulet {
namespace {

// Some 0.2 ms: longer than nearly all that a step does between two loops, and about what sleeping and waking take.
constexpr int patient_looks = 6000;

// Between two looks. WebAssembly has no instruction for it: divisions that wait for each other take about as long as
// one does elsewhere, and leave nearly all of a core to its other thread, which most likely has the work.
class Pause {
public:
    void operator()() {
        for (int i = 0; i < 8; ++i) value_ = 3.0 / value_;
        if (value_ == 0.0) std::abort();  // never, which the compiler does not know
    }

private:
    double value_ = 1.7;
};

#ifdef __wasm__
inline void wait(std::atomic<uint32_t>& place, uint32_t value) {
    __builtin_wasm_memory_atomic_wait32(reinterpret_cast<int*>(&place), static_cast<int>(value), -1);
}
inline void notify(std::atomic<uint32_t>& place) {
    __builtin_wasm_memory_atomic_notify(reinterpret_cast<int*>(&place), 1);
}
#else
inline void wait(std::atomic<uint32_t>& place, uint32_t value) { place.wait(value); }
inline void notify(std::atomic<uint32_t>& place) { place.notify_one(); }
#endif

}  // namespace

Crew& Crew::common() {
    static constinit Crew crew;
    return crew;
}

// False: nobody is wanted any more.
bool Crew::sleep(int number, uint32_t seen) {
    std::atomic<uint32_t>& asleep = beds_[number].asleep;
    // Both sides write first and look then, in one order for all threads: a loop that begins meanwhile is either seen
    // here, or finds that this worker sleeps.
    asleep.store(1);
    if (calls_.load() == seen && !dismissed_.load()) wait(asleep, 1);
    asleep.store(0);
    return !dismissed_.load();
}

void Crew::wake(int number) {
    std::atomic<uint32_t>& asleep = beds_[number].asleep;
    if (asleep.load() == 0) return;
    asleep.store(0);
    notify(asleep);
}

void Crew::lend(int number) {
    if (number < 1 || number >= most) return;
    uint32_t seen = 0;
    Pause pause;
    for (;;) {
        for (int looks = 0; calls_.load(std::memory_order_acquire) == seen; ++looks) {
            if (looks >= patient_looks && !sleep(number, seen)) return;
            pause();
        }
        seen = calls_.load(std::memory_order_acquire);
        loop_.work(number, pause);
    }
}

void Crew::dismiss() {
    dismissed_.store(true);
    for (int w = 1; w < most; ++w) wake(w);
}

void Crew::run(int workers, int count, int grain, SharedLoop::Run run, void* context) {
    if (busy_.exchange(true)) {
        run(context, 0, count, 0);
        return;
    }
    loop_.begin(workers < most ? workers : most, count, grain, run, context);
    calls_.fetch_add(1);
    for (int w = 1; w < workers && w < most; ++w) wake(w);
    Pause pause;
    loop_.work(0, pause);
    while (!loop_.ended()) {
        if (stopped_.load(std::memory_order_relaxed)) std::abort();
        pause();
    }
    busy_.store(false);
}

}  // namespace lendulet
