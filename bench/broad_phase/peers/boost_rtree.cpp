// Boost.Geometry's R-tree (https://www.boost.org/libs/geometry, 1.74 in Debian 12): quadratic and R* by insertion, and
// bulk-loaded ("packing"), sixteen children a node.
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

#include "bench/broad_phase/peers/neighbours.h"
#include "bench/broad_phase/subject.h"

namespace lendulet::bench {
namespace {

namespace geometry = boost::geometry;
namespace index = boost::geometry::index;

using Point = geometry::model::point<float, 3, geometry::cs::cartesian>;
using Box = geometry::model::box<Point>;
using Value = std::pair<Box, uint32_t>;

Box to_boost(const BroadBox& box) {
    return {Point(box.lower[0], box.lower[1], box.lower[2]), Point(box.upper[0], box.upper[1], box.upper[2])};
}
Value to_value(const BroadBox& box) { return {to_boost(box), box.index}; }

template <class Parameters, bool packing>
class BoostTree final : public Subject {
public:
    void load(const Boxes& fixed, const Boxes& moving) override {
        fill(fixed_, fixed);
        fill(moving_, moving);
        boxes_ = moving;
        neighbours_known_ = false;
    }

    // In the order of the tree, so that one search finds in the cache what the last one read.
    void find_pairs(Array<BoxPair>& pairs) override {
        for (const Value& value : moving_) {
            uint32_t a = value.second;
            auto keep_later = [&](const Value& hit) {
                if (hit.second > a) pairs.push_back({a, hit.second});
            };
            auto keep = [&](const Value& hit) {
                pairs.push_back(a < hit.second ? BoxPair{a, hit.second} : BoxPair{hit.second, a});
            };
            moving_.query(index::intersects(value.first), boost::make_function_output_iterator(keep_later));
            if (!fixed_.empty())
                fixed_.query(index::intersects(value.first), boost::make_function_output_iterator(keep));
        }
    }

    void update(const Boxes& moving, const std::vector<uint32_t>& changed, Array<BoxPair>& begun,
                Array<BoxPair>& ended) override {
        if (!neighbours_known_) learn_neighbours();
        if (packing) fill(moving_, moving);
        for (uint32_t place : changed) {
            if (!packing) {
                moving_.remove(to_value(boxes_[place]));
                moving_.insert(to_value(moving[place]));
            }
            boxes_[place] = moving[place];
        }
        for (uint32_t place : changed) {
            find(moving_, moving[place], found_);
            neighbours_.compare(moving[place].index, found_, begun, ended);
        }
    }

    void query(const Boxes& queries, Array<uint32_t>& hits, std::vector<uint32_t>& ends) override {
        auto keep = [&](const Value& hit) { hits.push_back(hit.second); };
        for (const BroadBox& box : queries) {
            moving_.query(index::intersects(to_boost(box)), boost::make_function_output_iterator(keep));
            ends.push_back(static_cast<uint32_t>(hits.size()));
        }
    }

private:
    using Tree = index::rtree<Value, Parameters>;

    void fill(Tree& tree, const Boxes& boxes) {
        if (packing) {
            values_.clear();
            for (const BroadBox& box : boxes) values_.push_back(to_value(box));
            tree = Tree(values_.begin(), values_.end());
        } else {
            tree.clear();
            for (const BroadBox& box : boxes) tree.insert(to_value(box));
        }
    }

    static void find(const Tree& tree, const BroadBox& box, std::vector<uint32_t>& found) {
        found.clear();
        auto keep = [&](const Value& hit) { found.push_back(hit.second); };
        tree.query(index::intersects(to_boost(box)), boost::make_function_output_iterator(keep));
    }

    // Not part of a frame: whoever uses this tree knows his pairs.
    void learn_neighbours() {
        neighbours_.reset(boxes_.size());
        for (const BroadBox& box : boxes_) {
            find(moving_, box, found_);
            for (uint32_t b : found_) {
                if (b > box.index) neighbours_.add(box.index, b);
            }
        }
        neighbours_known_ = true;
    }

    Tree fixed_, moving_;
    Boxes boxes_;
    std::vector<Value> values_;
    Neighbours neighbours_;
    bool neighbours_known_ = false;
    std::vector<uint32_t> found_;
};

template <class Parameters, bool packing>
SubjectType type(const char* name) {
    return {name, false, [] { return std::make_unique<BoostTree<Parameters, packing>>(); }};
}

}  // namespace

void add_boost(std::vector<SubjectType>& types) {
    types.push_back(type<index::quadratic<16>, false>("boost-quadratic"));
    types.push_back(type<index::rstar<16>, false>("boost-rstar"));
    types.push_back(type<index::quadratic<16>, true>("boost-packing"));
}

}  // namespace lendulet::bench
