#include "io/gltf_nodes.h"

#include <algorithm>
#include <cmath>

#include "io/file.h"

namespace lendulet {

namespace {

Affine read_matrix(const Field& field) {
    std::vector<double> m = field.numbers(16);  // by columns
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) field.refuse("is no affine transform");
    return {{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}, {m[12], m[13], m[14]}};
}

Quatd read_rotation(const Field& field) {
    if (!field) return {};
    std::vector<double> q = field.numbers(4);
    double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    // Exporters round; a length this far off is no rounding.
    if (!(length > 0.99 && length < 1.01)) field.refuse("is no unit quaternion");
    return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

Vec3d read_vector(const Field& field, double fallback) {
    if (!field) return {fallback, fallback, fallback};
    std::vector<double> v = field.numbers(3);
    return {v[0], v[1], v[2]};
}

void read_transform(const Field& node, GltfNode& out) {
    if (Field matrix = node["matrix"]) {
        out.local = read_matrix(matrix);
        return;
    }
    out.rotation = read_rotation(node["rotation"]);
    Mat3d r = matrix_of(out.rotation);
    Vec3d s = read_vector(node["scale"], 1.0);
    out.local = {{s.x * r.x, s.y * r.y, s.z * r.z}, read_vector(node["translation"], 0.0)};
    out.scale_signs = {s.x < 0.0 ? -1.0 : 1.0, s.y < 0.0 ? -1.0 : 1.0, s.z < 0.0 ? -1.0 : 1.0};
}

void read_children(const Field& list, size_t node_count, int parent, NodeTree& tree) {
    for (size_t i = 0; i < list.size(); ++i) {
        int child = list.at(i).index(node_count, "nodes");
        GltfNode& node = tree.nodes[static_cast<size_t>(child)];
        if (node.parent >= 0) list.at(i).refuse("gives " + tree.describe(child) + " a second parent");
        if (child == parent) list.at(i).refuse("makes a node its own child");
        node.parent = parent;
        tree.nodes[static_cast<size_t>(parent)].children.push_back(child);
    }
}

// Every node has at most one parent by now, so a node that no root leads to stands on a cycle.
void refuse_cycles(const NodeTree& tree) {
    std::vector<int> stack;
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        if (tree.nodes[i].parent < 0) stack.push_back(static_cast<int>(i));
    }
    std::vector<bool> reached(tree.nodes.size(), false);
    while (!stack.empty()) {
        int node = stack.back();
        stack.pop_back();
        reached[static_cast<size_t>(node)] = true;
        for (int child : tree.nodes[static_cast<size_t>(node)].children) stack.push_back(child);
    }
    auto lost = std::find(reached.begin(), reached.end(), false);
    if (lost != reached.end()) {
        refuse("", tree.describe(static_cast<int>(lost - reached.begin())) + ": is its own ancestor");
    }
}

std::vector<int> scene_roots(const Field& root, const NodeTree& tree) {
    std::vector<int> roots;
    Field scenes = root["scenes"];
    if (scenes.size() == 0) {
        for (size_t i = 0; i < tree.nodes.size(); ++i) {
            if (tree.nodes[i].parent < 0) roots.push_back(static_cast<int>(i));
        }
        return roots;
    }
    int scene = root["scene"].index_or(0, scenes.size(), "scenes");
    Field list = scenes.at(static_cast<size_t>(scene))["nodes"];
    std::vector<bool> listed(tree.nodes.size(), false);
    for (size_t i = 0; i < list.size(); ++i) {
        int node = list.at(i).index(tree.nodes.size(), "nodes");
        if (tree.nodes[static_cast<size_t>(node)].parent >= 0) list.at(i).refuse("is no root node");
        if (listed[static_cast<size_t>(node)]) list.at(i).refuse("is listed twice");
        listed[static_cast<size_t>(node)] = true;
        roots.push_back(node);
    }
    return roots;
}

// Splits a linear map into rotation * stretch with an upper triangular stretch (Gram-Schmidt on its columns). Scale
// signs of the node itself stay in the stretch, so that a node keeps the rotation it was given; a mirror further up
// that is left over goes to the x axis. Where a column vanishes the parent's rotation fills in.
void split(const Mat3d& linear, Vec3d signs, const Mat3d& fallback, NodeFrame& frame) {
    auto unit = [](Vec3d v, double size, bool& ok) {
        double length = std::sqrt(dot(v, v));
        ok = length > 1e-9 * size && length > 1e-30;
        return ok ? 1.0 / length * v : v;
    };
    Mat3d m{signs.x * linear.x, signs.y * linear.y, signs.z * linear.z};
    if (determinant(m) < 0.0) m.x = -1.0 * m.x;
    double size = std::sqrt(std::max({dot(m.x, m.x), dot(m.y, m.y), dot(m.z, m.z)}));
    bool ok_x = false, ok_y = false;
    Vec3d x = unit(m.x, size, ok_x);
    Vec3d y = unit(m.y - dot(m.y, x) * x, size, ok_y);
    Mat3d rotation = fallback;
    if (ok_x && ok_y) rotation = {x, y, cross(x, y)};
    frame.rotation = rotation;
    frame.stretch = transpose(rotation) * linear;
}

void place(NodeTree& tree, const std::vector<int>& roots) {
    std::vector<int> stack(roots.rbegin(), roots.rend());
    std::vector<Affine> world(tree.nodes.size());
    while (!stack.empty()) {
        int index = stack.back();
        stack.pop_back();
        GltfNode& node = tree.nodes[static_cast<size_t>(index)];
        size_t i = static_cast<size_t>(index), parent = static_cast<size_t>(std::max(node.parent, 0));
        world[i] = node.parent < 0 ? node.local : world[parent] * node.local;
        const Affine& w = world[i];
        double sum = dot(w.linear.x, w.linear.x) + dot(w.linear.y, w.linear.y) + dot(w.linear.z, w.linear.z) +
                     dot(w.translation, w.translation);
        if (!(sum < 1e60)) refuse("", tree.describe(index) + ": stands at no finite place");
        node.in_scene = true;
        bool moves = node.physics && node.physics->contains("motion");
        node.mover = moves ? index : node.parent < 0 ? -1 : tree.nodes[parent].mover;
        node.frame.origin = w.translation;
        NodeFrame above = node.parent < 0 ? NodeFrame{} : tree.nodes[parent].frame;
        split(w.linear, node.scale_signs, above.rotation, node.frame);
        Quatd product = above.turn * node.rotation, turn = quaternion_of(node.frame.rotation);
        bool same = product.x * turn.x + product.y * turn.y + product.z * turn.z + product.w * turn.w >= 0.0;
        node.frame.turn = same ? turn : Quatd{-turn.x, -turn.y, -turn.z, -turn.w};
        tree.order.push_back(index);
        stack.insert(stack.end(), node.children.rbegin(), node.children.rend());
    }
}

}  // namespace

Vec3d NodeFrame::scale() const { return {std::abs(stretch.x.x), std::abs(stretch.y.y), std::abs(stretch.z.z)}; }

bool NodeFrame::sheared() const {
    const Mat3d& s = stretch;
    double off = std::max(
        {std::abs(s.x.y), std::abs(s.x.z), std::abs(s.y.x), std::abs(s.y.z), std::abs(s.z.x), std::abs(s.z.y)});
    Vec3d d = scale();
    return off > 1e-5 * std::max({d.x, d.y, d.z});
}

Transform relative(const NodeFrame& a, const NodeFrame& b) {
    Mat3d back = transpose(a.rotation);
    return {to_float(back * (b.origin - a.origin)), to_float(quaternion_of(back * b.rotation))};
}

Field GltfNode::physics_field(int index) const {
    return {physics, "nodes[" + std::to_string(index) + "].extensions.KHR_physics_rigid_bodies"};
}

std::string NodeTree::describe(int node) const {
    const std::string& name = nodes[static_cast<size_t>(node)].name;
    return "nodes[" + std::to_string(node) + "]" + (name.empty() ? "" : " \"" + printable(name) + "\"");
}

NodeTree read_nodes(const Field& root, size_t mesh_count) {
    Field list = root["nodes"];
    NodeTree tree;
    tree.nodes.resize(list.size());
    for (size_t i = 0; i < list.size(); ++i) {
        Field field = list.at(i);
        GltfNode& node = tree.nodes[i];
        if (Field name = field["name"]) node.name = name.text();
        read_transform(field, node);
        node.mesh = field["mesh"].index_or(-1, mesh_count, "meshes");
        node.skinned = field["skin"].present();
        Field physics = field["extensions"]["KHR_physics_rigid_bodies"];
        if (physics && !physics.json().is_object()) physics.refuse("must be an object");
        if (physics) node.physics = &physics.json();
    }
    for (size_t i = 0; i < list.size(); ++i) {
        read_children(list.at(i)["children"], list.size(), static_cast<int>(i), tree);
    }
    refuse_cycles(tree);
    place(tree, scene_roots(root, tree));
    return tree;
}

}  // namespace lendulet
