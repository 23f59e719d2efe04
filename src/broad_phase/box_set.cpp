#include "broad_phase/box_set.h"

namespace lendulet {

void BoxSet::assign(const BroadBox* boxes, int count) {
    const auto lanes = (static_cast<size_t>(count) + block_size - 1) / block_size * block_size;
    blocks.resize_unset(lanes / block_size);
    index.resize_unset(lanes);
    kernels->fill(boxes, count, blocks.data(), index.data());
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
