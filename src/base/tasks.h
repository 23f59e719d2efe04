// Fork-join loops over the workers of a world. A loop cuts [0, count) into chunks of `grain`; which worker takes which
// chunk is left to chance, so bodies must write only to places given by their index.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace lendulet {

class TaskPool {
public:
    using Run = void (*)(void* context, int begin, int end, int worker);
    struct Hook {
        void* user = nullptr;
        int workers = 0;
        void (*parallel_for)(void* user, int count, int grain, Run run, void* context) = nullptr;
    };

    // `workers` threads in all, the calling one included; with a hook no threads are started.
    explicit TaskPool(int workers) : TaskPool(workers, Hook{}) {}
    TaskPool(int workers, Hook hook);
    ~TaskPool();
    TaskPool(const TaskPool&) = delete;
    TaskPool& operator=(const TaskPool&) = delete;

    int workers() const { return workers_; }
    // By how many of them loops are shared just now, see Alone.
    int sharing() const { return sharing_; }

    // While one of these is there and was told so, loops run on the calling thread alone: what is done in less time
    // than it takes to share it. Results do not tell.
    class Alone {
    public:
        Alone(TaskPool& pool, bool alone) : pool_(pool), before_(pool.sharing_) {
            if (alone && !shares_all) pool.sharing_ = 1;
        }
        ~Alone() { pool_.sharing_ = before_; }
        Alone(const Alone&) = delete;
        Alone& operator=(const Alone&) = delete;

    private:
        TaskPool& pool_;
        int before_;
    };
    // For tests, which are small: nothing is done alone.
    static inline bool shares_all = false;

    // Keeps the threads awake between loops from here to the end of the scope, unless all that follows is done alone: a
    // step is hundreds of short loops.
    class Session {
    public:
        explicit Session(TaskPool& pool) : pool_(pool), begun_(pool.sharing_ > 1) {
            if (begun_) pool_.begin_session();
        }
        ~Session() {
            if (begun_) pool_.end_session();
        }
        Session(const Session&) = delete;
        Session& operator=(const Session&) = delete;

    private:
        TaskPool& pool_;
        bool begun_;
    };

    // body(begin, end, worker) over disjoint chunks of [0, count); returns when all are done. Loops of one chunk, and
    // all loops of a pool of one worker, run at once on the calling thread.
    template <class Body>
    void for_each(int count, int grain, Body&& body) {
        if (count <= 0) return;
        if (sharing_ == 1 || count <= grain) {
            body(0, count, 0);
            return;
        }
        using Fn = std::remove_reference_t<Body>;
        dispatch(
            count, grain, [](void* c, int b, int e, int w) { (*static_cast<Fn*>(c))(b, e, w); },
            const_cast<void*>(static_cast<const void*>(&body)));
    }

    // The same for loops of many small pieces of equal cost: a few chunks a worker, of `least` or more. In loops of one
    // count a worker gets the same chunks as before, if it comes in time, and finds what it wrote in its own caches.
    template <class Body>
    void share(int count, int least, Body&& body) {
        const int even = (count + chunks_per_worker * sharing_ - 1) / (chunks_per_worker * sharing_);
        for_each(count, even > least ? even : least, body);
    }

    // In how many parts such a loop is cut: as many for each worker, where there is one for each.
    int parts(int count, int least) const {
        const int most = chunks_per_worker * sharing_, wanted = count / (least > 0 ? least : 1);
        return wanted < 1 ? 1 : wanted < sharing_ ? wanted : wanted < most ? wanted / sharing_ * sharing_ : most;
    }

private:
    static constexpr int chunks_per_worker = 2;

    void dispatch(int count, int grain, Run run, void* context);
    void begin_session();
    void end_session();
    void thread_main(int worker);

    struct Threads;  // std::thread and its friends; absent where there are none, or where they are lent (crew.h)
    int workers_ = 1, sharing_ = 1;
    Hook hook_;
    std::unique_ptr<Threads> threads_;
};

}  // namespace lendulet
