#include "bench/scenes/run.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>

namespace lendulet::bench {
namespace {

double now_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double quantile(std::vector<double> values, double q) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return values[static_cast<size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

std::vector<Pose> poses_of(const Engine& engine, const scenes::SceneDescription& scene) {
    std::vector<Pose> poses;
    for (size_t i = 0; i < scene.bodies.size(); ++i) poses.push_back(engine.pose(static_cast<int>(i)));
    return poses;
}

// FNV-1a over the bits of positions and orientations.
uint64_t hash_of(const std::vector<Pose>& poses) {
    uint64_t hash = 0xcbf29ce484222325ull;
    for (const Pose& pose : poses) {
        const float numbers[] = {pose.position.x,    pose.position.y,    pose.position.z,   pose.orientation.x,
                                 pose.orientation.y, pose.orientation.z, pose.orientation.w};
        for (float number : numbers) hash = (hash ^ std::bit_cast<uint32_t>(number)) * 0x100000001b3ull;
    }
    return hash;
}

// The times of one engine over all rounds.
struct Series {
    MakeEngine make;
    RunResult result;
    std::vector<double> step_ms;
    std::vector<double> stage_ms[static_cast<int>(Stage::count)];
    bool skipped = false;
};

void measure_end(const Engine& engine, const scenes::SceneDescription& scene, const std::vector<Pose>& before,
                 RunResult& result) {
    std::vector<Pose> end = poses_of(engine, scene);
    result.engine = engine.name();
    result.contacts = engine.contact_points();
    result.penetration = penetration(scene, end);
    result.joints = joint_error(scene, end);
    result.drift = drift(scene, before, end);
    result.stands = stands(scene, result.drift);
    result.hash = engine.hash();
    if (result.hash == 0) result.hash = hash_of(end);
}

void run_round(const scenes::SceneDescription& scene, const RunSettings& settings, int steps, Series& series) {
    std::string why;
    double start = now_ms();
    std::unique_ptr<Engine> engine = series.make(scene, settings.engine, &why);
    if (!engine) {
        std::fprintf(stderr, "%s: %s\n", scene.name.c_str(), why.c_str());
        series.skipped = true;
        return;
    }
    series.result.build_ms = now_ms() - start;
    for (int i = 0; i < scene.warm_up_steps; ++i) engine->step(i);
    std::vector<Pose> before;
    for (int i = 0; i < steps; ++i) {
        if (i == steps - 1) before = poses_of(*engine, scene);
        double begin = now_ms();
        engine->step(scene.warm_up_steps + i);
        double ms = now_ms() - begin;
        size_t k = static_cast<size_t>(i);
        if (series.step_ms.size() <= k) series.step_ms.push_back(ms);
        else series.step_ms[k] = std::min(series.step_ms[k], ms);
        if (const StepStatistics* statistics = engine->statistics())
            for (int s = 0; s < static_cast<int>(Stage::count); ++s)
                series.stage_ms[s].push_back(statistics->stage_ms[s]);
    }
    measure_end(*engine, scene, before, series.result);
}

void summarize(Series& series) {
    RunResult& result = series.result;
    result.median_ms = quantile(series.step_ms, 0.5);
    result.p99_ms = quantile(series.step_ms, 0.99);
    result.first_ms = series.step_ms.front();
    for (double ms : series.step_ms) result.mean_ms += ms / static_cast<double>(series.step_ms.size());
    for (int s = 0; s < static_cast<int>(Stage::count); ++s) result.stage_ms[s] = quantile(series.stage_ms[s], 0.5);
}

}  // namespace

bool has_bullet() {
#ifdef LENDULET_BENCH_BULLET
    return true;
#else
    return false;
#endif
}

std::vector<RunResult> run_scene(const scenes::SceneDescription& scene, const RunSettings& settings) {
    std::vector<Series> all;
    all.push_back({make_lendulet, {}, {}, {}});
#ifdef LENDULET_BENCH_BULLET
    if (settings.with_bullet && settings.engine.threads == 1) all.push_back({make_bullet, {}, {}, {}});
#endif
    int steps = std::max(1, settings.steps > 0 ? settings.steps : scene.steps);
    for (int round = 0; round < settings.rounds; ++round)
        for (Series& series : all)
            if (!series.skipped) run_round(scene, settings, steps, series);
    std::vector<RunResult> results;
    for (Series& series : all) {
        if (series.skipped) continue;
        summarize(series);
        series.result.scene = scene.name;
        series.result.threads = settings.engine.threads;
        for (const scenes::SceneBody& body : scene.bodies) series.result.bodies += body.type == BodyType::dynamic;
        results.push_back(std::move(series.result));
    }
    return results;
}

}  // namespace lendulet::bench
