// Which joints are solved side by side, and how: colours as for contacts, and for each joint whether its group of
// bodies is split from contacts and whether it needs softness. Kept from step to step while the joints stay the same
// and no group begins or ceases to touch something.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "solver/colouring.h"
#include "solver/joints/joint.h"
#include "solver/joints/kernels.h"

namespace lendulet {

// Contacts of a step, as Solver::prepare gets them.
struct ContactList {
    const ContactRecord* records;
    const uint32_t* list;
    int count;
    float dt;  // the step
};

struct JointSchedule {
    Array<uint32_t> order;     // indices of records, by group
    Array<JointGroup> groups;  // in the order in which they are solved
    Array<std::byte> rows;
    int first_overflow_group = 0;  // groups from here on hold one joint each, whose bodies others share

    explicit JointSchedule(const Memory* memory)
        : order(memory),
          groups(memory),
          rows(memory),
          sorter_(memory),
          joint_count_(memory),
          jointed_(memory),
          parent_(memory),
          touched_(memory),
          touched_before_(memory) {}

    // Sets the modes of `count` joints, BodyMotion::joints and ::free of the bodies that they move, and where need be
    // the groups. `same`: joints and bodies are those of the last call. Returns whether the groups are new.
    bool build(JointRecord* records, int count, bool same, ContactList contacts, SolverBodies& bodies,
               const JointTable& table, const JointTable& scalar_table);

    // Takes memory for so many ball joints.
    void make_ready(size_t bodies, size_t joints, const JointTable& table);

private:
    void find_groups_of_bodies(const JointRecord* records, int count, const SolverBodies& bodies);
    void find_touching(ContactList contacts, const SolverBodies& bodies);
    void set_modes(JointRecord* records, int count, const SolverBodies& bodies);
    void set_bodies(SolverBodies& bodies);
    void colour(const JointRecord* records, int count, const SolverBodies& bodies, const JointTable& table,
                const JointTable& scalar_table);
    uint32_t root(uint32_t body);

    JointGroup group_of(int type, int side_kind, bool split, int count, const uint32_t* which, size_t& bytes,
                        const JointTable& table) const;

    ColourSorter sorter_;
    Array<uint32_t> joint_count_;              // by body
    Array<uint32_t> jointed_;                  // bodies with joints that constraints move
    Array<uint32_t> parent_;                   // by body: the first one of its group
    Array<uint8_t> touched_, touched_before_;  // by first body of a group: it has contacts
};

}  // namespace lendulet
