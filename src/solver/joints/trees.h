// Which joints are solved directly: whole groups of bodies that joints without bounds connect as a tree, hung on at
// most one body that does not move, and that load a joint so much that iteration would leave it slack.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "solver/joints/tree.h"

namespace lendulet {

// What a joint carries, as the mass of all bodies beyond it over the reduced mass of the two that it joins. Iteration
// leaves a gap of (leak / bias) g h^2 times that: 0.35 mm at this load, dt = 1/60 and 8 substeps.
inline constexpr float joint_direct_load = 16.0f;
// A direct solve is serial.
inline constexpr int largest_tree = 1024;  // bodies

class JointTrees {
public:
    Array<TreeNode> nodes;
    Array<uint32_t> records;  // by node: its joint's record, where it has one
    Array<JointTree> trees;
    Array<TreeWork> work;
    Array<uint8_t> direct;  // by record

    explicit JointTrees(const Memory* memory)
        : nodes(memory),
          records(memory),
          trees(memory),
          work(memory),
          direct(memory),
          groups_(memory),
          first_link_(memory),
          links_(memory),
          carried_(memory) {}

    // `group` is by body: the first body of its group.
    void find(const JointRecord* joints, int count, const SolverBodies& bodies, const uint32_t* group);

private:
    struct Group {
        int32_t bodies = 0, inner = 0, anchors = 0;  // moved bodies, joints between two of them, other joints
        int32_t root = -1;                           // the body that hangs on one that does not move, or the heaviest
        bool other = false;                          // has joints that are not solved directly
    };
    bool is_tree(const Group& g) const {
        return !g.other && g.inner == g.bodies - 1 && g.anchors <= 1 && g.bodies > 1 && g.bodies <= largest_tree;
    }
    void count_groups(const JointRecord* joints, int count, const SolverBodies& bodies, const uint32_t* group);
    void link_bodies(const JointRecord* joints, int count, const SolverBodies& bodies, const uint32_t* group);
    void grow(const Group& g, const JointRecord* joints, const SolverBodies& bodies);
    float heaviest_load(int first, const SolverBodies& bodies);

    Array<Group> groups_;                 // by first body
    Array<uint32_t> first_link_, links_;  // joints of each body, those of trees alone
    Array<float> carried_;                // mass of a node with all below
};

}  // namespace lendulet
