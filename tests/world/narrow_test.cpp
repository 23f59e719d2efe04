// The batches of the narrow phase: one result for every width, and pairs that are kept while they barely move tell the
// same as pairs that are looked at anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "scenes/random.h"
#include "world/narrow/kernels.h"
#include "world/support.h"

namespace lendulet::test {
namespace {

using scenes::Random;

struct Boxes {
    std::vector<ShapeFrame> frames;
    BoxLists<batch_capacity, 16> lists;
};

// Pairs of boxes of many sizes near contact, some of them axis-aligned face to face.
void fill(Boxes& boxes, Random& random, int count) {
    boxes.frames.assign(static_cast<size_t>(2 * count), ShapeFrame{});
    for (int i = 0; i < 2 * count; ++i) {
        ShapeFrame& f = boxes.frames[static_cast<size_t>(i)];
        bool aligned = i / 2 % 3 == 0;
        Quat q = aligned ? Quat{} : random.rotation();
        const float rotation[4] = {q.x, q.y, q.z, q.w};
        std::memcpy(f.rotation, rotation, sizeof rotation);
        for (float& x : f.centre) x = random.range(-0.5f, 0.5f);
        for (float& x : f.arm) x = aligned ? 0.0f : random.range(-0.1f, 0.1f);
        for (float& x : f.half) x = random.range(0.2f, 0.6f);
        if (aligned && i % 2 == 1) f.centre[1] += 1.0f;
    }
    for (int k = 0; k < count; ++k) {
        boxes.lists.a[k] = 2 * k, boxes.lists.b[k] = 2 * k + 1;
        boxes.lists.margin[k] = k % 2 ? 0.3f : 0.02f;
        boxes.lists.way[k] = k % 2 ? 0.25f : 0.0f;
        boxes.lists.feature[k] = static_cast<float>(k % 16);
    }
}

// Sums up what a batch found, bit by bit; how many pairs touch by faces and by edges in `kinds`.
std::vector<uint32_t> bits_of(const Boxes& boxes, int count, int* kinds) {
    std::vector<uint32_t> bits;
    auto add = [&](const void* data, size_t bytes) {
        const auto* words = static_cast<const uint32_t*>(data);
        bits.insert(bits.end(), words, words + bytes / 4);
    };
    for (int k = 0; k < count; ++k) {
        add(&boxes.lists.clearance[k], 4);
        if (boxes.lists.clearance[k] > boxes.lists.margin[k]) continue;
        const BatchManifold& m = boxes.lists.out[k];
        add(&boxes.lists.feature[k], 4);
        add(&m.count, 4);
        if (m.count == 0) continue;
        ++kinds[boxes.lists.feature[k] > 6.0f];
        add(&m, offsetof(BatchManifold, count));
    }
    return bits;
}

TEST(NarrowKernels, BoxesGiveOneResultForEveryWidth) {
    for (int count : {1, 7, 100, batch_capacity}) {
        std::vector<uint32_t> expected;
        for (int width : widths) {
            Random random(17);
            auto boxes = std::make_unique<Boxes>();
            fill(*boxes, random, count);
            BoxBatch batch = boxes->lists.batch(boxes->frames.data(), count);
            narrow_kernels(width).collide_boxes(batch);
            int kinds[2] = {0, 0};
            std::vector<uint32_t> bits = bits_of(*boxes, count, kinds);
            if (count == batch_capacity) {
                EXPECT_GT(kinds[0], 40);
                EXPECT_GT(kinds[1], 10);
            }
            if (expected.empty()) expected = bits;
            EXPECT_EQ(bits, expected) << "width " << width << ", " << count << " pairs";
        }
    }
}

TEST(NarrowKernels, MotionGivesOneResultForEveryWidth) {
    constexpr int count = 61;
    Boxes boxes;
    Random random(3);
    fill(boxes, random, count);
    std::vector<KeptPose> poses(count);
    for (int k = 0; k < count; ++k) {
        KeptPose& pose = poses[static_cast<size_t>(k)];
        const ShapeFrame &a = boxes.frames[static_cast<size_t>(2 * k)],
                         &b = boxes.frames[static_cast<size_t>(2 * k + 1)];
        std::memcpy(pose.rotation_a, a.rotation, sizeof a.rotation);
        std::memcpy(pose.rotation_b, b.rotation, sizeof b.rotation);
        for (int i = 0; i < 3; ++i) pose.offset[i] = b.centre[i] - a.centre[i] + random.range(0.0f, 0.004f);
        pose.tolerance = 0.004f;
        pose.clearance = 1.0f;
    }
    std::vector<float> expected;
    for (int width : widths) {
        auto batch = std::make_unique<MotionBatch>();
        batch->frames = boxes.frames.data(), batch->poses = poses.data();
        batch->dt = 1.0f / 60.0f, batch->fall = 1e-3f;
        batch->count = count;
        for (int k = 0; k < count; ++k) batch->a[k] = 2 * k, batch->b[k] = 2 * k + 1, batch->pose[k] = k;
        narrow_kernels(width).test_motion(*batch);
        std::vector<float> found(batch->kept, batch->kept + count);
        found.insert(found.end(), batch->margin, batch->margin + count);
        if (expected.empty()) expected = found;
        EXPECT_EQ(found, expected) << "width " << width;
    }
    auto kept = std::count(expected.begin(), expected.begin() + count, 1.0f);
    EXPECT_GT(kept, 5);
    EXPECT_LT(kept, count - 5);
}

class KeptPairs : public ::testing::TestWithParam<int> {};

// A box over a floor, moved by hand by less than what has its manifold made anew: separations are those of its corners
// all the same. Positive gaps and no gravity: nothing pushes.
TEST_P(KeptPairs, SeparationsFollowTheCorners) {
    World world = WorldBuilder{}.sleep(false).gravity({}).width(GetParam()).build().value();
    add_floor(world);
    BodyId box = add_cube(world, 0.0f, 0);
    float worst = 0.0f;
    for (int i = 0; i < 40; ++i) {
        float s = static_cast<float>(i) / 40.0f;
        Quat turn = rotation_about({1.0f, 0.0f, 2.0f}, 1e-3f * (1.0f - 2.0f * s));
        Position at{1e-3f * s, 0.503f + 1e-3f * s * s, -5e-4f * s};
        ASSERT_TRUE(world.get(box).set_pose(at, turn));
        run(world, 1);
        ASSERT_EQ(world.contact_count(), 1);
        Contact c = world.contact(0);
        ASSERT_EQ(c.point_count, 4);
        for (int j = 0; j < 4; ++j) {
            Vec3 p = c.points[j].position - at;
            Vec3 corner{p.x < 0.0f ? -0.5f : 0.5f, -0.5f, p.z < 0.0f ? -0.5f : 0.5f};
            worst = std::fmax(worst, std::fabs(c.points[j].separation - (at + rotate(turn, corner)).y));
        }
    }
    EXPECT_LT(worst, 3e-6f);  // second order: 2 mrad squared times 0.7 m
}

// Pairs apart are left alone, but never for too long: points appear as soon as the gap is within the margin.
TEST_P(KeptPairs, ApproachIsNoticed) {
    for (const Shape& shape : {Shape{Box{{0.5f, 0.5f, 0.5f}}}, Shape{octahedron(0.5f)}}) {
        World world = WorldBuilder{}.sleep(false).gravity({}).width(GetParam()).build().value();
        add_floor(world);
        BodyId body = world.add_rigid_body({.shape = shape, .position = {0.0f, 0.65f, 0.0f}}).value();
        for (int i = 0; i < 300; ++i) {
            float gap = 0.15f - 5e-4f * static_cast<float>(i);
            ASSERT_TRUE(world.get(body).set_pose({0.0f, 0.5f + gap, 0.0f}, {}));
            run(world, 1);
            if (std::fabs(gap - 0.02f) > 1e-4f) {
                EXPECT_EQ(world.contact_count(), gap < 0.02f ? 1 : 0) << gap;
            }
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Widths, KeptPairs, ::testing::Values(1, 4, 8, 16));

// What lasts in a pair's records is that of the new pair where a slot or a stretch of records is taken over.
TEST(NarrowRecords, NewPairsInheritNothing) {
    World world = WorldBuilder{}.sleep(false).build().value();
    (void)world.add_static_body({.shape = Plane{}, .friction = 0.0f}).value();  // coefficients are averaged
    for (int round = 0; round < 4; ++round) {
        BodyId box = world.add_rigid_body({.shape = Box{}, .position = {0.0f, 0.5f, 0.0f}, .friction = 0.0f}).value();
        BodyId rough = world.add_rigid_body({.shape = Box{}, .position = {4.0f, 0.5f, 0.0f}, .friction = 1.0f}).value();
        world.get(box).set_velocity({1.0f, 0.0f, 0.0f}).value();
        world.get(rough).set_velocity({1.0f, 0.0f, 0.0f}).value();
        run(world, 30);
        EXPECT_NEAR(world.get(box).velocity().x, 1.0f, 1e-3f);
        EXPECT_NEAR(world.get(rough).velocity().x, 0.0f, 1e-3f);
        world.remove_body(box).value();
        world.remove_body(rough).value();
        run(world, round % 2);
    }
}

}  // namespace
}  // namespace lendulet::test
