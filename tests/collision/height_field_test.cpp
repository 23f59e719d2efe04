// Height fields beside meshes of the same triangles: contacts, rays, casts and distances agree; one-sided surfaces.
#include "collision/query/cast.h"
#include "collision/query/proximity.h"
#include "collision/query/ray.h"
#include "family.h"
#include "scale.h"

using namespace pairs;

namespace {

constexpr int cells = 24;
constexpr float cell = 0.4f;

float bumps(float x, float z) { return 0.3f * sin_cos(2.1f * x).sin * sin_cos(1.7f * z + 0.5f).cos; }

struct Both {
    Solid field, mesh;
    std::vector<int32_t> number;  // in the field, of the mesh's triangles

    template <class Height>
    static HeightField make(Height&& height, bool holes, bool one_sided) {
        std::vector<float> heights;
        std::vector<uint8_t> hole;
        float half = 0.5f * cell * cells;
        for (int k = 0; k <= cells; ++k)
            for (int i = 0; i <= cells; ++i)
                heights.push_back(height(cell * static_cast<float>(i) - half, cell * static_cast<float>(k) - half));
        for (int n = 0; n < cells * cells; ++n) hole.push_back(holes && (n % cells) % 5 == 2 && (n / cells) % 4 == 1);
        HeightFieldDef def;
        def.columns = def.rows = cells + 1;
        def.heights = heights, def.holes = hole;
        def.cell_x = def.cell_z = cell;
        def.origin = {-half, 0.0f, -half};
        def.one_sided = one_sided;
        return HeightField::from_heights(def).value();
    }
    template <class Height>
    explicit Both(Height&& height, bool holes = false, bool one_sided = false)
        : field(make(height, holes, one_sided)), mesh(mesh_of(std::get<HeightField>(field.shape), one_sided)) {
        const auto& f = std::get<HeightField>(field.shape);
        for (int n = 0; n < cells * cells; ++n)
            if (!f.is_hole(n % cells, n / cells)) number.push_back(2 * n), number.push_back(2 * n + 1);
    }
    static TriangleMesh mesh_of(const HeightField& f, bool one_sided) {
        TriangleOptions options;
        options.one_sided = one_sided;
        return TriangleMesh::from_triangles(f.vertices(), f.triangles(), options).value();
    }
    int32_t of_mesh(int32_t triangle) const { return triangle < 0 ? triangle : number[static_cast<size_t>(triangle)]; }
};

void expect_same(std::vector<Manifold> a, std::vector<Manifold> b, const char* what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    // Triangles come in another order, and so do manifolds; which of several points with one depth lead may differ.
    for (const Manifold& m : a) {
        const Manifold* nearest = &b[0];
        for (const Manifold& n : b)
            if (length(n.normal - m.normal) < length(nearest->normal - m.normal)) nearest = &n;
        expect_near(m.normal, nearest->normal, 0.02f, what);
        EXPECT_NEAR(deepest(m), deepest(*nearest), 1e-4f) << what;
    }
}

TEST(HeightFieldContacts, AreThoseOfTheSameMesh) {
    for (bool holes : {false, true}) {
        Both ground(bumps, holes);
        Random random(4);
        int touched = 0;
        for (const Kind& kind : every_kind()) {
            Solid shape(kind.shape);
            for (int i = 0; i < scaled(200, 20); ++i) {
                Quat turn = random.rotation();
                Vec3 at{random.in(-4.0f, 4.0f), random.in(-0.5f, 0.9f), random.in(-4.0f, 4.0f)};
                // On its own every fact is the same: compared with few manifolds, of which none had to go.
                std::vector<Manifold> a = manifolds(pair_of({ground.field, {}}, {shape, turn}, at, 0.02f));
                std::vector<Manifold> b = manifolds(pair_of({ground.mesh, {}}, {shape, turn}, at, 0.02f));
                ASSERT_EQ(a.empty(), b.empty()) << kind.name;
                for (const Manifold& m : a) ASSERT_NO_FATAL_FAILURE(expect_sound(m, 0.02f));
                PairCache cache;
                CollidePair on_field = pair_of({ground.field, {}}, {shape, turn}, at, 0.0f);
                CollidePair on_mesh = pair_of({ground.mesh, {}}, {shape, turn}, at, 0.0f);
                EXPECT_EQ(overlap(on_field, cache, {}), overlap(on_mesh, cache, {}));
                if (a.empty()) continue;
                ++touched;
                float least_a = 1e9f, least_b = 1e9f;
                for (const Manifold& m : a) least_a = minimum(least_a, deepest(m));
                for (const Manifold& m : b) least_b = minimum(least_b, deepest(m));
                EXPECT_EQ(least_a, least_b) << kind.name;
            }
        }
        EXPECT_GT(touched, scaled(400, 40));
    }
}

// Where a shape rests on a few facets all manifolds are the same.
TEST(HeightFieldContacts, RestingShapesHaveTheSameManifolds) {
    Both flat([](float, float) { return 0.0f; }), slope([](float x, float) { return 0.5f * x; }),
        valley([](float x, float) { return 0.7f * absolute(x); });
    const Kind shapes[] = {{"ball", Sphere{0.4f}}, {"box", Box{{0.3f, 0.4f, 0.5f}}}, {"capsule", Capsule{0.4f, 0.2f}}};
    Random random(9);
    for (const Both* ground : {&flat, &slope, &valley})
        for (const Kind& kind : shapes) {
            Solid shape(kind.shape);
            for (int i = 0; i < 100; ++i) {
                Quat turn = rotation_about({0.0f, 1.0f, 0.0f}, random.in(-3.0f, 3.0f));
                float x = random.in(-2.0f, 2.0f);
                Vec3 at{x, random.in(0.35f, 0.45f), random.in(-2.0f, 2.0f)};
                if (ground == &slope) at.y = 0.5f * x + 0.45f;
                if (ground == &valley) at = {0.0f, 0.48f, at.z};
                expect_same(manifolds(pair_of({ground->field, {}}, {shape, turn}, at, 0.02f)),
                            manifolds(pair_of({ground->mesh, {}}, {shape, turn}, at, 0.02f)), kind.name);
            }
        }
}

TEST(HeightFieldQueries, RaysCastsAndDistancesAreThoseOfTheSameMesh) {
    for (bool one_sided : {false, true}) {
        Both ground(bumps, true, one_sided);
        Random random(21);
        int hits = 0, casts = 0;
        for (int i = 0; i < scaled(4000, 200); ++i) {
            Vec3 from = random.vector(-6.0f, 6.0f), to = random.vector(-6.0f, 6.0f);
            if (i % 3 == 0) to = {from.x, -from.y, from.z};  // upright: parallel to two planes of every block
            from.y = i % 2 == 0 ? 0.3f * from.y : from.y;
            LocalRay ray{to_double(from), to_double(to - from), 1.0};
            LocalRayHit a, b;
            bool met = cast_ray(ground.field.geometry, ray, a);
            ASSERT_EQ(met, cast_ray(ground.mesh.geometry, ray, b));
            if (!met) continue;
            ++hits;
            EXPECT_EQ(a.fraction, b.fraction);
            EXPECT_EQ(a.normal.y, b.normal.y);
            EXPECT_EQ(a.triangle, ground.of_mesh(b.triangle));
            if (one_sided) {
                EXPECT_GT(a.normal.y, 0.0);
            }
        }
        EXPECT_GT(hits, scaled(500, 25));
        const std::vector<Kind> kinds = every_kind();
        for (int i = 0; i < scaled(400, 22); ++i) {
            Solid shape(kinds[static_cast<size_t>(i) % kinds.size()].shape);
            Motion still, moving;
            moving.pivot = to_double(random.vector(-4.0f, 4.0f));
            moving.rotation = random.rotation();
            moving.translation = to_double(random.vector(-6.0f, 6.0f));
            CastHit a, b;
            bool met = cast_shapes(ground.field.geometry, still, shape.geometry, moving, 1.0, a);
            ASSERT_EQ(met, cast_shapes(ground.mesh.geometry, still, shape.geometry, moving, 1.0, b)) << i;
            if (met) {
                ++casts;
                EXPECT_EQ(a.fraction, b.fraction);
                if (a.triangle == ground.of_mesh(b.triangle)) {
                    EXPECT_EQ(a.normal.y, b.normal.y);
                }
            }
            PlacedPair on_field{&ground.field.geometry, &shape.geometry, {}, moving.rotation, moving.pivot};
            PlacedPair on_mesh = on_field;
            on_mesh.a = &ground.mesh.geometry;
            Nearness n, m;
            bool near = nearness(on_field, 1.0, n);
            ASSERT_EQ(near, nearness(on_mesh, 1.0, m));
            if (near) {
                EXPECT_EQ(n.distance, m.distance);
            }
        }
        EXPECT_GT(casts, scaled(60, 3));
    }
}

TEST(OneSided, OnlyTheFrontIsMet) {
    auto level = [](float, float) { return 0.0f; };
    Both two(level), one(level, false, true);
    Solid ball(Sphere{0.4f}), box(Box{{0.3f, 0.4f, 0.5f}});
    for (const Solid* ground : {&one.field, &one.mesh, &two.field, &two.mesh}) {
        bool both = ground == &two.field || ground == &two.mesh;
        for (const Solid* shape : {&ball, &box}) {
            EXPECT_EQ(manifolds(pair_of({*ground, {}}, {*shape, {}}, {0.1f, 0.39f, 0.1f}, 0.02f)).size(), 1u);
            EXPECT_EQ(manifolds(pair_of({*ground, {}}, {*shape, {}}, {0.1f, -0.39f, 0.1f}, 0.02f)).size(), both);
            for (double way : {1.0, -1.0}) {
                Motion still, moving;
                moving.pivot = {0.1, -2.0 * way, 0.1};
                moving.translation = {0.0, 4.0 * way, 0.0};
                CastHit hit;
                EXPECT_EQ(cast_shapes(ground->geometry, still, shape->geometry, moving, 1.0, hit), both || way < 0.0);
            }
        }
        LocalRayHit hit;
        EXPECT_TRUE(cast_ray(ground->geometry, {{0.1, 1.0, 0.1}, {0.0, -2.0, 0.0}, 1.0}, hit));
        EXPECT_EQ(cast_ray(ground->geometry, {{0.1, -1.0, 0.1}, {0.0, 2.0, 0.0}, 1.0}, hit), both);
        // Distances know no sides.
        Nearness n;
        EXPECT_TRUE(nearness({&ground->geometry, &ball.geometry, {}, {}, {0.0, -0.5, 0.0}}, 1.0, n));
        EXPECT_NEAR(n.distance, 0.1, 1e-6);
    }
}

}  // namespace
