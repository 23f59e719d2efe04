// A structure under measurement: one of ours or a peer's. Every subject gets the same boxes and must give the same
// pairs.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/memory.h"
#include "bench/broad_phase/workload.h"
#include "broad_phase/box.h"

namespace lendulet::bench {

class Subject {
public:
    virtual ~Subject() = default;

    // Takes in both sets from nothing: what an earlier call built must not help.
    virtual void load(const Boxes& fixed, const Boxes& moving) = 0;
    // Appends all pairs of the moving set with itself and with the fixed one, each once, in any order. load() and
    // find_pairs() together are a frame of the modes `rebuild` and `split`.
    virtual void find_pairs(Array<BoxPair>& pairs) = 0;

    // A frame of the mode `refit`: the boxes at the `changed` places (ascending) are new, the fixed set is empty, box i
    // has index i. Appends the pairs that begin and those that end. Follows load() and find_pairs(), or another
    // update().
    virtual void update(const Boxes& moving, const std::vector<uint32_t>& changed, Array<BoxPair>& begun,
                        Array<BoxPair>& ended) = 0;

    // For each box asked for, appends the indices of all boxes loaded that overlap it; those of query i end in `hits`
    // at ends[i].
    virtual void query(const Boxes& queries, Array<uint32_t>& hits, std::vector<uint32_t>& ends) = 0;
};

struct SubjectType {
    std::string name;  // as in the CSV
    bool ours;
    std::function<std::unique_ptr<Subject>()> make;
};

// All structures of this engine, then the peers this program was built with.
const std::vector<SubjectType>& all_subjects();
// The peers it was built without: "Boost.Geometry (libboost-dev)", ...
const std::vector<std::string>& missing_peers();

// Defined where the peer was found when the build was configured.
void add_boost(std::vector<SubjectType>& types);
void add_libspatialindex(std::vector<SubjectType>& types);
void add_bullet(std::vector<SubjectType>& types);

}  // namespace lendulet::bench
