#include "base/tasks.h"

#include "base/assert.h"

#ifndef LENDULET_SINGLE_THREADED
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace lendulet {

#ifdef LENDULET_SINGLE_THREADED

struct TaskPool::Threads {};
TaskPool::TaskPool(int, Hook hook) : hook_(hook) {
    if (hook_.parallel_for) workers_ = hook_.workers;
}
TaskPool::~TaskPool() = default;
void TaskPool::begin_session() {}
void TaskPool::end_session() {}
void TaskPool::dispatch(int count, int grain, Run run, void* context) {
    if (hook_.parallel_for) hook_.parallel_for(hook_.user, count, grain, run, context);
    else run(context, 0, count, 0);
}

#else

namespace {

inline void relax_cpu() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

constexpr int patient_spins = 4000;  // some 50 to 100 us
constexpr uint32_t no_chunk = 0x7fffffffu;

}  // namespace

// One loop at a time. Its chunks are dealt out in stretches, one a worker, who takes those of his own first and then
// those that others have left: in loop after loop of one size he finds what he wrote in his own caches. A loop is
// published by raising `epoch`; the packed (epoch, chunk) of a stretch keeps a late worker from taking chunks of the
// following loop.
struct TaskPool::Threads {
    struct alignas(64) Stretch {
        std::atomic<uint64_t> ticket{0};  // epoch << 32 | next chunk
        std::atomic<uint32_t> end{0};     // one past its last chunk
    };
    std::vector<std::thread> threads;
    std::vector<Stretch> stretches;
    std::mutex mutex;
    std::condition_variable wake;
    bool stop = false;
    bool session = false;  // guarded by mutex for sleeping, read loosely while spinning
    std::atomic<bool> spinning{false};
    alignas(64) std::atomic<int> done{0};  // chunks finished in this epoch
    alignas(64) std::atomic<uint32_t> epoch{0};
    // The loop of this epoch; written before the tickets are released.
    int count = 0, grain = 1;
    Run run = nullptr;
    void* context = nullptr;

    explicit Threads(int workers) : stretches(static_cast<size_t>(workers)) {}
};

TaskPool::TaskPool(int workers, Hook hook) : workers_(workers < 1 ? 1 : workers), hook_(hook) {
    if (hook_.parallel_for) {
        workers_ = hook_.workers < 1 ? 1 : hook_.workers;
        return;
    }
    if (workers_ == 1) return;
    threads_ = std::make_unique<Threads>(workers_);
    for (int i = 1; i < workers_; ++i) threads_->threads.emplace_back([this, i] { thread_main(i); });
}

TaskPool::~TaskPool() {
    if (!threads_) return;
    {
        std::lock_guard lock(threads_->mutex);
        threads_->stop = true;
    }
    threads_->wake.notify_all();
    for (auto& t : threads_->threads) t.join();
}

void TaskPool::begin_session() {
    if (!threads_) return;
    {
        std::lock_guard lock(threads_->mutex);
        threads_->session = true;
        threads_->spinning.store(true, std::memory_order_relaxed);
    }
    threads_->wake.notify_all();
}

void TaskPool::end_session() {
    if (!threads_) return;
    std::lock_guard lock(threads_->mutex);
    threads_->session = false;
    threads_->spinning.store(false, std::memory_order_relaxed);
}

void TaskPool::work(int worker) {
    Threads& t = *threads_;
    for (int i = 0; i < workers_;) {
        const int owner = worker + i < workers_ ? worker + i : worker + i - workers_;
        Threads::Stretch& own = t.stretches[static_cast<size_t>(owner)];
        uint64_t ticket = own.ticket.load(std::memory_order_acquire);
        const uint32_t chunk = static_cast<uint32_t>(ticket);
        if (chunk >= own.end.load(std::memory_order_acquire)) {
            ++i;
            continue;
        }
        if (!own.ticket.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel)) continue;
        // The chunk is ours: its loop cannot end, nor the next one begin, before we count it as done.
        const int begin = static_cast<int>(chunk) * t.grain, end = begin + t.grain;
        t.run(t.context, begin, end < t.count ? end : t.count, worker);
        t.done.fetch_add(1, std::memory_order_release);
    }
}

void TaskPool::dispatch(int count, int grain, Run run, void* context) {
    if (hook_.parallel_for) {
        hook_.parallel_for(hook_.user, count, grain, run, context);
        return;
    }
    Threads& t = *threads_;
    const int chunks = (count + grain - 1) / grain;
    // No worker holds a chunk here (the last loop waited for all), and none can take one before the tickets are set:
    // every stretch has come to its end.
    t.count = count;
    t.grain = grain;
    t.run = run;
    t.context = context;
    t.done.store(0, std::memory_order_relaxed);
    const uint32_t epoch = t.epoch.load(std::memory_order_relaxed) + 1;
    auto first_chunk = [&](int worker) { return static_cast<uint32_t>(int64_t{chunks} * worker / workers_); };
    for (int w = 0; w < workers_; ++w) {
        // A late worker who has seen the last loop's ticket with this loop's end must find neither any more.
        Threads::Stretch& stretch = t.stretches[static_cast<size_t>(w)];
        stretch.ticket.store(uint64_t{epoch} << 32 | no_chunk, std::memory_order_relaxed);
        stretch.end.store(first_chunk(w + 1), std::memory_order_release);
        stretch.ticket.store(uint64_t{epoch} << 32 | first_chunk(w), std::memory_order_release);
    }
    t.epoch.store(epoch, std::memory_order_release);
    if (!t.spinning.load(std::memory_order_relaxed)) {
        std::lock_guard lock(t.mutex);
        t.wake.notify_all();
    }
    work(0);
    // Nearly always what is left ends within microseconds; only where there are more threads than cores it does not.
    for (int spins = 0; t.done.load(std::memory_order_acquire) < chunks;) {
        if (++spins < patient_spins) relax_cpu();
        else std::this_thread::yield();
    }
}

void TaskPool::thread_main(int worker) {
    Threads& t = *threads_;
    uint32_t seen = 0;
    for (;;) {
        for (int spins = 0; t.epoch.load(std::memory_order_acquire) == seen; ++spins) {
            if (t.spinning.load(std::memory_order_relaxed)) {
                if (spins < patient_spins) relax_cpu();
                else std::this_thread::yield();
                continue;
            }
            std::unique_lock lock(t.mutex);
            t.wake.wait(lock, [&] { return t.stop || t.session || t.epoch.load(std::memory_order_acquire) != seen; });
            if (t.stop) return;
        }
        seen = t.epoch.load(std::memory_order_acquire);
        work(worker);
    }
}

#endif

}  // namespace lendulet
