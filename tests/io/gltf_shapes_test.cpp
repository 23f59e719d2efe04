// Shapes of glTF files: each implicit shape, and what a node's scale makes of it.
#include "io/gltf_fixture.h"

namespace lendulet::test {
namespace {

class GltfShapes : public testing::Test {
protected:
    Scene scene = load(scene_file("shapes.gltf"));

    template <class T>
    T shape(std::string_view name) {
        const Shape& found = any_body(scene.world, name).shape();
        EXPECT_TRUE(std::holds_alternative<T>(found)) << name;
        return std::holds_alternative<T>(found) ? std::get<T>(found) : T{};
    }
};

TEST_F(GltfShapes, ImplicitShapesHaveTheirSizes) {
    EXPECT_FLOAT_EQ(shape<Sphere>("Sphere").radius, 0.25f);
    EXPECT_FLOAT_EQ(shape<Sphere>("DefaultSphere").radius, 0.5f);
    EXPECT_LT(distance(shape<Box>("Box").half_extents, {0.2f, 0.3f, 0.4f}), 1e-6f);
    EXPECT_FLOAT_EQ(shape<Capsule>("Capsule").half_height, 0.25f);
    EXPECT_FLOAT_EQ(shape<Capsule>("Capsule").radius, 0.2f);
    EXPECT_FLOAT_EQ(shape<TaperedCapsule>("TaperedCapsule").bottom_radius, 0.3f);
    EXPECT_FLOAT_EQ(shape<TaperedCapsule>("TaperedCapsule").top_radius, 0.2f);
    EXPECT_FLOAT_EQ(shape<Cylinder>("Cylinder").half_height, 0.3f);
    EXPECT_FLOAT_EQ(shape<Cylinder>("Cylinder").radius, 0.25f);
    EXPECT_FLOAT_EQ(shape<Cone>("Cone").radius, 0.3f);
    EXPECT_FLOAT_EQ(shape<Cone>("Cone").half_height, 0.3f);
    EXPECT_FLOAT_EQ(shape<TaperedCylinder>("TaperedCylinder").bottom_radius, 0.15f);
    EXPECT_FLOAT_EQ(shape<TaperedCylinder>("TaperedCylinder").top_radius, 0.3f);
    EXPECT_EQ(shape<Plane>("Ground").normal, (Vec3{0.0f, 1.0f, 0.0f}));
}

TEST_F(GltfShapes, ScaleIsWorkedIn) {
    EXPECT_FLOAT_EQ(shape<Sphere>("ScaledSphere").radius, 0.5f);
    EXPECT_LT(distance(shape<Box>("ScaledBox").half_extents, {0.2f, 0.6f, 1.2f}), 1e-6f);  // scale 1, -2, 3
    EXPECT_FLOAT_EQ(shape<Cylinder>("ScaledCylinder").radius, 0.5f);
    EXPECT_FLOAT_EQ(shape<Cylinder>("ScaledCylinder").half_height, 0.15f);
}

// The hull's points lie on the ellipsoid, so its extent is that of the ellipsoid along the axes.
TEST_F(GltfShapes, UnevenScaleGivesAHullAndAWarning) {
    Vec3 most{};
    for (Vec3 v : shape<ConvexHull>("StretchedSphere").vertices()) most = maximum(most, absolute(v));
    EXPECT_LT(distance(most, {0.5f, 0.25f, 0.25f}), 0.01f);
    EXPECT_TRUE(warns(scene, "\"StretchedSphere\": its sphere is stretched unevenly"));
    most = {};
    for (Vec3 v : shape<ConvexHull>("StretchedCapsule").vertices()) most = maximum(most, absolute(v));
    EXPECT_LT(distance(most, {0.2f, 0.9f, 0.2f}), 0.01f);
    EXPECT_TRUE(warns(scene, "\"StretchedCapsule\""));
}

TEST_F(GltfShapes, ScaleZeroDisables) {
    EXPECT_TRUE(warns(scene, "its scale of 0 disables the collider"));
    run(scene, 30);
    EXPECT_LT(moving(scene.world, "Disabled").position().y, 1.0f);  // falls: it moves, though nothing can touch it
}

TEST_F(GltfShapes, BoundedPlanesAreRectangles) {
    EXPECT_EQ(shape<TriangleMesh>("Table").triangle_count(), 2);
    Aabb box = any_body(scene.world, "Table").aabb();
    EXPECT_LT(distance(box.upper - box.lower, {4.0f, 0.0f, 6.0f}), 0.1f);
}

TEST(GltfShapeDetails, CapsuleWithOneSphereInsideTheOtherIsASphere) {
    Scene scene = load_text(gltf_text(
        "{'name':'a','extensions':{'KHR_physics_rigid_bodies':{'motion':{},'collider':{'geometry':{'shape':0}}}}}",
        "{'type':'capsule','capsule':{'height':0.2,'radiusBottom':0.5,'radiusTop':0.1}}"));
    const Shape& shape = any_body(scene.world, "a").shape();
    ASSERT_TRUE(std::holds_alternative<Sphere>(shape));
    EXPECT_FLOAT_EQ(std::get<Sphere>(shape).radius, 0.5f);
    EXPECT_LT(distance(any_body(scene.world, "a").collider_pose().translation, {0.0f, -0.1f, 0.0f}), 1e-6f);
}

TEST(GltfShapeDetails, ShearGivesAHull) {
    // Scale along x of a parent, seen by a child turned by 45 degrees about z.
    Scene scene = load_text(
        gltf_text("{'scale':[2,1,1],'children':[1]},"
                  "{'name':'a','rotation':[0,0,0.38268343,0.92387953],'extensions':{'KHR_physics_rigid_bodies':"
                  "{'collider':{'geometry':{'shape':0}}}}}",
                  "{'type':'box','box':{'size':[1,1,1]}}"));
    EXPECT_TRUE(std::holds_alternative<ConvexHull>(any_body(scene.world, "a").shape()));
    // The sheared box is the unit box turned by 45 degrees and then stretched: 2 sqrt(2) wide, sqrt(2) high.
    Aabb box = any_body(scene.world, "a").aabb();
    EXPECT_LT(distance(box.upper - box.lower, {2.8284271f, 1.4142136f, 1.0f}), 1e-3f);
}

TEST(GltfShapeDetails, UnknownShapesAreLeftOut) {
    Scene scene = load_text(gltf_text(
        "{'extensions':{'KHR_physics_rigid_bodies':{'collider':{'geometry':{'shape':0}}}}}", "{'type':'torus'}"));
    EXPECT_EQ(scene.world.body_count(), 0);
    EXPECT_TRUE(warns(scene, "\"torus\""));
}

TEST(GltfShapeDetails, PlanesOfMovingBodies) {
    Scene scene = load_text(gltf_text(
        "{'name':'a','extensions':{'KHR_physics_rigid_bodies':{'motion':{},'collider':{'geometry':{'shape':0}}}}},"
        "{'name':'b','extensions':{'KHR_physics_rigid_bodies':{'motion':{},'collider':{'geometry':{'shape':1}}}}}",
        "{'type':'plane'},{'type':'plane','plane':{'sizeX':2,'sizeZ':4}}"));
    EXPECT_TRUE(warns(scene, "\"a\": a moving body cannot have an unbounded plane"));
    EXPECT_TRUE(std::holds_alternative<Box>(any_body(scene.world, "b").shape()));
    EXPECT_TRUE(warns(scene, "\"b\": a moving plane collides as a thin box"));
}

TEST(GltfMeshes, HullsAndTriangles) {
    Scene scene = load(scene_file("meshes.gltf"));
    const World& world = scene.world;
    EXPECT_EQ(std::get<TriangleMesh>(any_body(world, "Bowl").shape()).triangle_count(), 128);
    const auto& gem = std::get<ConvexHull>(any_body(world, "Gem").shape());
    EXPECT_EQ(gem.vertices().size(), 8u);
    // The twin shares the hull, and the node that holds the geometry may stand anywhere.
    EXPECT_EQ(&gem.data(), &std::get<ConvexHull>(any_body(world, "GemTwin").shape()).data());
    EXPECT_LT(distance(from_origin(any_body(world, "Gem").position()), {0.0f, 2.0f, 0.0f}), 1e-6f);
    // A hull over two child nodes reaches from the left gem's tip to the right, half-sized gem's.
    Aabb pair = any_body(world, "Pair").aabb();
    EXPECT_NEAR(pair.upper.x - pair.lower.x, 0.5f + 0.45f + 0.5f + 0.225f, 1e-3f);
    EXPECT_TRUE(std::holds_alternative<ConvexHull>(any_body(world, "MovingMesh").shape()));
    EXPECT_TRUE(warns(scene, "\"MovingMesh\": a mesh on a moving body collides as its convex hull"));
    EXPECT_TRUE(warns(scene, "\"Tile\": its convex hull is flat"));
    run(scene, 240);
    for (const char* name : {"Gem", "GemTwin", "Pair", "MovingMesh", "Tile"}) {
        EXPECT_GT(moving(world, name).position().y, -0.1f) << name;  // the bowl holds them
    }
}

}  // namespace
}  // namespace lendulet::test
