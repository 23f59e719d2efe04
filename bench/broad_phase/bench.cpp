#include "bench/broad_phase/bench.h"

#include <algorithm>
#include <cstdio>

#include "bench/broad_phase/report.h"
#include "bench/lists.h"
#include "io/file.h"

namespace lendulet::bench {
namespace {

constexpr int largest_size = 10'000'000;

Error unknown(const std::string& option, const std::string& what, const std::vector<std::string>& known) {
    return {ErrorCode::unknown_name, option + ": there is no \"" + printable(what) + "\"; there are " + joined(known)};
}

// The values named in `list`, each once, in the order of `all`; all of them where the list is empty.
template <class T, class Name>
Result<std::vector<T>> choose(const std::string& option, const std::string& list, const std::vector<T>& all,
                              Name&& name) {
    if (list.empty()) return all;
    std::vector<std::string> known, wanted = parts_of(list);
    for (const T& value : all) known.push_back(std::string(name(value)));
    for (const std::string& part : wanted) {
        if (std::find(known.begin(), known.end(), part) == known.end()) return unknown(option, part, known);
    }
    std::vector<T> chosen;
    for (size_t i = 0; i < all.size(); ++i) {
        if (std::find(wanted.begin(), wanted.end(), known[i]) != wanted.end()) chosen.push_back(all[i]);
    }
    return chosen;
}

struct Plan {
    std::vector<Cell> cells;
    std::vector<SubjectType> subjects;
};

Result<Plan> plan(const BroadPhaseOptions& options) {
    if (options.repeats < 1 || options.repeats > 1000)
        return Error{ErrorCode::bad_config, "--repeats must be 1 to 1000"};
    auto distributions = choose("--distributions", options.distributions,
                                std::vector<Distribution>(std::begin(all_distributions), std::end(all_distributions)),
                                [](Distribution d) { return name_of(d); });
    if (!distributions.ok()) return distributions.error();
    auto modes = choose("--modes", options.modes, std::vector<Mode>(std::begin(all_modes), std::end(all_modes)),
                        [](Mode m) { return name_of(m); });
    if (!modes.ok()) return modes.error();
    auto subjects =
        choose("--structures", options.structures, all_subjects(), [](const SubjectType& type) { return type.name; });
    if (!subjects.ok()) return subjects.error();
    auto sizes = read_numbers("--sizes", options.sizes.empty() ? "10,100,1000,10000,100000,1000000" : options.sizes, 1,
                              largest_size);
    if (!sizes.ok()) return sizes.error();
    Plan plan{{}, subjects.value()};
    for (Distribution distribution : distributions.value()) {
        for (int size : sizes.value()) {
            if (options.sizes.empty() && size > 100000 && distribution != Distribution::uniform) continue;
            for (Mode mode : modes.value()) plan.cells.push_back({distribution, size, mode});
        }
    }
    return plan;
}

Status write(const std::string& path, const std::string& text) {
    return path.empty() ? Status{} : write_file(path, text);
}

}  // namespace

Result<int> bench_broad_phase(const BroadPhaseOptions& options) {
    Result<Plan> planned = plan(options);
    if (!planned.ok()) return planned.error();
    for (const std::string& path : {options.csv, options.svg}) {
        Status writable = check_writable(path);
        if (!writable.ok()) return writable.error();
    }
    if (!missing_peers().empty())
        std::printf("Measured without %s, which the build did not find.\n", joined(missing_peers()).c_str());
    Bench bench(planned.value().subjects, options.repeats);
    std::vector<Row> rows;
    int exit_code = 0;
    for (const Cell& cell : planned.value().cells) {
        CellResult result = bench.measure(cell);
        std::printf("%s\n", cell_table(result).c_str());
        std::fflush(stdout);
        for (const std::string& sentence : result.different) {
            std::fprintf(stderr, "lendulet: %s\n", sentence.c_str());
            exit_code = 1;
        }
        rows.insert(rows.end(), result.rows.begin(), result.rows.end());
    }
    Status csv = write(options.csv, broad_phase_csv(rows));
    if (!csv.ok()) return csv.error();
    Status svg = write(options.svg, broad_phase_chart(rows));
    if (!svg.ok()) return svg.error();
    return exit_code;
}

}  // namespace lendulet::bench
