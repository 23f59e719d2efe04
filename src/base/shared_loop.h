// One loop at a time, which several threads share. Its chunks are dealt out in stretches, one a worker, who takes those
// of his own first and then those that others have left: in loop after loop of one size he finds what he wrote in his
// own caches.
//
// A step is hundreds of loops of a few microseconds, and a line that goes from core to core takes a tenth of one: so
// only one is written to begin a loop, and each worker writes his own, which others look at when they have nothing to
// do. A stretch whose ticket is of an earlier loop has not been begun.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace lendulet {

class SharedLoop {
public:
    using Run = void (*)(void* context, int begin, int end, int worker);
    static constexpr int most_workers = 255;
    struct Worker {
        alignas(64) std::atomic<uint64_t> ticket{0};  // epoch << 32 | next chunk of his stretch
        alignas(64) std::atomic<uint64_t> done{0};    // epoch << 32 | chunks that he has finished, of any stretch
    };

    // `workers`: as many as any loop may have.
    explicit constexpr SharedLoop(Worker* workers) : workers_(workers) {}

    // Number of the loop that was begun last; 0: none.
    uint32_t epoch() const { return Plan(plan_.load(std::memory_order_acquire)).epoch(); }
    // Publishes a loop of chunks of `grain`, once the one before has ended. A loop of nothing only raises the epoch.
    void begin(int workers, int count, int grain, Run run, void* context);
    // Takes chunks as number `worker` until none is left; those who are beyond the loop's workers take none. Number 0
    // is the thread that began the loop. pause() is called while others are about to finish.
    template <class Pause>
    void work(int worker, Pause&& pause);
    // All chunks are done. For the thread that began the loop.
    bool ended() const { return ended(plan_.load(std::memory_order_relaxed)); }

private:
    static constexpr int most_chunks = (1 << 24) - 1;
    // Looks before chunks of others are taken, about what it takes until a worker who has just finished is seen to
    // have: to look at his ticket too early would take it out of his caches.
    static constexpr int patient_looks = 12;

    // A loop in one number: epoch << 32 | workers << 24 | chunks.
    class Plan {
    public:
        constexpr explicit Plan(uint64_t bits) : bits_(bits) {}
        constexpr Plan(uint32_t epoch, int workers, int chunks)
            : bits_(uint64_t{epoch} << 32 | uint64_t(workers) << 24 | uint64_t(chunks)) {}
        uint64_t bits() const { return bits_; }
        uint32_t epoch() const { return static_cast<uint32_t>(bits_ >> 32); }
        int workers() const { return static_cast<int>(bits_ >> 24 & 0xff); }
        int chunks() const { return static_cast<int>(bits_ & most_chunks); }
        // Of the worker's stretch, which ends where the next one begins.
        uint32_t first_chunk(int worker) const { return static_cast<uint32_t>(int64_t{chunks()} * worker / workers()); }

    private:
        uint64_t bits_;
    };
    static constexpr uint64_t none = ~uint64_t{0};

    bool ended(uint64_t plan) const;
    // The next chunk of a worker's stretch, or none.
    uint64_t claim(const Plan& plan, int owner);
    void run_chunk(const Plan& plan, uint64_t chunk, int worker);

    Worker* workers_;
    // A late worker may look at the plan while the next loop is begun, at the others only once he holds a chunk.
    alignas(64) std::atomic<uint64_t> plan_{0};
    int count_ = 0, grain_ = 1;
    Run run_ = nullptr;
    void* context_ = nullptr;
};

inline void SharedLoop::begin(int workers, int count, int grain, Run run, void* context) {
    const int fewest = count / most_chunks + 1;
    count_ = count;
    grain_ = grain > fewest ? grain : fewest;
    run_ = run;
    context_ = context;
    const int chunks = static_cast<int>((int64_t{count} + grain_ - 1) / grain_);
    const Plan plan(epoch() + 1, workers < most_workers ? workers : most_workers, chunks);
    plan_.store(plan.bits(), std::memory_order_release);
}

inline bool SharedLoop::ended(uint64_t bits) const {
    const Plan plan(bits);
    int left = plan.chunks();
    for (int w = 0; w < plan.workers() && left > 0; ++w) {
        const uint64_t done = workers_[w].done.load(std::memory_order_acquire);
        if (static_cast<uint32_t>(done >> 32) == plan.epoch()) left -= static_cast<int>(done & 0xffffffffu);
    }
    return left <= 0;
}

// A stretch that holds chunks is not left behind: its loop has not ended before they are taken. So a worker who comes
// late with an old plan finds the ticket of that loop at its end, or a later one.
inline uint64_t SharedLoop::claim(const Plan& plan, int owner) {
    const uint32_t first = plan.first_chunk(owner), end = plan.first_chunk(owner + 1);
    std::atomic<uint64_t>& ticket = workers_[owner].ticket;
    uint64_t seen = ticket.load(std::memory_order_acquire);
    for (;;) {
        const auto epoch = static_cast<uint32_t>(seen >> 32);
        if (static_cast<int32_t>(epoch - plan.epoch()) > 0) return none;
        const uint32_t next = epoch == plan.epoch() ? static_cast<uint32_t>(seen) : first;
        if (next >= end) return none;
        if (ticket.compare_exchange_weak(seen, uint64_t{plan.epoch()} << 32 | (next + 1), std::memory_order_acq_rel))
            return next;
    }
}

inline void SharedLoop::run_chunk(const Plan& plan, uint64_t chunk, int worker) {
    const int64_t begin = static_cast<int64_t>(chunk) * grain_, end = begin + grain_;
    run_(context_, static_cast<int>(begin), static_cast<int>(end < count_ ? end : count_), worker);
    std::atomic<uint64_t>& done = workers_[worker].done;
    const uint64_t before = done.load(std::memory_order_relaxed);
    const bool first = static_cast<uint32_t>(before >> 32) != plan.epoch();
    done.store(first ? uint64_t{plan.epoch()} << 32 | 1 : before + 1, std::memory_order_release);
}

template <class Pause>
inline void SharedLoop::work(int worker, Pause&& pause) {
    const Plan plan(plan_.load(std::memory_order_acquire));
    if (worker >= plan.workers()) return;
    for (uint64_t chunk; (chunk = claim(plan, worker)) != none;) run_chunk(plan, chunk, worker);
    for (int looks = 0; looks < patient_looks; ++looks) {
        const bool over = worker == 0 ? ended(plan.bits()) : plan_.load(std::memory_order_relaxed) != plan.bits();
        if (over) return;
        pause();
    }
    for (int i = 1; i < plan.workers(); ++i) {
        const int owner = worker + i < plan.workers() ? worker + i : worker + i - plan.workers();
        for (uint64_t chunk; (chunk = claim(plan, owner)) != none;) run_chunk(plan, chunk, worker);
    }
}

}  // namespace lendulet
