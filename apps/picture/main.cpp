// Simulates a built-in scene and writes what it looks like as a PPM image on standard output; scripts/picture makes it
// a PNG. Usage: picture SCENE SECONDS [AZIMUTH_DEGREES [ELEVATION_DEGREES [ZOOM]]]
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>

#include "apps/picture/draw.h"
#include "scenes/scene.h"

using namespace lendulet;

namespace {

constexpr int width = 1000, height = 560;
constexpr Vec3 palette[] = {{0.80f, 0.24f, 0.14f}, {0.90f, 0.55f, 0.10f}, {0.16f, 0.42f, 0.70f},
                            {0.20f, 0.55f, 0.36f}, {0.78f, 0.70f, 0.52f}, {0.45f, 0.28f, 0.55f}};
constexpr Vec3 static_colour{0.52f, 0.53f, 0.55f};

// Neighbours in creation order get colours that look unrelated (Fibonacci hashing).
Vec3 colour_of(int body) {
    uint32_t mixed = static_cast<uint32_t>(body + 1) * 2654435769u;
    return palette[(mixed >> 16) % std::size(palette)];
}

// Walls would stand between the viewer and what is inside: static bodies that rise above the floor on the viewer's side
// are left out.
bool hides_the_scene(const StaticBodyRef& body, const picture::Camera& camera, const Aabb& region) {
    if (body.type() != BodyType::fixed) return false;
    Aabb box = body.aabb();
    Vec3 towards = normalize(camera.eye - camera.target);
    Vec3 centre = 0.5f * (from_origin(box.lower) + from_origin(box.upper));
    bool rises = box.upper.y > region.lower.y + 0.5f;
    return rises && dot(centre - camera.target, {towards.x, 0.0f, towards.z}) > 0.0f;
}

Aabb region_of_moving_bodies(const World& world) {
    Aabb region{{1e9f, 1e9f, 1e9f}, {-1e9f, -1e9f, -1e9f}};
    for (int i = 0; i < world.body_count(); ++i) {
        StaticBodyRef body = world.get_static(world.body(i));
        if (body.type() != BodyType::dynamic) continue;
        region.lower = at(minimum(from_origin(region.lower), from_origin(body.aabb().lower)));
        region.upper = at(maximum(from_origin(region.upper), from_origin(body.aabb().upper)));
    }
    return region;
}

picture::Camera frame(const Aabb& region, float azimuth, float elevation, float zoom) {
    Vec3 lower = from_origin(region.lower), upper = from_origin(region.upper);
    float size = length(upper - lower);
    SinCos a = sin_cos(azimuth * pi / 180.0f), e = sin_cos(elevation * pi / 180.0f);
    picture::Camera camera;
    camera.target = 0.5f * (lower + upper);
    camera.eye = camera.target + (1.5f * size / zoom) * Vec3{e.cos * a.sin, e.sin, e.cos * a.cos};
    return camera;
}

void paint(const StaticBodyRef& body, Vec3 colour, std::vector<picture::Painted>& out) {
    Pose pose{body.position(), body.orientation()};
    for (int c = 0; c < body.collider_count(); ++c) {
        Pose local = pose * body.collider_pose(c);
        for (picture::Triangle t : picture::triangles_of(body.shape(c))) {
            for (int k = 0; k < 3; ++k) {
                t.corners[k] = from_origin(local * t.corners[k]);
                t.normals[k] = rotate(local.orientation, t.normals[k]);
            }
            out.push_back({t, colour});
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: picture SCENE SECONDS [AZIMUTH_DEGREES [ELEVATION_DEGREES [ZOOM]]]\n");
        return 2;
    }
    auto number = [&](int i, double fallback) { return static_cast<float>(i < argc ? std::atof(argv[i]) : fallback); };
    Scene scene = build_scene(argv[1]).value();
    int steps = static_cast<int>(number(2, 0.0) / scene.dt + 0.5f);
    for (int step = 0; step < steps; ++step) {
        if (scene.before_step) scene.before_step(scene.world, step);
        scene.world.update(scene.dt).value();
    }
    const World& world = scene.world;
    Aabb region = region_of_moving_bodies(world);
    picture::Camera camera = frame(region, number(3, 35.0), number(4, 25.0), number(5, 1.0));
    std::vector<picture::Painted> triangles;
    for (int i = 0; i < world.body_count(); ++i) {
        StaticBodyRef body = world.get_static(world.body(i));
        if (hides_the_scene(body, camera, region)) continue;
        Vec3 colour = body.type() == BodyType::dynamic ? colour_of(i) : static_colour;
        paint(body, colour, triangles);
    }
    picture::Image image = picture::draw(triangles, camera, width, height);
    std::printf("P6\n%d %d\n255\n", image.width, image.height);
    std::fwrite(image.rgb.data(), 1, image.rgb.size(), stdout);
    return 0;
}
