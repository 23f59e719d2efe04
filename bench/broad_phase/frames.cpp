// What a sample of each mode runs and what it found.
#include <algorithm>
#include <cmath>
#include <ctime>

#include "bench/broad_phase/measure.h"

namespace lendulet::bench {
namespace {

constexpr double least_sample_ns = 3e5;  // a thousand times what reading the clock takes
constexpr int boxes_in_steps = 40000;    // of as many boxes in all are the refit frames that are prepared at once

// Mixes two numbers well enough that sums of it tell sets apart (the finalizer of SplitMix64).
uint64_t mix(uint64_t a, uint64_t b) {
    uint64_t x = (a << 32 | b) + 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

}  // namespace

double thread_ns() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

std::string_view name_of(Mode mode) {
    switch (mode) {
        case Mode::rebuild:
            return "rebuild";
        case Mode::split:
            return "split";
        case Mode::refit:
            return "refit";
        case Mode::query:
            return "query";
    }
    return "unknown";
}

std::string name_of(const Cell& cell) {
    return std::string(name_of(cell.distribution)) + ", " + std::to_string(cell.n) + " boxes, " +
           std::string(name_of(cell.mode));
}

Frames::Frames(const Cell& cell) : cell_(cell), motion_(cell.distribution, make_boxes(cell.distribution, cell.n)) {
    for (const BroadBox& box : motion_.boxes()) {
        bool fixed = cell.mode == Mode::split && box.index % 2 == 0;
        (fixed ? fixed_ : moving_).push_back(box);
    }
    if (cell.mode == Mode::query) queries_ = make_queries(moving_, queries_per_frame);
    if (cell.mode == Mode::refit) steps_.resize(static_cast<size_t>(std::clamp(boxes_in_steps / cell.n, 4, 200) + 1));
    next_sample();
}

void Frames::next_sample() {
    if (!steps_.empty()) start_ = motion_.boxes();
    for (Step& step : steps_) {
        step.changed = motion_.next_frame();
        step.boxes.clear();
        for (uint32_t place : step.changed) step.boxes.push_back(motion_.boxes()[place]);
    }
}

void Frames::prepare(Subject& subject) const {
    if (cell_.mode == Mode::rebuild || cell_.mode == Mode::split) return;
    subject.load(fixed_, moving_);
    if (cell_.mode == Mode::query) return;
    Array<BoxPair> pairs;
    subject.find_pairs(pairs);
}

int Frames::frames_for(double frame_ns) const {
    if (!steps_.empty()) return static_cast<int>(steps_.size());
    return std::clamp(static_cast<int>(least_sample_ns / std::max(frame_ns, 1.0)), 1, 100000);
}

double Frames::run(Subject& subject, int frames, bool untimed_first) {
    frames_ = steps_.empty() ? std::max(frames, 1) : static_cast<int>(steps_.size());
    pairs_.clear();
    ended_.clear();
    int first = 0;
    now_ = start_;
    if (!steps_.empty()) run_once(subject, &steps_[static_cast<size_t>(first++)]);
    else if (untimed_first) run_once(subject, nullptr);
    double start = thread_ns();
    for (int i = first; i < frames_; ++i) run_once(subject, steps_.empty() ? nullptr : &steps_[static_cast<size_t>(i)]);
    return (thread_ns() - start) / (frames_ - first);
}

// Refit frames add to the lists, which are compared as a whole; the frames of the other modes are all the same.
void Frames::run_once(Subject& subject, const Step* step) {
    switch (cell_.mode) {
        case Mode::rebuild:
        case Mode::split:
            pairs_.clear();
            subject.load(fixed_, moving_);
            subject.find_pairs(pairs_);
            break;
        case Mode::refit:
            for (size_t i = 0; i < step->changed.size(); ++i) now_[step->changed[i]] = step->boxes[i];
            subject.update(now_, step->changed, pairs_, ended_);
            break;
        case Mode::query:
            hits_.clear();
            ends_.clear();
            subject.query(queries_, hits_, ends_);
            break;
    }
}

Frames::Found Frames::found() const {
    Found found;
    for (const BoxPair& pair : pairs_) found.sum += mix(pair.a, pair.b);
    for (const BoxPair& pair : ended_) found.sum += mix(pair.b, pair.a);
    found.count = pairs_.size() + ended_.size();
    uint32_t hit = 0;
    for (size_t i = 0; i < ends_.size(); ++i) {
        for (; hit < ends_[i]; ++hit) found.sum += mix(i, hits_[hit]);
    }
    found.count += hits_.size();
    found.per_frame = static_cast<double>(found.count) / (steps_.empty() ? 1 : frames_);
    return found;
}

}  // namespace lendulet::bench
