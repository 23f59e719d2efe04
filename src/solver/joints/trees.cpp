#include "solver/joints/trees.h"

#include "lendulet/math.h"

namespace lendulet {
namespace {

float inverse_mass(const SolverBodies& bodies, int32_t i) { return bodies.state[static_cast<size_t>(i)].inverse_mass; }

}  // namespace

void JointTrees::count_groups(const JointRecord* joints, int count, const SolverBodies& bodies, const uint32_t* group) {
    groups_.assign(static_cast<size_t>(bodies.count), Group{});
    for (int32_t i = reserved_bodies; i < bodies.count; ++i) {
        Group& g = groups_[group[i]];
        ++g.bodies;
        if (g.anchors == 0 && (g.root < 0 || inverse_mass(bodies, i) < inverse_mass(bodies, g.root))) g.root = i;
    }
    for (int i = 0; i < count; ++i) {
        const JointRecord& r = joints[i];
        bool a = inverse_mass(bodies, r.body_a) > 0.0f, b = inverse_mass(bodies, r.body_b) > 0.0f;
        Group& g = groups_[group[a ? r.body_a : r.body_b]];
        if (a && b) ++g.inner;
        else ++g.anchors, g.root = a ? r.body_a : r.body_b;
        g.other |= !solves_directly(r.type);
    }
}

// Lists of joints by body, by counting.
void JointTrees::link_bodies(const JointRecord* joints, int count, const SolverBodies& bodies, const uint32_t* group) {
    first_link_.assign(static_cast<size_t>(bodies.count) + 1, 0u);
    auto for_each_end = [&](auto&& end) {
        for (int i = 0; i < count; ++i)
            for (int32_t body : {joints[i].body_a, joints[i].body_b})
                if (inverse_mass(bodies, body) > 0.0f && is_tree(groups_[group[body]]))
                    end(static_cast<size_t>(body), static_cast<uint32_t>(i));
    };
    for_each_end([&](size_t body, uint32_t) { ++first_link_[body + 1]; });
    for (size_t i = 1; i < first_link_.size(); ++i) first_link_[i] += first_link_[i - 1];
    links_.resize_unset(first_link_.back());
    for_each_end([&](size_t body, uint32_t joint) { links_[first_link_[body]++] = joint; });
    for (size_t i = first_link_.size() - 1; i > 0; --i) first_link_[i] = first_link_[i - 1];
    first_link_[0] = 0;
}

// Nodes from the root on, breadth first.
void JointTrees::grow(const Group& g, const JointRecord* joints, const SolverBodies& bodies) {
    const size_t first = nodes.size();
    TreeNode root{};
    root.body = g.root;
    root.parent = -1;
    nodes.push_back(root);
    records.push_back(0u);
    for (size_t n = first; n < nodes.size(); ++n) {
        const int32_t body = nodes[n].body;
        for (uint32_t l = first_link_[static_cast<size_t>(body)]; l < first_link_[static_cast<size_t>(body) + 1]; ++l) {
            const JointRecord& r = joints[links_[l]];
            int32_t other = r.body_a == body ? r.body_b : r.body_a;
            if (nodes[n].has_joint && records[n] == links_[l]) continue;  // where it came from
            if (inverse_mass(bodies, other) > 0.0f) {
                TreeNode child{};
                child.body = other;
                child.parent = static_cast<int32_t>(n - first);
                child.is_b = r.body_b == other;
                child.has_joint = true;
                child.type = r.type;
                nodes.push_back(child);
                records.push_back(links_[l]);
            } else {  // the root's joint to what does not move
                nodes[n].has_joint = true;
                nodes[n].is_b = r.body_b == body;
                nodes[n].type = r.type;
                records[n] = links_[l];
            }
        }
    }
}

float JointTrees::heaviest_load(int first, const SolverBodies& bodies) {
    const int count = nodes.count() - first;
    carried_.resize_unset(static_cast<size_t>(count));
    auto node = [&](int i) -> const TreeNode& { return nodes[static_cast<size_t>(first + i)]; };
    for (int i = 0; i < count; ++i) carried_[static_cast<size_t>(i)] = 1.0f / inverse_mass(bodies, node(i).body);
    float most = 0.0f;
    for (int i = count - 1; i >= 0; --i) {
        const int parent = node(i).parent;
        const float carried = carried_[static_cast<size_t>(i)];
        float inverse = inverse_mass(bodies, node(i).body);
        if (parent >= 0) {
            carried_[static_cast<size_t>(parent)] += carried;
            inverse += inverse_mass(bodies, node(parent).body);
        }
        if (node(i).has_joint) most = maximum(most, carried * inverse);
    }
    return most;
}

void JointTrees::find(const JointRecord* joints, int count, const SolverBodies& bodies, const uint32_t* group) {
    nodes.clear();
    records.clear();
    trees.clear();
    direct.assign(static_cast<size_t>(count), uint8_t{0});
    count_groups(joints, count, bodies, group);
    link_bodies(joints, count, bodies, group);
    for (const Group& g : groups_) {
        if (!is_tree(g)) continue;
        const int first = nodes.count();
        grow(g, joints, bodies);
        if (heaviest_load(first, bodies) < joint_direct_load) {
            nodes.resize_unset(static_cast<size_t>(first));
            records.resize_unset(static_cast<size_t>(first));
            continue;
        }
        trees.push_back({first, nodes.count() - first, false});
        for (size_t n = static_cast<size_t>(first); n < nodes.size(); ++n)
            if (nodes[n].has_joint) direct[records[n]] = 1;
    }
    work.resize_unset(nodes.size());
}

}  // namespace lendulet
