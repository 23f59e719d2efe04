#include "io/gltf_motion.h"

#include <algorithm>
#include <array>

namespace lendulet {

namespace {

constexpr float infinite_mass = 1e12f;  // kg; the heaviest body there is: any other is a feather to it

Quat read_inertia_orientation(const Field& field) {
    if (!field) return {};
    std::vector<double> v = field.numbers(4);
    Quat q{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), static_cast<float>(v[3])};
    float size = square_root(dot(q, q));
    if (!(size > 0.99f && size < 1.01f)) field.refuse("is no unit quaternion");
    return normalize(q);
}

// Moments of 0 stand for infinity. Along the node's own axes infinity can be 1e9 times the finite moments; turned into
// them it may only be 1e4 times, as one float cannot hold a large and a small part of a moment.
void replace_infinite(std::array<float, 3>& moments, bool turned) {
    float largest = *std::max_element(moments.begin(), moments.end());
    float infinite = largest == 0.0f ? 1e9f : largest * (turned ? 1e4f : 1e9f);
    for (float& m : moments) {
        if (m == 0.0f) m = infinite;
    }
}

// No solid has a principal moment larger than the sum of the other two; the world refuses such tensors.
void limit_to_solid(std::array<float, 3>& moments, const std::string& where, Warnings& warnings) {
    size_t k = static_cast<size_t>(std::max_element(moments.begin(), moments.end()) - moments.begin());
    float others = moments[(k + 1) % 3] + moments[(k + 2) % 3];
    if (moments[k] <= others) return;
    moments[k] = 0.99999f * others;
    warnings.add(where, "no solid has such moments of inertia; the largest is cut to the sum of the others");
}

void read_inertia(const Field& motion, const std::string& where, RigidBodyDef& def, Warnings& warnings) {
    Field diagonal = motion["inertiaDiagonal"];
    if (!diagonal) return;
    Vec3 d = diagonal.vector_or({});
    if (min_component(d) < 0.0f) diagonal.refuse("must not be negative");
    Quat q = read_inertia_orientation(motion["inertiaOrientation"]);
    std::array<float, 3> moments{d.x, d.y, d.z};
    bool turned = absolute(q.w) < 0.999999f;
    replace_infinite(moments, turned);
    limit_to_solid(moments, where, warnings);
    def.inertia =
        rotate_diagonal<float>(rotation_matrix<float>(QuatT<float>(q), 1.0f), Vec3{moments[0], moments[1], moments[2]});
}

}  // namespace

void read_motion(const Field& motion, const NodeFrame& frame, const std::string& where, RigidBodyDef& def,
                 Warnings& warnings) {
    def.position = at(to_float(frame.origin));
    def.orientation = frame.orientation();
    def.kinematic = motion["isKinematic"].boolean_or(false);
    def.velocity = rotate(def.orientation, motion["linearVelocity"].vector_or({}));
    def.angular_velocity = rotate(def.orientation, motion["angularVelocity"].vector_or({}));
    def.gravity_factor = static_cast<float>(motion["gravityFactor"].number_or(1.0));
    if (Field centre = motion["centerOfMass"]) {
        Vec3 c = centre.vector_or({});
        def.centre_of_mass = to_float(frame.stretch * Vec3d{c.x, c.y, c.z});
    }
    Field mass = motion["mass"];
    if (mass && mass.number() < 0.0) mass.refuse("must not be negative");
    if (def.kinematic) return;
    if (mass) def.mass = static_cast<float>(mass.number());
    if (def.mass && *def.mass == 0.0f) {
        // A body that nothing can push keeps its velocity, so gravity must not change it either.
        def.mass = infinite_mass;
        def.gravity_factor = 0.0f;
    }
    read_inertia(motion, where, def, warnings);
}

}  // namespace lendulet
