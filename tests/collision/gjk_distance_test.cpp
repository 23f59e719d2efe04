// Distance and depth of polytopes against the oracle, in the regimes of the acceptance list: far, near, touching,
// slightly and deeply overlapping; at three scales, with both simplex solvers.
#include "gjk_fixture.h"

namespace lendulet::gjk_test {
namespace {

struct Regime {
    const char* name;
    float lo, hi;  // wanted distance in units of the scale
};
constexpr Regime regimes[] = {{"far", 0.1f, 2.0f},
                              {"near", 1e-4f, 1e-2f},
                              {"touch", 0.0f, 0.0f},
                              {"overlap", -0.05f, -1e-3f},
                              {"deep", -0.5f, -0.1f}};

float wanted_distance(Random& random, const Regime& regime, float scale) {
    if (regime.lo > 0.0f) return scale * random.log_uniform(regime.lo, regime.hi);
    return scale * random.uniform(regime.lo, regime.hi);
}

template <class MakeCore>
void compare_with_oracle(const char* what, int count, double mean_iterations, MakeCore make_core) {
    Random random(11);
    for (float scale : scales)
        for (const Regime& regime : regimes) {
            Tally tally(std::string(what) + " " + regime.name + " " + std::to_string(scale));
            for (int i = 0; i < count; ++i) {
                Core a = make_core(random, scale), b = make_core(random, scale);
                Transform t = place(random, a, b, wanted_distance(random, regime, scale));
                oracle::Answer answer = oracle_answer(a, b, t);
                for (SimplexSolver method : both_methods) tally.judge(a, b, t, query(a, b, t, method), answer);
            }
            EXPECT_LE(tally.max_iterations, 24) << tally.name;
            EXPECT_LE(tally.max_expansions, 64) << tally.name;
            EXPECT_LE(tally.iterations, mean_iterations * tally.count) << tally.name;
            EXPECT_LE(tally.expansions, 8.0 * tally.count) << tally.name;
        }
}

TEST(GjkDistance, BoxesAgreeWithTheOracle) {
    compare_with_oracle("boxes", cases(33400), 4.0,
                        [](Random& random, float scale) { return random_box(random, scale); });
}

TEST(GjkDistance, HullsAgreeWithTheOracle) {
    // To make a hull for the oracle takes longer than to ask it: pairs are drawn from a stock.
    constexpr int stock = 120;
    std::vector<Core> hulls;
    float made_at = 0.0f;
    compare_with_oracle("hulls", cases(1340), 5.0, [&](Random& random, float scale) {
        if (scale != made_at) hulls.clear(), made_at = scale;
        while (hulls.size() < stock) hulls.push_back(random_hull(random, scale, 64));
        return hulls[static_cast<size_t>(random.integer(stock))];
    });
}

TEST(GjkDistance, MixedCoresAgreeWithTheOracle) {
    compare_with_oracle("mixed", cases(6700), 4.0, [](Random& random, float scale) {
        switch (random.integer(5)) {
            case 0:
                return make_point();
            case 1:
                return make_segment(scale * random.uniform(0.1f, 1.0f));
            case 2:
                return make_triangle(scale * random.direction(), scale * random.direction(),
                                     scale * random.direction());
            case 3:
                return random_box(random, scale);
            default:
                return random_hull(random, scale, 12);
        }
    });
}

}  // namespace
}  // namespace lendulet::gjk_test
