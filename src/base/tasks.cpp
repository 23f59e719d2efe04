#include "base/tasks.h"

#if defined(LENDULET_LENT_THREADS)
#include "base/crew.h"
#elif !defined(LENDULET_SINGLE_THREADED)
#include "base/shared_loop.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace lendulet {

#if defined(LENDULET_LENT_THREADS)

struct TaskPool::Threads {};
TaskPool::TaskPool(int workers, Hook hook) : workers_(workers < 1 ? 1 : workers), hook_(hook) {
    if (hook_.parallel_for) workers_ = hook_.workers < 1 ? 1 : hook_.workers;
    sharing_ = workers_;
}
TaskPool::~TaskPool() = default;
void TaskPool::begin_session() {}
void TaskPool::end_session() {}
void TaskPool::dispatch(int count, int grain, Run run, void* context) {
    if (hook_.parallel_for) hook_.parallel_for(hook_.user, count, grain, run, context);
    else Crew::common().run(workers_, count, grain, run, context);
}

#elif defined(LENDULET_SINGLE_THREADED)

struct TaskPool::Threads {};
TaskPool::TaskPool(int, Hook hook) : hook_(hook) {
    if (hook_.parallel_for) workers_ = hook_.workers;
    sharing_ = workers_;
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

}  // namespace

struct TaskPool::Threads {
    std::vector<std::thread> threads;
    std::vector<SharedLoop::Worker> workers;
    SharedLoop loop;
    std::mutex mutex;
    std::condition_variable wake;
    bool stop = false;
    bool session = false;  // guarded by mutex for sleeping, read loosely while spinning
    std::atomic<bool> spinning{false};

    explicit Threads(int count) : workers(static_cast<size_t>(count)), loop(workers.data()) {}
};

TaskPool::TaskPool(int workers, Hook hook) : workers_(workers < 1 ? 1 : workers), hook_(hook) {
    if (hook_.parallel_for) workers_ = hook_.workers < 1 ? 1 : hook_.workers;
    sharing_ = workers_;
    if (hook_.parallel_for || workers_ == 1) return;
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

void TaskPool::dispatch(int count, int grain, Run run, void* context) {
    if (hook_.parallel_for) {
        hook_.parallel_for(hook_.user, count, grain, run, context);
        return;
    }
    Threads& t = *threads_;
    t.loop.begin(workers_, count, grain, run, context);
    if (!t.spinning.load(std::memory_order_relaxed)) {
        std::lock_guard lock(t.mutex);
        t.wake.notify_all();
    }
    t.loop.work(0, relax_cpu);
    // Nearly always what is left ends within microseconds; only where there are more threads than cores it does not.
    for (int spins = 0; !t.loop.ended();) {
        if (++spins < patient_spins) relax_cpu();
        else std::this_thread::yield();
    }
}

void TaskPool::thread_main(int worker) {
    Threads& t = *threads_;
    uint32_t seen = 0;
    for (;;) {
        for (int spins = 0; t.loop.epoch() == seen; ++spins) {
            if (t.spinning.load(std::memory_order_relaxed)) {
                if (spins < patient_spins) relax_cpu();
                else std::this_thread::yield();
                continue;
            }
            std::unique_lock lock(t.mutex);
            t.wake.wait(lock, [&] { return t.stop || t.session || t.loop.epoch() != seen; });
            if (t.stop) return;
        }
        seen = t.loop.epoch();
        t.loop.work(worker, relax_cpu);
    }
}

#endif

}  // namespace lendulet
