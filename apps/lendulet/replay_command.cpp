// `lendulet run FILE.json`: makes the run of a repro file again and compares its bits with those that were saved.
#include <chrono>
#include <cinttypes>
#include <cstdio>

#include "apps/lendulet/commands.h"
#include "apps/lendulet/interrupt.h"
#include "apps/lendulet/progress.h"
#include "apps/lendulet/view/repro.h"
#include "bindings/c/handle.h"
#include "io/file.h"

namespace lendulet::cli {

namespace {

// What a repro file says itself.
Status check_options(const RunOptions& options) {
    const char* what = nullptr;
    if (!options.record.empty()) what = "--record: a repro file is run without a recording; the page makes one";
    if (options.given.seconds) what = "--seconds: a repro file says how many steps it is";
    if (options.given.dt) what = "--dt: a repro file is run with the step of its scene";
    return what ? Status(Error{ErrorCode::bad_config, what}) : check_outputs(options);
}

// All steps, with what was done before each, and after the last; fewer where Ctrl-C is pressed.
Status repeat(lendulet_world& world, const Repro& repro, RunObserver& observer, Progress& progress) {
    size_t next = 0;
    for (int step = 0; step <= repro.steps; ++step) {
        Result<size_t> done = act(world, repro, step, next);
        if (!done.ok()) return done.error();
        next = done.value();
        if (step == repro.steps || interrupted) break;
        if (lendulet_step(&world) < 0) return Error{ErrorCode::bad_config, lendulet_error()};
        observer.after_step(world.scene);
        progress.advance(step + 1);
    }
    return {};
}

}  // namespace

int replay(const RunOptions& options) {
    if (Status s = check_options(options); !s) return fail(s.error().message);
    Result<Repro> read = read_repro(options.scene);
    if (!read.ok()) return fail(read.error().message);
    const Repro& repro = read.value();
    if (is_repro(repro.scene)) return fail(printable(options.scene) + ": its scene is a repro file itself");
    Result<Scene> opened = open_scene(repro.scene, options);
    if (!opened.ok()) return fail(opened.error().message);
    lendulet_world world(std::move(opened).value());
    RunObserver observer(world.scene);
    const double dt = world.scene.dt;
    auto start = std::chrono::steady_clock::now();
    {
        Progress progress(repro.steps, dt, !options.quiet);
        Status repeated = repeat(world, repro, observer, progress);
        if (!repeated.ok()) return fail(printable(options.scene) + ": " + repeated.error().message);
    }
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const RunSummary summary = observer.finish(world.scene, dt, wall);
    if (Status reported = report(summary, options); !reported) return fail(reported.error().message);
    if (summary.steps < repro.steps)
        return fail("ended early: there are no bits to compare with those that were saved");
    char hash[17];
    std::snprintf(hash, sizeof hash, "%016" PRIx64, world.scene.world.hash());
    const bool same = repro.hash == hash;
    if (!same)
        std::fprintf(stderr, "lendulet: not the bits that were saved: %s, the file has %s\n", hash,
                     printable(repro.hash).c_str());
    else if (!options.quiet) std::fprintf(stderr, "The same bits as when it was saved.\n");
    return same ? 0 : 1;
}

}  // namespace lendulet::cli
