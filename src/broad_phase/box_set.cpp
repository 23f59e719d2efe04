#include "broad_phase/box_set.h"

#include "broad_phase/block_fill.h"

namespace lendulet {

void BoxSet::assign(const BroadBox* boxes, int count) {
    const auto lanes = (static_cast<size_t>(count) + block_size - 1) / block_size * block_size;
    blocks.resize_unset(lanes / block_size);
    index.resize_unset(lanes);
    BoxBlock* block = blocks.data();
    uint32_t* next_index = index.data();
    for (int left = count; left > 0; left -= block_size, ++block) {
        for (int half = 0; half < block_size; half += 4, boxes += 4, next_index += 4) {
            if (half >= left) {
                clear_half(*block, half);
                break;
            }
            Float4 low[4], high[4];
            auto load = [&](int i, const BroadBox& box) {
                low[i] = load_wide<Float4>(box.lower);
                high[i] = load_wide<Float4>(box.upper);
            };
            if (half + 4 <= left) {
                for (int i = 0; i < 4; ++i) load(i, boxes[i]);
            } else {
                for (int i = 0; i < 4; ++i) load(i, half + i < left ? boxes[i] : empty_box);
            }
            store_quad(*block, half, next_index, low, high);
        }
    }
    index.resize_unset(static_cast<size_t>(count));
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
