// Which joints are solved side by side, and how: colours as for contacts, and for each joint whether gravity is split
// between its two passes and whether it needs softness.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "solver/colouring.h"
#include "solver/joint.h"
#include "solver/kernels.h"

namespace lendulet {

// Contacts of a step, as Solver::prepare gets them.
struct ContactList {
    const ContactRecord* records;
    const uint32_t* list;
    int count;
};

struct JointSchedule {
    Array<uint32_t> order;     // indices of records, by group
    Array<JointGroup> groups;  // in the order in which they are solved
    Array<std::byte> rows;
    int first_overflow_group = 0;  // groups from here on hold joints that share bodies: one lane, one thread
    bool any_touching = false;     // whether some bodies have joints and belong to a group with contacts

    explicit JointSchedule(const Memory* memory)
        : order(memory),
          groups(memory),
          rows(memory),
          sorter_(memory),
          joint_count_(memory),
          parent_(memory),
          touched_(memory) {}

    // Colours `count` joints, sets their flags, and BodyMotion::joints and ::free of the bodies that they move.
    void build(JointRecord* records, int count, ContactList contacts, SolverBodies& bodies,
               const SolverKernels& kernels, const SolverKernels& scalar_kernels);

private:
    void find_touching(const JointRecord* records, int count, ContactList contacts, const SolverBodies& bodies);
    void set_modes(JointRecord* records, int count, SolverBodies& bodies);
    void colour(const JointRecord* records, int count, const SolverBodies& bodies, const SolverKernels& kernels,
                const SolverKernels& scalar_kernels);
    uint32_t root(uint32_t body);

    ColourSorter sorter_;
    Array<uint32_t> joint_count_;  // by body
    Array<uint32_t> parent_;       // union-find over bodies that joints connect
    Array<uint8_t> touched_;       // by body: its group has contacts
};

}  // namespace lendulet
