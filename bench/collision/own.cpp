// This engine's routines: the distance query with either simplex solver, cold and warm, and manifolds of boxes singly
// and in batches of every width.
#include <cmath>
#include <limits>

#include "bench/collision/pairs.h"
#include "collision/gjk.h"
#include "collision/narrow_phase.h"
#include "world/narrow/kernels.h"

namespace lendulet::bench {
namespace {

// The set as the engine sees it.
struct Loaded {
    const PairSet* set = nullptr;
    std::vector<Geometry> a, b;
    std::vector<Transform> pose, moved;

    void load(const PairSet& s) {
        *this = {};
        set = &s;
        for (const ConvexCase& c : s.cases) {
            a.push_back(make_geometry(c.a).value());
            b.push_back(make_geometry(c.b).value());
            pose.push_back(c.b_in_a);
            moved.push_back(c.moved);
        }
    }
    size_t size() const { return a.size(); }
};

class Distance : public PairSubject {
public:
    Distance(SimplexSolver solver, bool warm) : solver_(solver), warm_(warm) {}
    std::string routine() const override {
        return std::string("lendulet distance, ") +
               (solver_ == SimplexSolver::half_space ? "half-space" : "barycentric") + (warm_ ? ", warm" : "");
    }
    bool takes(const PairSet& set) const override { return !set.is_pile(); }
    bool moved() const override { return warm_; }
    void load(const PairSet& set) override { data_.load(set), caches_.assign(data_.size(), {}); }
    void rewind() override {
        for (size_t i = 0; i < data_.size(); ++i) {
            caches_[i] = {};
            if (warm_) (void)distance({&data_.a[i], &data_.b[i], data_.pose[i]}, caches_[i], solver_, 1e30f);
        }
    }
    void run(std::vector<double>& answers) override {
        const std::vector<Transform>& pose = warm_ ? data_.moved : data_.pose;
        for (size_t i = 0; i < data_.size(); ++i) {
            ConvexDistance d = distance({&data_.a[i], &data_.b[i], pose[i]}, caches_[i], solver_, 1e30f);
            answers[i] = d.converged ? d.distance : failed;
        }
    }

private:
    SimplexSolver solver_;
    bool warm_;
    Loaded data_;
    std::vector<GjkCache> caches_;
};

// Manifolds prefer a face to a pair of edges that is less deep by up to 0.5 % of the smallest half extent (at most 1
// m), and those of hulls take the normal of a face that looks within 3.5 degrees along the shortest way out.
constexpr double preference = 1e-2;

double deepest(const Manifold& m) {
    float d = m.points[0].separation;
    for (int i = 1; i < m.count; ++i) d = minimum(d, m.points[i].separation);
    return d;
}

// What collide() answers; no manifold: too far apart, which is right in a pile alone.
double collide_one(const CollidePair& pair, PairCache& cache, bool is_pile) {
    Manifold m;
    if (collide(pair, cache, {}, &m, 1) == 1) return deepest(m);
    return is_pile ? contact_margin : failed;
}

// One pair after the other.
class SingleManifold : public PairSubject {
public:
    std::string routine() const override { return "lendulet manifold, single"; }
    bool takes(const PairSet& set) const override { return set.overlapping; }
    double allowed() const override { return preference; }
    void load(const PairSet& set) override { data_.load(set); }
    void rewind() override { caches_.assign(data_.size(), {}); }
    void run(std::vector<double>& answers) override {
        for (size_t i = 0; i < data_.size(); ++i) {
            const Transform& t = data_.pose[i];
            answers[i] = collide_one({&data_.a[i], &data_.b[i], {}, t.rotation, t.translation, contact_margin},
                                     caches_[i], data_.set->is_pile());
        }
    }

private:
    Loaded data_;
    std::vector<PairCache> caches_;
};

class BatchManifold : public PairSubject {
public:
    explicit BatchManifold(int width) : kernels_(narrow_kernels(width)) {}
    std::string routine() const override { return "lendulet manifold, width " + std::to_string(kernels_.width); }
    bool takes(const PairSet& set) const override {
        return set.overlapping && std::holds_alternative<Box>(set.cases[0].a);
    }
    double allowed() const override { return preference; }
    void load(const PairSet& set) override {
        frames_.clear(), a_ = set.a, b_ = set.b;
        data_.load(set);
        for (const PlacedBox& box : set.boxes)
            add_frame(box.half, {from_origin(box.pose.position), box.pose.orientation});
        if (set.is_pile()) return;
        for (const ConvexCase& c : set.cases) {
            a_.push_back(add_frame(std::get<Box>(c.a).half_extents, {}));
            b_.push_back(add_frame(std::get<Box>(c.b).half_extents, c.b_in_a));
        }
    }
    void run(std::vector<double>& answers) override {
        const int total = static_cast<int>(a_.size());
        for (int first = 0; first < total; first += batch_capacity) {
            const int count = total - first < batch_capacity ? total - first : batch_capacity;
            for (int k = 0; k < count; ++k) {
                const auto i = static_cast<size_t>(first + k);
                lists_->a[k] = a_[i], lists_->b[k] = b_[i];
                lists_->margin[k] = contact_margin, lists_->way[k] = lists_->feature[k] = 0.0f;
            }
            BoxBatch batch = lists_->batch(frames_.data(), count);
            kernels_.collide_boxes(batch);
            for (int k = 0; k < count; ++k) answers[static_cast<size_t>(first + k)] = answer(first, k);
        }
    }

private:
    double answer(int first, int k) const {
        const lendulet::BatchManifold& m = lists_->out[k];
        const bool is_pile = data_.set->is_pile(), apart = lists_->clearance[k] > contact_margin;
        if (!apart & (m.count == 0)) return answer_single(static_cast<size_t>(first + k), is_pile);
        float least = m.points[0].separation;  // those that are absent are far above
        for (int i = 1; i < 4; ++i) least = minimum(least, m.points[i].separation);
        return !apart ? least : is_pile ? contact_margin : failed;
    }
    // As a step does: where the features that face each other do not overlap, the distance query decides.
    double answer_single(size_t i, bool is_pile) const {
        PairCache cache;
        const Transform& t = data_.pose[i];
        return collide_one({&data_.a[i], &data_.b[i], {}, t.rotation, t.translation, contact_margin}, cache, is_pile);
    }
    int32_t add_frame(Vec3 half, const Transform& t) {
        ShapeFrame f{};
        const Quat q = t.rotation;
        const float rotation[4] = {q.x, q.y, q.z, q.w};
        for (int k = 0; k < 4; ++k) f.rotation[k] = rotation[k];
        for (int k = 0; k < 3; ++k) f.half[k] = component(half, k), f.centre[k] = component(t.translation, k);
        f.near = contact_margin;
        f.reach = f.radius = length(half);
        frames_.push_back(f);
        return static_cast<int32_t>(frames_.size()) - 1;
    }
    const NarrowKernels& kernels_;
    Loaded data_;
    std::vector<ShapeFrame> frames_;
    std::vector<int32_t> a_, b_;
    std::unique_ptr<BoxLists<batch_capacity, 16>> lists_ = std::make_unique<BoxLists<batch_capacity, 16>>();
};

}  // namespace

void add_own_subjects(PairSubjects& subjects) {
    for (bool warm : {false, true})
        for (SimplexSolver solver : {SimplexSolver::half_space, SimplexSolver::barycentric})
            subjects.push_back(std::make_unique<Distance>(solver, warm));
    subjects.push_back(std::make_unique<SingleManifold>());
    for (int width : {1, 4, 8, 16}) subjects.push_back(std::make_unique<BatchManifold>(width));
}

}  // namespace lendulet::bench
