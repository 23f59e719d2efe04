// What is measured: pairs of convex shapes at known distances, and what measures it.
#pragma once

#include <ctime>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lendulet/shapes.h"
#include "lendulet/world.h"

namespace lendulet::bench {

// Two boxes or two hulls, seen from the frame of A.
struct ConvexCase {
    Shape a, b;
    Transform b_in_a, moved;    // moved: by up to 1 mm and a milliradian
    double truth, truth_moved;  // distance, m; negative: depth
};

// A box in the world.
struct PlacedBox {
    Vec3 half;
    Pose pose;
};

struct PairSet {
    std::string name;  // "box-box far"
    bool overlapping;
    std::vector<ConvexCase> cases;
    // Of a pile: its boxes, and which of them the cases are. Pairs are those that a broad phase gives, most of them
    // apart: what gives manifolds is asked for these, and answers `contact_margin` where they are farther than that.
    std::vector<PlacedBox> boxes{};
    std::vector<int32_t> a{}, b{};
    bool is_pile() const { return !boxes.empty(); }
};

// Boxes with half extents from 0.25 to 1 m: far (0.1 to 2 m apart), near (1e-4 to 1e-2 m), touching, overlapping by 1
// to 50 mm and by 0.1 to 0.5 m; hulls of 32 points on a ball of a metre, drawn from 64 of
// them, far and deep.
std::vector<PairSet> make_pair_sets(int pairs);
// All pairs of a settled pile of boxes of half a metre whose bounds, widened by 5 cm, overlap. Sorted.
PairSet make_pile_set(int bodies);
// All boxes of a world, static ones too, in the order of its bodies.
std::vector<PlacedBox> boxes_of(const World& world);
// Distance of a pair, m; negative: depth. See pairs.cpp for how it is known.
double truth_of(const Shape& a, const Shape& b, const Transform& b_in_a);

// How far apart shapes may be for a manifold, m.
inline constexpr float contact_margin = 0.02f;
// The answer of a routine that says that it has none.
inline constexpr double failed = std::numeric_limits<double>::quiet_NaN();

// A routine that answers all pairs of a set one after the other.
class PairSubject {
public:
    virtual ~PairSubject() = default;
    virtual std::string routine() const = 0;
    // Whether it has answers of this kind.
    virtual bool takes(const PairSet& set) const = 0;
    virtual void load(const PairSet& set) = 0;
    virtual void rewind() {}                      // before each round, not measured
    virtual bool moved() const { return false; }  // answers for the moved poses
    // m; an answer that is off by more has failed.
    virtual double allowed() const { return 1e-3; }
    // Distances or depths as the truth has them, or `failed`.
    virtual void run(std::vector<double>& answers) = 0;
};
using PairSubjects = std::vector<std::unique_ptr<PairSubject>>;

void add_own_subjects(PairSubjects& subjects);
void add_bullet_subjects(PairSubjects& subjects);
void add_ccd_subjects(PairSubjects& subjects);
void add_fcl_subjects(PairSubjects& subjects);
// Peers that the build did not find, by Debian's names.
std::vector<std::string> missing_collision_peers();

struct CollisionRow {
    std::string routine, name;
    double median_ns, worst_error;  // m; below 0: not judged
    long failures;
    bool ours;
};
using CollisionRows = std::vector<CollisionRow>;

// Closed forms, meshes and height fields: by time alone, and the result beside that of the distance query.
void measure_kinds(int pairs, int repeats, CollisionRows& rows);
// Rays into a settled pile of boxes.
void measure_rays(int rays, int bodies, int repeats, CollisionRows& rows);

// The pile and the rays, for the peers: boxes of half a metre at these poses, beside static boxes.
struct RayScene {
    std::vector<PlacedBox> boxes;
    std::vector<Vec3> from, to;
    std::vector<double> fractions;  // of this engine's hits, above 1: none
};
// Times in ns a ray, one for each round, and fractions of the hits.
std::vector<double> bullet_rays(const RayScene& scene, int repeats, std::vector<double>& fractions);

// Hulls that several pairs share are shared by those that measure, too, as engines do: make(shape) is called once for
// each, and for each box.
template <class T>
class SharedShapes {
public:
    void clear() { hulls_.clear(); }
    template <class Make>
    std::shared_ptr<T> of(const Shape& shape, Make&& make) {
        const auto* hull = std::get_if<ConvexHull>(&shape);
        if (!hull) return make(shape);
        std::shared_ptr<T>& made = hulls_[&hull->data()];
        if (!made) made = make(shape);
        return made;
    }

private:
    std::map<const void*, std::shared_ptr<T>> hulls_;
};

double median_of(std::vector<double> values);

// Time that this program has computed, ns: what others do on the machine meanwhile does not count.
inline double computing_time() { return 1e9 / static_cast<double>(CLOCKS_PER_SEC) * static_cast<double>(std::clock()); }

}  // namespace lendulet::bench
