#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/summary.h"

namespace lendulet {

namespace {

using OrderedJson = nlohmann::ordered_json;

// JSON has no infinity and no NaN; a figure that is neither finite nor meaningful reads 0.
double finite(double v) { return std::isfinite(v) ? v : 0.0; }

OrderedJson triple(double x, double y, double z) { return {finite(x), finite(y), finite(z)}; }
OrderedJson triple(Vec3 v) { return triple(v.x, v.y, v.z); }

OrderedJson momentum_json(const Momentum& m) {
    return {{"linear", triple(m.linear[0], m.linear[1], m.linear[2])},
            {"angular", triple(m.angular[0], m.angular[1], m.angular[2])}};
}

const char* type_name(BodyType type) {
    return type == BodyType::fixed ? "static" : type == BodyType::kinematic ? "kinematic" : "dynamic";
}

OrderedJson body_json(const SummaryBody& body) {
    const Quat& q = body.pose.orientation;
    return {{"name", body.name},
            {"type", type_name(body.type)},
            {"position", triple(from_origin(body.pose.position))},
            {"orientation", {finite(q.x), finite(q.y), finite(q.z), finite(q.w)}},
            {"linear_velocity", triple(body.velocity)},
            {"angular_velocity", triple(body.angular_velocity)},
            {"asleep", body.asleep}};
}

OrderedJson times_json(const StepTimes& times) {
    OrderedJson stages = OrderedJson::object();
    for (const auto& [name, median] : times.stage_medians) stages[name] = finite(median);
    return {{"median", finite(times.median)}, {"p99", finite(times.p99)}, {"stages", stages}};
}

}  // namespace

std::string summary_json(const RunSummary& s) {
    char hash[17];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(s.hash));
    OrderedJson out;
    out["scene"] = s.scene;
    out["dt"] = finite(s.dt);
    out["steps"] = s.steps;
    out["threads"] = s.threads;
    out["width"] = s.width;
    out["broad_phase"] = s.broad_phase;
    out["ms_per_step"] = times_json(s.times);
    out["contacts"] = s.contacts;
    out["max_penetration"] = finite(s.max_penetration);
    out["energy"] = {{"start", finite(s.energy_start)}, {"end", finite(s.energy_end)}};
    out["momentum"] = {{"start", momentum_json(s.momentum_start)}, {"end", momentum_json(s.momentum_end)}};
    out["hash"] = hash;
    out["bodies"] = OrderedJson::array();
    for (const SummaryBody& body : s.bodies) out["bodies"].push_back(body_json(body));
    out["triggers"] = OrderedJson::array();
    for (const TriggerEvent& e : s.triggers) {
        out["triggers"].push_back({{"trigger", e.trigger}, {"other", e.other}, {"first_time", finite(e.first_time)}});
    }
    out["warnings"] = s.warnings;
    // Names come from files and command lines; bytes that are no UTF-8 are replaced instead of refused.
    return out.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace lendulet
