#include "bench/scenes/bench.h"

#include <vector>

#include "bench/lists.h"
#include "bench/scenes/report.h"
#include "bench/scenes/run.h"
#include "io/file.h"

namespace lendulet::bench {
namespace {

constexpr const char* default_scenes =
    "large_pyramid,many_pyramids,box_pile_1000,box_pile_4000,box_pile_16000,sphere_pile_4000,sphere_pile_16000,"
    "capsule_pile_4000,convex_pile_4000,mixed_pile_4000,joint_grid,ragdolls_100,tumbler,mesh_terrain,"
    "large_world_sleep,wall_ball,stack_20,stack_50,stack_100,mass_ratio_100,mass_ratio_1000,chain_heavy_100";

}  // namespace

Result<int> bench_scenes(const SceneOptions& options) {
    if (options.steps < 0 || options.steps > 100000) return Error{ErrorCode::bad_config, "--steps must be 1 to 100000"};
    if (options.repeats < 1 || options.repeats > 100) return Error{ErrorCode::bad_config, "--repeats must be 1 to 100"};
    if (!options.against.empty() && options.against != "bullet" && options.against != "none") {
        return Error{ErrorCode::unknown_name,
                     "--against: there is no \"" + printable(options.against) + "\"; there are bullet, none"};
    }
    if (options.against == "bullet" && !has_bullet())
        return Error{ErrorCode::bad_config, "--against: this program was built without Bullet (libbullet-dev)"};
    Result<std::vector<int>> threads =
        read_numbers("--threads", options.threads.empty() ? "1" : options.threads, 1, 64);
    if (!threads.ok()) return threads.error();
    std::vector<scenes::SceneDescription> scenes;
    for (const std::string& name : parts_of(options.scenes.empty() ? default_scenes : options.scenes)) {
        Result<scenes::SceneDescription> scene = scenes::describe_scene(name);
        if (!scene.ok()) return scene.error();
        scenes.push_back(std::move(scene).value());
        scenes.back().name = name;  // as it was asked for: stack_20, not stack:20
    }
    Status writable = check_writable(options.csv);
    if (!writable.ok()) return writable.error();
    RunSettings settings;
    settings.rounds = options.repeats;
    settings.steps = options.steps;
    settings.with_bullet = options.against != "none";
    std::vector<RunResult> all;
    print_table_head();
    for (const scenes::SceneDescription& scene : scenes) {
        for (int count : threads.value()) {
            settings.engine.threads = count;
            std::vector<RunResult> results = run_scene(scene, settings);
            print_table_rows(results);
            all.insert(all.end(), results.begin(), results.end());
        }
    }
    if (!options.csv.empty()) {
        Status written = write_file(options.csv, scenes_csv(all));
        if (!written.ok()) return written.error();
    }
    return 0;
}

}  // namespace lendulet::bench
