// A progress bar on standard error, only where that is a terminal.
#pragma once

#include <chrono>
#include <cstdint>

namespace lendulet::cli {

class Progress {
public:
    // Shows nothing where `wanted` is false or standard error is no terminal.
    Progress(int64_t steps, double dt, bool wanted);
    ~Progress();
    // Called after each step; draws at most ten times a second.
    void advance(int64_t done);

private:
    void draw(int64_t done);

    using Clock = std::chrono::steady_clock;
    int64_t steps_;
    double dt_;
    bool shown_;
    Clock::time_point start_ = Clock::now(), drawn_ = start_;
};

}  // namespace lendulet::cli
