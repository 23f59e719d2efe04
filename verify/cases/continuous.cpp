// Cases A40 and A41: nothing passes through anything, however fast it flies or spins.
#include <cmath>
#include <vector>

#include "verify/cases/cases.h"
#include "verify/cases/walls.h"

namespace lendulet::verify {
namespace {

TriangleMesh wall_mesh(Vec3 half, bool closed) {
    constexpr int cells = 6;
    std::vector<Vec3> vertices;
    std::vector<uint32_t> indices;
    for (float side : {-1.0f, 1.0f}) {
        if (!closed && side > 0.0f) break;
        auto first = static_cast<uint32_t>(vertices.size());
        auto where = [](int i) { return 2.0f * static_cast<float>(i) / cells - 1.0f; };
        for (int i = 0; i <= cells; ++i)
            for (int k = 0; k <= cells; ++k)
                vertices.push_back({closed ? side * half.x : 0.0f, half.y * where(i), half.z * where(k)});
        for (uint32_t i = 0; i < cells; ++i)
            for (uint32_t k = 0; k < cells; ++k) {
                uint32_t a = first + i * (cells + 1) + k, b = a + cells + 1;
                for (uint32_t v : {a, a + 1, b, a + 1, b + 1, b}) indices.push_back(v);
            }
    }
    return TriangleMesh::from_triangles(vertices, indices).value();
}

// How far from the surface a ball without bounce ends that was about to pass through.
double gap_after_impact(const Setting& s, Wall wall, float speed) {
    const float dt = s.dt();
    World world = s.builder({}).no_friction().build().value();
    add_fixed(world, s.frame, {.shape = wall_shape(wall, {0.0005f, 2.0f, 2.0f})});
    BodyId ball = add_body(world, s.frame,
                           {.shape = Sphere{0.05f},
                            .position = {-0.6f * speed * dt - 0.06f, 0.11f, 0.03f},
                            .velocity = {speed, 0.0f, 0.0f}});
    advance(world, 2, dt);
    double surface = wall == Wall::sheet ? 0.0 : -0.0005;
    return surface - (place(world, s.frame, ball).x + 0.05);
}

struct Spin {
    double energy_rise;  // highest over first, less 1
    bool through;
};

// A rod of 2 x 0.04 m that spins beside a wall or a pole hits it and flies away on its own side.
Spin spin_rod(const Setting& s, float rate, int kind) {
    const bool pole = kind % 2 == 1;
    World world = s.builder({}).no_friction().build().value();
    const float distance = pole ? 0.5f : 0.7f;
    StaticBodyDef obstacle{.shape = Box{{0.01f, 2.0f, 2.0f}}, .position = {distance, 0.0f, 0.0f}};
    if (pole) {
        obstacle.shape = Cylinder{1.0f, 0.01f};
        obstacle.orientation = rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi);
    }
    add_fixed(world, s.frame, obstacle);
    RigidBodyDef def{.shape = Box{{0.02f, 1.0f, 0.02f}},
                     .orientation = rotation_about({0.0f, 0.0f, 1.0f}, 0.3f * static_cast<float>(kind)),
                     .angular_velocity = {0.0f, 0.0f, kind == 2 ? -rate : rate}};
    if (kind >= 2) def.shape = Capsule{0.98f, 0.02f};
    BodyId rod = add_body(world, s.frame, def);
    Spin seen{};
    const double first = totals(world, s.frame.origin).kinetic_energy;
    for (int i = 0, steps = s.steps(1.0 / 3.0); i < steps && !seen.through; ++i) {
        advance(world, 1, s.dt());
        seen.energy_rise = std::fmax(seen.energy_rise, totals(world, s.frame.origin).kinetic_energy / first - 1.0);
        if (pole) continue;
        RigidBodyRef body = world.get(rod);
        for (float end : {-1.0f, 0.0f, 1.0f}) {  // no point of its axis on the far side
            Vec3d tip = s.frame.local(body.position() + rotate(body.orientation(), {0.0f, end, 0.0f}));
            seen.through = seen.through || tip.x > static_cast<double>(distance);
        }
    }
    return seen;
}

}  // namespace

Shape wall_shape(Wall wall, Vec3 half) {
    if (wall == Wall::box) return Box{half};
    return wall_mesh(half, wall == Wall::closed_mesh);
}

bool held_by_wall(const Frame& frame, const Shot& shot) {
    World world = WorldBuilder().no_gravity().sleep(false).solver_steps(shot.solver_steps).build().value();
    add_fixed(world, frame, {.shape = wall_shape(shot.wall, {0.5f * shot.thickness, 2.0f, 2.0f})});
    BodyId ball = add_body(world, frame,
                           {.shape = Sphere{0.05f},
                            .position = {-0.2f - shot.phase * shot.speed * shot.dt, 0.1f, 0.07f - 0.3f * shot.phase},
                            .velocity = {shot.speed, 0.05f * shot.speed * shot.phase, 0.0f}});
    for (int i = 0; i < 8; ++i) {
        advance(world, 1, shot.dt);
        if (place(world, frame, ball).x > 0.0) return false;
    }
    return true;
}

// 400 speeds and phases for each wall.
void bullets_against_walls(const Setting& s, Figures& out) {
    Quantity& gap = out.quantity("distance from the wall after the impact, m", within(5e-3));
    for (Wall wall : walls) {
        const float thickness = wall == Wall::box ? 0.02f : wall == Wall::closed_mesh ? 0.001f : 0.0f;
        const char* names[] = {"box of 20 mm", "mesh of 1 mm", "sheet of triangles"};
        int escaped = 0;
        const int speeds = s.scaled(50, 4);
        for (int i = 0; i < speeds; ++i)
            for (int phase = 0; phase < 8; ++phase) {
                float part = static_cast<float>(i) / static_cast<float>(speeds - 1);
                escaped += !held_by_wall(s.frame, {.wall = wall,
                                                   .thickness = thickness,
                                                   .speed = 20.0f + 980.0f * part,
                                                   .phase = 0.02f + 0.93f * static_cast<float>(phase) / 7.0f,
                                                   .solver_steps = phase % 2 ? s.solver_steps() : s.solver_steps() / 2,
                                                   .dt = s.dt()});
            }
        out.quantity(std::string("through a ") + names[static_cast<int>(wall)] + ", of 400", at_most()).add(escaped);
        for (float speed : {25.0f, 120.0f, 450.0f, 1000.0f}) gap.add(gap_after_impact(s, wall, speed));
    }
}

void spinning_rods(const Setting& s, Figures& out) {
    Quantity &through = out.quantity("through the wall, of 200", at_most()),
             &energy = out.quantity("rise of energy / energy", at_most(1e-3));
    int count = 0;
    const int speeds = s.scaled(50, 3);
    for (int i = 0; i < speeds; ++i)
        for (int kind = 0; kind < 4; ++kind) {
            float rate = 100.0f + 400.0f * static_cast<float>(i) / static_cast<float>(speeds - 1);
            Spin seen = spin_rod(s, rate, kind);
            count += seen.through;
            energy.add(seen.energy_rise);
        }
    through.add(count);
}

}  // namespace lendulet::verify
