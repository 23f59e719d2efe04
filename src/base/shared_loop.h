// One loop at a time, which several threads share. Its chunks are dealt out in stretches, one a worker, who takes those
// of his own first and then those that others have left: in loop after loop of one size he finds what he wrote in his
// own caches. A loop is published by raising `epoch`; the packed (epoch, chunk) of a stretch keeps a late worker from
// taking chunks of the following loop.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace lendulet {

class SharedLoop {
public:
    using Run = void (*)(void* context, int begin, int end, int worker);
    struct alignas(64) Stretch {
        std::atomic<uint64_t> ticket{0};  // epoch << 32 | next chunk
        std::atomic<uint32_t> end{0};     // one past its last chunk
    };

    // `stretches`: one for each worker that any loop may have.
    explicit constexpr SharedLoop(Stretch* stretches) : stretches_(stretches) {}

    // Number of the loop that was begun last; 0: none.
    uint32_t epoch() const { return epoch_.load(std::memory_order_acquire); }
    // Publishes a loop of chunks of `grain`, once the one before has ended. A loop of nothing only raises the epoch.
    void begin(int workers, int count, int grain, Run run, void* context);
    // Takes chunks as number `worker` until none is left; those who are beyond the loop's workers take none.
    void work(int worker);
    // All chunks are done. For the thread that began the loop.
    bool ended() const { return done_.load(std::memory_order_acquire) >= chunks_; }

private:
    static constexpr uint32_t no_chunk = 0x7fffffffu;

    Stretch* stretches_;
    int chunks_ = 0;
    alignas(64) std::atomic<int> done_{0};  // chunks finished in this epoch
    alignas(64) std::atomic<uint32_t> epoch_{0};
    // The loop of this epoch; written before the tickets are released.
    std::atomic<int> workers_{0};
    int count_ = 0, grain_ = 1;
    Run run_ = nullptr;
    void* context_ = nullptr;
};

inline void SharedLoop::begin(int workers, int count, int grain, Run run, void* context) {
    // No worker holds a chunk here (the last loop waited for all), and none can take one before the tickets are set:
    // every stretch has come to its end.
    chunks_ = (count + grain - 1) / grain;
    count_ = count;
    grain_ = grain;
    run_ = run;
    context_ = context;
    workers_.store(workers, std::memory_order_relaxed);
    done_.store(0, std::memory_order_relaxed);
    const uint32_t epoch = epoch_.load(std::memory_order_relaxed) + 1;
    auto first_chunk = [&](int worker) { return static_cast<uint32_t>(int64_t{chunks_} * worker / workers); };
    for (int w = 0; w < workers; ++w) {
        // A late worker who has seen the last loop's ticket with this loop's end must find neither any more.
        Stretch& stretch = stretches_[w];
        stretch.ticket.store(uint64_t{epoch} << 32 | no_chunk, std::memory_order_relaxed);
        stretch.end.store(first_chunk(w + 1), std::memory_order_release);
        stretch.ticket.store(uint64_t{epoch} << 32 | first_chunk(w), std::memory_order_release);
    }
    epoch_.store(epoch, std::memory_order_release);
}

inline void SharedLoop::work(int worker) {
    for (int i = 0;;) {
        const int workers = workers_.load(std::memory_order_relaxed);
        if (i >= workers || worker >= workers) return;
        const int owner = worker + i < workers ? worker + i : worker + i - workers;
        Stretch& own = stretches_[owner];
        uint64_t ticket = own.ticket.load(std::memory_order_acquire);
        const uint32_t chunk = static_cast<uint32_t>(ticket);
        // A ticket that can be taken is that of a loop which has not ended: the number of workers, read again after it,
        // is that loop's too.
        if (chunk >= own.end.load(std::memory_order_acquire) || workers_.load(std::memory_order_relaxed) != workers) {
            ++i;
            continue;
        }
        if (!own.ticket.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel)) continue;
        // The chunk is ours: its loop cannot end, nor the next one begin, before we count it as done.
        const int begin = static_cast<int>(chunk) * grain_, end = begin + grain_;
        run_(context_, begin, end < count_ ? end : count_, worker);
        done_.fetch_add(1, std::memory_order_release);
    }
}

}  // namespace lendulet
