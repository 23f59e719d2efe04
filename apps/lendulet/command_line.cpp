// The command line: options, their names and their checks. Nothing else of the program knows CLI11.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <optional>

#include "apps/lendulet/commands.h"
#include "bench/broad_phase/bench.h"
#include "bench/collision/bench.h"
#include "bench/lists.h"
#include "bench/scenes/bench.h"
#include "explain/explain.h"
#include "io/file.h"

namespace lendulet::cli {

namespace {

// Thrown by option callbacks; becomes the one sentence.
struct BadOption {
    std::string sentence;
};

std::optional<double> parse_decimal(std::string_view text) {
    double value = 0.0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

// A decimal number, or a fraction of two.
double parse_number(const std::string& option, const std::string& text) {
    size_t slash = text.find('/');
    std::optional<double> above = parse_decimal(std::string_view(text).substr(0, slash)), below = 1.0;
    if (slash != std::string::npos) below = parse_decimal(std::string_view(text).substr(slash + 1));
    if (!above || !below || *below == 0.0) {
        throw BadOption{option + " must be a number or a fraction such as 1/60, not \"" + printable(text) + "\""};
    }
    return *above / *below;
}

template <class T>
T choice(const std::string& option, Result<T> found) {
    if (!found.ok()) throw BadOption{option + ": " + found.error().message};
    return found.value();
}

// What is given as text and becomes a number or a choice once all options are there.
struct RawOptions {
    std::string seconds, dt, broad_phase, simplex, integrator;
};

void add_run_options(CLI::App& command, RunOptions& options, RawOptions& raw) {
    command
        .add_option("SCENE", options.scene,
                    "a built-in scene (see `lendulet scenes`), a .gltf or .glb file, or a repro file of the viewer")
        ->required();
    command.add_option("--seconds", raw.seconds, "how long to simulate, s (default 10)")->type_name("S");
    command.add_option("--dt", raw.dt, "the step, s, such as 0.01 or 1/60 (default 1/60)")->type_name("D");
    command.add_option("--threads", options.world.workers, "threads, 1 to 64 (default 1)")
        ->type_name("N")
        ->check(CLI::Range(1, 64));
    command.add_option("--solver-steps", options.world.solver_steps, "substeps of a step, 1 to 64 (default 8)")
        ->type_name("N")
        ->check(CLI::Range(1, 64));
    command
        .add_option("--broad-phase", raw.broad_phase,
                    "all-pairs, sweep-1, sweep-3, rtree-quadratic, rtree-star, rtree-str, rtree-omt or default")
        ->type_name("NAME");
    command.add_option("--simplex", raw.simplex, "barycentric or half-space")->type_name("NAME");
    command.add_option("--integrator", raw.integrator, "momentum, explicit-euler, symplectic-euler or runge-kutta-4")
        ->type_name("NAME");
    command.add_option("--width", options.world.width, "SIMD lanes: 1, 4, 8 or 16 (default: the most there are)")
        ->type_name("W");
    command.add_flag("--no-sleep", options.given.no_sleep, "keep resting bodies awake");
    command.add_option("--json", options.json, "write the summary as JSON; - for standard output")->type_name("FILE|-");
    command.add_option("--record", options.record, "write a recording of all poses")->type_name("FILE");
    command.add_flag("--quiet", options.quiet, "print errors alone");
}

void finish_run_options(const CLI::App& command, const RawOptions& raw, RunOptions& options) {
    if (command.count("--seconds")) options.seconds = parse_number("--seconds", raw.seconds);
    if (command.count("--dt")) options.dt = parse_number("--dt", raw.dt);
    if (!(options.seconds >= 0.0)) throw BadOption{"--seconds must not be negative"};
    if (!(options.dt > 0.0 && options.dt <= 1.0)) throw BadOption{"--dt must be more than 0 and at most 1 s"};
    if (options.seconds / options.dt > 1e9) throw BadOption{"--seconds / --dt is more than a thousand million steps"};
    if (command.count("--broad-phase")) {
        options.world.broad_phase = choice("--broad-phase", broad_phase_from_name(raw.broad_phase));
    }
    if (command.count("--simplex")) options.world.simplex = choice("--simplex", simplex_from_name(raw.simplex));
    if (command.count("--integrator")) {
        options.world.integrator = choice("--integrator", integrator_from_name(raw.integrator));
    }
    bool known_width = false;
    for (int width : {1, 4, 8, 16}) known_width |= options.world.width == width;
    if (command.count("--width") && !known_width) throw BadOption{"--width must be 1, 4, 8 or 16"};
    options.given.seconds = command.count("--seconds") > 0;
    options.given.dt = command.count("--dt") > 0;
    options.given.threads = command.count("--threads") > 0;
    options.given.solver_steps = command.count("--solver-steps") > 0;
    options.given.broad_phase = command.count("--broad-phase") > 0;
    options.given.simplex = command.count("--simplex") > 0;
    options.given.integrator = command.count("--integrator") > 0;
    options.given.width = command.count("--width") > 0;
}

void add_broad_phase_options(CLI::App& command, bench::BroadPhaseOptions& options) {
    command.add_option("--sizes", options.sizes, "numbers of boxes (default 10 to 100000, uniform to 1000000)")
        ->type_name("N,N,...");
    command.add_option("--distributions", options.distributions, "uniform, clustered, ground, one-huge (default all)")
        ->type_name("NAME,...");
    command.add_option("--modes", options.modes, "rebuild, split, refit, query (default all)")->type_name("NAME,...");
    command.add_option("--structures", options.structures, "broad phases and peers (default all)")
        ->type_name("NAME,...");
    command.add_option("--repeats", options.repeats, "samples of each structure (default 15)")->type_name("N");
    command.add_option("--csv", options.csv, "write the results as CSV")->type_name("FILE");
    command.add_option("--svg", options.svg, "draw the results as a chart")->type_name("FILE");
}

void add_scene_options(CLI::App& command, bench::SceneOptions& options) {
    command.add_option("--scenes", options.scenes, "built-in scenes (default: 22 of them)")->type_name("NAME,...");
    command.add_option("--threads", options.threads, "thread counts, 1 to 64 (default 1)")->type_name("N,...");
    command.add_option("--steps", options.steps, "measured steps (default: what each scene is meant for)")
        ->type_name("N")
        ->check(CLI::Range(1, 100000));
    command.add_option("--repeats", options.repeats, "rounds (default 3)")->type_name("N");
    command.add_option("--against", options.against, "bullet or none (default: bullet where it was built in)")
        ->type_name("NAME");
    command.add_option("--csv", options.csv, "write the results as CSV")->type_name("FILE");
}

void add_collision_options(CLI::App& command, bench::CollisionOptions& options) {
    command.add_option("--pairs", options.pairs, "pairs of each case (default 20000)")->type_name("N");
    command.add_option("--rays", options.rays, "rays (default 100000)")->type_name("N");
    command.add_option("--bodies", options.bodies, "boxes of the pile that they meet (default 16000)")->type_name("N");
    command.add_option("--repeats", options.repeats, "rounds (default 9)")->type_name("N");
    command.add_option("--csv", options.csv, "write the results as CSV")->type_name("FILE");
}

void add_explain_options(CLI::App& command, explain::Options& options) {
    command.add_option("WHAT", options.question.what, "gjk, epa, distance (both), clip or sat")->required();
    command
        .add_option("A", options.question.a, "KIND:NUMBERS[@X,Y,Z[@RX,RY,RZ]], such as box:0.5,0.5,0.5@1,0,0@0,0,30")
        ->required();
    command.add_option("B", options.question.b, "the other shape")->required();
    command.add_option("--simplex", options.question.simplex, "half-space (default) or barycentric")->type_name("NAME");
    command.add_option("--svg", options.svg, "the picture (default explain-WHAT.svg)")->type_name("FILE");
    command.add_flag("--frames", options.frames, "each step in a file of its own");
}

void add_verify_options(CLI::App& command, VerifyOptions& options, std::string& cases, std::string& quality) {
    command.add_option("--cases", cases, "which cases, such as A01,A08 (default all)")->type_name("ID,...");
    command.add_option("--quality", quality, "d60 (steps of 1/60 s) or hq (1/240 s)")->type_name("NAME");
    command.add_option("--threads", options.run.workers, "threads (default: as many as there are)")
        ->type_name("N")
        ->check(CLI::Range(1, 64));
    command.add_option("--json", options.json, "write the figures as JSON; - for standard output")->type_name("FILE|-");
    command.add_option("--html", options.html, "write a page with the table and the curves")->type_name("FILE");
    command.add_option("--svg", options.svg, "write the curves as a picture")->type_name("FILE");
}

void finish_verify_options(const std::string& cases, const std::string& quality, VerifyOptions& options) {
    if (!cases.empty()) options.run.cases = bench::parts_of(cases);
    if (!quality.empty()) options.run.quality = choice("--quality", verify::quality_from_name(quality));
}

void add_view_options(CLI::App& command, ViewOptions& options, std::string& give_up) {
    command.add_option("SCENE", options.scene, "a built-in scene, a .gltf or .glb file, a recording or a repro file")
        ->required();
    command.add_option("--port", options.port, "where to serve, 0: any (default 8080)")
        ->type_name("N")
        ->check(CLI::Range(0, 65535));
    command.add_flag("--any-port", options.any_port, "take another port where that one is taken");
    command.add_option("--page", options.page, "folder of the viewer's page (default: as built beside the program)")
        ->type_name("FOLDER");
    command.add_option("--threads", options.threads, "threads of the simulation, 1 to 64 (default 1)")
        ->type_name("N")
        ->check(CLI::Range(1, 64));
    command.add_option("--give-up", give_up, "end after so many seconds without a visitor, 0: never (default)")
        ->type_name("S");
}

void finish_view_options(const std::string& give_up, ViewOptions& options) {
    if (!give_up.empty()) options.give_up = parse_number("--give-up", give_up);
    if (!(options.give_up >= 0.0 && options.give_up < 1e6)) throw BadOption{"--give-up must be 0 to 1e6 s"};
}

// An empty list or file name would pass for an option that was not given.
void refuse_empty(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() > 0 && option->get_expected_max() > 0 && option->as<std::string>().empty())
            throw BadOption{option->get_name() + " must not be empty"};
    }
}

constexpr const char* benchmarks = "broad-phase, scenes and collision";
bool is_benchmark(std::string_view name) { return name == "broad-phase" || name == "scenes" || name == "collision"; }

// The exit code of a benchmark, or 2 after its sentence.
int finish(const Result<int>& measured) { return measured.ok() ? measured.value() : fail(measured.error().message); }

}  // namespace

int execute(int argc, char** argv) {
    if (argc < 2)
        return fail("a command is required: run, view, info, scenes, verify, explain or bench (--help says more)");
    std::string first = argv[1];
    bool known = first.rfind('-', 0) == 0;
    for (const char* command : {"run", "view", "info", "scenes", "verify", "explain", "bench"})
        known |= first == command;
    if (!known) {
        return fail("\"" + printable(first) +
                    "\" is no command; there are run, view, info, scenes, verify, explain and bench");
    }
    if (first == "bench" && (argc < 3 || (argv[2][0] != '-' && !is_benchmark(argv[2]))))
        return fail(argc < 3 ? std::string("bench needs the name of a benchmark; there are ") + benchmarks
                             : "\"" + printable(argv[2]) + "\" is no benchmark; there are " + benchmarks);
    CLI::App app{"Lendulet: rigid bodies in three dimensions.", "lendulet"};
    app.set_version_flag("--version", "lendulet " LENDULET_VERSION);
    app.require_subcommand(1);
    RunOptions options;
    RawOptions raw;
    std::string recording;
    CLI::App* run_command = app.add_subcommand("run", "simulate a scene and print a summary");
    add_run_options(*run_command, options, raw);
    CLI::App* view_command = app.add_subcommand("view", "show a scene in the browser, simulated by this program");
    ViewOptions view_options;
    std::string give_up;
    add_view_options(*view_command, view_options, give_up);
    CLI::App* info_command = app.add_subcommand("info", "check and describe a recording");
    info_command->add_option("FILE", recording, "a recording made by `lendulet run --record`")->required();
    CLI::App* scenes_command = app.add_subcommand("scenes", "list the built-in scenes");
    CLI::App* verify_command = app.add_subcommand("verify", "measure the physics against closed forms");
    VerifyOptions verify_options;
    std::string verify_cases, verify_quality;
    add_verify_options(*verify_command, verify_options, verify_cases, verify_quality);
    CLI::App* bench_command = app.add_subcommand("bench", "measure this engine beside others");
    bench_command->require_subcommand(1);
    bench::BroadPhaseOptions broad_phase;
    CLI::App* broad_phase_command = bench_command->add_subcommand("broad-phase", "structures that find pairs of boxes");
    add_broad_phase_options(*broad_phase_command, broad_phase);
    bench::SceneOptions bench_scene_options;
    CLI::App* bench_scenes_command = bench_command->add_subcommand("scenes", "whole steps of built-in scenes");
    add_scene_options(*bench_scenes_command, bench_scene_options);
    explain::Options explained;
    CLI::App* explain_command = app.add_subcommand("explain", "draw a collision algorithm step by step");
    add_explain_options(*explain_command, explained);
    bench::CollisionOptions collision;
    CLI::App* collision_command = bench_command->add_subcommand("collision", "distance queries, manifolds and rays");
    add_collision_options(*collision_command, collision);
    try {
        app.parse(argc, argv);
        if (run_command->parsed()) {
            refuse_empty(*run_command);
            finish_run_options(*run_command, raw, options);
        }
        if (view_command->parsed()) {
            refuse_empty(*view_command);
            finish_view_options(give_up, view_options);
        }
        if (verify_command->parsed()) {
            refuse_empty(*verify_command);
            finish_verify_options(verify_cases, verify_quality, verify_options);
        }
        if (broad_phase_command->parsed()) refuse_empty(*broad_phase_command);
        if (bench_scenes_command->parsed()) refuse_empty(*bench_scenes_command);
        if (collision_command->parsed()) refuse_empty(*collision_command);
        if (explain_command->parsed()) refuse_empty(*explain_command);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
        return fail(printable(error.what()));
    } catch (const BadOption& bad) {
        return fail(bad.sentence);
    }
    if (run_command->parsed()) return run(options);
    if (view_command->parsed()) return view(view_options);
    if (info_command->parsed()) return info(recording);
    if (scenes_command->parsed()) return list_scenes();
    if (verify_command->parsed()) return verify(verify_options);
    if (bench_scenes_command->parsed()) return finish(bench::bench_scenes(bench_scene_options));
    if (explain_command->parsed()) return finish(explain::explain(explained));
    if (collision_command->parsed()) return finish(bench::bench_collision(collision));
    if (broad_phase_command->parsed()) return finish(bench::bench_broad_phase(broad_phase));
    return fail("a command is required");
}

}  // namespace lendulet::cli
