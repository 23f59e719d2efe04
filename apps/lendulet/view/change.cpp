#include "apps/lendulet/view/change.h"

#include "io/file.h"

namespace lendulet::cli {

namespace {

void add_shape(lendulet_world& world, const Asked& command) {
    lendulet_part part{};
    part.type = command.whole("type", LENDULET_CONE);
    part.mesh = -1;
    const Json& size = command.list("size");
    if (size.size() > std::size(part.size)) throw Asked::Refused{"size must be at most four numbers"};
    for (size_t i = 0; i < size.size(); ++i) {
        if (!size[i].is_number()) throw Asked::Refused{"size must be numbers"};
        part.size[i] = size[i].get<float>();
    }
    part.rounding = command.real("rounding");
    part.orientation[3] = 1.0f;
    part.density = command.real("density");
    part.friction = part.restitution = -1.0f;
    lendulet_body_definition body{};
    command.vector("at", body.position), command.vector("velocity", body.velocity);
    body.orientation[3] = body.gravity_factor = 1.0f;
    body.type = LENDULET_DYNAMIC;
    must(lendulet_add_body(&world, &body, &part, 1, nullptr));
}

void set(lendulet_world& world, const Asked& command) {
    lendulet_settings s{};
    must(lendulet_read_settings(&world, &s));
    if (command.has("gravity")) command.vector("gravity", s.gravity);
    const std::pair<const char*, float*> reals[] = {{"stepSize", &s.step_size},
                                                    {"friction", &s.friction},
                                                    {"restitution", &s.restitution},
                                                    {"rigidSpeed", &s.rigid_separation_speed},
                                                    {"staticSpeed", &s.static_separation_speed}};
    for (auto [name, value] : reals)
        if (command.has(name)) *value = command.real(name);
    const std::pair<const char*, int32_t*> wholes[] = {{"solverSteps", &s.solver_steps},
                                                       {"broadPhase", &s.broad_phase},
                                                       {"simplex", &s.simplex},
                                                       {"integrator", &s.integrator},
                                                       {"workers", &s.workers},
                                                       {"width", &s.width},
                                                       {"sleep", &s.sleep},
                                                       {"continuous", &s.continuous}};
    for (auto [name, value] : wholes)
        if (command.has(name)) *value = command.whole(name, 1000);
    must(lendulet_set_settings(&world, &s));
}

}  // namespace

lendulet_body body_at(lendulet_world& world, int index) {
    const lendulet_body* bodies = nullptr;
    int count = lendulet_read_bodies(&world, &bodies);
    return index < count ? bodies[index] : 0;
}

void change(lendulet_world& world, const Asked& command) {
    const std::string what = command.text("do");
    float a[3], b[3], c[3];
    if (what == "sphere") {
        command.vector("at", a), command.vector("velocity", b);
        must(lendulet_add_sphere(&world, command.real("radius"), a, b, command.real("density"), nullptr));
    } else if (what == "box") {
        command.vector("half", a), command.vector("at", b), command.vector("velocity", c);
        must(lendulet_add_box(&world, a, b, c, command.real("density"), nullptr));
    } else if (what == "shape") {
        add_shape(world, command);
    } else if (what == "grab") {
        command.vector("point", a);
        must(lendulet_grab(&world, body_at(world, command.whole("body", most_bodies)), a));
    } else if (what == "drag") {
        command.vector("target", a);
        lendulet_drag(&world, a);  // may have been let go by a restore
    } else if (what == "release") {
        lendulet_release(&world);
    } else if (what == "set") {
        set(world, command);
    } else {
        throw Asked::Refused{"there is no change named \"" + printable(what) + "\""};
    }
}

}  // namespace lendulet::cli
