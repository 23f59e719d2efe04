#include "broad_phase/box_set.h"

#include "math/wide/gather.h"

namespace lendulet {

void BoxSet::assign(const BroadBox* boxes, int count) {
    int block_count = (count + block_size - 1) / block_size;
    blocks.resize_unset(static_cast<size_t>(block_count));
    index.resize_unset(static_cast<size_t>(count));
    constexpr int row = static_cast<int>(sizeof(BroadBox) / sizeof(float));
    int i = 0;
    for (; i + 4 <= count; i += 4) {  // rows to lanes
        Float4 low[4], high[4];
        load4<4>(floats_of(boxes), i, row, 0, low);
        load4<4>(floats_of(boxes), i, row, row / 2, high);
        BoxBlock& block = blocks.data()[i / block_size];
        for (int d = 0; d < 3; ++d) {
            store_wide(block.lower[d] + i % block_size, low[d]);
            store_wide(block.upper[d] + i % block_size, high[d]);
        }
        std::memcpy(index.data() + i, &low[3], sizeof low[3]);  // the word behind `lower` is the index
    }
    for (; i < count; ++i) {
        set_lane(blocks[i / block_size], i % block_size, boxes[i].lower, boxes[i].upper);
        index[i] = boxes[i].index;
    }
    for (; i < block_count * block_size; ++i) clear_lane(blocks[i / block_size], i % block_size);
}

void BoxSet::append_boxes(Array<BroadPhaseBox>& out) const {
    for (int i = 0; i < count(); ++i) {
        const BroadBox b = box(i);
        out.push_back({{b.lower[0], b.lower[1], b.lower[2]}, {b.upper[0], b.upper[1], b.upper[2]}, 0, true, b.index});
    }
}

const char* BoxSet::check() const {
    if (blocks.count() != (count() + block_size - 1) / block_size) return "blocks do not fit boxes";
    for (int i = count(); i < blocks.count() * block_size; ++i) {
        if (!(lower(0, i) > upper(0, i))) return "a lane without a box is set";
    }
    return "";
}

}  // namespace lendulet
