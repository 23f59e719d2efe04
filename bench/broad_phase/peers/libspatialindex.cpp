// libspatialindex (https://libspatialindex.org, 1.9.3 in Debian 12): its R*-tree in memory, bulk-loaded by STR, every
// box asked for its neighbours. The library is made for data on disk and in doubles; a box keeps its value exactly.
#include <spatialindex/SpatialIndex.h>

#include "bench/broad_phase/peers/neighbours.h"
#include "bench/broad_phase/subject.h"

namespace lendulet::bench {
namespace {

constexpr double fill_factor = 0.9;
constexpr uint32_t children = 16, dimensions = 3;

SpatialIndex::Region to_region(const BroadBox& box) {
    double lower[3], upper[3];
    for (int d = 0; d < 3; ++d) {
        lower[d] = static_cast<double>(box.lower[d]);
        upper[d] = static_cast<double>(box.upper[d]);
    }
    return {lower, upper, dimensions};
}

class Stream final : public SpatialIndex::IDataStream {
public:
    explicit Stream(const Boxes& boxes) : boxes_(boxes) {}
    SpatialIndex::IData* getNext() override {
        if (!hasNext()) return nullptr;
        const BroadBox& box = boxes_[next_++];
        SpatialIndex::Region region = to_region(box);
        return new SpatialIndex::RTree::Data(0, nullptr, region, box.index);
    }
    bool hasNext() override { return next_ < boxes_.size(); }
    uint32_t size() override { return static_cast<uint32_t>(boxes_.size()); }
    void rewind() override { next_ = 0; }

private:
    const Boxes& boxes_;
    size_t next_ = 0;
};

class Collect final : public SpatialIndex::IVisitor {
public:
    explicit Collect(std::vector<uint32_t>& found) : found_(found) {}
    void visitNode(const SpatialIndex::INode&) override {}
    void visitData(const SpatialIndex::IData& data) override {
        found_.push_back(static_cast<uint32_t>(data.getIdentifier()));
    }
    void visitData(std::vector<const SpatialIndex::IData*>&) override {}

private:
    std::vector<uint32_t>& found_;
};

class Tree {
public:
    void fill(const Boxes& boxes) {
        tree_.reset();
        storage_.reset();
        if (boxes.empty()) return;  // the bulk loader takes no empty stream
        storage_.reset(SpatialIndex::StorageManager::createNewMemoryStorageManager());
        Stream stream(boxes);
        SpatialIndex::id_type id;
        tree_.reset(SpatialIndex::RTree::createAndBulkLoadNewRTree(SpatialIndex::RTree::BLM_STR, stream, *storage_,
                                                                   fill_factor, children, children, dimensions,
                                                                   SpatialIndex::RTree::RV_RSTAR, id));
    }
    void replace(const BroadBox& before, const BroadBox& after) {
        tree_->deleteData(to_region(before), before.index);
        tree_->insertData(0, nullptr, to_region(after), after.index);
    }
    void find(const BroadBox& box, std::vector<uint32_t>& found) const {
        found.clear();
        if (!tree_) return;
        Collect collect(found);
        tree_->intersectsWithQuery(to_region(box), collect);
    }

private:
    std::unique_ptr<SpatialIndex::IStorageManager> storage_;
    std::unique_ptr<SpatialIndex::ISpatialIndex> tree_;
};

class SpatialIndexTree final : public Subject {
public:
    void load(const Boxes& fixed, const Boxes& moving) override {
        fixed_.fill(fixed);
        moving_.fill(moving);
        boxes_ = moving;
        neighbours_known_ = false;
    }

    void find_pairs(Array<BoxPair>& pairs) override {
        for (const BroadBox& box : boxes_) {
            uint32_t a = box.index;
            moving_.find(box, found_);
            for (uint32_t b : found_) {
                if (b > a) pairs.push_back({a, b});
            }
            fixed_.find(box, found_);
            for (uint32_t b : found_) pairs.push_back(a < b ? BoxPair{a, b} : BoxPair{b, a});
        }
    }

    void update(const Boxes& moving, const std::vector<uint32_t>& changed, Array<BoxPair>& begun,
                Array<BoxPair>& ended) override {
        if (!neighbours_known_) learn_neighbours();
        for (uint32_t place : changed) {
            moving_.replace(boxes_[place], moving[place]);
            boxes_[place] = moving[place];
        }
        for (uint32_t place : changed) {
            moving_.find(moving[place], found_);
            neighbours_.compare(moving[place].index, found_, begun, ended);
        }
    }

    void query(const Boxes& queries, Array<uint32_t>& hits, std::vector<uint32_t>& ends) override {
        for (const BroadBox& box : queries) {
            moving_.find(box, found_);
            hits.append(found_.data(), found_.size());
            ends.push_back(static_cast<uint32_t>(hits.size()));
        }
    }

private:
    // Not part of a frame: whoever uses this tree knows his pairs.
    void learn_neighbours() {
        neighbours_.reset(boxes_.size());
        for (const BroadBox& box : boxes_) {
            moving_.find(box, found_);
            for (uint32_t b : found_) {
                if (b > box.index) neighbours_.add(box.index, b);
            }
        }
        neighbours_known_ = true;
    }

    Tree fixed_, moving_;
    Boxes boxes_;
    Neighbours neighbours_;
    bool neighbours_known_ = false;
    std::vector<uint32_t> found_;
};

}  // namespace

void add_libspatialindex(std::vector<SubjectType>& types) {
    types.push_back({"libspatialindex", false, [] { return std::make_unique<SpatialIndexTree>(); }});
}

}  // namespace lendulet::bench
