// Impacts on bodies with joints: what the joints hand on, at once, to the bodies behind them.
//
// An impact on a body of a chain is one on all of it. Newton's law for the body alone, with joints that then make
// velocities agree, would leave next to nothing of a bounce: of two balls in a rod that falls on its end one comes back
// and the other goes on down. So impacts see how the body answers with its joints held, W = J (M^-1 - M^-1 G^T (G M^-1
// G^T)^-1 G M^-1) J^T with G the locked rows of the joints near it, and every body gets its part of the impulse.
#pragma once

#include "lendulet/math.h"
#include "solver/bodies.h"
#include "solver/joints/joint_solver.h"

namespace lendulet {

// A body that an impact reaches.
struct ReachedBody {
    int32_t body;
    float inverse_mass;
    SymMat3 inverse_inertia;
    Vec3 dp;  // displacement and rotation since the start of the step
    Quat dq;
    Vec3 impulse, angular_impulse;  // the latter about its centre of mass
};

class ImpactJoints {
public:
    explicit ImpactJoints(const Memory* memory)
        : first_(memory), of_body_(memory), near_(memory), bodies_(memory), rows_(memory), matrix_(memory) {}

    void begin_step(JointList joints) {
        joints_ = joints;
        listed_ = false;
    }
    void make_ready(size_t bodies, size_t joints);
    // Finds the bodies that an impact between two of them reaches, of which at least one has joints; these are to be
    // put where they are then, before lock().
    Array<ReachedBody>& reach(const SolverBodies& bodies, int32_t a, int32_t b);
    void lock(const SolverBodies& bodies);
    // What the joints take from how fast the point's velocity changes along u per unit impulse along w.
    float held_back(Vec3 arm_a, Vec3 arm_b, Vec3 u, Vec3 w);
    // What all bodies get of an impulse at B's arm, and the opposite at A's; the first two are A and B.
    const Array<ReachedBody>& hand_on(Vec3 arm_a, Vec3 arm_b, Vec3 impulse);
    const Array<ReachedBody>& reached() const { return bodies_; }

private:
    // One side of a joint, relative to the origin of this step's places.
    struct JointEnd {
        Vec3 x, arm;
        Quat frame;
        float inverse_mass;
    };
    struct Row {
        int a, b;  // among bodies_
        Vec3 along, turn_a, turn_b;
    };
    void list_joints(int count);
    int find(const SolverBodies& bodies, int32_t body);
    void add_joint(const SolverBodies& bodies, const JointRecord& r);
    JointEnd end_of(const SolverBodies& bodies, int body, const float* arm, const float* frame) const;
    void factor();
    // Impulses of bodies: none but a row's, or those of a contact.
    void clear();
    void push(const Row& row, float impulse);
    void push_contact(Vec3 arm_a, Vec3 arm_b, Vec3 impulse);
    float speed(const Row& row) const;
    // L^-1 of the speeds that an impulse gives the rows.
    void answer_of(Vec3 arm_a, Vec3 arm_b, Vec3 impulse, double* y);
    double& at(int i, int j) { return matrix_[static_cast<size_t>(i * rows_.count() + j)]; }

    JointList joints_{};
    bool listed_ = false;
    Array<uint32_t> first_, of_body_;  // joints by body
    Array<uint32_t> near_;             // those that the impact goes through, nearest first
    Array<ReachedBody> bodies_;
    Array<Row> rows_;
    Array<double> matrix_;  // L D L^T of G M^-1 G^T: L below the diagonal, D on it
};

}  // namespace lendulet
