// What is particular to the wide tree: vectors of any width and any number of workers write the same lists, boxes keep
// their lanes while they move a little, and what jumps, comes or goes wears the tree until it is built anew.
#include "broad_phase/wide_tree/wide_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "broad_phase/support.h"

using namespace lendulet;
using namespace lendulet::broad_phase_test;

namespace {

constexpr int widths[] = {4, 8, 16};

Pairs all_pairs(WideTree& tree, TaskPool& tasks) {
    Array<BoxPair> out;
    tree.find_pairs(tasks, out);
    return as_written(out);
}

Pairs sorted(Pairs pairs) {
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

void move_by(BroadBox& box, Random& random, float most) {
    for (int d = 0; d < 3; ++d) {
        float by = random.uniform(-most, most);
        box.lower[d] += by;
        box.upper[d] += by;
    }
}

struct Lists {
    Pairs begun, ended;
    bool operator==(const Lists&) const = default;
};

// A tree, its boxes and the pairs there should be.
class Scene {
public:
    Scene(Boxes fixed, Boxes moving, int width = 0, int workers = 1)
        : boxes(std::move(moving)), fixed_(std::move(fixed)), tasks(workers), tree(&memory_, width) {
        tree.set_fixed(fixed_.data(), static_cast<int>(fixed_.size()), &tasks);
        tree.set_moving(boxes.data(), static_cast<int>(boxes.size()), &tasks);
        before_ = boxes;
    }
    // Tells the tree what has become of `boxes`.
    Lists update() {
        std::vector<uint32_t> changed;
        for (size_t i = 0; i < std::min(boxes.size(), before_.size()); ++i) {
            if (std::memcmp(&boxes[i], &before_[i], sizeof(BroadBox))) changed.push_back(static_cast<uint32_t>(i));
        }
        Array<BoxPair> begun, ended;
        tree.update(tasks, boxes.data(), static_cast<int>(boxes.size()), changed.data(),
                    static_cast<int>(changed.size()), begun, ended);
        before_ = boxes;
        return {as_written(begun), as_written(ended)};
    }
    // The same, and compares with brute force.
    void update_and_compare(const std::string& what) {
        Pairs old = expected_pairs(fixed_, before_), now = expected_pairs(fixed_, boxes);
        Lists expected;
        std::set_difference(now.begin(), now.end(), old.begin(), old.end(), std::back_inserter(expected.begun));
        std::set_difference(old.begin(), old.end(), now.begin(), now.end(), std::back_inserter(expected.ended));
        Lists found = update();
        ASSERT_EQ(found.begun, expected.begun) << what;
        ASSERT_EQ(found.ended, expected.ended) << what;
        ASSERT_STREQ(tree.check(), "") << what;
        ASSERT_EQ(sorted(all_pairs(tree, tasks)), now) << what;
    }

    // Hands all boxes over at once, and compares with brute force.
    void move_all_and_compare(const std::string& what) {
        tree.move_all(boxes.data(), static_cast<int>(boxes.size()), &tasks);
        before_ = boxes;
        ASSERT_STREQ(tree.check(), "") << what;
        ASSERT_EQ(sorted(all_pairs(tree, tasks)), expected_pairs(fixed_, boxes)) << what;
    }

    Boxes boxes;

private:
    Boxes fixed_, before_;
    Memory memory_;

public:
    TaskPool tasks;
    WideTree tree;
};

// Boxes of many batches move while others jump into them, come, go and change their indices: what the steps of a frame
// begin and end one after the other adds up to the frame, however many workers there are and whether it is built anew.
TEST(WideTreeTest, StepsOfAFrameAddUp) {
    for (int workers : {1, 3}) {
        for (int jumps_of_100 : {2, 60}) {
            const Boxes fixed = make_boxes("uniform", 300, 7, 100000);
            Scene scene(fixed, make_boxes("uniform", 1500, 8), 0, workers);
            Random random(9);
            uint32_t next_index = 5000;
            for (int frame = 0; frame < 12; ++frame) {
                for (BroadBox& box : scene.boxes) {
                    const int chance = random.below(100);
                    if (chance < 40) move_by(box, random, 0.5f);
                    if (chance >= 100 - jumps_of_100) move_by(box, random, 12.0f);
                    if (chance == 50) box.index = next_index++;
                }
                std::swap(scene.boxes[3], scene.boxes[700]);
                const bool grows = frame % 3 == 1;
                if (grows) scene.boxes.insert(scene.boxes.end(), 20, BroadBox{});
                else scene.boxes.resize(scene.boxes.size() - 20);
                for (size_t i = scene.boxes.size() - 20; grows && i < scene.boxes.size(); ++i) {
                    scene.boxes[i] = scene.boxes[i - 600];
                    move_by(scene.boxes[i], random, 0.5f);
                    scene.boxes[i].index = next_index++;
                }
                scene.update_and_compare("workers " + std::to_string(workers) + ", frame " + std::to_string(frame));
            }
        }
    }
}

TEST(WideTreeTest, WidthsWriteTheSameLists) {
    for (const std::string& kind : distributions) {
        for (int n : {5, 100, 700}) {
            Boxes fixed = make_boxes(kind, n / 2, 3, 100000), moving = make_boxes(kind, n, 4);
            Scene reference(fixed, moving, widths[0]);
            Pairs pairs = all_pairs(reference.tree, reference.tasks);
            ASSERT_EQ(sorted(pairs), expected_pairs(fixed, moving)) << kind << n;
            Random random(static_cast<uint32_t>(n));
            for (BroadBox& box : reference.boxes) {
                if (random.below(4) == 0) move_by(box, random, 0.4f);
            }
            Lists lists = reference.update();
            for (int width : widths) {
                Scene other(fixed, moving, width);
                EXPECT_EQ(all_pairs(other.tree, other.tasks), pairs) << kind << n << ' ' << width;
                other.boxes = reference.boxes;
                EXPECT_EQ(other.update(), lists) << kind << n << ' ' << width;
                EXPECT_EQ(all_pairs(other.tree, other.tasks), all_pairs(reference.tree, reference.tasks));
            }
        }
    }
}

// More groups than a list of those to be looked at holds, all near one box.
TEST(WideTreeTest, ABoxMayBeNearAllGroups) {
    constexpr size_t n = 14000;
    Boxes before = make_boxes("uniform", n, 6);
    const float side = 40;
    before[9] = box_around({side / 2, side / 2, side / 2}, {side, side, side / 4}, before[9].index);
    Boxes after = before;
    Random random(8);
    for (size_t i = 9; i < n; i += 50) move_by(after[i], random, 0.3f);
    Pairs old = pairs_by_sweep(before, 2), now = pairs_by_sweep(after, 2);
    Lists expected;
    std::set_difference(now.begin(), now.end(), old.begin(), old.end(), std::back_inserter(expected.begun));
    std::set_difference(old.begin(), old.end(), now.begin(), now.end(), std::back_inserter(expected.ended));
    ASSERT_GT(expected.begun.size(), 100u);

    std::vector<BoxQuery> queries;
    for (size_t i = 0; i < 130; ++i) {
        BroadBox box = after[i % 3 ? i : 9];  // every third meets nearly half of all
        queries.push_back({{box.lower[0], box.lower[1], box.lower[2]}, {box.upper[0], box.upper[1], box.upper[2]}});
    }
    for (int width : widths) {
        Scene scene({}, before, width);
        scene.boxes = after;
        EXPECT_EQ(scene.update(), expected) << width;
        EXPECT_STREQ(scene.tree.check(), "");
        Array<BoxPair> found;
        {
            PairList list(found, true);
            scene.tree.find_hits(queries.data(), 0, static_cast<int>(queries.size()), list);
        }
        size_t next = 0;
        for (size_t i = 0; i < queries.size(); ++i) {
            scene.tree.visit_overlapping(queries[i].lower, queries[i].upper, [&](uint32_t index) {
                bool same = next < found.size() && found[next].a == i && found[next].b == index;
                ASSERT_TRUE(same) << width << ' ' << i;
                ++next;
            });
        }
        EXPECT_EQ(next, found.size());
        EXPECT_GT(next, n * 10);
    }
}

TEST(WideTreeTest, WorkersWriteTheSameLists) {
    Boxes fixed = make_boxes("ground", 3000, 3, 100000), moving = make_boxes("clustered", 9000, 4);
    Scene reference(fixed, moving);
    Pairs pairs = all_pairs(reference.tree, reference.tasks);
    Random random(5);
    for (BroadBox& box : reference.boxes) {
        if (random.below(3) == 0) move_by(box, random, 0.4f);
    }
    Lists lists = reference.update();
    EXPECT_FALSE(lists.begun.empty());
    EXPECT_FALSE(lists.ended.empty());
    for (int workers : {2, 5, 8}) {
        Scene other(fixed, moving, 0, workers);
        EXPECT_EQ(all_pairs(other.tree, other.tasks), pairs) << workers;
        other.boxes = reference.boxes;
        EXPECT_EQ(other.update(), lists) << workers;
        EXPECT_STREQ(other.tree.check(), "");
    }
}

TEST(WideTreeTest, BoxesThatMoveALittleKeepTheirLanes) {
    Scene scene(make_boxes("plane", 100, 1, 100000), make_boxes("uniform", 1000, 2));
    Random random(1);
    for (int frame = 0; frame < 40; ++frame) {
        for (BroadBox& box : scene.boxes) {
            if (random.below(20) == 0) move_by(box, random, 0.1f);
        }
        scene.update_and_compare("frame " + std::to_string(frame));
        if (HasFatalFailure()) return;
    }
    EXPECT_EQ(scene.tree.builds(), 1);
}

TEST(WideTreeTest, BoxesNotListedAreNotLookedAt) {
    Scene scene({}, make_boxes("uniform", 1000, 2));
    Boxes rest = scene.boxes;
    auto frame = [&] {  // with box 7 in its place and nonsense in all others
        Boxes poisoned = scene.boxes;
        for (BroadBox& box : poisoned) std::memset(static_cast<void*>(&box), 0xff, sizeof box);
        poisoned[7] = rest[7];
        Array<BoxPair> begun, ended;
        uint32_t changed = 7;
        scene.tree.update(scene.tasks, poisoned.data(), 1000, &changed, 1, begun, ended);
        return Lists{as_written(begun), as_written(ended)};
    };
    Pairs before = expected_pairs({}, rest), after;
    Random random(3);
    for (int k = 0; k < 20; ++k) {
        move_by(rest[7], random, 0.3f);
        Lists lists = frame();
        after = expected_pairs({}, rest);
        Pairs with_begun;
        std::set_union(before.begin(), before.end(), lists.begun.begin(), lists.begun.end(),
                       std::back_inserter(with_begun));
        Pairs left;
        std::set_difference(with_begun.begin(), with_begun.end(), lists.ended.begin(), lists.ended.end(),
                            std::back_inserter(left));
        ASSERT_EQ(left, after);
        before = after;
    }
    EXPECT_EQ(scene.tree.builds(), 1);
}

TEST(WideTreeTest, JumpsWearTheTreeUntilItIsBuiltAnew) {
    Scene scene(make_boxes("plane", 50, 1, 100000), make_boxes("uniform", 800, 2));
    Random random(2);
    for (int frame = 0; frame < 120; ++frame) {
        for (int k = 0; k < 5; ++k) {
            BroadBox& box = scene.boxes[static_cast<size_t>(random.below(800))];
            box = box_around({random.uniform(0, 14), random.uniform(0, 14), random.uniform(0, 14)}, {.4f, .3f, .5f},
                             box.index);
        }
        scene.update_and_compare("frame " + std::to_string(frame));
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(scene.tree.builds(), 1);
    EXPECT_LT(scene.tree.builds(), 60);  // and not at every other jump
}

TEST(WideTreeTest, BoxesThatDriftApartAreBuiltAnew) {
    Scene scene({}, make_boxes("uniform", 1000, 2));
    for (int frame = 0; frame < 30; ++frame) {
        for (BroadBox& box : scene.boxes) {  // every other box to the other side
            float by = box.index % 2 ? 0.2f : -0.2f;
            box.lower[0] += by;
            box.upper[0] += by;
        }
        scene.update_and_compare("frame " + std::to_string(frame));
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(scene.tree.builds(), 1);
}

TEST(WideTreeTest, AllBoxesMovedAtOnceKeepTheirLanesWhileTheyStayNear) {
    Scene scene(make_boxes("plane", 50, 1, 100000), make_boxes("uniform", 1000, 2), 0, 2);
    Random random(5);
    for (int frame = 0; frame < 10; ++frame) {
        for (BroadBox& box : scene.boxes) {
            move_by(box, random, 0.1f);
            box.lower[1] -= 1.0f, box.upper[1] -= 1.0f;  // all of them fall
        }
        scene.move_all_and_compare("frame " + std::to_string(frame));
        if (HasFatalFailure()) return;
    }
    EXPECT_EQ(scene.tree.builds(), 1);
    scene.boxes[7].upper[0] = infinity;  // has to stand beside the tree
    scene.move_all_and_compare("an infinite box");
    EXPECT_EQ(scene.tree.builds(), 2);
    std::swap(scene.boxes[3], scene.boxes[900]);
    scene.move_all_and_compare("two that changed places");
    for (BroadBox& box : scene.boxes) move_by(box, random, 10.0f);
    scene.move_all_and_compare("all elsewhere");
    EXPECT_EQ(scene.tree.builds(), 3);
    scene.boxes.pop_back();
    scene.move_all_and_compare("one gone");
    EXPECT_EQ(scene.tree.builds(), 4);
}

TEST(WideTreeTest, AllBoxesMovedAtOnceAmongOtherChanges) {
    Scene scene(make_boxes("plane", 50, 1, 100000), make_boxes("uniform", 700, 2));
    Random random(6);
    for (int frame = 0; frame < 60; ++frame) {
        const int moved = frame % 3 ? 700 : 20;
        for (int k = 0; k < moved; ++k)
            move_by(scene.boxes[static_cast<size_t>(random.below(static_cast<int>(scene.boxes.size())))], random,
                    frame % 5 ? 0.05f : 3.0f);
        if (frame % 7 == 6) scene.boxes.pop_back();
        if (frame % 3 == 1) scene.move_all_and_compare("frame " + std::to_string(frame));
        else scene.update_and_compare("frame " + std::to_string(frame));
        if (HasFatalFailure()) return;
    }
}

TEST(WideTreeTest, TheLastBoxInTheHoleOfARemovedOneKeepsItsLane) {
    Scene scene(make_boxes("plane", 50, 1, 100000), make_boxes("uniform", 1000, 2));
    Random random(4);
    for (int frame = 0; frame < 60; ++frame) {
        for (int k = 0; k < 3; ++k) {
            scene.boxes[static_cast<size_t>(random.below(static_cast<int>(scene.boxes.size())))] = scene.boxes.back();
            scene.boxes.pop_back();
        }
        scene.update_and_compare("frame " + std::to_string(frame));
        if (HasFatalFailure()) return;
    }
    EXPECT_EQ(scene.tree.builds(), 1);  // moving it to a loose group would have worn the tree
}

TEST(WideTreeTest, BoxesComeAndGoAndBecomeInfinite) {
    for (int width : widths) {
        Scene scene(make_boxes("uniform", 60, 1, 100000), {}, width, 2);
        Random random(6);
        uint32_t next_index = 0;
        for (int frame = 0; frame < 80; ++frame) {
            int come = frame == 40 ? 600 : random.below(20);
            for (const BroadBox& box : make_boxes("uniform", come, static_cast<uint32_t>(frame), next_index)) {
                scene.boxes.push_back(box);
            }
            next_index += static_cast<uint32_t>(come);
            for (BroadBox& box : scene.boxes) {
                if (random.below(100)) continue;
                float& side = box.upper[random.below(3)];
                side = side == inf ? 20 : inf;
            }
            if (frame == 60) scene.boxes.resize(scene.boxes.size() / 10);
            if (frame == 70) std::reverse(scene.boxes.begin(), scene.boxes.end());
            if (frame == 75) scene.boxes.clear();
            scene.update_and_compare(std::to_string(width) + ", frame " + std::to_string(frame));
            if (HasFatalFailure()) return;
        }
    }
}

// Sum of the edge lengths of all groups but the largest ones.
float size_of_groups(const Boxes& boxes, size_t left_out) {
    Scene scene({}, boxes);
    Array<BroadPhaseBox> nodes;
    scene.tree.boxes(nodes);
    int leaf_depth = 0;
    for (const BroadPhaseBox& node : nodes) leaf_depth = std::max(leaf_depth, node.depth);
    std::vector<float> sizes;
    for (const BroadPhaseBox& node : nodes) {
        if (node.leaf || node.depth != leaf_depth - 1) continue;
        float size = 0;
        for (int d = 0; d < 3; ++d) size += node.upper[d] - node.lower[d];
        sizes.push_back(size);
    }
    std::sort(sizes.begin(), sizes.end());
    float sum = 0;
    for (size_t i = 0; i + left_out < sizes.size(); ++i) sum += sizes[i];
    return sum;
}

TEST(WideTreeTest, StraysAndHugeBoxesSpoilOnlyTheirOwnGroups) {
    Boxes boxes = make_boxes("uniform", 4000, 2);
    float usual = size_of_groups(boxes, 0);
    Boxes strays = boxes;
    for (size_t i = 0; i < 3; ++i) {
        strays[1000 * i] =
            box_around({1e6f, 3e5f * static_cast<float>(i), -1e6f}, {.5f, .5f, .5f}, strays[1000 * i].index);
    }
    EXPECT_LT(size_of_groups(strays, 3), 1.3f * usual);
    Boxes huge = boxes;
    for (size_t i = 0; i < 40; ++i) huge[100 * i] = box_around({8, 8, 8}, {500, 1, 500}, huge[100 * i].index);
    EXPECT_LT(size_of_groups(huge, 2), 1.3f * usual);  // forty boxes, in two groups at most
}

TEST(WideTreeTest, SwarmsFarApartAreResolved) {
    Boxes near = make_boxes("uniform", 2000, 2), far = near;
    for (size_t i = 0; i < far.size(); ++i) {  // two swarms, each tiny beside their distance
        for (int d = 0; d < 3; ++d) {
            float by = i % 2 ? 4096.0f : 0.0f;
            far[i].lower[d] += by;
            far[i].upper[d] += by;
        }
    }
    // Half as dense, so a group is 2^(1/3) as long; a few groups, however many boxes there are, reach from one swarm to
    // the other where the order of slabs and strips goes across.
    EXPECT_LT(size_of_groups(far, 5), 1.6f * size_of_groups(near, 0));
}

}  // namespace
