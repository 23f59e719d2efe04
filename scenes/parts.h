// Pieces that several scenes are built of.
#pragma once

#include "scenes/description.h"
#include "scenes/random.h"

namespace lendulet::scenes {

inline constexpr float light_density = 100.0f;  // kg/m^3, of most scenes' bodies
inline constexpr Vec3 half_metre{0.5f, 0.5f, 0.5f};
inline constexpr Vec3 along_x{1.0f, 0.0f, 0.0f}, along_y{0.0f, 1.0f, 0.0f}, along_z{0.0f, 0.0f, 1.0f};

// Adds a body with one collider and returns it, to be changed further before the next one is added.
SceneBody& add_body(SceneDescription& scene, Shape shape, Position position, float density = light_density);
SceneBody& add_static(SceneDescription& scene, Shape shape, Position position);

// A floor with its top at y = 0, reaching `half` metres from the origin along x and z.
void add_ground(SceneDescription& scene, float half);

// An open-topped square container on a floor at y = 0 whose inner half width is `inner`.
void add_container(SceneDescription& scene, float inner, float height);

// Another shape on a body.
ColliderDef& add_part(SceneBody& body, Shape shape, Transform local = {}, float density = light_density);

// Joints between bodies by their indices.
SceneJoint& add_ball_joint(SceneDescription& scene, int a, int b, Position anchor);
SceneJoint& add_hinge(SceneDescription& scene, int a, int b, Position anchor, Vec3 axis);
// Index of the body that was added last.
inline int last_body(const SceneDescription& scene) { return static_cast<int>(scene.bodies.size()) - 1; }

// Long hills with short waves on them, m.
float terrain_height(float x, float z);
// The same as a mesh: a square of `cells` x `cells` quads of two triangles each, centred on the
// origin; heights times `rise`.
void add_terrain(SceneDescription& scene, uint32_t cells, float cell, float rise = 1.0f);

// The hull of `count` random points on an ellipsoid with radii between 0.75 and 1 times `radius`.
ConvexHull rock(Random& random, int count, float radius);

enum class Kind { box, sphere, capsule, convex, mixed };

// One shape of every kind, all of about a metre.
class Props {
public:
    explicit Props(Random& random);
    // The shape of the body with this number; mixed goes through the kinds in turn.
    Shape shape(Kind kind, int number) const;

private:
    std::vector<ConvexHull> rocks_;
};

}  // namespace lendulet::scenes
