// `lendulet run SCENE`: simulates a built-in scene or a glTF file and says what came of it.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "apps/lendulet/commands.h"
#include "apps/lendulet/interrupt.h"
#include "apps/lendulet/progress.h"
#include "io/file.h"
#include "io/gltf.h"
#include "io/recording.h"
#include "io/summary.h"

namespace lendulet::cli {

namespace {

bool ends_with(const std::string& text, std::string_view end) {
    if (text.size() < end.size()) return false;
    for (size_t i = 0; i < end.size(); ++i) {
        char c = text[text.size() - end.size() + i];
        if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != end[i]) return false;
    }
    return true;
}

// What the command line says wins over what the scene chose.
Configure configuration(const RunOptions& options) {
    return [&options](WorldBuilder& builder) {
        const RunOptions::Given& given = options.given;
        if (given.threads) builder.workers(options.world.workers);
        if (given.solver_steps) builder.solver_steps(options.world.solver_steps);
        if (given.broad_phase) builder.broad_phase(options.world.broad_phase);
        if (given.simplex) builder.simplex(options.world.simplex);
        if (given.integrator) builder.integrator(options.world.integrator);
        if (given.width) builder.width(options.world.width);
        if (given.no_sleep) builder.sleep(false);
    };
}

Status simulate(Scene& scene, const RunOptions& options, RunObserver& observer, RecordingWriter* recording) {
    int64_t steps = std::llround(options.seconds / options.dt);
    Progress progress(steps, options.dt, !options.quiet);
    for (int64_t i = 0; i < steps && !interrupted; ++i) {
        if (scene.before_step) scene.before_step(scene.world, static_cast<int>(i));
        Status updated = scene.world.update(static_cast<float>(options.dt));
        if (!updated.ok()) return updated;
        observer.after_step(scene);
        if (recording) {
            Status written = recording->add_step(scene.world);
            if (!written.ok()) return written;
        }
        progress.advance(i + 1);
    }
    return {};
}

}  // namespace

Status report(const RunSummary& summary, const RunOptions& options) {
    if (!options.quiet) {
        for (const std::string& sentence : summary.warnings) {
            std::fprintf(stderr, "warning: %s\n", printable(sentence).c_str());
        }
    }
    std::string out;
    if (options.json == "-") {
        out = summary_json(summary);
    } else {
        if (!options.quiet) out = summary_text(summary);
        if (!options.json.empty()) {
            Status written = write_file(options.json, summary_json(summary));
            if (!written.ok()) return written;
        }
    }
    std::fwrite(out.data(), 1, out.size(), stdout);
    if (std::fflush(stdout) != 0) return Error{ErrorCode::io, "standard output: cannot be written"};
    return {};
}

Status check_outputs(const RunOptions& options) {
    const std::string json = options.json == "-" ? "" : options.json;
    const bool reads = is_gltf(options.scene) || is_repro(options.scene);
    for (const std::string& out : {json, options.record}) {
        if (reads && !out.empty() && is_same_file(out, options.scene))
            return Error{ErrorCode::io, printable(out) + ": would be written over the scene that is read"};
        if (Status writable = check_writable(out); !writable) return writable;
    }
    if (!json.empty() && is_same_file(json, options.record))
        return Error{ErrorCode::io, "--json and --record name the same file: " + printable(json)};
    return {};
}

bool is_gltf(const std::string& name) { return ends_with(name, ".gltf") || ends_with(name, ".glb"); }
bool is_repro(const std::string& name) { return ends_with(name, ".json"); }

Result<Scene> open_scene(const std::string& name, const RunOptions& options) {
    if (is_gltf(name)) return load_gltf(name, configuration(options));
    Result<Scene> scene = build_scene(name, configuration(options));
    std::error_code ignored;
    if (!scene.ok() && scene.error().code == ErrorCode::unknown_name && std::filesystem::exists(name, ignored))
        return Error{ErrorCode::unknown_name,
                     printable(name) + ": is neither a .gltf, .glb or .json file nor the name of a built-in scene"};
    return scene;
}

int run(const RunOptions& options) {
    const Interruptible interruptible;
    if (is_repro(options.scene)) return replay(options);
    if (Status writable = check_outputs(options); !writable) return fail(writable.error().message);
    Result<Scene> opened = open_scene(options.scene, options);
    if (!opened.ok()) return fail(opened.error().message);
    Scene& scene = opened.value();
    std::optional<RecordingWriter> recording;
    if (!options.record.empty()) {
        Result<RecordingWriter> created = RecordingWriter::create(options.record, scene.name, options.dt);
        if (!created.ok()) return fail(created.error().message);
        recording = std::move(created).value();
        Status begun = recording->begin(scene.world);
        if (!begun.ok()) return fail(begun.error().message);
    }
    RunObserver observer(scene);
    auto start = std::chrono::steady_clock::now();
    Status simulated = simulate(scene, options, observer, recording ? &*recording : nullptr);
    double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!simulated.ok()) return fail(simulated.error().message);
    if (recording) {
        Status finished = recording->finish(scene.world);
        if (!finished.ok()) return fail(finished.error().message);
    }
    Status reported = report(observer.finish(scene, options.dt, wall), options);
    return reported.ok() ? 0 : fail(reported.error().message);
}

}  // namespace lendulet::cli
