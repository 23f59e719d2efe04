#include "apps/lendulet/progress.h"

#include <unistd.h>

#include <cstdio>

namespace lendulet::cli {

Progress::Progress(int64_t steps, double dt, bool wanted)
    : steps_(steps), dt_(dt), shown_(wanted && steps > 0 && isatty(STDERR_FILENO)) {}

Progress::~Progress() {
    if (shown_) std::fprintf(stderr, "\r\033[K");  // leaves the line empty
}

void Progress::advance(int64_t done) {
    if (!shown_ || Clock::now() - drawn_ < std::chrono::milliseconds(100)) return;
    drawn_ = Clock::now();
    draw(done);
}

void Progress::draw(int64_t done) {
    constexpr int width = 40;
    double part = static_cast<double>(done) / static_cast<double>(steps_);
    double elapsed = std::chrono::duration<double>(drawn_ - start_).count();
    char bar[width + 1];
    for (int i = 0; i < width; ++i) bar[i] = i < part * width ? '#' : '.';
    bar[width] = '\0';
    std::fprintf(stderr, "\r[%s] %3.0f %%  %.1f times real time", bar, 100.0 * part,
                 static_cast<double>(done) * dt_ / elapsed);
    std::fflush(stderr);
}

}  // namespace lendulet::cli
