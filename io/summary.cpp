#include "io/summary.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lendulet {

namespace {

template <class Id>
uint64_t key_of(Id id) {
    return static_cast<uint64_t>(id.index) << 32 | id.generation;
}

// The nearest-rank quantile of values that may be reordered; 0 where there are none.
double quantile(std::vector<float> values, double q) {
    if (values.empty()) return 0.0;
    size_t rank = static_cast<size_t>(std::ceil(q * static_cast<double>(values.size())));
    size_t index = std::min(std::max<size_t>(rank, 1), values.size()) - 1;
    std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(index), values.end());
    return values[index];
}

constexpr int stage_count = static_cast<int>(Stage::count);

std::vector<SummaryBody> bodies_of(const World& world) {
    std::vector<SummaryBody> out;
    out.reserve(static_cast<size_t>(world.body_count()));
    for (int i = 0; i < world.body_count(); ++i) {
        StaticBodyRef body = world.get_static(world.body(i));
        SummaryBody line;
        line.name = body_name(world, i);
        line.type = body.type();
        line.pose = {body.position(), body.orientation()};
        if (line.type != BodyType::fixed) {
            const RigidBodyRef moving = world.get(world.body(i));
            line.velocity = moving.velocity();
            line.angular_velocity = moving.angular_velocity();
            line.asleep = moving.asleep();
        }
        out.push_back(std::move(line));
    }
    return out;
}

}  // namespace

std::string body_name(const World& world, int index) {
    std::string_view own = world.get_static(world.body(index)).name();
    return own.empty() ? "body_" + std::to_string(index) : std::string(own);
}

RunObserver::RunObserver(const Scene& scene) {
    for (const auto& [id, name] : scene.collider_names) collider_names_[key_of(id)] = name;
    const World& world = scene.world;
    summary_.scene = scene.name;
    step_start_ = world.time();
    summary_.energy_start = world.kinetic_energy() + world.potential_energy();
    summary_.momentum_start = world.momentum();
}

void RunObserver::after_step(const Scene& scene) {
    const StepStatistics& statistics = scene.world.statistics();
    note_times(statistics);
    summary_.max_penetration = std::max<double>(summary_.max_penetration, statistics.max_penetration);
    ++summary_.steps;
    note_overlaps(scene);
    step_start_ = scene.world.time();
}

// The parts of a compound trigger go by one name, so they give one event for each body that meets them; other triggers
// are told apart by their body, as names may repeat. A step looks for overlaps where the bodies stand when it begins.
void RunObserver::note_overlaps(const Scene& scene) {
    const World& world = scene.world;
    auto name_of_body = [&](BodyId id) {
        for (int i = 0; i < world.body_count(); ++i) {
            if (world.body(i) == id) return body_name(world, i);
        }
        return std::string();
    };
    for (const Overlap& overlap : world.overlaps()) {
        auto own = collider_names_.find(key_of(overlap.trigger));
        std::string trigger =
            own != collider_names_.end() ? own->second : std::string(world.get_static(overlap.trigger_body).name());
        std::string identity =
            own != collider_names_.end() ? own->second : "\n" + std::to_string(key_of(overlap.trigger_body));
        if (!seen_.try_emplace({identity, key_of(overlap.other_body)}, summary_.triggers.size()).second) continue;
        if (trigger.empty()) trigger = name_of_body(overlap.trigger_body);
        summary_.triggers.push_back({trigger, name_of_body(overlap.other_body), step_start_});
    }
}

void RunObserver::note_times(const StepStatistics& statistics) {
    constexpr size_t most = 1 << 20;
    if (summary_.steps % stride_ != 0) return;
    if (samples_.size() == most) {
        for (size_t i = 0; i < most / 2; ++i) samples_[i] = samples_[2 * i];
        samples_.resize(most / 2);
        stride_ *= 2;
        if (summary_.steps % stride_ != 0) return;
    }
    Sample sample{static_cast<float>(statistics.total_ms), {}};
    for (int i = 0; i < stage_count; ++i) sample.stages[i] = static_cast<float>(statistics.stage_ms[i]);
    samples_.push_back(sample);
}

StepTimes RunObserver::times() const {
    auto column = [&](auto value) {
        std::vector<float> out;
        out.reserve(samples_.size());
        for (const Sample& sample : samples_) out.push_back(value(sample));
        return out;
    };
    StepTimes out;
    std::vector<float> totals = column([](const Sample& s) { return s.total; });
    out.median = quantile(totals, 0.5);
    out.p99 = quantile(std::move(totals), 0.99);
    for (int i = 0; i < stage_count; ++i) {
        double median = quantile(column([&](const Sample& s) { return s.stages[i]; }), 0.5);
        out.stage_medians.emplace_back(name_of(static_cast<Stage>(i)), median);
    }
    return out;
}

RunSummary RunObserver::finish(const Scene& scene, double dt, double wall_seconds) {
    const World& world = scene.world;
    RunSummary out = std::move(summary_);
    out.dt = dt;
    out.seconds = world.time();
    out.wall_seconds = wall_seconds;
    out.threads = world.config().workers;
    out.width = world.config().width;
    out.broad_phase = name_of(world.config().broad_phase);
    out.times = times();
    out.colliding_pairs = world.contact_count();
    for (int i = 0; i < out.colliding_pairs; ++i) out.contacts += world.contact(i).point_count;
    out.energy_end = world.kinetic_energy() + world.potential_energy();
    out.momentum_end = world.momentum();
    out.hash = world.hash();
    out.bodies = bodies_of(world);
    std::set<std::string> told;
    for (const auto& list :
         {scene.warnings, std::vector<std::string>(world.warnings().begin(), world.warnings().end())}) {
        for (const std::string& sentence : list) {
            if (told.insert(sentence).second) out.warnings.push_back(sentence);
        }
    }
    return out;
}

}  // namespace lendulet
