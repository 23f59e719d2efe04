#include "io/gltf_fixture.h"

#include <algorithm>
#include <cmath>

namespace lendulet::test {

std::string gltf_text(const std::string& nodes, const std::string& shapes, const std::string& physics) {
    std::string text = "{'asset':{'version':'2.0'},'extensions':{";
    text += "'KHR_implicit_shapes':{'shapes':[" + shapes + "]}";
    if (!physics.empty()) text += ",'KHR_physics_rigid_bodies':{" + physics + "}";
    text += "},'nodes':[" + nodes + "]}";
    std::replace(text.begin(), text.end(), '\'', '"');
    return text;
}

BodyId find_body(const World& world, std::string_view name) {
    for (int i = 0; i < world.body_count(); ++i) {
        if (world.get_static(world.body(i)).name() == name) return world.body(i);
    }
    ADD_FAILURE() << "no body \"" << name << '"';
    return {};
}

bool warns(const Scene& scene, std::string_view part) {
    auto has = [&](const std::string& sentence) { return sentence.find(part) != std::string::npos; };
    return std::any_of(scene.warnings.begin(), scene.warnings.end(), has) ||
           std::any_of(scene.world.warnings().begin(), scene.world.warnings().end(), has);
}

void run(Scene& scene, int steps) {
    for (int i = 0; i < steps; ++i) scene.world.update(1.0f / 60.0f).value();
}

float distance(Vec3 a, Vec3 b) { return length(a - b); }

float angle_between(Quat a, Quat b) { return 2.0f * std::acos(std::min(1.0f, std::abs(dot(a, b)))); }

}  // namespace lendulet::test
