// Convex shapes on triangle meshes: flat triangulations are like a plane, edges are felt where they stick out and
// nowhere else, both sides are solid, names last.
#include "meshes.h"

#include "collision/mesh/candidates.h"
#include "family.h"
#include "geometry/mesh.h"

using namespace pairs;

namespace {

const Vec3 up{0.0f, 1.0f, 0.0f};

std::vector<Manifold> on(const Solid& mesh, const Solid& shape, Vec3 at, Quat turn = {}, float margin = 0.02f) {
    return manifolds(pair_of({mesh, {}}, {shape, turn}, at, margin));
}

// Whether the points hold up what presses at `centre`: it lies in their convex hull, seen from above.
bool supports(const Manifold& m, Vec3 centre) {
    for (int k = 0; k < 64; ++k) {  // some point lies on the far side of the centre in every direction
        SinCos d = sin_cos(2.0f * pi * static_cast<float>(k) / 64.0f);
        bool held = false;
        for (int i = 0; i < m.count; ++i) {
            Vec3 p = m.points[i].position - centre;
            held |= d.cos * p.x + d.sin * p.z > 0.0f;
        }
        if (!held) return false;
    }
    return true;
}

void expect_same(const std::vector<Manifold>& kept, const std::vector<Manifold>& fresh) {
    ASSERT_EQ(kept.size(), fresh.size());
    for (size_t k = 0; k < kept.size(); ++k) {
        const Manifold &a = kept[k], &b = fresh[k];
        ASSERT_EQ(a.count, b.count);
        EXPECT_EQ(a.normal, b.normal);
        EXPECT_EQ(a.key, b.key);
        for (int j = 0; j < a.count; ++j) {
            EXPECT_EQ(a.points[j].position, b.points[j].position);
            EXPECT_EQ(a.points[j].separation, b.points[j].separation);
            EXPECT_EQ(a.points[j].id, b.points[j].id);
        }
    }
}

int looked_at(const MeshCandidates& near) {
    uint32_t triangles[MeshCandidates::capacity];
    uint8_t places[MeshCandidates::capacity];
    return near.near(triangles, places);
}

TEST(Mesh, FlatGridGivesThePlanesNormalEverywhere) {
    Solid mesh(flat_grid(16, 0.5f)), ball(Sphere{0.4f}), box(Box{{0.3f, 0.4f, 0.5f}});
    Random random(5);
    uint32_t key = 0;
    for (int i = 0; i < 1500; ++i) {
        // Along a skew line that meets many edges and corners, pressed in by up to 5 mm; then through corners exactly.
        float s = 0.004f * static_cast<float>(i) - 3.0f;
        Vec3 at = i % 3 == 0 ? Vec3{0.5f * static_cast<float>(i % 11 - 5), 0.4f, 0.5f * static_cast<float>(i % 7 - 3)}
                             : Vec3{s, 0.4f - random.in(0.0f, 5e-3f), 0.37f * s};
        std::vector<Manifold> m = on(mesh, ball, at);
        ASSERT_EQ(m.size(), 1u) << i;
        EXPECT_EQ(m[0].normal, up);
        ASSERT_EQ(m[0].count, 1);
        EXPECT_NEAR(m[0].points[0].separation, at.y - 0.4f, 1e-6f);
        expect_near(m[0].points[0].position, {at.x, 0.5f * (at.y - 0.4f), at.z}, 1e-5f);
        m = on(mesh, box, at, rotation_about(up, s));
        ASSERT_EQ(m.size(), 1u) << i;
        EXPECT_EQ(m[0].normal, up);
        ASSERT_EQ(m[0].count, 4);
        EXPECT_NEAR(deepest(m[0]), at.y - 0.4f, 1e-6f);
        EXPECT_TRUE(supports(m[0], at));
        if (i == 0) key = m[0].key;
        EXPECT_EQ(m[0].key, key);
    }
}

TEST(Mesh, TiltedShapesOnAFlatGridTouchLikeOnAPlane) {
    Solid mesh(flat_grid(16, 0.5f)), plane(Plane{up, 0.0f});
    Random random(8);
    for (const Kind& kind : every_kind()) {
        Solid shape(kind.shape);
        for (int i = 0; i < 100; ++i) {
            Quat turn = random.rotation();
            CentredBox box = bounds(shape.geometry, turn);
            Vec3 at{random.in(-1.0f, 1.0f), box.half.y - box.centre.y - random.in(-0.01f, 0.05f),
                    random.in(-1.0f, 1.0f)};
            std::vector<Manifold> m = on(mesh, shape, at, turn);
            Manifold expected = manifold(pair_of({plane, {}}, {shape, turn}, at, 0.02f));
            ASSERT_EQ(m.size(), 1u) << kind.name;
            EXPECT_EQ(m[0].normal, up) << kind.name;
            EXPECT_NEAR(deepest(m[0]), deepest(expected), 1e-3f) << kind.name;
        }
    }
}

TEST(Mesh, CornerNamesLastWhileABoxSlides) {
    Solid mesh(flat_grid(16, 0.5f)), box(Box{{0.3f, 0.4f, 0.5f}});
    uint32_t names[4] = {};
    for (int i = 0; i < 300; ++i) {
        float s = 0.003f * static_cast<float>(i);
        std::vector<Manifold> m = on(mesh, box, {s, 0.399f, -0.7f * s}, rotation_about(up, 0.2f));
        ASSERT_EQ(m.size(), 1u);
        ASSERT_EQ(m[0].count, 4);
        for (int k = 0; k < 4; ++k) {
            if (i == 0) names[k] = m[0].points[k].id;
            bool known = false;
            for (uint32_t name : names) known |= name == m[0].points[k].id;
            EXPECT_TRUE(known) << i;
        }
    }
}

TEST(Mesh, BothSidesAreSolid) {
    Solid mesh(flat_grid(4, 1.0f)), ball(Sphere{0.4f}), box(Box{{0.3f, 0.4f, 0.5f}});
    for (const Solid* shape : {&ball, &box}) {
        // Even deep in, the side of the centre decides.
        for (float y : {0.39f, 0.2f, 0.01f, -0.01f, -0.2f, -0.39f}) {
            std::vector<Manifold> m = on(mesh, *shape, {0.3f, y, 0.2f});
            ASSERT_EQ(m.size(), 1u) << y;
            EXPECT_EQ(m[0].normal, (y > 0.0f ? up : -up)) << y;
            EXPECT_NEAR(deepest(m[0]), absolute(y) - 0.4f, 1e-5f);
        }
    }
}

TEST(Mesh, RidgeTouchesAlongItsEdge) {
    // A roof with its ridge along z; edges at the foot do not matter here.
    Solid roof(grid(4, 1.0f, [](float x, float) { return 1.0f - absolute(x); }));
    Solid ball(Sphere{0.5f}), box(Box{{0.5f, 0.5f, 0.5f}}), cylinder(Cylinder{0.5f, 0.5f});
    for (float z : {0.25f, 0.0f, -0.7f}) {
        std::vector<Manifold> m = on(roof, ball, {0.0f, 1.49f, z});
        ASSERT_EQ(m.size(), 1u);
        expect_near(m[0].normal, up, 1e-5f);
        EXPECT_NEAR(deepest(m[0]), -0.01f, 1e-5f);
        m = on(roof, box, {0.1f, 1.49f, z});
        ASSERT_EQ(m.size(), 1u);
        expect_near(m[0].normal, up, 1e-5f);
        ASSERT_EQ(m[0].count, 2);
        for (int k = 0; k < 2; ++k) {
            EXPECT_NEAR(m[0].points[k].position.x, 0.0f, 1e-4f);
            EXPECT_NEAR(absolute(m[0].points[k].position.z - z), 0.5f, 1e-3f);
            EXPECT_NEAR(m[0].points[k].separation, -0.01f, 1e-4f);
        }
    }
    // On a slope there is the slope's normal.
    float h = std::sqrt(0.5f);
    std::vector<Manifold> m = on(roof, ball, {0.5f + 0.49f * h, 0.5f + 0.49f * h, 0.1f});
    ASSERT_EQ(m.size(), 1u);
    expect_near(m[0].normal, {h, h, 0.0f}, 1e-5f);
    EXPECT_NEAR(deepest(m[0]), -0.01f, 1e-5f);
}

TEST(Mesh, ValleyTouchesBothSides) {
    Solid valley(grid(4, 1.0f, [](float x, float) { return absolute(x); })), ball(Sphere{0.5f});
    float h = std::sqrt(0.5f);
    std::vector<Manifold> m = on(valley, ball, {0.0f, 0.5f / h - 0.01f, 0.1f});
    ASSERT_EQ(m.size(), 2u);
    for (const Manifold& side : m) {
        EXPECT_NEAR(absolute(side.normal.x), h, 1e-5f);
        EXPECT_NEAR(side.normal.y, h, 1e-5f);
        EXPECT_NEAR(deepest(side), -0.01f * h, 1e-5f);
    }
    EXPECT_NE(m[0].key, m[1].key);
}

// Two slopes of 4 degrees with a ridge along z: gentle, so that its faces stand for it wherever a shape lies over them.
// Over the ridge itself, in the wedge between the faces' prisms, the closest points decide.
TEST(Mesh, GentleRidgeHoldsWhatLiesAlongIt) {
    const float slope = 0.07f;
    Solid mesh(grid(8, 0.5f, [&](float x, float) { return -slope * absolute(x); }));
    const Quat along_z = rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi);
    Solid capsule(Capsule{0.6f, 0.3f}), box(Box{{0.3f, 0.3f, 0.6f}});
    for (float z : {-0.4f, 0.0f, 0.13f}) {
        for (float x : {-0.02f, -0.004f, 0.0f, 0.004f, 0.02f}) {
            std::vector<Manifold> m = on(mesh, capsule, {x, 0.29f, z}, along_z);
            ASSERT_FALSE(m.empty()) << x;
            float deepest_of_all = 1.0f;
            for (const Manifold& one : m) {
                deepest_of_all = minimum(deepest_of_all, deepest(one));
                EXPECT_GT(one.normal.y, 0.99f) << x;
            }
            EXPECT_NEAR(deepest_of_all, std::hypot(x, 0.29f) - 0.3f, 1.5e-3f) << x;
        }
        std::vector<Manifold> m = on(mesh, box, {0.0f, 0.29f, z});
        float deepest_of_all = 1.0f;
        for (const Manifold& one : m) deepest_of_all = minimum(deepest_of_all, deepest(one));
        EXPECT_NEAR(deepest_of_all, -0.01f, 1e-3f);
    }
}

TEST(Mesh, ClosedBoxPushesOutOfItsTop) {
    // A box over the rim of a block made of triangles, sunk in by 1 cm and hanging over the side by 0.3 m and by 2 cm:
    // its centre is behind the side's triangles, which must not pull it in.
    Solid block(box_mesh({1.0f, 1.0f, 1.0f})), box(Box{{0.5f, 0.5f, 0.5f}});
    for (float x : {0.8f, 0.52f, 0.0f}) {
        std::vector<Manifold> m = on(block, box, {x, 1.49f, 0.1f});
        ASSERT_EQ(m.size(), 1u) << x;
        expect_near(m[0].normal, up, 1e-5f);
        EXPECT_EQ(m[0].count, 4);
        EXPECT_NEAR(deepest(m[0]), -0.01f, 1e-5f);
    }
}

TEST(Mesh, BorderTouchesFromTheSide) {
    Solid sheet(flat_grid(2, 1.0f)), ball(Sphere{0.5f}), box(Box{{0.5f, 0.5f, 0.5f}});
    std::vector<Manifold> m = on(sheet, ball, {1.49f, 0.0f, 0.3f});
    ASSERT_EQ(m.size(), 1u);
    expect_near(m[0].normal, {1.0f, 0.0f, 0.0f}, 1e-5f);
    EXPECT_NEAR(deepest(m[0]), -0.01f, 1e-5f);
    m = on(sheet, box, {1.505f, 0.1f, 0.3f});
    ASSERT_EQ(m.size(), 1u);
    expect_near(m[0].normal, {1.0f, 0.0f, 0.0f}, 1e-4f);
    EXPECT_NEAR(deepest(m[0]), 0.005f, 1e-5f);
}

TEST(Mesh, SeparatedDistanceAgreesWithBruteForce) {
    // On bumpy ground every edge counts: the least separation of all manifolds is the distance to the nearest triangle.
    auto height = [](float x, float z) { return 0.3f * sin_cos(2.1f * x).sin * sin_cos(1.7f * z + 0.5f).cos; };
    TriangleMesh ground = grid(12, 0.4f, height);
    Solid mesh(ground);
    Random random(12);
    int compared = 0;
    for (const Kind& kind : every_kind()) {
        Solid shape(kind.shape);
        for (int i = 0; i < 60; ++i) {
            Quat turn = random.rotation();
            Vec3 at{random.in(-1.5f, 1.5f), random.in(0.5f, 1.0f), random.in(-1.5f, 1.5f)};
            float nearest = 1e9f;
            for (const MeshTriangle& t : ground.data().triangles) {
                Vec3 corners[3];
                for (int k = 0; k < 3; ++k) corners[k] = ground.data().vertices[t.vertex[k]] - at;
                Geometry g;
                g.kind = GeometryKind::triangle;
                g.triangle = corners;
                GjkCache cache;
                ConvexDistance d = distance({&g, &shape.geometry, {{}, turn}}, cache, SimplexSolver::barycentric, 1e9f);
                nearest = minimum(nearest, d.distance - shape.geometry.rounding);
            }
            const float margin = 0.1f;
            PairCache cache;
            CollidePair pair = pair_of({mesh, {}}, {shape, turn}, at, margin);
            if (absolute(nearest) > 1e-4f) {
                EXPECT_EQ(overlap(pair, cache, {}), nearest < 0.0f);
            }
            if (nearest < 1e-3f || absolute(nearest - margin) < 1e-3f) continue;
            ++compared;
            std::vector<Manifold> m = manifolds(pair);
            ASSERT_EQ(!m.empty(), nearest < margin) << kind.name << " " << nearest;
            float least = 1e9f;
            for (const Manifold& one : m) least = minimum(least, deepest(one));
            if (!m.empty()) {
                EXPECT_NEAR(least, nearest, 0.02f) << kind.name << " " << i;
            }
        }
    }
    EXPECT_GT(compared, 200);
}

// A contact of an edge or a corner is the nearest place to the shape for some way around: else its triangle's neighbour
// is nearer, and a normal that leans over that would push sideways.
TEST(Mesh, EdgesAndCornersAreTheNearestPlacesAround) {
    for (float rise : {0.3f, 0.04f}) {
        auto height = [&](float x, float z) { return rise * sin_cos(2.1f * x).sin * sin_cos(1.7f * z + 0.5f).cos; };
        TriangleMesh ground = grid(12, 0.4f, height);
        const MeshData& data = ground.data();
        Solid mesh(ground);
        Random random(13);
        int edges = 0;
        for (const Kind& kind : every_kind()) {
            Solid shape(kind.shape);
            for (int i = 0; i < 60; ++i) {
                Quat turn = random.rotation();
                CentredBox box = bounds(shape.geometry, turn);
                Vec3 at{random.in(-1.5f, 1.5f), 0.0f, random.in(-1.5f, 1.5f)};
                at.y = height(at.x, at.z) + box.half.y - box.centre.y + random.in(0.0f, 0.1f);
                for (const Manifold& m : on(mesh, shape, at, turn, 0.1f)) {
                    const ManifoldPoint& p = m.points[0];
                    if (m.key >> 31 == 0 || m.follow == 0.0f || p.separation < 1e-3f) continue;
                    const Vec3 foot = p.position - 0.5f * p.separation * m.normal;
                    for (const MeshTriangle& t : data.triangles) {
                        const Vec3 a = data.vertices[t.vertex[0]],
                                   n = data.normals[static_cast<size_t>(&t - &data.triangles[0])];
                        bool has_foot = absolute(dot(n, foot - a)) < 1e-4f;
                        for (int k = 0; k < 3; ++k) {
                            Vec3 from = data.vertices[t.vertex[k]], to = data.vertices[t.vertex[(k + 1) % 3]];
                            has_foot &= dot(normalize(cross(n, to - from)), foot - from) > -1e-4f;
                        }
                        if (!has_foot) continue;
                        ++edges;
                        for (uint32_t v : t.vertex) {
                            Vec3 way = data.vertices[v] - foot;
                            EXPECT_LT(dot(m.normal, way), 0.02f * length(way) + 1e-4f) << kind.name << " " << i;
                        }
                    }
                }
            }
        }
        EXPECT_GT(edges, rise > 0.1f ? 100 : 10);
    }
}

// Triangles kept while a shape moves away from where they were found change nothing, to the bit; nor do too many to
// keep.
TEST(Mesh, KeptTrianglesChangeNothing) {
    for (float step : {0.4f, 0.05f}) {
        auto height = [](float x, float z) { return 0.2f * sin_cos(2.1f * x).sin * sin_cos(1.7f * z + 0.5f).cos; };
        Solid mesh(grid(step > 0.1f ? 16 : 96, step, height));
        for (const Kind& kind : every_kind()) {
            Solid shape(kind.shape);
            MeshCandidates near;
            const CentredBox box = bounds(shape.geometry, {});
            int searches = 0, touching = 0;
            for (int i = 0; i < 80; ++i) {
                float s = 0.012f * static_cast<float>(i) - 0.5f;
                Vec3 at{s, 0.0f, 0.7f * s};
                at.y = height(at.x, at.z) + box.half.y - box.centre.y + 0.01f;
                Quat turn = rotation_about(normalize(Vec3{1.0f, 0.2f, 0.5f}), 0.4f * s);
                CollidePair pair = pair_of({mesh, {}}, {shape, turn}, at, 0.03f);
                PairCache cache;
                std::vector<Manifold> kept(max_mesh_manifolds), fresh = manifolds(pair);
                const Vec3 before = near.lower;
                const bool found = near.count >= 0;
                kept.resize(static_cast<size_t>(collide(pair, cache, {}, kept.data(), max_mesh_manifolds, &near)));
                searches += !found || !(near.lower == before);
                touching += !kept.empty();
                expect_same(kept, fresh);
                if (HasFailure()) return;
            }
            EXPECT_GT(touching, 40) << kind.name;
            EXPECT_LT(searches, 40) << kind.name;
            EXPECT_GE(near.count, 1) << kind.name;
            if (near.are_listed()) {
                EXPECT_GT(searches, 1) << kind.name;
            }
        }
    }
}

// Shapes that tumble over hills and plunge into them, among triangles smaller and larger than they are, by steps and
// with margins of all sizes; the mesh turns as well.
TEST(Mesh, TumblingShapesTouchAsIfNothingWereKept) {
    auto height = [](float x, float z) { return 0.3f * sin_cos(2.1f * x).sin * sin_cos(1.7f * z + 0.5f).cos; };
    Random random(26);
    for (float step : {0.45f, 0.15f}) {
        Solid mesh(grid(step > 0.2f ? 20 : 60, step, height));
        for (const Kind& kind : every_kind()) {
            Solid shape(kind.shape);
            MeshCandidates near;
            Vec3 at{};
            Quat turn, floor;
            int touching = 0;
            for (int i = 0; i < 600; ++i) {
                const float size = i % 50 == 49 ? 0.3f : random.in(0.0f, 0.04f);
                at += size * random.direction();
                at = {clamp(at.x, -2.0f, 2.0f), clamp(at.y, -0.4f, 0.9f), clamp(at.z, -2.0f, 2.0f)};
                turn = rotation_about(random.direction(), random.in(0.0f, 0.1f)) * turn;
                floor = rotation_about(random.direction(), random.in(0.0f, 0.005f)) * floor;
                const CollidePair pair =
                    pair_of({mesh, floor}, {shape, floor * turn}, rotate(floor, at), random.in(0.0f, 0.06f));
                PairCache cache;
                std::vector<Manifold> kept(max_mesh_manifolds);
                kept.resize(static_cast<size_t>(collide(pair, cache, {}, kept.data(), max_mesh_manifolds, &near)));
                SCOPED_TRACE(kind.name);
                SCOPED_TRACE(i);
                expect_same(kept, manifolds(pair));
                if (HasFailure()) return;
                touching += !kept.empty();
            }
            EXPECT_GT(touching, 100) << kind.name;
        }
    }
}

// A shape that rests looks at the triangles that it stands on and few others.
TEST(Mesh, TrianglesThatAreApartAreNotLookedAtAgain) {
    auto height = [](float x, float z) { return 0.2f * sin_cos(1.1f * x).sin * sin_cos(0.9f * z).cos; };
    Solid mesh(grid(40, 0.2f, height));
    for (const Kind& kind : every_kind()) {
        Solid shape(kind.shape);
        const CentredBox box = bounds(shape.geometry, {});
        MeshCandidates near;
        Vec3 at{0.03f, 0.0f, 0.05f};
        at.y = height(at.x, at.z) + box.half.y - box.centre.y + 0.005f;
        int first = 0, later = 0;
        for (int i = 0; i < 4; ++i) {
            at.x += 1e-4f;
            PairCache cache;
            std::vector<Manifold> out(max_mesh_manifolds);
            collide(pair_of({mesh, {}}, {shape, {}}, at, 0.02f), cache, {}, out.data(), max_mesh_manifolds, &near);
            (i == 0 ? first : later) = near.are_listed() ? looked_at(near) : 0;
        }
        if (!near.are_listed()) continue;
        EXPECT_LT(later, 2 * near.count / 3) << kind.name << ' ' << first;
    }
}

TEST(Mesh, AtMostTheDeepestManifoldsAreKept) {
    // Many facets within a ball's margin.
    Solid mesh(grid(20, 0.1f, [](float x, float z) { return 3.0f * (x * x + z * z); })), ball(Sphere{0.9f});
    CollidePair pair = pair_of({mesh, {}}, {ball, {}}, {0.01f, 0.85f, 0.02f}, 0.5f);
    PairCache cache;
    Manifold out[max_mesh_manifolds];
    int all = collide(pair, cache, {}, out, max_mesh_manifolds);
    ASSERT_EQ(all, max_mesh_manifolds);
    float least = 1e9f;
    for (const Manifold& m : out) {
        ASSERT_NO_FATAL_FAILURE(expect_sound(m, 0.5f));
        least = minimum(least, deepest(m));
    }
    for (int i = 1; i < all; ++i) EXPECT_LE(deepest(out[i - 1]), deepest(out[i]));
    Manifold few[3];
    ASSERT_EQ(collide(pair, cache, {}, few, 3), 3);
    EXPECT_EQ(deepest(few[0]), least);
    for (int i = 0; i < 16; ++i) {
        for (int k = 0; k < i; ++k) EXPECT_NE(out[i].key, out[k].key);
    }
}

TEST(Mesh, DeepAndDegenerateInputStaysFinite) {
    Solid ground(grid(6, 0.5f, [](float x, float z) { return 0.1f * x * z; })),
        sliver(grid(6, 1e-3f, [](float x, float) { return x; }));
    std::vector<Kind> kinds = every_kind();
    kinds.push_back({"slab", Box{{1.0f, 1e-4f, 1.0f}}});
    kinds.push_back({"huge", Box{{1e3f, 1e3f, 1e3f}}});
    Random random(77);
    for (const Kind& kind : kinds) {
        Solid shape(kind.shape);
        for (const Solid* mesh : {&ground, &sliver}) {
            for (int i = 0; i < 20; ++i) {
                Quat turn = i % 2 == 0 ? Quat{} : random.rotation();
                Vec3 at = i < 4 ? Vec3{} : 0.2f * random.direction();
                for (const Manifold& m : on(*mesh, shape, at, turn))
                    ASSERT_NO_FATAL_FAILURE(expect_sound(m, 0.02f)) << kind.name;
            }
        }
    }
}

}  // namespace
