// Trees of joints that iteration cannot hold stiff, solved directly: all locked rows of a tree together, in time
// proportional to its joints. See tree.cpp.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/bodies.h"
#include "solver/joints/kernels.h"

namespace lendulet {

// Impulse of a substep that a direct solve may give at the end of an arm, over I / (h r): see largest_impulse().
inline constexpr float joint_stability = 1.0f;

// A body of a tree with the joint that leads to its parent. Parents come before their children.
struct TreeNode {
    int32_t body;     // solver body, moved by constraints
    int32_t parent;   // index within the tree, or -1: the root, or a body that is not moved
    bool is_b;        // the body is B of the joint, the parent A
    bool has_joint;   // false at a root that no joint holds
    JointClass type;  // ball, hinge or fixed
    std::byte* row;   // the joint's row of one lane
};

struct JointTree {
    int first, count;  // nodes
    bool split;
};

// What the solve knows of a node; kept outside of it to be allocated once.
struct TreeWork {
    float mass[21];      // lower triangle, with what the joints of children add, then factored
    float push[6];       // impulses from below on the body; then its change of velocity
    float own[6][6];     // rows of the joint on the body, linear and angular part, ...
    float other[6][6];   // ... and on the parent
    float answer[6][6];  // mass^-1 times `own`, by row
    float want[6];       // velocities that rows have to lose, then impulses
    float rows[21];      // their own response with all below solved, factored
};

bool solves_directly(JointClass type);
void solve_tree(const JointTree& tree, const TreeNode* nodes, TreeWork* work, SolverBodies& bodies,
                const JointConstants& k, bool biased);

}  // namespace lendulet
