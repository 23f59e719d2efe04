// Sort-and-sweep on one axis (thesis 5.1; Baraff 1992): boxes sorted by where they begin on the axis along which their
// centres scatter most; each is tested against those that begin before it ends. Fast for hundreds of boxes and for long
// scenes; time grows as N^(5/3) for boxes spread over a cube.
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/block.h"
#include "broad_phase/box.h"
#include "broad_phase/pair_chunks.h"

namespace lendulet {

class Sweep {
public:
    explicit Sweep(const Memory* memory)
        : fixed_(memory), moving_(memory), keys_(memory), keys_swap_(memory), chunks_(memory) {}

    void set_fixed(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void set_moving(const BroadBox* boxes, int count, TaskPool* tasks = nullptr);
    void find_pairs(TaskPool& tasks, Array<BoxPair>& out);
    void query_box(const float lower[3], const float upper[3], Array<uint32_t>& out) const;
    uint32_t ray(const float origin[3], const float translation[3], float max_t, float& t) const;
    void boxes(Array<BroadPhaseBox>& out) const;
    size_t bytes() const;

private:
    // Boxes in the order in which they begin on the axis; coordinates in arrays of their own, the sweep's axis first.
    struct Sorted {
        Array<float> lower[3], upper[3];
        Array<uint32_t> index;
        int axis = 0;
        explicit Sorted(const Memory* memory);
        int count() const { return index.count(); }
        void coordinates(int i, float box_lower[3], float box_upper[3]) const;  // in the order x, y, z
        int first_at_or_after(float x) const;
        int first_after(float x) const;
        size_t bytes() const;
    };
    void sort_into(Sorted& set, const BroadBox* boxes, int count);
    static void sweep_from(const Sorted& from, int i, const Sorted& over, int first, PairList& out);

    Sorted fixed_, moving_;
    const BroadBox* fixed_boxes_ = nullptr;
    int fixed_count_ = 0, axis_ = 0;
    Array<uint64_t> keys_, keys_swap_;
    PairChunks chunks_;
};

}  // namespace lendulet
