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

}  // namespace

// One loop at a time. A loop is published by raising `epoch`; workers take chunks from `next` until none is left and
// then lower `busy`. The packed (epoch, chunk) counter keeps a late worker from taking chunks of the following loop.
struct TaskPool::Threads {
    std::vector<std::thread> threads;
    std::mutex mutex;
    std::condition_variable wake;
    bool stop = false;
    bool session = false;  // guarded by mutex for sleeping, read loosely while spinning
    std::atomic<bool> spinning{false};
    alignas(64) std::atomic<uint64_t> ticket{0};  // epoch << 32 | next chunk
    alignas(64) std::atomic<int> done{0};         // chunks finished in this epoch
    alignas(64) std::atomic<uint32_t> epoch{0};
    // The loop of this epoch; written before `ticket` is released.
    int count = 0, grain = 1;
    std::atomic<int> chunks{0};
    Run run = nullptr;
    void* context = nullptr;
};

TaskPool::TaskPool(int workers, Hook hook) : workers_(workers < 1 ? 1 : workers), hook_(hook) {
    if (hook_.parallel_for) {
        workers_ = hook_.workers < 1 ? 1 : hook_.workers;
        return;
    }
    if (workers_ == 1) return;
    threads_ = std::make_unique<Threads>();
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
    for (;;) {
        uint64_t ticket = t.ticket.load(std::memory_order_acquire);
        uint32_t chunk = static_cast<uint32_t>(ticket);
        if (chunk >= static_cast<uint32_t>(t.chunks.load(std::memory_order_relaxed))) return;
        if (!t.ticket.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel)) continue;
        // The chunk is ours: its loop cannot end, nor the next one begin, before we count it as done.
        int begin = static_cast<int>(chunk) * t.grain, end = begin + t.grain;
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
    int chunks = (count + grain - 1) / grain;
    // No worker holds a chunk here (the last loop waited for all), and none can take one before the ticket is reset.
    t.count = count;
    t.grain = grain;
    t.run = run;
    t.context = context;
    t.done.store(0, std::memory_order_relaxed);
    t.chunks.store(chunks, std::memory_order_relaxed);
    uint32_t epoch = t.epoch.load(std::memory_order_relaxed) + 1;
    t.ticket.store(uint64_t{epoch} << 32, std::memory_order_release);
    t.epoch.store(epoch, std::memory_order_release);
    if (!t.spinning.load(std::memory_order_relaxed)) {
        std::lock_guard lock(t.mutex);
        t.wake.notify_all();
    }
    work(0);
    for (int spins = 0; t.done.load(std::memory_order_acquire) < chunks;) {
        if (++spins < 200) relax_cpu();
        else std::this_thread::yield();
    }
    // Park the ticket beyond the last chunk, so that late workers find nothing while the next loop is being written.
    t.ticket.store(uint64_t{epoch} << 32 | 0x7fffffffu, std::memory_order_release);
}

void TaskPool::thread_main(int worker) {
    Threads& t = *threads_;
    uint32_t seen = 0;
    for (;;) {
        for (int spins = 0; t.epoch.load(std::memory_order_acquire) == seen; ++spins) {
            if (t.spinning.load(std::memory_order_relaxed)) {
                if (spins < 2000) relax_cpu();
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
