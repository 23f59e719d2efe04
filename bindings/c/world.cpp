// The C interface: errors, scenes, worlds and their steps.
#include "bindings/c/handle.h"

using namespace lendulet;
using namespace lendulet::c;

namespace {

// Plain memory: a string would have to be destroyed at the end of each thread, which not every platform can.
thread_local char sentence[512];

const std::vector<SceneInfo>& scenes() {
    static const std::vector<SceneInfo> list = built_in_scenes();
    return list;
}

const SceneInfo* scene_at(int32_t scene) {
    return scene >= 0 && static_cast<size_t>(scene) < scenes().size() ? &scenes()[static_cast<size_t>(scene)] : nullptr;
}

lendulet_world* hand_out(Result<Scene> scene) {
    if (!scene) return refuse(scene.error()), nullptr;
    return new lendulet_world(std::move(scene).value());
}

}  // namespace

namespace lendulet::c {

lendulet_result refuse(const Error& error) {
    size_t size = error.message.copy(sentence, sizeof sentence - 1);
    sentence[size] = 0;
    return -1 - static_cast<lendulet_result>(error.code);
}

lendulet_result refuse_null(const char* call) {
    return refuse({ErrorCode::bad_config, std::string(call) + ": a world or a pointer is null"});
}

lendulet_result refuse_body(const char* call) {
    return refuse({ErrorCode::stale_id, std::string(call) + ": there is no such body that can move in this world"});
}

}  // namespace lendulet::c

extern "C" {

uint32_t lendulet_version(void) { return LENDULET_C_VERSION; }
const char* lendulet_error(void) { return sentence; }

int32_t lendulet_scene_count(void) { return static_cast<int32_t>(scenes().size()); }
// The names and sentences are literals, which end with a zero.
const char* lendulet_scene_name(int32_t scene) { return scene_at(scene) ? scene_at(scene)->name.data() : nullptr; }
const char* lendulet_scene_description(int32_t scene) {
    return scene_at(scene) ? scene_at(scene)->description.data() : nullptr;
}
int32_t lendulet_scene_size(int32_t scene) { return scene_at(scene) ? scene_at(scene)->default_size : 0; }

lendulet_world* lendulet_create_scene(const char* name) {
    if (!name) return refuse_null("create_scene"), nullptr;
    return hand_out(build_scene(name));
}

lendulet_world* lendulet_create_world(float gravity) {
    Result<World> world = WorldBuilder{}.down_gravity(gravity).build();
    if (!world) return refuse(world.error()), nullptr;
    return hand_out(Scene{std::move(world).value(), "world", 1.0f / 60.0f, 600, {}, {}});
}

void lendulet_destroy(lendulet_world* world) { delete world; }

lendulet_result lendulet_step(lendulet_world* world) {
    if (!world) return refuse_null("step");
    Scene& scene = world->scene;
    if (scene.before_step) scene.before_step(scene.world, static_cast<int>(scene.world.step_count()));
    pull(*world);
    return result_of(scene.world.update(scene.dt));
}

float lendulet_step_size(const lendulet_world* world) { return world ? world->scene.dt : 0.0f; }
double lendulet_time(const lendulet_world* world) { return world ? world->scene.world.time() : 0.0; }
uint64_t lendulet_step_count(const lendulet_world* world) { return world ? world->scene.world.step_count() : 0; }
uint64_t lendulet_hash(const lendulet_world* world) { return world ? world->scene.world.hash() : 0; }

lendulet_result lendulet_reserve(lendulet_world* world, int32_t bodies, int32_t contacts, int32_t joints) {
    if (!world) return refuse_null("reserve");
    return result_of(world->scene.world.reserve({bodies, contacts, joints}));
}

lendulet_result lendulet_set_gravity(lendulet_world* world, const float gravity[3]) {
    if (!world || !gravity) return refuse_null("set_gravity");
    return result_of(world->scene.world.set_gravity(vector(gravity)));
}

lendulet_result lendulet_read_gravity(const lendulet_world* world, float out[3]) {
    if (!world || !out) return refuse_null("read_gravity");
    put(out, world->scene.world.config().gravity);
    return 0;
}

lendulet_result lendulet_read_snapshot(lendulet_world* world, const uint8_t** out) {
    if (!world || !out) return refuse_null("read_snapshot");
    world->snapshot = world->scene.world.snapshot();
    return give(world->snapshot, out);
}

lendulet_result lendulet_restore(lendulet_world* world, const uint8_t* bytes, size_t size) {
    if (!world || !bytes) return refuse_null("restore");
    Status status = world->scene.world.restore({bytes, size});
    if (status.ok()) world->grip = {};
    return result_of(status);
}

void lendulet_forget_removed(lendulet_world* world) {
    if (world) world->scene.world.forget_removed();
}

}  // extern "C"
