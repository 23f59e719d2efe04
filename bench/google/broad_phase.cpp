// bench_broad_phase: what `lendulet bench broad-phase` measures, as Google Benchmark targets with that library's
// options and output. Names are structure/distribution/count/mode; larger counts than 10 000 are left to `lendulet
// bench`, which knows what would take too long.
#include <benchmark/benchmark.h>

#include "bench/broad_phase/measure.h"

namespace lendulet::bench {
namespace {

// The frame's own time, as `lendulet bench` takes it: a sample of many frames is one iteration of the time of one.
void run(benchmark::State& state, const SubjectType& type, const Cell& cell) {
    Frames frames(cell);
    std::unique_ptr<Subject> subject = type.make();
    frames.prepare(*subject);
    int per_sample = frames.frames_for(frames.run(*subject, 1));
    for (auto _ : state) {
        frames.next_sample();
        state.SetIterationTime(1e-9 * frames.run(*subject, per_sample));
    }
    state.counters["pairs"] = frames.found().per_frame;
}

void add_all() {
    for (const SubjectType& type : all_subjects()) {
        for (Distribution distribution : all_distributions) {
            for (int n : {10, 100, 1000, 10000}) {
                for (Mode mode : all_modes) {
                    Cell cell{distribution, n, mode};
                    std::string name = type.name + "/" + std::string(name_of(distribution)) + "/" + std::to_string(n) +
                                       "/" + std::string(name_of(mode));
                    benchmark::RegisterBenchmark(name.c_str(),
                                                 [&type, cell](benchmark::State& s) { run(s, type, cell); })
                        ->UseManualTime()
                        ->Iterations(n < 10000 ? 100 : 10);
                }
            }
        }
    }
}

}  // namespace
}  // namespace lendulet::bench

int main(int count, char** arguments) {
    lendulet::bench::add_all();
    benchmark::Initialize(&count, arguments);
    if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
