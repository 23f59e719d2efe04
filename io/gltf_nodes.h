// The node tree of a glTF file: names, parents, and where each node stands in the world. Arithmetic is in double, so
// that poses come out right to the last bit of a float however deep the tree.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/json_field.h"
#include "lendulet/math.h"

namespace lendulet {

struct Vec3d {
    double x = 0.0, y = 0.0, z = 0.0;
};
struct Quatd {
    double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};
// Columns of a 3 x 3 matrix.
struct Mat3d {
    Vec3d x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0};
};
// p -> linear p + translation
struct Affine {
    Mat3d linear;
    Vec3d translation;
};

Vec3d operator+(Vec3d a, Vec3d b);
Vec3d operator-(Vec3d a, Vec3d b);
Vec3d operator*(double s, Vec3d a);
double dot(Vec3d a, Vec3d b);
Vec3d cross(Vec3d a, Vec3d b);
Vec3d operator*(const Mat3d& m, Vec3d v);
Mat3d operator*(const Mat3d& a, const Mat3d& b);
Affine operator*(const Affine& a, const Affine& b);
Mat3d transpose(const Mat3d& m);
double determinant(const Mat3d& m);
Quatd operator*(Quatd a, Quatd b);
Mat3d matrix_of(Quatd q);
Quatd quaternion_of(const Mat3d& rotation);
Vec3 to_float(Vec3d v);
Quat to_float(Quatd q);

// Where a node stands: a rigid frame, and what scale and shear turn the node's own coordinates into that frame's:
// world point = origin + rotation * stretch * p.
struct NodeFrame {
    Vec3d origin;
    Mat3d rotation;
    Mat3d stretch;  // diagonal for a node without shear; a negative entry mirrors that axis
    Quatd turn;     // `rotation`, with the sign that the product of the nodes' own quaternions has
    Quat orientation() const { return to_float(turn); }
    // The lengths of the diagonal, and whether there is anything beside it.
    Vec3d scale() const;
    bool sheared() const;
};
// The frame `b` as seen from `a`, both in the world.
Transform relative(const NodeFrame& a, const NodeFrame& b);

struct GltfNode {
    std::string name;  // empty where the file gives none
    int parent = -1;
    int mesh = -1;
    bool skinned = false;
    std::vector<int> children;
    Affine local;    // to the parent
    Quatd rotation;  // as given; identity where the node has a matrix
    Vec3d scale_signs{1.0, 1.0, 1.0};
    bool in_scene = false;
    int mover = -1;   // the node itself or its nearest ancestor with `motion`; -1: part of the fixed world
    NodeFrame frame;  // set for nodes in the scene
    const Json* physics = nullptr;  // its KHR_physics_rigid_bodies, null where it has none

    Field physics_field(int index) const;
};

struct NodeTree {
    std::vector<GltfNode> nodes;
    std::vector<int> order;  // the default scene's nodes, parents before children

    // "nodes[3] "Door"" for messages.
    std::string describe(int node) const;
};

// Reads nodes and the default scene. Refuses cycles, nodes with two parents, indices out of range and transforms that
// are not finite. Throws LoadFailure.
NodeTree read_nodes(const Field& root, size_t mesh_count);

}  // namespace lendulet
