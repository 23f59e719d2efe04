// Ctrl-C ends a run early: the steps done are summed up. A second one ends the program at once.
#pragma once

#include <csignal>

namespace lendulet::cli {

inline volatile std::sig_atomic_t interrupted = 0;

// Interrupts are noted in `interrupted` while there is one of these.
class Interruptible {
public:
    Interruptible() { std::signal(SIGINT, note); }
    ~Interruptible() { std::signal(SIGINT, SIG_DFL); }
    Interruptible(const Interruptible&) = delete;
    Interruptible& operator=(const Interruptible&) = delete;

private:
    static void note(int) {
        interrupted = 1;
        std::signal(SIGINT, SIG_DFL);
    }
};

}  // namespace lendulet::cli
