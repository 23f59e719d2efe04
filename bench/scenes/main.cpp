// bench_scenes: the built-in scenes here and in Bullet, the same scene, the same step, the same run.
#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "bench/scenes/report.h"
#include "bench/scenes/run.h"

namespace lendulet::bench {
namespace {

constexpr const char* help =
    "bench_scenes [options] [SCENE ...]\n"
    "Runs scenes (default: a representative list) by turns in this engine and in Bullet and compares them.\n"
    "  --rounds N        rounds; the time of a step is the least of all rounds (default 3)\n"
    "  --steps N         steps a round (default: what the scene is meant for)\n"
    "  --threads N,N,..  thread counts of this engine (default 1); Bullet runs beside 1\n"
    "  --solver-steps N  substeps of this engine\n"
    "  --width N         SIMD width of this engine: 1, 4, 8 or 16\n"
    "  --broad-phase X   all-pairs, sweep-1 or rtree-omt\n"
    "  --stages          also a table of this engine's stages\n"
    "  --no-bullet       this engine alone\n"
    "  --csv FILE        all results as CSV\n";

const std::vector<std::string> default_scenes = {
    "box_pile:1000",   "box_pile:4000",     "sphere_pile:4000",  "capsule_pile:4000", "convex_pile:4000",
    "mixed_pile:4000", "large_pyramid:100", "many_pyramids",     "joint_grid",        "ragdolls:100",
    "tumbler",         "mesh_terrain",      "large_world_sleep", "stack:20",          "mass_ratio:100",
    "chain_heavy:100", "wall_ball"};

struct Options {
    RunSettings run;
    std::vector<int> threads{1};
    std::vector<std::string> scenes;
    std::string csv, error;
    bool stages = false, help = false;
    int solver_steps = 0, width = 0;
    std::string broad_phase;
};

bool read_number(std::string_view text, int lowest, int* number) {
    auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), *number);
    return status == std::errc{} && end == text.data() + text.size() && *number >= lowest;
}

bool read_list(std::string_view text, std::vector<int>* numbers) {
    numbers->clear();
    while (true) {
        size_t comma = text.find(',');
        int number = 0;
        if (!read_number(text.substr(0, comma), 1, &number)) return false;
        numbers->push_back(number);
        if (comma == text.npos) return true;
        text.remove_prefix(comma + 1);
    }
}

// Reads an option with its value; false where the value is missing or bad.
bool read_valued(std::string_view option, const char* value, Options* options) {
    if (value == nullptr) return false;
    if (option == "--rounds") return read_number(value, 1, &options->run.rounds);
    if (option == "--steps") return read_number(value, 1, &options->run.steps);
    if (option == "--threads") return read_list(value, &options->threads);
    if (option == "--solver-steps") return read_number(value, 1, &options->solver_steps);
    if (option == "--width") return read_number(value, 1, &options->width);
    if (option == "--broad-phase") return options->broad_phase = value, broad_phase_from_name(value).ok();
    if (option == "--csv") return options->csv = value, true;
    return false;
}

Options read_options(int count, char** arguments) {
    Options options;
    for (int i = 1; i < count; ++i) {
        std::string_view option = arguments[i];
        if (option == "--help") options.help = true;
        else if (option == "--stages") options.stages = true;
        else if (option == "--no-bullet") options.run.with_bullet = false;
        else if (!option.starts_with("--")) options.scenes.emplace_back(option);
        else if (read_valued(option, arguments[i + 1], &options)) ++i;
        else
            return options.error = "Option " + std::string(option) + " is unknown or its value is missing or bad.",
                   options;
    }
    if (options.scenes.empty()) options.scenes = default_scenes;
    options.run.engine.configure = [options](WorldBuilder& builder) {
        if (options.solver_steps > 0) builder.solver_steps(options.solver_steps);
        if (options.width > 0) builder.width(options.width);
        if (!options.broad_phase.empty()) builder.broad_phase(broad_phase_from_name(options.broad_phase).value());
    };
    return options;
}

int fail(const std::string& sentence) {
    std::fprintf(stderr, "%s\n", sentence.c_str());
    return 2;
}

int run(Options options) {
    std::vector<RunResult> all;
    print_table_head();
    for (const std::string& name : options.scenes) {
        Result<scenes::SceneDescription> scene = scenes::describe_scene(name);
        if (!scene) return fail(scene.error().message);
        for (int threads : options.threads) {
            options.run.engine.threads = threads;
            std::vector<RunResult> results = run_scene(scene.value(), options.run);
            print_table_rows(results);
            if (options.stages && !results.empty()) print_stages(results.front());
            all.insert(all.end(), results.begin(), results.end());
        }
    }
    return options.csv.empty() || write_csv(options.csv, all) ? 0 : 2;
}

}  // namespace
}  // namespace lendulet::bench

int main(int count, char** arguments) {
    lendulet::bench::Options options = lendulet::bench::read_options(count, arguments);
    if (options.help) return std::fputs(lendulet::bench::help, stdout), 0;
    if (!options.error.empty()) return lendulet::bench::fail(options.error);
    return lendulet::bench::run(std::move(options));
}
