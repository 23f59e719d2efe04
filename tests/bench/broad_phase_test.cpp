// The benchmark of broad phases: what it measures on, and that it notices who finds other pairs.
#include <gtest/gtest.h>

#include <set>

#include "bench/broad_phase/report.h"
#include "broad_phase/block.h"

namespace lendulet::bench {
namespace {

long brute_force(const Boxes& boxes) {
    long pairs = 0;
    for (size_t i = 0; i < boxes.size(); ++i) {
        for (size_t j = i + 1; j < boxes.size(); ++j) pairs += overlap(boxes[i], boxes[j].lower, boxes[j].upper);
    }
    return pairs;
}

TEST(Workload, DistributionsAreWhatTheyAreCalled) {
    for (Distribution distribution : all_distributions) {
        Boxes boxes = make_boxes(distribution, 2000);
        ASSERT_EQ(boxes.size(), 2000u);
        for (uint32_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(boxes[i].index, i);
    }
    EXPECT_NEAR(static_cast<double>(brute_force(make_boxes(Distribution::uniform, 2000))) / 2000, 0.5, 0.1);
    EXPECT_GT(brute_force(make_boxes(Distribution::clustered, 2000)), 3 * 2000 / 2);
    EXPECT_GE(brute_force(make_boxes(Distribution::one_huge, 2000)), 1999);
    EXPECT_EQ(make_boxes(Distribution::ground, 10)[0].upper[1], 0.0f);
}

TEST(Workload, OneBoxInTwentyMovesByHalfItsExtentAtMost) {
    Motion motion(Distribution::one_huge, make_boxes(Distribution::one_huge, 1000));
    for (int frame = 0; frame < 200; ++frame) {
        Boxes before = motion.boxes();
        std::vector<uint32_t> changed = motion.next_frame();
        ASSERT_GE(changed.size(), 40u);  // 49 draws, some of them equal
        ASSERT_LE(changed.size(), 50u);
        std::set<uint32_t> moved(changed.begin(), changed.end());
        for (uint32_t i = 0; i < before.size(); ++i) {
            for (int d = 0; d < 3; ++d) {
                float way = motion.boxes()[i].lower[d] - before[i].lower[d];
                EXPECT_LE(std::abs(way), moved.contains(i) ? 0.51f : 0.0f) << i;
            }
        }
    }
    const Boxes home = make_boxes(Distribution::one_huge, 1000);
    EXPECT_EQ(motion.boxes()[0].lower[0], home[0].lower[0]);
    for (size_t i = 0; i < home.size(); ++i) EXPECT_LT(std::abs(motion.boxes()[i].lower[0] - home[i].lower[0]), 1.6f);
}

TEST(BroadPhaseBench, EveryStructureAndPeerFindsTheSameInEveryMode) {
    Bench bench(all_subjects(), 1);
    for (Distribution distribution : all_distributions) {
        for (int n : {1, 2, 60}) {
            for (Mode mode : all_modes) {
                CellResult result = bench.measure({distribution, n, mode});
                EXPECT_EQ(result.rows.size(), all_subjects().size());
                for (const std::string& sentence : result.different) ADD_FAILURE() << sentence;
            }
        }
    }
}

// Two subjects that need no boxes: one leaves out what the other finds, or finds it at another place.
class Stub final : public Subject {
public:
    explicit Stub(uint32_t found) : found_(found) {}
    void load(const Boxes&, const Boxes&) override {}
    void find_pairs(Array<BoxPair>& pairs) override { pairs.push_back({0, found_}); }
    void update(const Boxes&, const std::vector<uint32_t>&, Array<BoxPair>& begun, Array<BoxPair>& ended) override {
        if (found_ == 1) begun.push_back({0, 1});
        else ended.push_back({0, 1});
    }
    void query(const Boxes& queries, Array<uint32_t>& hits, std::vector<uint32_t>& ends) override {
        for (size_t i = 0; i < queries.size(); ++i) {
            if (i == found_) hits.push_back(0);
            ends.push_back(static_cast<uint32_t>(hits.size()));
        }
    }

private:
    uint32_t found_;
};

TEST(BroadPhaseBench, DifferencesAreFound) {
    SubjectType right{"right", true, [] { return std::make_unique<Stub>(1); }};
    SubjectType wrong{"wrong", false, [] { return std::make_unique<Stub>(2); }};
    for (Mode mode : all_modes) {
        CellResult same = Bench({right, right}, 2).measure({Distribution::uniform, 10, mode});
        EXPECT_TRUE(same.different.empty());
        CellResult result = Bench({right, wrong}, 2).measure({Distribution::uniform, 10, mode});
        ASSERT_FALSE(result.different.empty()) << name_of(mode);
        EXPECT_NE(result.different[0].find("wrong finds other ones"), std::string::npos) << result.different[0];
    }
}

// Takes N^2 nanoseconds to load.
class Slow final : public Subject {
public:
    void load(const Boxes&, const Boxes& moving) override {
        double n = static_cast<double>(moving.size()), end = thread_ns() + n * n;
        while (thread_ns() < end) {}
    }
    void find_pairs(Array<BoxPair>&) override {}
    void update(const Boxes&, const std::vector<uint32_t>&, Array<BoxPair>&, Array<BoxPair>&) override {}
    void query(const Boxes&, Array<uint32_t>&, std::vector<uint32_t>&) override {}
};

TEST(BroadPhaseBench, LongFramesAreLeftOutWithASentence) {
    SubjectType slow{"slow", true, [] { return std::make_unique<Slow>(); }};
    CellResult result = Bench({slow}, 1).measure({Distribution::uniform, 200000, Mode::rebuild});
    EXPECT_TRUE(result.rows.empty());
    EXPECT_NE(cell_table(result).find("slow is left out: it would take about"), std::string::npos);
}

TEST(BroadPhaseBench, Csv) {
    std::vector<Row> rows{{"sweep-1", {Distribution::one_huge, 100, Mode::split}, 1234.56, 78}};
    EXPECT_EQ(broad_phase_csv(rows),
              "structure,distribution,n,mode,median_ns,pairs\nsweep-1,one-huge,100,split,1234.6,78\n");
}

}  // namespace
}  // namespace lendulet::bench
