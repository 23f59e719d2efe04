// Gallery: a T-handle that tumbles, and beside it what a simple integrator makes of the same motion.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

constexpr float bar_half = 0.55f, bar_radius = 0.11f, stem_half = 0.3f, stem_radius = 0.1f, density = 1000.0f;
constexpr Vec3 first_spin{0.03f, 8.0f, 0.0f};  // body frame, rad/s; the stem lies along y
constexpr Position real_place{-1.1f, 1.6f, 0.0f}, naive_place{1.1f, 1.6f, 0.0f};

void add_handle(SceneBody& body) {
    add_part(body, Cylinder{bar_half, bar_radius}, {{0.0f, 0.0f, 0.0f}, rotation_about({0.0f, 0.0f, 1.0f}, 0.5f * pi)},
             density);
    add_part(body, Cylinder{stem_half, stem_radius}, {{0.0f, bar_radius + stem_half, 0.0f}, {}}, density);
}

struct Cylinders {
    Vec3 inertia;  // principal, about the centre of mass
    float centre;  // along the stem
};
Cylinders handle_inertia() {
    auto mass = [](float half, float r) { return density * pi * r * r * 2.0f * half; };
    auto across = [](float m, float half, float r) { return m * (0.25f * r * r + half * half / 3.0f); };
    const float bar = mass(bar_half, bar_radius), stem = mass(stem_half, stem_radius);
    const float place = bar_radius + stem_half, centre = stem * place / (bar + stem);
    const float shift = bar * centre * centre + stem * (place - centre) * (place - centre);
    return {{0.5f * bar * bar_radius * bar_radius + across(stem, stem_half, stem_radius) + shift,
             across(bar, bar_half, bar_radius) + 0.5f * stem * stem_radius * stem_radius,
             across(bar, bar_half, bar_radius) + across(stem, stem_half, stem_radius) + shift},
            centre};
}

// Euler's equations in the body's frame, one explicit step each: w += h I^-1 (I w x w), and the orientation by w.
// Energy grows with every step; where it has grown sixfold the motion begins anew.
struct Naive {
    Vec3 w = first_spin;
    Quat q;

    void advance(Vec3 inertia, float dt) {
        const Vec3 L = multiply(inertia, w);
        if (dot(w, L) > 6.0f * dot(first_spin, multiply(inertia, first_spin))) *this = {};
        const Vec3 change = cross(multiply(inertia, w), w);
        const float angle = length(w) * dt;
        q = normalize(q * rotation_about(w, angle));
        w = w + Vec3{change.x / inertia.x, change.y / inertia.y, change.z / inertia.z} * dt;
    }
};

}  // namespace

SceneDescription t_handle(int) {
    SceneDescription scene;
    scene.gravity = {};
    scene.steps = 1800;
    const Cylinders solid = handle_inertia();
    SceneBody& real = scene.bodies.emplace_back();
    add_handle(real);
    real.position = real_place;
    real.angular_velocity = first_spin;
    real.allow_sleep = false;
    real.name = "momentum kept";
    SceneBody& naive = scene.bodies.emplace_back();
    add_handle(naive);
    naive.type = BodyType::kinematic;
    naive.position = naive_place;
    naive.name = "naive integrator";
    add_static(scene, Box{{2.6f, 0.1f, 1.2f}}, {0.0f, 0.0f, 0.0f});
    // Follows from the number of the step alone: where that does not go on by one, the motion is made anew.
    scene.before_step = [inertia = solid.inertia, centre = solid.centre, dt = scene.dt, state = Naive{}, done = 0](
                            SceneDriver& driver, int step) mutable {
        if (step < done) state = {}, done = 0;
        for (; done <= step; ++done) state.advance(inertia, dt);
        const Vec3 arm = rotate(state.q, Vec3{0.0f, centre, 0.0f});
        driver.move_to(1, {naive_place + Vec3{0.0f, centre, 0.0f} - arm, state.q});
    };
    return scene;
}

}  // namespace lendulet::scenes
