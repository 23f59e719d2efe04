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
    bool takes(const PairSet&) const override { return true; }
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
            Manifold m;
            const Transform& t = data_.pose[i];
            int count = collide({&data_.a[i], &data_.b[i], {}, t.rotation, t.translation, contact_margin}, caches_[i],
                                {}, &m, 1);
            answers[i] = count == 1 ? deepest(m) : failed;
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
        frames_.assign(2 * set.cases.size(), {});
        for (size_t i = 0; i < set.cases.size(); ++i) {
            const ConvexCase& c = set.cases[i];
            fill(frames_[2 * i], c.a, {});
            fill(frames_[2 * i + 1], c.b, c.b_in_a);
        }
    }
    void run(std::vector<double>& answers) override {
        const int total = static_cast<int>(frames_.size() / 2);
        for (int first = 0; first < total; first += batch_capacity) {
            const int count = total - first < batch_capacity ? total - first : batch_capacity;
            for (int k = 0; k < count; ++k) {
                lists_->a[k] = 2 * (first + k), lists_->b[k] = 2 * (first + k) + 1;
                lists_->margin[k] = contact_margin, lists_->way[k] = lists_->feature[k] = 0.0f;
            }
            BoxBatch batch = lists_->batch(frames_.data(), count);
            kernels_.collide_boxes(batch);
            for (int k = 0; k < count; ++k) {
                const lendulet::BatchManifold& m = lists_->out[k];
                double least = 1e30;
                for (int j = 0; j < m.count; ++j) least = std::min<double>(least, m.points[j].separation);
                answers[static_cast<size_t>(first + k)] = m.count > 0 ? least : failed;
            }
        }
    }

private:
    static void fill(ShapeFrame& f, const Shape& shape, const Transform& t) {
        const Vec3 half = std::get<Box>(shape).half_extents;
        const Quat q = t.rotation;
        const float rotation[4] = {q.x, q.y, q.z, q.w};
        for (int k = 0; k < 4; ++k) f.rotation[k] = rotation[k];
        for (int k = 0; k < 3; ++k) f.half[k] = component(half, k), f.centre[k] = component(t.translation, k);
        f.near = contact_margin;
        f.reach = f.radius = length(half);
    }
    const NarrowKernels& kernels_;
    std::vector<ShapeFrame> frames_;
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
