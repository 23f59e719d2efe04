// A bare set of bodies and joints for tests of the solver alone: no colliders, no world. Bodies are given by their
// principal frames; each step packs them, solves and unpacks, as a world does.
#pragma once

#include <vector>

#include "base/hash.h"
#include "lendulet/math.h"
#include "solver/solver.h"

namespace lendulet::test {

struct RigBody {
    Position position;
    Quat orientation;
    float mass = 1.0f;  // 0: static
    Vec3 inertia{1.0f, 1.0f, 1.0f};
    Vec3 v{}, L{};
    int32_t index = 0;
    BodyInertia world_inertia{};

    Vec3 w() const {
        if (!(mass > 0.0f)) return {};
        Vec3 l = rotate_inverse(orientation, L);
        return rotate(orientation, Vec3{l.x / inertia.x, l.y / inertia.y, l.z / inertia.z});
    }
    void set_w(Vec3 w) { L = rotate(orientation, multiply(inertia, rotate_inverse(orientation, w))); }
    float kinetic() const { return 0.5f * (mass * dot(v, v) + dot(L, w())); }
};

// A joint at a point of the world, with its x axis along `axis`.
inline JointRecord rig_joint(JointClass type, const std::vector<RigBody>& bodies, int a, int b, Position anchor,
                             Vec3 axis = {1.0f, 0.0f, 0.0f}) {
    JointRecord r{};
    r.type = type;
    r.body_a = a;
    r.body_b = b;
    r.swing_limit = unlimited;
    r.lower = -unlimited;
    r.upper = unlimited;
    r.spring_force = unlimited;
    Quat frame = rotation_between({1.0f, 0.0f, 0.0f}, normalize(axis));
    auto put = [&](int body, float* arm, float* rotation) {
        const RigBody& o = bodies[static_cast<size_t>(body)];
        Vec3 local = rotate_inverse(o.orientation, anchor - o.position);
        Quat q = conjugate(o.orientation) * frame;
        arm[0] = local.x, arm[1] = local.y, arm[2] = local.z;
        rotation[0] = q.x, rotation[1] = q.y, rotation[2] = q.z, rotation[3] = q.w;
    };
    put(a, r.arm_a, r.frame_a);
    put(b, r.arm_b, r.frame_b);
    return r;
}

class JointRig {
public:
    explicit JointRig(int width = 8, int workers = 1)
        : tasks_(workers), solver_bodies_(nullptr), room_(nullptr), solver_(nullptr, width) {}

    std::vector<RigBody> bodies;
    std::vector<JointRecord> joints;    // body_a and body_b are indices into `bodies`
    std::vector<JointAxesRecord> axes;  // of six-degree joints
    std::vector<ContactRecord> contacts;
    Vec3 gravity{0.0f, -9.81f, 0.0f};
    int substeps = 8;

    int add(const RigBody& body) {
        bodies.push_back(body);
        return static_cast<int>(bodies.size()) - 1;
    }
    JointRecord& join(JointClass type, int a, int b, Position anchor, Vec3 axis = {1.0f, 0.0f, 0.0f}) {
        joints.push_back(rig_joint(type, bodies, a, b, anchor, axis));
        return joints.back();
    }

    void step(float dt) {
        pack();
        SolverSettings settings{dt, substeps, length(gravity)};
        std::vector<uint32_t> list(contacts.size());
        for (size_t i = 0; i < list.size(); ++i) list[i] = static_cast<uint32_t>(i);
        int count = static_cast<int>(contacts.size());
        std::vector<ContactEnds> ends;
        for (const ContactRecord& c : contacts)
            ends.push_back({c.body_a, c.body_b, contact_kind(c),
                            !(solver_bodies_.state[static_cast<size_t>(c.body_a)].inverse_mass > 0.0f),
                            c.restitution > 0.0f, false, false, false, false});
        room_.rows.resize_unset(solver_.schedule(room_.sorter, solver_bodies_, ends.data(), list.data(), count));
        solver_.prepare(tasks_, solver_bodies_, contacts.data(), room_.rows.data());
        solver_.prepare_joints(tasks_, solver_bodies_,
                               {records_.data(), static_cast<int>(records_.size()), axes.data()},
                               {contacts.data(), list.data(), count, dt});
        solver_.solve(tasks_, settings, solver_bodies_, contacts.data());
        solver_.store(tasks_, solver_bodies_, contacts.data());
        solver_.store_joints(tasks_);
        unpack();
    }

    // Way from the anchor on A to that on B.
    Vec3 gap(size_t joint) const {
        const JointRecord& r = joints[joint];
        const RigBody &a = bodies[static_cast<size_t>(r.body_a)], &b = bodies[static_cast<size_t>(r.body_b)];
        Vec3 ra = rotate(a.orientation, Vec3{r.arm_a[0], r.arm_a[1], r.arm_a[2]});
        Vec3 rb = rotate(b.orientation, Vec3{r.arm_b[0], r.arm_b[1], r.arm_b[2]});
        return (b.position - a.position) + (rb - ra);
    }
    // Rotation from the joint frame on A to that on B, as the shorter turn.
    Quat rotation(size_t joint) const {
        const JointRecord& r = joints[joint];
        auto frame = [&](int body, const float* f) {
            return bodies[static_cast<size_t>(body)].orientation * Quat{f[0], f[1], f[2], f[3]};
        };
        Quat q = conjugate(frame(r.body_a, r.frame_a)) * frame(r.body_b, r.frame_b);
        return q.w < 0.0f ? Quat{-q.x, -q.y, -q.z, -q.w} : q;
    }
    float angle(size_t joint) const {
        Quat q = rotation(joint);
        return 2.0f * arc_tangent2(q.x, q.w);
    }
    float swing(size_t joint) const {
        Quat q = rotation(joint);
        return 2.0f * arc_tangent2(square_root(q.y * q.y + q.z * q.z), square_root(q.x * q.x + q.w * q.w));
    }
    float largest_gap() const {
        float most = 0.0f;
        for (size_t i = 0; i < joints.size(); ++i) most = maximum(most, length(gap(i)));
        return most;
    }
    double energy() const {
        double sum = 0.0;
        for (const RigBody& b : bodies)
            sum +=
                static_cast<double>(b.kinetic()) - static_cast<double>(b.mass) * dot(gravity, from_origin(b.position));
        return sum;
    }
    void momentum(double p[3], double l[3]) const {
        for (int i = 0; i < 3; ++i) p[i] = l[i] = 0.0;
        for (const RigBody& b : bodies) {
            double x[3] = {b.position.x, b.position.y, b.position.z};
            double q[3] = {static_cast<double>(b.mass) * b.v.x, static_cast<double>(b.mass) * b.v.y,
                           static_cast<double>(b.mass) * b.v.z};
            double own[3] = {b.L.x, b.L.y, b.L.z};
            for (int i = 0; i < 3; ++i) {
                int j = (i + 1) % 3, k = (i + 2) % 3;
                p[i] += q[i];
                l[i] += own[i] + (x[j] * q[k] - x[k] * q[j]);
            }
        }
    }
    uint64_t hash() const {
        uint64_t h = 0;
        for (const RigBody& b : bodies) {
            float values[13] = {b.position.x,    b.position.y,    b.position.z, b.orientation.x, b.orientation.y,
                                b.orientation.z, b.orientation.w, b.v.x,        b.v.y,           b.v.z,
                                b.L.x,           b.L.y,           b.L.z};
            h = hash_floats(h, values, 13);
        }
        for (const JointRecord& r : joints) h = hash_floats(h, r.linear, 10);
        return h;
    }
    const Solver& solver() const { return solver_; }

private:
    static void put(float* p, Vec3 v) { p[0] = v.x, p[1] = v.y, p[2] = v.z; }
    static void put(float* p, Quat q) { p[0] = q.x, p[1] = q.y, p[2] = q.z, p[3] = q.w; }
    static Vec3 get(const float* p) { return {p[0], p[1], p[2]}; }

    void pack() {
        int moving = 0;
        for (RigBody& b : bodies) b.index = b.mass > 0.0f ? reserved_bodies + moving++ : static_body;
        solver_bodies_.reset(moving);
        for (const RigBody& b : bodies) {
            if (!(b.mass > 0.0f)) continue;
            size_t k = static_cast<size_t>(b.index);
            BodyState s{};
            s.inverse_mass = 1.0f / b.mass;
            s.dq[3] = 1.0f;
            solver_bodies_.state[k] = s;
            BodyStart start{};
            put(start.v, b.v);
            put(start.w, b.w());
            solver_bodies_.start[k] = start;
            BodyPlace place{};
            put(place.x, from_origin(b.position));
            solver_bodies_.place[k] = place;
            Vec3 inverse{1.0f / b.inertia.x, 1.0f / b.inertia.y, 1.0f / b.inertia.z};
            SymMat3 m = rotate_diagonal(rotation_matrix<float>(QuatT<float>(b.orientation), 1.0f), inverse);
            solver_bodies_.inertia[k] = {{m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}, 0.0f, 0.0f};
            BodyMotion o{};
            put(o.q0, b.orientation);
            put(o.inertia, b.inertia);
            put(o.inverse_inertia, inverse);
            o.free = 1.0f;
            float most = max_component(b.inertia), least = min_component(b.inertia);
            o.anisotropy = most - least <= 1e-6f * most ? 1.0f : most / least;
            put(o.angular_momentum, b.L);
            put(o.acceleration, gravity);
            solver_bodies_.motion[k] = o;
        }
        records_ = joints;
        for (JointRecord& r : records_) {
            const RigBody &a = bodies[static_cast<size_t>(r.body_a)], &b = bodies[static_cast<size_t>(r.body_b)];
            pack_side(a, r.body_a, r.arm_a, r.frame_a);
            pack_side(b, r.body_b, r.arm_b, r.frame_b);
        }
        for (ContactRecord& c : contacts)
            for (int32_t body : {c.body_a, c.body_b}) solver_bodies_.motion[static_cast<size_t>(body)].free = 0.0f;
    }
    // The sides of static bodies are given in the world.
    static void pack_side(const RigBody& body, int32_t& index, float* arm, float* frame) {
        index = body.index;
        if (index != static_body) return;
        put(arm, from_origin(body.position + rotate(body.orientation, get(arm))));
        put(frame, body.orientation * Quat{frame[0], frame[1], frame[2], frame[3]});
    }
    void unpack() {
        for (RigBody& b : bodies) {
            if (!(b.mass > 0.0f)) continue;
            const BodyState& s = solver_bodies_.state[static_cast<size_t>(b.index)];
            b.position = b.position + get(s.dp);
            b.orientation = normalize(Quat{s.dq[0], s.dq[1], s.dq[2], s.dq[3]} * b.orientation);
            b.v = b.v + get(s.v);
            b.L = get(solver_bodies_.motion[static_cast<size_t>(b.index)].angular_momentum);
        }
        for (size_t i = 0; i < joints.size(); ++i) {  // all but what pack() turned and renumbered
            JointRecord kept = joints[i];
            joints[i] = records_[i];
            joints[i].body_a = kept.body_a;
            joints[i].body_b = kept.body_b;
            for (int k = 0; k < 3; ++k) joints[i].arm_a[k] = kept.arm_a[k], joints[i].arm_b[k] = kept.arm_b[k];
            for (int k = 0; k < 4; ++k) joints[i].frame_a[k] = kept.frame_a[k], joints[i].frame_b[k] = kept.frame_b[k];
        }
    }

    TaskPool tasks_;
    SolverBodies solver_bodies_;
    ScheduleRoom room_;
    Solver solver_;
    std::vector<JointRecord> records_;
};

}  // namespace lendulet::test
