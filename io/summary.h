// What a run amounted to: measured while it runs, written as JSON or as text when it ends.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace lendulet {

// Milliseconds of all steps.
struct StepTimes {
    double median = 0.0, p99 = 0.0;
    std::vector<std::pair<std::string, double>> stage_medians;  // in the order in which a step goes through them
};

struct SummaryBody {
    std::string name;
    BodyType type = BodyType::dynamic;
    Pose pose;
    Vec3 velocity, angular_velocity;
    bool asleep = false;
};

// A collider that overlapped a trigger, and when it was first seen to.
struct TriggerEvent {
    std::string trigger, other;
    double first_time = 0.0;  // s
};

struct RunSummary {
    std::string scene;
    double dt = 0.0, seconds = 0.0, wall_seconds = 0.0;
    int64_t steps = 0;  // that were run, also where fewer than asked for
    int threads = 1, width = 0;
    std::string broad_phase;
    StepTimes times;
    int contacts = 0, colliding_pairs = 0;  // contact points and contacts at the end
    double max_penetration = 0.0;           // the deepest of any step, m
    double energy_start = 0.0, energy_end = 0.0;
    Momentum momentum_start{}, momentum_end{};
    uint64_t hash = 0;
    std::vector<SummaryBody> bodies;  // in creation order
    std::vector<TriggerEvent> triggers;
    std::vector<std::string> warnings;
};

// The name of a world's body: its own, or body_<i> with its place in creation order.
std::string body_name(const World& world, int index);

// Watches a scene while it runs. Costs a few numbers per step, and a look at the overlaps.
class RunObserver {
public:
    explicit RunObserver(const Scene& scene);
    void after_step(const Scene& scene);
    RunSummary finish(const Scene& scene, double dt, double wall_seconds);

private:
    void note_times(const StepStatistics& statistics);
    void note_overlaps(const Scene& scene);
    StepTimes times() const;

    RunSummary summary_;
    double step_start_ = 0.0;  // the world's time before the step to come, s
    // Times of every stride-th step: the stride doubles whenever a million are there, so that a long run does not fill
    // the memory.
    struct Sample {
        float total, stages[static_cast<int>(Stage::count)];
    };
    std::vector<Sample> samples_;
    int64_t stride_ = 1;
    std::map<uint64_t, std::string> collider_names_;
    std::map<std::pair<std::string, uint64_t>, size_t> seen_;  // trigger's name and the other body's id
};

// The JSON that `lendulet run --json` writes, ending in a line feed. All numbers in it are finite.
std::string summary_json(const RunSummary& summary);
// A page for people.
std::string summary_text(const RunSummary& summary);

}  // namespace lendulet
