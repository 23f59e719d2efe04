// Contacts that may meet within a substep, told wide, against what impacts then make of them one by one.
#include "solver/meetings.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include "base/memory.h"
#include "numbers.h"
#include "solver/impacts.h"
#include "solver/kernels.h"

namespace lendulet {
namespace {

constexpr int contacts_of_case = 37;  // not a multiple of any width

// Pairs of bodies that fly and turn somehow, each with a contact, as in the midst of a step.
struct FlyingPairs {
    Memory memory;
    SolverBodies bodies{&memory};
    std::array<ContactRecord, contacts_of_case> records{};
    std::array<ImpactContact, contacts_of_case> contacts{};
    std::array<MeetingBlock, 3> blocks{};
    RandomNumbers random;
    float speed = 3.0f, spin = 8.0f, push = 10.0f;  // m/s, rad/s, m/s^2

    explicit FlyingPairs(uint32_t seed) : random{seed} {
        // In some the bodies hardly meet but by how they turn or are pushed within the substep.
        if (seed % 3 == 1) speed = 0.3f, spin = 60.0f;
        if (seed % 3 == 2) speed = 0.3f, push = 1000.0f;
        bodies.reset(2 * contacts_of_case);
        for (int i = reserved_bodies; i < bodies.count; ++i) add_body(static_cast<size_t>(i));
        solver_kernels(1).begin_step(bodies, 0, (bodies.count + block_bodies - 1) / block_bodies * block_bodies);
        for (int i = 0; i < contacts_of_case; ++i) add_contact(i);
    }
    void fill(float* x, int count, float size) {
        for (int k = 0; k < count; ++k) x[k] = random.in(-size, size);
    }
    void add_body(size_t i) {
        bodies.set_at_rest(static_cast<int>(i));
        BodyState& s = bodies.state[i];
        fill(s.v, 3, 0.5f), fill(s.w, 3, 0.5f), fill(s.dp, 3, 0.02f), fill(s.dq, 3, 0.05f);
        s.dq[3] = std::sqrt(1.0f - (s.dq[0] * s.dq[0] + s.dq[1] * s.dq[1] + s.dq[2] * s.dq[2]));
        s.inverse_mass = 1.0f;
        BodyMotion& m = bodies.motion[i];
        const bool round = random.in(0.0f, 1.0f) < 0.3f;
        for (int k = 0; k < 3; ++k) {
            m.inertia[k] = round ? 0.1f : random.in(0.1f, 0.19f);
            m.inverse_inertia[k] = 1.0f / m.inertia[k];
        }
        m.anisotropy = round ? 1.0f : 1.9f;
        fill(m.acceleration, 3, push);
        fill(bodies.start[i].v, 3, speed), fill(bodies.start[i].w, 3, spin);
        const Quat q{s.dq[0], s.dq[1], s.dq[2], s.dq[3]};
        const SymMat3 inverse = rotate_diagonal(rotation_matrix<float>(QuatT<float>(q), 1.0f),
                                                {m.inverse_inertia[0], m.inverse_inertia[1], m.inverse_inertia[2]});
        const SymMat3 inertia =
            rotate_diagonal(rotation_matrix<float>(QuatT<float>(q), 1.0f), {m.inertia[0], m.inertia[1], m.inertia[2]});
        const float packed[6] = {inverse.xx, inverse.yy, inverse.zz, inverse.xy, inverse.xz, inverse.yz};
        for (int k = 0; k < 6; ++k) bodies.inertia[i].inverse[k] = packed[k];
        const Vec3 w{bodies.start[i].w[0] + s.w[0], bodies.start[i].w[1] + s.w[1], bodies.start[i].w[2] + s.w[2]};
        const Vec3 L = inertia * w;
        m.angular_momentum[0] = L.x, m.angular_momentum[1] = L.y, m.angular_momentum[2] = L.z;
    }
    void add_contact(int i) {
        ContactRecord& r = records[static_cast<size_t>(i)];
        Vec3 n{};
        while (length(n) < 0.1f) n = {random.in(-1.0f, 1.0f), random.in(-1.0f, 1.0f), random.in(-1.0f, 1.0f)};
        n = normalize(n);
        const int kind = static_cast<int>(random.in(0.0f, 3.0f));
        r.normal[0] = n.x, r.normal[1] = n.y, r.normal[2] = n.z;
        r.body_a = reserved_bodies + 2 * i, r.body_b = r.body_a + 1;
        r.restitution = random.in(0.05f, 1.0f);
        r.static_friction = r.dynamic_friction = 0.5f;
        r.follow = kind == 0 ? 0.5f : random.in(0.0f, 1.0f) < 0.5f ? 0.0f : 1.0f;
        r.point_count = kind == 0 ? 1 : 1 + static_cast<int>(random.in(0.0f, 4.0f));
        r.flags = kind == 0 ? contact_balls : kind == 1 ? contact_sharp : 0;
        if (random.in(0.0f, 1.0f) < 0.3f) r.flags |= contact_swift;
        const float gap = random.in(-0.01f, 0.05f);
        r.radius_a = kind == 1 ? 0.0f : 0.3f, r.radius_b = kind == 0 ? 0.4f : 0.0f;
        const Vec3 offset = kind == 0 ? (r.radius_a + r.radius_b + gap) * n : 0.9f * n;
        r.arm_offset[0] = offset.x, r.arm_offset[1] = offset.y, r.arm_offset[2] = offset.z;
        for (int j = 0; j < 4; ++j) {
            ContactPointRecord& p = r.points[j];
            p.separation = far_separation;
            if (j >= r.point_count) continue;
            p.separation = gap + (kind == 0 ? 0.0f : random.in(0.0f, 0.02f));
            Vec3 at = (r.radius_a + 0.5f * p.separation) * n;
            if (kind != 0) {
                const Vec3 x = perpendicular(n), y = cross(n, x);
                at = 0.45f * n + random.in(-0.4f, 0.4f) * x + random.in(-0.4f, 0.4f) * y;
            }
            p.position[0] = at.x, p.position[1] = at.y, p.position[2] = at.z;
        }
        contacts[static_cast<size_t>(i)] = {static_cast<uint32_t>(i), r.body_a, r.body_b, false, false, false};
    }
    // Bits of those that may meet, by width.
    uint64_t find(int width, const SubstepConstants& k, MeetingsOf of = MeetingsOf::impacts) {
        uint64_t found = 0;
        for (size_t i = 0; i < blocks.size(); ++i) {
            const auto first = static_cast<int>(i) * meeting_lanes;
            const SolverKernels& kernels = solver_kernels(width);
            kernels.prepare_meetings(blocks[i], bodies, records.data(), {contacts.data(), first, contacts_of_case, of});
            kernels.find_meetings(blocks[i], bodies, k);
            found |= uint64_t{blocks[i].meets} << first;
        }
        return found;
    }
    // Bits of those that bounce when all are tried.
    uint64_t bounce(const SubstepConstants& k) {
        for (MeetingBlock& block : blocks) block.meets = 0xffff;
        resolve_impacts(bodies, records.data(), {contacts.data(), contacts_of_case, blocks.data(), nullptr, nullptr}, k,
                        0);
        uint64_t met = 0;
        for (size_t i = 0; i < contacts.size(); ++i)
            if (bodies.start[static_cast<size_t>(contacts[i].b)].struck > 0) met |= uint64_t{1} << i;
        return met;
    }
};

SubstepConstants constants() {
    SubstepConstants k{};
    k.h = 1.0f / 480.0f;
    k.bounce_speed = 0.083f;
    k.first = true;
    return k;
}

TEST(Meetings, NoImpactIsMissedAndMostContactsArePassedOver) {
    const SubstepConstants k = constants();
    int found = 0, met = 0;
    for (uint32_t seed = 1; seed <= 300; ++seed) {
        FlyingPairs pairs(seed);
        const uint64_t may = pairs.find(1, k), does = pairs.bounce(k);
        EXPECT_EQ(does & ~may, 0u) << seed;
        EXPECT_EQ(may >> contacts_of_case, 0u) << seed;
        found += __builtin_popcountll(may), met += __builtin_popcountll(does);
    }
    EXPECT_GT(met, 1000);
    EXPECT_LT(found, 3 * met);
    EXPECT_LT(met, 300 * contacts_of_case / 2);
}

TEST(Meetings, EveryWidthFindsTheSame) {
    const SubstepConstants k = constants();
    for (uint32_t seed = 1; seed <= 50; ++seed) {
        const uint64_t expected = FlyingPairs(seed).find(1, k);
        for (int width : {4, 8, 16}) EXPECT_EQ(FlyingPairs(seed).find(width, k), expected) << seed << ' ' << width;
    }
}

TEST(Meetings, WhatCarriedSomethingMeetsNothingByItself) {
    const SubstepConstants k = constants();
    FlyingPairs pairs(7);
    ASSERT_NE(pairs.find(1, k), 0u);
    for (ContactRecord& r : pairs.records)
        for (float& impulse : r.normal_impulse) impulse = 1.0f;
    EXPECT_EQ(pairs.find(1, k), 0u);
    EXPECT_NE(pairs.find(1, k, MeetingsOf::all_points), 0u);
}

// Only blows after which the bodies part with the bounce speed are impacts.
TEST(Meetings, SlowestBouncePartsWithTheBounceSpeed) {
    ContactRecord r{};
    for (float restitution : {0.1f, 0.5f, 1.0f}) {
        r.restitution = restitution;
        r.flags = 0;
        EXPECT_NEAR(slowest_bounce(r) * restitution, 1.0f, 1e-6f);
        r.flags = contact_swift;
        EXPECT_EQ(slowest_bounce(r), 1.0f);
    }
}

}  // namespace
}  // namespace lendulet
