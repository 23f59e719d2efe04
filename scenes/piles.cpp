// Piles: bodies turned at random, dropped in layers into an open container or onto hills of triangles.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

// Bodies along each side of a layer: ten layers up to 4000 bodies (10 x 10 for 1000, 20 x 20 for 4000), then layers and
// sides grow together up to 32 x 32 in 16 layers for 16000.
int pile_side(int count) {
    int side = 1;
    while (count <= 4000 ? side * side * 10 < count : side < 20 || int64_t{125} * side * side < int64_t{8} * count)
        ++side;
    return side;
}

SceneDescription pile(Kind kind, int count, float spacing) {
    SceneDescription scene;
    scene.steps = 200;
    Random random;
    Props props(random);
    int side = pile_side(count), layer = side * side;
    float inner = 0.5f * static_cast<float>(side) * spacing;
    float layers = static_cast<float>((count + layer - 1) / layer);
    add_container(scene, inner, maximum(6.0f, layers * spacing + 4.0f));
    float jitter = 0.02f * spacing;
    for (int i = 0; i < count; ++i) {
        float x = static_cast<float>(i % side) + 0.5f, y = static_cast<float>(i / layer);
        float z = static_cast<float>(i / side % side) + 0.5f;
        Position position;
        position.x = x * spacing - inner + random.range(-jitter, jitter);
        position.y = 1.0f + y * spacing + random.range(-jitter, jitter);
        position.z = z * spacing - inner + random.range(-jitter, jitter);
        add_body(scene, props.shape(kind, i), position).orientation = random.rotation();
    }
    return scene;
}

// The hills of add_terrain() as a height field, of rock below, with bands of mud and of ice across the slopes.
void add_height_field(SceneDescription& scene, int cells, float cell) {
    static const Material table[] = {
        {.static_friction = 0.6f, .dynamic_friction = 0.5f},
        {.static_friction = 1.2f, .dynamic_friction = 1.0f, .friction_combine = CombineRule::maximum},
        {.static_friction = 0.05f, .dynamic_friction = 0.03f, .friction_combine = CombineRule::minimum}};
    std::vector<float> heights;
    std::vector<uint8_t> materials;
    float half = 0.5f * static_cast<float>(cells) * cell;
    for (int row = 0; row <= cells; ++row)
        for (int column = 0; column <= cells; ++column) {
            float x = static_cast<float>(column) * cell - half, z = static_cast<float>(row) * cell - half;
            heights.push_back(terrain_height(x, z));
            if (row == cells || column == cells) continue;
            int band = (column / 12) % 4;
            materials.push_back(static_cast<uint8_t>(band == 1 ? 1 : band == 3 ? 2 : 0));
        }
    HeightFieldDef def;
    def.columns = def.rows = cells + 1;
    def.heights = heights, def.materials = materials;
    def.cell_x = def.cell_z = cell;
    def.origin = {-half, 0.0f, -half};
    SceneBody& ground = add_static(scene, HeightField::from_heights(def).value(), {});
    ground.name = "terrain";
    ground.colliders[0].materials = table;
}

}  // namespace

SceneDescription box_pile(int count) { return pile(Kind::box, count, 1.8f); }
SceneDescription ten_thousand_boxes(int) { return box_pile(10000); }
SceneDescription sphere_pile(int count) { return pile(Kind::sphere, count, 1.1f); }
SceneDescription capsule_pile(int count) { return pile(Kind::capsule, count, 1.45f); }
SceneDescription convex_pile(int count) { return pile(Kind::convex, count, 1.25f); }
SceneDescription mixed_pile(int count) { return pile(Kind::mixed, count, 1.8f); }

SceneDescription mesh_terrain(int count) {
    SceneDescription scene;
    scene.steps = 240;
    add_terrain(scene, 224, 0.5f);
    Random random;
    Props props(random);
    for (int i = 0; i < count; ++i) {
        Position position{(static_cast<float>(i % 32) - 15.5f) * 2.0f, 5.0f + 2.0f * static_cast<float>(i / 1024),
                          (static_cast<float>(i / 32 % 32) - 15.5f) * 2.0f};
        add_body(scene, props.shape(Kind::mixed, i), position).orientation = random.rotation();
    }
    return scene;
}

// A heap over a summit, which breaks up and rolls down on all sides.
SceneDescription height_field(int count) {
    SceneDescription scene;
    scene.steps = 400;
    add_height_field(scene, 224, 0.5f);
    Random random;
    Props props(random);
    const float summit_x = 0.5f * pi / 0.15f;
    int side = pile_side(count), layer = side * side;
    float inner = 0.5f * static_cast<float>(side);
    for (int i = 0; i < count; ++i) {
        float x = static_cast<float>(i % side) + 0.5f - inner, z = static_cast<float>(i / side % side) + 0.5f - inner;
        Position position{summit_x + 1.4f * x, 4.5f + 1.4f * static_cast<float>(i / layer), 1.4f * z};
        add_body(scene, props.shape(Kind::mixed, i), position).orientation = random.rotation();
    }
    return scene;
}

}  // namespace lendulet::scenes
