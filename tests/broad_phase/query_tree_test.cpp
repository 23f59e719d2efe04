// The tree of queries finds what a scan of all boxes does, however its boxes came into it.
#include "broad_phase/query_tree.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "broad_phase/support.h"
#include "scale.h"

namespace lendulet {
namespace {

using broad_phase_test::Random;

struct Model {
    Memory memory{};
    QueryTree tree{&memory};
    std::vector<BroadBox> boxes;  // by index; of those that are gone the index is no_box

    BroadBox random_box(Random& random, uint32_t index) {
        BroadBox b{{}, index, {}, 0u};
        const float size = random.uniform(0.01f, 2.0f);
        for (int d = 0; d < 3; ++d) {
            b.lower[d] = random.uniform(-20.0f, 20.0f);
            b.upper[d] = b.lower[d] + size;
        }
        if (random.below(50) == 0) b.lower[1] = -infinity;
        return b;
    }
    void build() {
        std::vector<BroadBox> alive;
        for (const BroadBox& b : boxes)
            if (b.index != no_box) alive.push_back(b);
        tree.build(alive.data(), static_cast<int>(alive.size()));
    }
    void change(Random& random) {
        const auto i = static_cast<uint32_t>(random.below(static_cast<int>(boxes.size()) + 1));
        if (i == boxes.size()) boxes.push_back({{}, no_box, {}, 0u});
        if (boxes[i].index == no_box) {
            boxes[i] = random_box(random, i);
            tree.insert(boxes[i]);
        } else if (random.below(3) == 0) {
            boxes[i].index = no_box;
            tree.remove(i);
        } else {
            boxes[i] = random_box(random, i);
            tree.move(boxes[i]);
        }
    }
    void expect_right(Random& random) const {
        const BroadBox asked = const_cast<Model*>(this)->random_box(random, 0);
        std::vector<uint32_t> found, expected;
        tree.overlapping(asked.lower, asked.upper, [&](uint32_t index) { found.push_back(index); });
        std::sort(found.begin(), found.end());
        EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "one was found twice";
        int alive = 0;
        for (const BroadBox& b : boxes) {
            if (b.index == no_box) continue;
            ++alive;
            EXPECT_TRUE(tree.holds(b.index));
            if (overlap(b, asked.lower, asked.upper)) expected.push_back(b.index);
        }
        EXPECT_EQ(tree.count(), alive);
        EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
        for (uint32_t index : found) EXPECT_LT(index, boxes.size());
        for (uint32_t index : found) EXPECT_NE(boxes[index].index, no_box) << "it is gone";
    }
};

TEST(QueryTree, FollowsBoxesThatComeGoAndMove) {
    for (uint32_t start : {0u, 1u, 7u, 300u}) {
        Random random(start + 1);
        Model m;
        for (uint32_t i = 0; i < start; ++i) m.boxes.push_back(m.random_box(random, i));
        m.build();
        for (int round = 0; round < scaled(400); ++round) {
            for (int k = random.below(20); k >= 0; --k) m.change(random);
            m.expect_right(random);
            if (m.tree.is_worn()) m.build();
            m.expect_right(random);
        }
    }
}

TEST(QueryTree, RefitsAfterChanges) {
    Random random(3);
    Model m;
    for (uint32_t i = 0; i < 200; ++i) m.boxes.push_back(m.random_box(random, i));
    m.build();
    for (int round = 0; round < 50; ++round) {
        for (int k = 0; k < 10; ++k) m.change(random);
        for (BroadBox& b : m.boxes)
            for (int d = 0; d < 3 && b.index != no_box; ++d) b.lower[d] += 0.1f, b.upper[d] += 0.1f;
        EXPECT_TRUE(m.tree.refit(m.boxes.data()));
        m.expect_right(random);
    }
}

// Boxes one inside the other: every one that comes goes a level deeper.
TEST(QueryTree, StaysShallowEnoughToSearch) {
    Random random(4);
    Model m;
    float size = 1e6f;
    for (uint32_t i = 0; i < 2000; ++i, size *= 0.99f) {
        m.boxes.push_back({{0.0f, 0.0f, 0.0f}, i, {size, size, size}, 0u});
        m.tree.insert(m.boxes.back());
    }
    EXPECT_TRUE(m.tree.is_worn());
    const float lower[3] = {0.0f, 0.0f, 0.0f}, upper[3] = {1e-6f, 1e-6f, 1e-6f};
    size_t found = 0;
    m.tree.overlapping(lower, upper, [&](uint32_t) { ++found; });
    EXPECT_EQ(found, m.boxes.size());
}

TEST(QueryTree, BecomesWornAsItGrows) {
    Random random(5);
    Model m;
    for (uint32_t i = 0; i < 300; ++i) m.boxes.push_back(m.random_box(random, i));
    m.build();
    EXPECT_FALSE(m.tree.is_worn());
    for (uint32_t i = 300; i < 700; ++i) {
        m.boxes.push_back(m.random_box(random, i));
        m.tree.insert(m.boxes.back());
    }
    EXPECT_TRUE(m.tree.is_worn());
    m.build();
    EXPECT_FALSE(m.tree.is_worn());
}

// Casts of both widths, one by one and by turns, visit every box that they meet, each once.
struct Visited {
    std::vector<std::vector<uint32_t>> of;
    float* limit;
    static float one(void* context, uint32_t index) {
        static_cast<Visited*>(context)->of[0].push_back(index);
        return *static_cast<Visited*>(context)->limit;
    }
    static void many(void* context, const CastVisit* visits, int count) {
        for (int k = 0; k < count; ++k)
            static_cast<Visited*>(context)->of[static_cast<size_t>(visits[k].cast)].push_back(visits[k].index);
    }
};

SweptBox random_cast(Random& random) {
    SweptBox s;
    for (int d = 0; d < 3; ++d) {
        s.origin[d] = random.uniform(-25.0f, 25.0f);
        s.translation[d] = random.below(4) == 0 ? (random.below(2) ? 0.0f : -0.0f) : random.uniform(-40.0f, 40.0f);
        s.half[d] = random.below(2) ? 0.0f : random.uniform(0.0f, 1.0f);
    }
    return s;
}

// In double; `slack` is how much nearer than that a box may be.
bool crosses(const BroadBox& b, const SweptBox& s, double limit, double slack) {
    double enter = 0.0, leave = limit;
    for (int d = 0; d < 3; ++d) {
        const double low = double{b.lower[d]} - s.half[d] - slack, high = double{b.upper[d]} + s.half[d] + slack;
        const double from = s.origin[d], along = s.translation[d];
        if (along == 0.0) {
            if (from < low || from > high) return false;
            continue;
        }
        enter = std::max(enter, std::min((low - from) / along, (high - from) / along));
        leave = std::min(leave, std::max((low - from) / along, (high - from) / along));
    }
    return enter <= leave;
}

TEST(QueryTree, CastsVisitWhatTheyMeet) {
    Random random(6);
    for (int size : {1, 3, 40, 600}) {
        Model m;
        for (uint32_t i = 0; i < static_cast<uint32_t>(size); ++i) {
            m.boxes.push_back(m.random_box(random, i));
            m.boxes.back().lower[1] = std::max(m.boxes.back().lower[1], -20.0f);
        }
        m.build();
        std::vector<SweptBox> casts;
        std::vector<float> limits;
        for (int i = 0; i < scaled(200, 50); ++i) {
            casts.push_back(random_cast(random));
            limits.push_back(random.uniform(0.0f, 1.0f));
        }
        for (int width : {4, 0}) {
            Visited all{std::vector<std::vector<uint32_t>>(casts.size()), limits.data()};
            ManyCasts many{{},
                           0,
                           casts.data(),
                           limits.data(),
                           static_cast<int>(casts.size()),
                           &all,
                           Visited::many,
                           reinterpret_cast<const char*>(m.boxes.data()),
                           sizeof(BroadBox)};
            m.tree.add_to(many);
            ASSERT_EQ(many.tree_count, 1);
            query_tree_casts(width)(many);
            for (size_t i = 0; i < casts.size(); ++i) {
                Visited single{std::vector<std::vector<uint32_t>>(1), &limits[i]};
                query_tree_cast(width)(many.trees[0], casts[i], limits[i], {Visited::one, &single});
                std::vector<uint32_t>&found = all.of[i], &alone = single.of[0];
                std::sort(found.begin(), found.end());
                std::sort(alone.begin(), alone.end());
                EXPECT_EQ(found, alone);
                EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "one was found twice";
                for (const BroadBox& b : m.boxes) {
                    const bool visited = std::binary_search(found.begin(), found.end(), b.index);
                    EXPECT_TRUE(visited || !crosses(b, casts[i], limits[i], 0.0));
                    EXPECT_TRUE(!visited || crosses(b, casts[i], limits[i], 1e-3));
                }
            }
        }
    }
}

}  // namespace
}  // namespace lendulet
