// Who overlaps whom, for peers that answer box queries but do not report changes: the list of a box that moved is
// compared with what the tree now finds.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/memory.h"
#include "broad_phase/box.h"

namespace lendulet::bench {

class Neighbours {
public:
    void reset(size_t count) {
        for (std::vector<uint32_t>& list : lists_) list.clear();
        lists_.resize(count);
    }
    void add(uint32_t a, uint32_t b) {
        insert(lists_[a], b);
        insert(lists_[b], a);
    }

    // `now` is what the tree finds for box `a` (itself may be among it); it is sorted here.
    void compare(uint32_t a, std::vector<uint32_t>& now, Array<BoxPair>& begun, Array<BoxPair>& ended) {
        std::sort(now.begin(), now.end());
        before_ = lists_[a];  // lists_[a] changes below
        size_t i = 0;
        for (uint32_t b : now) {
            if (b == a) continue;
            for (; i < before_.size() && before_[i] < b; ++i) end(a, before_[i], ended);
            if (i < before_.size() && before_[i] == b) {
                ++i;
            } else {
                add(a, b);
                begun.push_back(ordered(a, b));
            }
        }
        for (; i < before_.size(); ++i) end(a, before_[i], ended);
    }

private:
    static BoxPair ordered(uint32_t a, uint32_t b) { return a < b ? BoxPair{a, b} : BoxPair{b, a}; }
    static void insert(std::vector<uint32_t>& list, uint32_t b) {
        list.insert(std::lower_bound(list.begin(), list.end(), b), b);
    }
    static void erase(std::vector<uint32_t>& list, uint32_t b) {
        list.erase(std::lower_bound(list.begin(), list.end(), b));
    }
    void end(uint32_t a, uint32_t b, Array<BoxPair>& ended) {
        erase(lists_[a], b);
        erase(lists_[b], a);
        ended.push_back(ordered(a, b));
    }

    std::vector<std::vector<uint32_t>> lists_;  // ascending
    std::vector<uint32_t> before_;
};

}  // namespace lendulet::bench
