// One step of all awake bodies, contacts and joints: substeps of impacts, kick, biased solve, drift and relax.
//
// The scheme is a substepped soft Gauss-Seidel ("leaky TGS"): a biased pass undoes a share of the overlap and gives up
// a share of the accumulated impulse (which damps slow modes), a relax pass without bias makes the velocities right
// again and alone carries friction. Sources: Macklin et al., "Small Steps in Physics Simulation" (SCA 2019); Catto,
// "Solver2D" (2024); the leak and its stiffness are ours, see docs/solver.md.
#pragma once

#include <cstdint>

#include "base/memory.h"
#include "base/tasks.h"
#include "solver/bodies.h"
#include "solver/colouring.h"
#include "solver/contact.h"
#include "solver/impacts.h"
#include "solver/joints/joint_solver.h"
#include "solver/kernels.h"
#include "solver/watch.h"

namespace lendulet {

struct SolverSettings {
    float dt;
    int substeps;
    float gravity;  // magnitude, for the bounce threshold, m/s^2
    // Where no body moves by more than this in m/s or rad/s after the first few substeps, the others are left out; 0:
    // never. For contacts alone.
    float rest_speed = 0.0f;
};

// Share of the overlap that a biased pass undoes in one substep, and of the impulse that it gives up. A stack of n
// equal boxes sinks by (leak / bias) g h^2 n per face, and stands up to a height of about (0.98 bias / (leak g
// h^2))^(1/3).
inline constexpr float contact_bias = 0.35f;
inline constexpr float contact_leak = 0.175f;
// Impacts slower than this many times |g| h do not bounce: less than a substep's fall cannot be told from rest.
inline constexpr float bounce_threshold_substeps = 4.0f;

SubstepConstants substep_constants(const SolverSettings& settings);

// Of manifolds, all, and the first that get rows; those after them are left to impacts.
struct ContactCount {
    int all, rows;
    ContactCount(int with_rows) : all(with_rows), rows(with_rows) {}
    ContactCount(int number, int with_rows) : all(number), rows(with_rows) {}
};

class Solver {
public:
    Solver(const Memory* memory, int width)
        : schedule_(memory),
          impacts_(memory),
          last_impacts_(memory),
          meetings_(memory),
          disturbed_(memory),
          foreseen_(memory),
          watched_meetings_(memory),
          joints_(memory, width),
          impact_joints_(memory),
          kernels_(solver_kernels(width)) {}

    // Colours manifolds by their ends; `list` names their records. `extras`, by record: see ContactExtra; null where no
    // material has any. `cut`: of the bodies that solve() is given. Returns the bytes of rows that prepare() is to be
    // given.
    size_t schedule(ColourSorter& sorter, const SolverBodies& bodies, const ContactEnds* ends, const uint32_t* list,
                    ContactCount count, const ContactCut& cut = {}, ContactExtra* extras = nullptr);
    // Packs them into rows, memory aligned to Memory::alignment that must stay until store(). `records` as before;
    // their impulses are multiplied by `impulse_unit`, a power of two, and divided by it in store().
    void prepare(TaskPool& tasks, SolverBodies& bodies, const ContactRecord* records, std::byte* rows,
                 float impulse_unit = 1.0f);
    // So that contacts of `other` may become this one's without asking for memory; before schedule().
    void make_room(const Solver& other) {
        schedule_.make_room(other.schedule_);
        const size_t impacts = impacts_.size() + other.impacts_.size();
        impacts_.reserve(impacts);
        meetings_.reserve(impacts / meeting_lanes + 1);
    }
    // Takes memory for so many entries of bodies, contacts, and joints; before schedule().
    void make_ready(size_t bodies, size_t contacts, size_t joints) {
        schedule_.order.make_ready(contacts);
        joints_.make_ready(bodies, joints);
        if (joints > 0) impact_joints_.make_ready(bodies, joints);
    }
    // Of a contact of four points, without empty lanes.
    size_t largest_row() const { return kernels_.row_bytes[2] / static_cast<size_t>(kernels_.width); }
    // Colours the joints and packs them; after prepare() and with the same contacts, in every step. `joints` must stay
    // until store_joints(), and until the next call where that one reuses them.
    void prepare_joints(TaskPool& tasks, SolverBodies& bodies, JointList joints, ContactList contacts,
                        JointReuse reuse = {});
    // Contacts that solve() is to note things of, among those of the last schedule(); they must stay until it is done.
    // A list of none is as good as no call.
    void watch(const WatchList& list);
    // Runs the substeps; bodies of the range move: all that the contacts and joints given name, and others as well.
    void solve(TaskPool& tasks, const SolverSettings& settings, SolverBodies& bodies, const ContactRecord* records,
               BodyRange range);
    void solve(TaskPool& tasks, const SolverSettings& settings, SolverBodies& bodies, const ContactRecord* records) {
        solve(tasks, settings, bodies, records, {0, bodies.count});
    }
    // Whether the last solve() left substeps out, since all of its bodies rested.
    bool rested() const { return rested_; }
    // Bodies of the range, of which no contact and no joint knows, take all of settings.dt at once.
    void coast(TaskPool& tasks, const SolverSettings& settings, SolverBodies& bodies, BodyRange range) const;
    // Writes impulses and final separations back.
    void store(TaskPool& tasks, const SolverBodies& bodies, ContactRecord* records);
    // Writes impulses back into the joints given to prepare_joints().
    void store_joints(TaskPool& tasks) { joints_.store(tasks); }

    // Calls visit(record, colour) for every contact that the last schedule() coloured.
    template <class Visit>
    void for_each_coloured(Visit&& visit) const {
        for (const ContactGroup& group : schedule_.groups)
            for (int i = 0; i < group.count; ++i) visit(group.order[i], group.colour);
    }
    int colour_count() const { return schedule_.colours; }
    int overflow() const { return schedule_.overflow; }
    const JointSolver& joints() const { return joints_; }
    size_t row_bytes() const { return schedule_.row_bytes; }

private:
    // Whether several threads would take longer than one for its contacts and joints and so many bodies.
    bool is_small(int bodies) const;
    // Whether it is asked, after so many substeps, if all bodies rest.
    bool may_rest(const SolverSettings& settings, int substep) const;
    // Calls run(kernels, group, begin, end) for all groups [first, last).
    template <class Run>
    void run_groups(int first, int last, Run&& run) const;
    // The same for those between tiles, colour after colour; workers share a colour.
    template <class Run>
    void for_each_between(TaskPool& tasks, Run&& run) const;
    // And for all, in no order.
    template <class Run>
    void for_each_group(TaskPool& tasks, Run&& run) const;
    // Calls run(tile, bodies) for every tile, or for parts of the only one.
    template <class Run>
    void for_each_tile(TaskPool& tasks, BodyRange range, Run&& run) const;
    using Pass = SolverKernels::Pass;
    // Which of `impacts_` may meet in this substep; prepares what of it is to be asked.
    // Tells each contact of the impacts which is the next between the same bodies.
    void link_impacts(int bodies);
    void find_meetings(TaskPool& tasks, const SolverBodies& bodies, const ContactRecord* records,
                       const SubstepConstants& k);
    // Watched contacts: when the step begins; before the rows of a substep, who of them may meet in it; and after
    // these what they carry.
    void list_foreseen(const ContactRecord* records);
    void foresee_watched(TaskPool& tasks, SolverBodies& bodies, const ContactRecord* records,
                         const SubstepConstants& k);
    void note_watched(TaskPool& tasks, SolverBodies& bodies, const ContactRecord* records, float h, bool last) const;
    // Of the row of a watched contact: what its points carry, N s.
    void read_watched(const WatchedContact& contact, float impulses[4]) const;
    void pass_group(const ContactGroup& group, int begin, int end, SolverBodies& bodies, const SubstepConstants& k,
                    Pass pass) const;
    void pass_tile(int tile, SolverBodies& bodies, const SubstepConstants& k, Pass pass) const;
    void pass_between(TaskPool& tasks, SolverBodies& bodies, const SubstepConstants& k, Pass pass) const;

    ColourSchedule schedule_;
    Array<ImpactContact> impacts_;
    Array<int32_t> last_impacts_;   // by body: the last of these so far that it is B of
    Array<MeetingBlock> meetings_;  // of these
    int passing_ = 0;               // how many of these pass: the last
    bool rested_ = false;
    Array<uint8_t> disturbed_;  // by body, see ImpactList
    const ContactExtra* extras_ = nullptr;
    WatchList watched_;
    Array<ImpactContact> foreseen_;         // those that have rows and are asked how fast they meet
    Array<MeetingBlock> watched_meetings_;  // of these
    JointSolver joints_;
    ImpactJoints impact_joints_;
    const SolverKernels& kernels_;
};

}  // namespace lendulet
