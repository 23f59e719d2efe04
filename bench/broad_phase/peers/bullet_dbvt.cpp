// Bullet's dynamic bounding volume tree (https://github.com/bulletphysics/bullet3, 3.24 in Debian 12), used as Bullet's
// own broad phase uses it, one tree for each set: leaves inserted one by one, pairs by descending two trees at once,
// leaves that moved updated and asked for their neighbours. Boxes are exact, without the margin that Bullet adds.
#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "bench/broad_phase/peers/neighbours.h"
#include "bench/broad_phase/subject.h"

namespace lendulet::bench {
namespace {

btDbvtVolume to_bullet(const BroadBox& box) {
    return btDbvtVolume::FromMM(btVector3(box.lower[0], box.lower[1], box.lower[2]),
                                btVector3(box.upper[0], box.upper[1], box.upper[2]));
}

uint32_t index_of(const btDbvtNode* leaf) { return static_cast<uint32_t>(leaf->dataAsInt); }

struct WritePairs : btDbvt::ICollide {
    explicit WritePairs(Array<BoxPair>& out) : pairs(out) {}
    void Process(const btDbvtNode* a, const btDbvtNode* b) {
        uint32_t i = index_of(a), j = index_of(b);
        pairs.push_back(i < j ? BoxPair{i, j} : BoxPair{j, i});
    }
    Array<BoxPair>& pairs;
};

template <class List>
struct WriteHits : btDbvt::ICollide {
    explicit WriteHits(List& out) : hits(out) {}
    void Process(const btDbvtNode* leaf) { hits.push_back(index_of(leaf)); }
    List& hits;
};

class BulletTree final : public Subject {
public:
    void load(const Boxes& fixed, const Boxes& moving) override {
        fixed_.clear();
        for (const BroadBox& box : fixed) insert(fixed_, box);
        moving_.clear();
        leaves_.clear();
        for (const BroadBox& box : moving) leaves_.push_back(insert(moving_, box));
        neighbours_known_ = false;
    }

    void find_pairs(Array<BoxPair>& pairs) override {
        WritePairs write(pairs);
        moving_.collideTTpersistentStack(moving_.m_root, moving_.m_root, write);
        moving_.collideTTpersistentStack(moving_.m_root, fixed_.m_root, write);
    }

    void update(const Boxes& moving, const std::vector<uint32_t>& changed, Array<BoxPair>& begun,
                Array<BoxPair>& ended) override {
        if (!neighbours_known_) learn_neighbours();
        for (uint32_t place : changed) {
            btDbvtVolume volume = to_bullet(moving[place]);
            moving_.update(leaves_[place], volume);
        }
        for (uint32_t place : changed) {
            found_.clear();
            WriteHits<std::vector<uint32_t>> write(found_);
            moving_.collideTVNoStackAlloc(moving_.m_root, to_bullet(moving[place]), stack_, write);
            neighbours_.compare(moving[place].index, found_, begun, ended);
        }
    }

    void query(const Boxes& queries, Array<uint32_t>& hits, std::vector<uint32_t>& ends) override {
        WriteHits<Array<uint32_t>> write(hits);
        for (const BroadBox& box : queries) {
            moving_.collideTVNoStackAlloc(moving_.m_root, to_bullet(box), stack_, write);
            ends.push_back(static_cast<uint32_t>(hits.size()));
        }
    }

private:
    static btDbvtNode* insert(btDbvt& tree, const BroadBox& box) {
        btDbvtNode* leaf = tree.insert(to_bullet(box), nullptr);
        leaf->dataAsInt = static_cast<int>(box.index);
        return leaf;
    }

    // Not part of a frame: whoever uses this tree knows his pairs.
    void learn_neighbours() {
        neighbours_.reset(leaves_.size());
        Array<BoxPair> pairs;
        find_pairs(pairs);
        for (const BoxPair& pair : pairs) neighbours_.add(pair.a, pair.b);
        neighbours_known_ = true;
    }

    btDbvt fixed_, moving_;
    std::vector<btDbvtNode*> leaves_;
    btNodeStack stack_;
    Neighbours neighbours_;
    bool neighbours_known_ = false;
    std::vector<uint32_t> found_;
};

}  // namespace

void add_bullet(std::vector<SubjectType>& types) {
    types.push_back({"btDbvt", false, [] { return std::make_unique<BulletTree>(); }});
}

}  // namespace lendulet::bench
