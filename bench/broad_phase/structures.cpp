// This engine's broad phases as subjects, on one thread, and the list of all subjects.
#include "bench/broad_phase/subject.h"
#include "broad_phase/broad_phase.h"

namespace lendulet::bench {
namespace {

class Ours final : public Subject {
public:
    explicit Ours(BroadPhaseType type) : broad_phase_(type, nullptr), remembers_(remembers(type)) {}

    void load(const Boxes& fixed, const Boxes& moving) override {
        if (remembers_) broad_phase_.set_moving(nullptr, 0);
        if (has_fixed_ || !fixed.empty()) {
            if (remembers_) broad_phase_.set_fixed(nullptr, 0);
            broad_phase_.set_fixed(fixed.data(), static_cast<int>(fixed.size()));
            has_fixed_ = !fixed.empty();
        }
        broad_phase_.set_moving(moving.data(), static_cast<int>(moving.size()));
    }

    void find_pairs(Array<BoxPair>& pairs) override { broad_phase_.find_pairs(tasks_, pairs); }

    void update(const Boxes& moving, const std::vector<uint32_t>& changed, Array<BoxPair>& begun,
                Array<BoxPair>& ended) override {
        broad_phase_.update(tasks_, moving.data(), static_cast<int>(moving.size()), changed.data(),
                            static_cast<int>(changed.size()), begun, ended);
    }

    void query(const Boxes& queries, Array<uint32_t>& hits, std::vector<uint32_t>& ends) override {
        batch_.clear();
        for (const BroadBox& box : queries)
            batch_.push_back({{box.lower[0], box.lower[1], box.lower[2]}, {box.upper[0], box.upper[1], box.upper[2]}});
        broad_phase_.query_boxes(tasks_, batch_.data(), static_cast<int>(batch_.size()), offsets_, hits);
        ends.assign(offsets_.begin() + 1, offsets_.end());
    }

private:
    // The sweeps keep their order and rtree-omt refits where boxes are set that it may know again: to start from
    // nothing they are emptied first. The others build whatever they had.
    static bool remembers(BroadPhaseType type) {
        return type == BroadPhaseType::sweep_1 || type == BroadPhaseType::sweep_3 || type == BroadPhaseType::rtree_omt;
    }

    TaskPool tasks_{1};
    BroadPhase broad_phase_;
    bool remembers_;
    bool has_fixed_ = false;
    std::vector<BoxQuery> batch_;
    Array<uint32_t> offsets_;
};

std::vector<SubjectType> list_subjects() {
    std::vector<SubjectType> types;
    for (int i = 0; i < broad_phase_types; ++i) {
        BroadPhaseType type = static_cast<BroadPhaseType>(i);
        types.push_back({std::string(name_of(type)), true, [type] { return std::make_unique<Ours>(type); }});
    }
#ifdef LENDULET_BENCH_BOOST
    add_boost(types);
#endif
#ifdef LENDULET_BENCH_SPATIALINDEX
    add_libspatialindex(types);
#endif
#ifdef LENDULET_BENCH_BULLET
    add_bullet(types);
#endif
    return types;
}

}  // namespace

const std::vector<SubjectType>& all_subjects() {
    static const std::vector<SubjectType> types = list_subjects();
    return types;
}

const std::vector<std::string>& missing_peers() {
    static const std::vector<std::string> missing = {
#ifndef LENDULET_BENCH_BOOST
        "Boost.Geometry (libboost-dev)",
#endif
#ifndef LENDULET_BENCH_SPATIALINDEX
        "libspatialindex (libspatialindex-dev)",
#endif
#ifndef LENDULET_BENCH_BULLET
        "Bullet (libbullet-dev)",
#endif
    };
    return missing;
}

}  // namespace lendulet::bench
