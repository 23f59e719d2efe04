// libccd (https://github.com/danfis/libccd, 2.1 in Debian 12, double precision): whether two shapes overlap by GJK, and
// how deep by its expanding polytope and by Minkowski portals, which do not seek the least depth.
#include <ccd/ccd.h>
#include <ccd/quat.h>

#include <limits>

#include "bench/collision/pairs.h"

namespace lendulet::bench {
namespace {

struct Solid {
    Vec3 half;                        // of a box
    const std::vector<Vec3>* points;  // of a hull; null: a box
    ccd_vec3_t position;
    ccd_quat_t rotation;
};

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
    const auto& s = *static_cast<const Solid*>(object);
    ccd_quat_t back;
    ccd_vec3_t d;
    ccdQuatInvert2(&back, &s.rotation);
    ccdVec3Copy(&d, direction);
    ccdQuatRotVec(&d, &back);
    if (!s.points) {
        ccdVec3Set(out, d.v[0] < 0.0 ? -s.half.x : s.half.x, d.v[1] < 0.0 ? -s.half.y : s.half.y,
                   d.v[2] < 0.0 ? -s.half.z : s.half.z);
    } else {
        double most = -1e300;
        for (Vec3 p : *s.points) {
            double along = d.v[0] * p.x + d.v[1] * p.y + d.v[2] * p.z;
            if (along > most) most = along, ccdVec3Set(out, p.x, p.y, p.z);
        }
    }
    ccdQuatRotVec(out, &s.rotation);
    ccdVec3Add(out, &s.position);
}
void centre(const void* object, ccd_vec3_t* out) { ccdVec3Copy(out, &static_cast<const Solid*>(object)->position); }

enum class Routine { intersect, gjk_epa, portals };

class Ccd final : public PairSubject {
public:
    explicit Ccd(Routine routine) : routine_(routine) {
        CCD_INIT(&settings_);
        settings_.support1 = settings_.support2 = support;
        settings_.center1 = settings_.center2 = centre;
        settings_.max_iterations = 100;
        settings_.epa_tolerance = 1e-6;
        settings_.mpr_tolerance = 1e-6;
    }
    std::string routine() const override {
        constexpr const char* names[] = {"libccd GJK, yes or no", "libccd GJK and EPA", "libccd portals"};
        return names[static_cast<int>(routine_)];
    }
    bool takes(const PairSet& set) const override {
        return !set.is_pile() && set.overlapping != (routine_ == Routine::intersect);
    }
    void load(const PairSet& set) override {
        set_ = &set;
        a_.clear(), b_.clear(), shared_.clear();
        for (const ConvexCase& c : set.cases) {
            a_.push_back(solid(c.a, {}));
            b_.push_back(solid(c.b, c.b_in_a));
        }
    }
    void run(std::vector<double>& answers) override {
        for (size_t i = 0; i < a_.size(); ++i) answers[i] = answer(i);
    }

private:
    Solid solid(const Shape& shape, const Transform& t) {
        Solid s{{}, nullptr, {}, {}};
        if (const auto* box = std::get_if<Box>(&shape)) {
            s.half = box->half_extents;
        } else {
            s.points = shared_
                           .of(shape,
                               [](const Shape& hull) {
                                   auto corners = std::get<ConvexHull>(hull).vertices();
                                   return std::make_shared<std::vector<Vec3>>(corners.begin(), corners.end());
                               })
                           .get();
        }
        ccdVec3Set(&s.position, t.translation.x, t.translation.y, t.translation.z);
        ccdQuatSet(&s.rotation, t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w);
        return s;
    }
    // A yes or no that is right counts as the truth, but for what only just touches.
    double answer(size_t i) {
        const double truth = set_->cases[i].truth;
        if (routine_ == Routine::intersect) {
            bool overlaps = ccdGJKIntersect(&a_[i], &b_[i], &settings_) != 0;
            return !overlaps || truth < 1e-6 ? truth : failed;
        }
        ccd_real_t depth = 0.0;
        ccd_vec3_t direction, position;
        int status = routine_ == Routine::gjk_epa
                         ? ccdGJKPenetration(&a_[i], &b_[i], &settings_, &depth, &direction, &position)
                         : ccdMPRPenetration(&a_[i], &b_[i], &settings_, &depth, &direction, &position);
        return status == 0 ? -depth : failed;
    }
    Routine routine_;
    ccd_t settings_;
    const PairSet* set_ = nullptr;
    SharedShapes<std::vector<Vec3>> shared_;
    std::vector<Solid> a_, b_;
};

}  // namespace

void add_ccd_subjects(PairSubjects& subjects) {
    for (Routine r : {Routine::intersect, Routine::gjk_epa, Routine::portals})
        subjects.push_back(std::make_unique<Ccd>(r));
}

}  // namespace lendulet::bench
