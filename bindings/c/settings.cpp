// The C interface: forks, and settings that change while a world runs.
#include "bindings/c/handle.h"

using namespace lendulet;
using namespace lendulet::c;

namespace {

template <class Choice>
const char* choice_name(int32_t choice, Choice last) {
    // Literals, which end with a zero.
    return choice >= 0 && choice <= static_cast<int32_t>(last) ? name_of(static_cast<Choice>(choice)).data() : nullptr;
}

template <class Choice>
bool choose(int32_t choice, Choice last, Choice& out) {
    if (choice < 0 || choice > static_cast<int32_t>(last)) return false;
    out = static_cast<Choice>(choice);
    return true;
}

// False where a choice does not exist; build() checks the numbers.
bool config_of(const lendulet_settings& s, WorldConfig& config) {
    config.gravity = vector(s.gravity);
    config.solver_steps = s.solver_steps;
    config.workers = s.workers;
    config.width = s.width;
    config.allow_sleep = s.sleep != 0;
    config.continuous = s.continuous != 0;
    config.friction = s.friction;
    config.restitution = s.restitution;
    config.rigid_separation_speed = s.rigid_separation_speed;
    config.static_separation_speed = s.static_separation_speed;
    return choose(s.broad_phase, BroadPhaseType::wide_tree, config.broad_phase) &&
           choose(s.simplex, SimplexSolver::half_space, config.simplex) &&
           choose(s.integrator, Integrator::runge_kutta_4, config.integrator);
}

}  // namespace

extern "C" {

lendulet_world* lendulet_fork(const lendulet_world* world) {
    if (!world) return refuse_null("fork"), nullptr;
    const Scene& scene = world->scene;
    Result<World> forked = scene.world.fork();
    if (!forked) return refuse(forked.error()), nullptr;
    return new lendulet_world(
        Scene{std::move(forked).value(), scene.name, scene.dt, scene.steps, scene.before_step, scene.warnings});
}

lendulet_result lendulet_read_settings(const lendulet_world* world, lendulet_settings* out) {
    if (!world || !out) return refuse_null("read_settings");
    const WorldConfig& c = world->scene.world.config();
    *out = {};
    put(out->gravity, c.gravity);
    out->step_size = world->scene.dt;
    out->solver_steps = c.solver_steps;
    out->broad_phase = static_cast<int32_t>(c.broad_phase);
    out->simplex = static_cast<int32_t>(c.simplex);
    out->integrator = static_cast<int32_t>(c.integrator);
    out->workers = c.workers, out->width = c.width;
    out->sleep = c.allow_sleep, out->continuous = c.continuous;
    out->friction = c.friction, out->restitution = c.restitution;
    out->rigid_separation_speed = c.rigid_separation_speed;
    out->static_separation_speed = c.static_separation_speed;
    return 0;
}

lendulet_result lendulet_set_settings(lendulet_world* world, const lendulet_settings* settings) {
    if (!world || !settings) return refuse_null("set_settings");
    if (!(settings->step_size > 0.0f && settings->step_size <= 1.0f))
        return refuse({ErrorCode::bad_time_step, "set_settings: the step must be above 0 and at most 1 s"});
    Scene& scene = world->scene;
    WorldConfig config = scene.world.config();
    if (!config_of(*settings, config))
        return refuse({ErrorCode::unknown_name,
                       "set_settings: a broad phase, simplex solver or integrator of that "
                       "number does not exist"});
    Result<World> forked = scene.world.fork(config);
    if (!forked) return refuse(forked.error());
    scene.world = std::move(forked).value();
    scene.dt = settings->step_size;
    return 0;
}

const char* lendulet_choice_name(int32_t kind, int32_t choice) {
    switch (kind) {
        case LENDULET_BROAD_PHASES:
            return choice_name(choice, BroadPhaseType::wide_tree);
        case LENDULET_SIMPLEX_SOLVERS:
            return choice_name(choice, SimplexSolver::half_space);
        case LENDULET_INTEGRATORS:
            return choice_name(choice, Integrator::runge_kutta_4);
        default:
            return nullptr;
    }
}

}  // extern "C"
