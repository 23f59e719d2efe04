// Runs one scene in several engines by turns and gathers what they did.
#pragma once

#include <string>
#include <vector>

#include "bench/scenes/engine.h"
#include "bench/scenes/metrics.h"

namespace lendulet::bench {

struct RunSettings {
    int rounds = 3;
    int steps = 0;  // 0: as many as the scene is meant for
    EngineSettings engine;
    bool with_bullet = true;
};

struct RunResult {
    std::string engine, scene;
    int threads = 1, bodies = 0, contacts = 0;
    double median_ms = 0.0, p99_ms = 0.0, first_ms = 0.0, mean_ms = 0.0, build_ms = 0.0;
    Penetration penetration;
    JointError joints;
    Drift drift;
    bool stands = true;
    uint64_t hash = 0;  // of this engine's state after the last step; of other engines' poses
    double stage_ms[static_cast<int>(Stage::count)] = {};  // medians; zero for engines that do not tell
};

bool has_bullet();

// Engines run by turns (A B A B ...), each with a new world every round, so that whatever else the machine does meets
// all of them. Runs are repeatable, so the time of step i is the least of all rounds; figures are taken from that
// series.
std::vector<RunResult> run_scene(const scenes::SceneDescription& scene, const RunSettings& settings);

}  // namespace lendulet::bench
