// Measures subjects by turns (A B A B ...) on the same boxes, so that whatever else the machine does meets all of them,
// and compares what they find.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/broad_phase/subject.h"

namespace lendulet::bench {

// rebuild: everything from nothing, all pairs.
// split: the same with every second box static: two structures, both built anew, half of the boxes search.
// refit: 5 % of the boxes have moved; the pairs that begin and end.
// query: a thousand box queries on what was built before.
enum class Mode : uint8_t { rebuild, split, refit, query };
inline constexpr Mode all_modes[] = {Mode::rebuild, Mode::split, Mode::refit, Mode::query};
std::string_view name_of(Mode);
inline constexpr int queries_per_frame = 1000;

struct Cell {
    Distribution distribution;
    int n;
    Mode mode;
};
std::string name_of(const Cell& cell);  // "uniform, 1000 boxes, rebuild"

// Time of this thread, ns. Where the machine does other things too, a long frame is interrupted more often than a short
// one, and time on the wall would be unfair to it.
double thread_ns();

// The frames of one cell for one subject: what a sample times.
class Frames {
public:
    explicit Frames(const Cell& cell);

    // Brings a fresh subject to where frames can be run; not timed as part of a frame.
    void prepare(Subject& subject) const;
    // Makes what the next sample works on: for refit frames the boxes move on. Each begins, as its caller's would, by
    // writing the boxes that have moved into the array.
    void next_sample();
    // Runs the frames of a sample and gives the time of one on this thread, ns. `frames` of 0 asks for as many as the
    // cell wants. One before them, if asked for and of refit frames always the first, is not timed: it finds in the
    // caches what other subjects left there.
    double run(Subject& subject, int frames = 0, bool untimed_first = false);
    // How many frames at least of one subject make a sample that the clock can measure, if one takes `frame_ns`.
    int frames_for(double frame_ns) const;

    // What the last run() found: pairs (begun and ended ones, hits) of a frame, and a sum over them that does not
    // depend on their order.
    struct Found {
        double per_frame = 0.0;
        uint64_t count = 0, sum = 0;
        bool operator==(const Found& o) const { return count == o.count && sum == o.sum; }
    };
    Found found() const;

private:
    struct Step {
        std::vector<uint32_t> changed;
        Boxes boxes;  // as they then are
    };
    void run_once(Subject& subject, const Step* step);

    Cell cell_;
    Boxes fixed_, moving_, queries_;
    Boxes start_, now_;  // refit only: before the frames of a sample, and while they run
    Motion motion_;
    std::vector<Step> steps_;  // refit only
    int frames_ = 1;
    Array<BoxPair> pairs_, ended_;
    Array<uint32_t> hits_;
    std::vector<uint32_t> ends_;
};

struct Row {
    std::string structure;
    Cell cell;
    double median_ns = 0.0;
    long pairs = 0;
};

struct CellResult {
    Cell cell;
    std::vector<Row> rows;
    std::vector<std::string> skipped;    // a sentence for each subject left out
    std::vector<std::string> different;  // a sentence for each that disagrees with the first row
};

class Bench {
public:
    Bench(std::vector<SubjectType> types, int repeats) : types_(std::move(types)), repeats_(repeats) {}
    CellResult measure(const Cell& cell);

private:
    struct Entrant;
    class Agreement;
    std::vector<Entrant> enter(const Cell& cell, CellResult& result);
    void warm_up(std::vector<Entrant>& entrants, Frames& frames, Agreement& agreement, CellResult& result);
    // What a frame with its preparation is likely to take, s, from smaller counts that are tried first; negative where
    // even those say nothing.
    double expected_seconds(const SubjectType& type, const Cell& cell);
    void remember(const SubjectType& type, const Cell& cell, double seconds);

    using Key = std::pair<std::string, std::pair<Distribution, Mode>>;
    std::vector<SubjectType> types_;
    int repeats_;
    std::map<Key, std::map<int, double>> seconds_;  // by count
};

}  // namespace lendulet::bench
