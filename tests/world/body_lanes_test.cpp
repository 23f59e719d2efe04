// What a step does for each body by itself, in lanes: one result for every width, and that of the formulas for one
// body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "math/kept_sum.h"
#include "scenes/random.h"
#include "world/body_lanes/kernels.h"
#include "world/limits.h"
#include "world/support.h"

namespace lendulet::test {
namespace {

using scenes::Random;
constexpr float dt = 1.0f / 60.0f;
constexpr int body_count = 37;  // whole blocks of no width

// Bodies of all kinds: balls, tumbling ones, kinematic ones; every seventh one has a box, a capsule or a ball, others a
// shape whose box is given.
struct Crowd {
    Memory memory;
    BodyStore store{&memory, 1};
    SolverBodies packed{&memory};
    std::vector<bool> dynamic;

    Crowd() {
        Random random(5);
        auto vector = [&](float most) {
            return Vec3{random.range(-most, most), random.range(-most, most), random.range(-most, most)};
        };
        for (int i = 0; i < body_count; ++i) {
            const uint32_t slot = store.add();
            dynamic.push_back(i % 5 != 4);
            store.info[slot].type = dynamic.back() ? BodyType::dynamic : BodyType::kinematic;
            store.pose[slot] = {at(vector(20.0f)), random.rotation()};
            store.momenta[slot] = {vector(9.0f), vector(1e-6f), vector(3.0f), vector(1e-6f), vector(1e-8f)};
            if (!dynamic.back()) continue;
            BodyMass& m = store.mass[slot];
            m.mass = random.range(0.5f, 4.0f), m.inverse_mass = 1.0f / m.mass;
            const float moment = random.range(0.2f, 2.0f);
            m.inertia = i % 3 == 0 ? Vec3{moment, moment, moment} : Vec3{moment, 1.2f * moment, 1.5f * moment};
            m.inverse_inertia = {1.0f / m.inertia.x, 1.0f / m.inertia.y, 1.0f / m.inertia.z};
            m.anisotropy = i % 3 == 0 ? 1.0f : 1.5f;
            store.change[slot] = {vector(0.1f), vector(0.1f)};
        }
        packed.reset(body_count);
    }
    static size_t place(int i) { return static_cast<size_t>(i + reserved_bodies); }

    void pack(int width) {
        auto batch = std::make_unique<PackBatch>();
        batch->bodies = columns(store);
        batch->packed = &packed;
        batch->count = body_count;
        for (int i = 0; i < filled(body_count); ++i) {
            const int k = std::min(i, body_count - 1);
            batch->body[i] = k, batch->place[i] = k + reserved_bodies;
            batch->dynamic[i] = dynamic[static_cast<size_t>(k)] ? 1.0f : 0.0f;
            batch->share[i] = k % 2 == 0 ? 1.0f : 0.5f;
            batch->free[i] = dynamic[static_cast<size_t>(k)] && k % 4 != 0 ? 0.0f : 1.0f;
            batch->linear_loss[i] = 0.01f, batch->angular_loss[i] = 0.02f;
            for (int c = 0; c < 3; ++c) batch->acceleration[c][i] = -3.0f, batch->torque[c][i] = 0.5f;
        }
        body_kernels(width).pack(*batch);
    }
    // Returns which are doubtful.
    std::vector<bool> unpack(int width) {
        auto batch = std::make_unique<UnpackBatch>();
        std::vector<Pose> before(body_count);
        batch->bodies = columns(store);
        batch->packed = &packed;
        batch->before = before.data();
        batch->most_speed = max_speed, batch->most_spin = max_angular_speed;
        batch->count = body_count;
        for (int i = 0; i < filled(body_count); ++i) {
            const int k = std::min(i, body_count - 1);
            batch->body[i] = k, batch->place[i] = k + reserved_bodies;
            batch->dynamic[i] = dynamic[static_cast<size_t>(k)] ? 1.0f : 0.0f;
            batch->substeps[i] = 2.0f;
            batch->loss[i] = 0.0f;
            for (int c = 0; c < 3; ++c) batch->gain[c][i] = 0.25f;
        }
        body_kernels(width).unpack(*batch);
        return std::vector<bool>(batch->doubtful, batch->doubtful + body_count);
    }
};

template <class T>
void expect_same(const Array<T>& a, const Array<T>& b, int width, const char* what) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(T)), 0) << what << ", width " << width;
}

TEST(BodyLanes, PackAndUnpackAlikeForAllWidths) {
    Crowd expected;
    expected.pack(1);
    expected.unpack(1);
    for (int width : widths) {
        Crowd crowd;
        crowd.pack(width);
        crowd.unpack(width);
        expect_same(crowd.packed.state, expected.packed.state, width, "state");
        expect_same(crowd.packed.inertia, expected.packed.inertia, width, "inertia");
        expect_same(crowd.packed.start, expected.packed.start, width, "start");
        expect_same(crowd.packed.place, expected.packed.place, width, "place");
        expect_same(crowd.packed.motion, expected.packed.motion, width, "motion");
        expect_same(crowd.store.pose, expected.store.pose, width, "pose");
        expect_same(crowd.store.momenta, expected.store.momenta, width, "momenta");
        expect_same(crowd.store.change, expected.store.change, width, "change");
    }
}

TEST(BodyLanes, PackWhatOneBodyHas) {
    for (int width : widths) {
        Crowd crowd;
        crowd.pack(width);
        for (int i = 0; i < body_count; ++i) {
            const auto slot = static_cast<uint32_t>(i);
            const BodyStart& start = crowd.packed.start[Crowd::place(i)];
            EXPECT_EQ((Vec3{start.v[0], start.v[1], start.v[2]}), crowd.store.velocity(slot)) << i;
            EXPECT_EQ((Vec3{start.w[0], start.w[1], start.w[2]}), crowd.store.angular_velocity(slot)) << i;
            const SymMat3 I = crowd.dynamic[slot] ? crowd.store.inverse_inertia_world(slot) : SymMat3{};
            const float* packed = crowd.packed.inertia[Crowd::place(i)].inverse;
            const float wanted[6] = {I.xx, I.yy, I.zz, I.xy, I.xz, I.yz};
            for (int k = 0; k < 6; ++k) EXPECT_EQ(packed[k], wanted[k]) << i;
        }
    }
}

TEST(BodyLanes, UnpackingAddsWhatTheSolverFound) {
    Crowd crowd, before;
    crowd.pack(16);
    const Quat turn = rotation_about({0.3f, -0.5f, 0.8f}, 0.2f);
    for (int i = 0; i < body_count; ++i) {
        BodyState& s = crowd.packed.state[Crowd::place(i)];
        const float v[3] = {0.5f, -1.0f, 2.0f}, dp[3] = {0.125f, 0.25f, -0.5f},
                    dq[4] = {turn.x, turn.y, turn.z, turn.w};
        std::memcpy(s.v, v, sizeof v), std::memcpy(s.dp, dp, sizeof dp), std::memcpy(s.dq, dq, sizeof dq);
    }
    crowd.unpack(16);
    for (int i = 0; i < body_count; ++i) {
        const auto slot = static_cast<uint32_t>(i);
        const Pose &was = before.store.pose[slot], &is = crowd.store.pose[slot];
        const Quat wanted = turn * was.orientation;
        EXPECT_GT(dot(wanted, is.orientation), 1.0f - 1e-6f) << i;
        EXPECT_NEAR(dot(is.orientation, is.orientation), 1.0f, 3e-7f) << i;
        const bool dynamic = crowd.dynamic[slot], free = dynamic && i % 4 == 0;
        const Vec3 gained = !dynamic ? Vec3{}
                            : free   ? Vec3{0.25f, 0.25f, 0.25f}
                                     : before.store.mass[slot].mass * Vec3{0.5f, -1.0f, 2.0f};
        BodyMomenta wanted_momenta = before.store.momenta[slot];
        if (dynamic) add_kept(wanted_momenta.p, wanted_momenta.p_low, gained);
        EXPECT_EQ(crowd.store.momenta[slot].p, wanted_momenta.p) << i;
        EXPECT_EQ(crowd.store.momenta[slot].p_low, wanted_momenta.p_low) << i;
        Vec3 x = from_origin(was.position);
        add_kept(x, wanted_momenta.x_low, {0.125f, 0.25f, -0.5f});
        EXPECT_EQ(is.position, at(x)) << i;
        EXPECT_EQ(crowd.store.momenta[slot].x_low, wanted_momenta.x_low) << i;
    }
}

TEST(BodyLanes, DoubtIsOfTheBodyAlone) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (int width : widths) {
        Crowd crowd;
        crowd.pack(width);
        auto state = [&](int i) -> BodyState& { return crowd.packed.state[Crowd::place(i)]; };
        state(3).dp[1] = nan;
        state(6).v[2] = inf;
        state(11).v[0] = 2.0f * max_speed;
        state(17).dq[0] = 3.0f;
        crowd.packed.motion[Crowd::place(22)].angular_momentum[0] = 1e6f;
        const std::vector<bool> doubtful = crowd.unpack(width);
        for (int i = 0; i < body_count; ++i)
            EXPECT_EQ(doubtful[static_cast<size_t>(i)], i == 3 || i == 6 || i == 11 || i == 17 || i == 22)
                << i << ", width " << width;
    }
}

// ---------------------------------------------------------------------------------------------------------------------

// A collider on each body of the crowd.
struct Colliders {
    Crowd crowd;
    std::vector<Transform> local = std::vector<Transform>(body_count);
    std::vector<Geometry> geometry = std::vector<Geometry>(body_count);
    std::vector<ShapeFrame> frames = std::vector<ShapeFrame>(body_count);
    std::vector<BroadBox> boxes = std::vector<BroadBox>(body_count);
    BoundBatch batch{};

    Colliders() {
        Random random(9);
        for (size_t i = 0; i < body_count; ++i) {
            auto size = [&] { return random.range(0.1f, 0.6f); };
            Geometry& g = geometry[i];
            g.kind = i % 3 == 0 ? GeometryKind::box : i % 3 == 1 ? GeometryKind::segment : GeometryKind::point;
            if (i % 7 == 6) g.kind = GeometryKind::tapered_cylinder;
            if (g.kind == GeometryKind::box || g.kind == GeometryKind::tapered_cylinder)
                g.size = {size(), size(), size()};
            if (g.kind == GeometryKind::segment) g.size.y = size();
            if (i % 3 != 0) g.rounding = size();
            local[i] = {{size(), -size(), size()}, random.rotation()};
        }
        batch.bodies = columns(crowd.store);
        batch.local = local.data(), batch.geometry = geometry.data(), batch.frames = frames.data();
        batch.dt = dt, batch.fall = dt * 9.81f, batch.most_fall = 2.0f * max_speed;
        batch.most_foreseen_turn = most_foreseen_turn;
        batch.count = body_count;
        for (int i = 0; i < filled(body_count); ++i) {
            const int k = std::min(i, body_count - 1);
            const auto slot = static_cast<size_t>(k);
            batch.collider[i] = batch.body[i] = batch.box[i] = k;
            batch.kinematic[i] = crowd.dynamic[slot] ? 0.0f : 1.0f;
            batch.gravity_factor[i] = 1.0f;
            batch.radius[i] = bounding_radius(geometry[slot]);
            if (geometry[slot].kind <= GeometryKind::box) continue;
            const CentredBox box = bounds(geometry[slot], rotation(k));
            batch.given[i] = 1.0f;
            for (int c = 0; c < 3; ++c)
                batch.given_centre[c][i] = component(box.centre, c), batch.given_half[c][i] = component(box.half, c);
        }
    }
    Quat rotation(int i) const {
        return crowd.store.pose[static_cast<size_t>(i)].orientation * local[static_cast<size_t>(i)].rotation;
    }
    void bound(int width, bool unboxed) {
        for (float& x : batch.unboxed) x = unboxed ? 1.0f : 0.0f;
        batch.boxes = boxes.data();
        body_kernels(width).bound(batch);
        for (int i = 0; i < body_count; ++i) {
            if (batch.renewed[i] == 0.0f) continue;
            BroadBox& box = boxes[static_cast<size_t>(i)];
            for (int c = 0; c < 3; ++c) box.lower[c] = batch.lower[c][i], box.upper[c] = batch.upper[c][i];
        }
    }
};

TEST(BodyLanes, BoundsAlikeForAllWidths) {
    auto expected = std::make_unique<Colliders>();
    expected->bound(1, true);
    for (int width : widths) {
        auto colliders = std::make_unique<Colliders>();
        colliders->bound(width, true);
        EXPECT_EQ(std::memcmp(colliders->frames.data(), expected->frames.data(), body_count * sizeof(ShapeFrame)), 0);
        EXPECT_EQ(std::memcmp(colliders->boxes.data(), expected->boxes.data(), body_count * sizeof(BroadBox)), 0);
    }
}

// The shape where it is and where its body's velocity takes it, with the margin between.
TEST(BodyLanes, BoxesHoldTheShapeThroughTheStep) {
    auto colliders = std::make_unique<Colliders>();
    colliders->bound(16, true);
    for (int i = 0; i < body_count; ++i) {
        const auto slot = static_cast<uint32_t>(i);
        const ShapeFrame& f = colliders->frames[slot];
        const Vec3 arm = rotate(colliders->crowd.store.pose[slot].orientation, colliders->local[slot].translation);
        EXPECT_LT(length(Vec3{f.arm[0], f.arm[1], f.arm[2]} - arm), 1e-6f) << i;
        const CentredBox box = bounds(colliders->geometry[slot], colliders->rotation(i));
        const Vec3 centre = from_origin(colliders->crowd.store.pose[slot].position) + arm + box.centre;
        const Vec3 way = dt * colliders->crowd.store.velocity(slot);
        for (int c = 0; c < 3; ++c) {
            const float x = component(centre, c), half = component(box.half, c), moved = component(way, c);
            const float lower = minimum(x, x + moved) - half, upper = maximum(x, x + moved) + half;
            const float grown = lower - colliders->boxes[slot].lower[c];
            EXPECT_GT(grown, 0.004f) << i;
            EXPECT_NEAR(colliders->boxes[slot].upper[c] - upper, grown, 1e-5f) << i;
        }
    }
}

TEST(BodyLanes, BoxesStayWhileTheyHoldTheirShapesClosely) {
    auto colliders = std::make_unique<Colliders>();
    for (uint32_t slot = 0; slot < body_count; ++slot) colliders->crowd.store.momenta[slot] = {};
    auto renewed = [&](int i) { return colliders->batch.renewed[i] > 0.0f; };
    colliders->bound(16, true);
    for (int i = 0; i < body_count; ++i) EXPECT_TRUE(renewed(i)) << i;
    for (int width : widths) {
        colliders->bound(width, false);
        for (int i = 0; i < body_count; ++i) EXPECT_FALSE(renewed(i)) << i;
    }
    // Within the leeway, and beyond it to each side.
    auto move = [&](int i, Vec3 way) {
        Position& x = colliders->crowd.store.pose[static_cast<uint32_t>(i)].position;
        x = x + way;
    };
    move(8, {1e-3f, -1e-3f, 1e-3f});
    const Vec3 sides[] = {{5e-3f, 0, 0}, {-5e-3f, 0, 0}, {0, 5e-3f, 0}, {0, -5e-3f, 0}, {0, 0, 5e-3f}, {0, 0, -5e-3f}};
    for (int k = 0; k < 6; ++k) move(13 + k, sides[k]);
    colliders->bound(8, false);
    for (int i = 0; i < body_count; ++i) EXPECT_EQ(renewed(i), i >= 13 && i < 19) << i;
    // What has become much too wide is renewed too, here along one axis.
    for (int c = 0; c < 3; ++c) colliders->boxes[static_cast<size_t>(20 + c)].lower[c] -= 0.01f;
    for (int c = 0; c < 3; ++c) colliders->boxes[static_cast<size_t>(23 + c)].upper[c] += 0.01f;
    colliders->bound(4, false);
    for (int i = 0; i < body_count; ++i) EXPECT_EQ(renewed(i), i >= 20 && i < 26) << i;
}

}  // namespace
}  // namespace lendulet::test
