#include "geometry/quickhull.h"

#include <array>
#include <utility>

#include "base/assert.h"

namespace lendulet {

namespace {

using Wide3 = Vec3T<int64_t>;
using Vec3d = Vec3T<double>;
constexpr uint32_t none = ~0u;

__extension__ typedef __int128 Int128;
using Exact3 = Vec3T<Int128>;

Wide3 difference(LatticePoint a, LatticePoint b) { return a - b; }
Vec3d to_double(Wide3 v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }
double norm(Vec3d v) { return __builtin_sqrt(dot(v, v)); }

// The normal (b - a) x (c - a), of at most 82 bits a component, without error.
Exact3 exact_normal(LatticePoint a, LatticePoint b, LatticePoint c) {
    Wide3 u = difference(b, a), v = difference(c, a);
    return cross(Exact3{u.x, u.y, u.z}, Exact3{v.x, v.y, v.z});
}

struct Facet {
    uint32_t corner[3], twin[3];  // twin: half edge 3 facet + i
    Vec3d unit;
    uint32_t first = none;  // its points, through next_
    uint32_t farthest = none;
    double farthest_distance = 0.0;
    uint32_t visit = 0;  // number of the insertion that last saw this facet
    bool visible = false, alive = true;
};

class Builder {
public:
    Builder(std::span<const LatticePoint> points, std::span<const double> slack)
        : points_(points), slack_(slack), next_(points.size(), none), cone_at_(points.size(), none) {
        for (double s : slack) admitted_slack_ = s < admitted_slack_ ? s : admitted_slack_;
    }

    Rank run(double flat, TriangleSurface& surface) {
        std::array<uint32_t, 4> start{};
        Rank rank = choose_simplex(flat, start);
        if (rank != Rank::space) return rank;
        make_simplex(start);
        insert_pending();
        admit_all();
        do insert_pending();
        while (find_overlooked());
        write(surface);
        return Rank::space;
    }

private:
    // Height above a facet's plane, in lattice units; its error is below `decided`.
    double distance(const Facet& f, uint32_t p) const {
        return dot(f.unit, to_double(difference(points_[p], points_[f.corner[0]])));
    }
    bool sees(uint32_t p, const Facet& f) const {
        constexpr double decided = 0.01;  // eight roundings of numbers below 2^41
        double d = distance(f, p);
        if (d > decided || d < -decided) return d > 0.0;
        return side_of(points_[f.corner[0]], points_[f.corner[1]], points_[f.corner[2]], points_[p]) > 0;
    }

    uint32_t farthest_from(uint32_t a) const {
        return best([&](Vec3d d) { return dot(d, d); }, a);
    }
    template <class Measure>
    uint32_t best(Measure measure, uint32_t origin) const {
        uint32_t index = origin;
        double largest = 0.0;
        for (uint32_t i = 0; i < points_.size(); ++i) {
            if (slack_[i] > admitted_slack_) continue;
            double m = measure(to_double(difference(points_[i], points_[origin])));
            if (m > largest) largest = m, index = i;
        }
        return index;
    }

    // Two points far apart, the one farthest from their line, the one farthest from the plane. All are true corners of
    // the hull, or lie in one plane with them.
    Rank choose_simplex(double flat, std::array<uint32_t, 4>& s) const {
        s[0] = farthest_from(0);
        s[1] = farthest_from(s[0]);
        Vec3d axis = to_double(difference(points_[s[1]], points_[s[0]]));
        if (norm(axis) <= flat) return Rank::point;
        s[2] = best(
            [&](Vec3d d) {
                Vec3d c = cross(axis, d);
                return dot(c, c);
            },
            s[0]);
        Vec3d normal = cross(axis, to_double(difference(points_[s[2]], points_[s[0]])));
        if (norm(normal) <= flat * norm(axis)) return Rank::line;
        auto height = [&](Vec3d d) {
            double h = dot(normal, d);
            return h < 0.0 ? -h : h;
        };
        s[3] = best(height, s[0]);
        if (height(to_double(difference(points_[s[3]], points_[s[0]]))) <= flat * norm(normal)) return Rank::plane;
        int side = side_of(points_[s[0]], points_[s[1]], points_[s[2]], points_[s[3]]);
        if (side == 0) return Rank::plane;
        if (side > 0) std::swap(s[1], s[2]);  // the fourth must lie behind
        return Rank::space;
    }

    void insert_pending() {
        for (size_t i = 0; i < pending_.size(); ++i) {  // grows on the way
            uint32_t f = pending_[i];
            if (facets_[f].alive && facets_[f].farthest != none) insert(facets_[f].farthest, f);
        }
        pending_.clear();
    }
    // Points with more than the least slack were only carried along until now: put in early, they would become corners
    // although others, put in later, leave them within their slack.
    void admit_all() {
        admitted_slack_ = 1e300;
        for (uint32_t id = 0; id < facets_.size(); ++id) {
            Facet& f = facets_[id];
            if (!f.alive || f.first == none) continue;
            for (uint32_t p = f.first; p != none; p = next_[p]) offer(f, p, distance(f, p));
            pending_.push_back(id);
        }
    }
    void offer(Facet& f, uint32_t p, double height) const {
        if (height <= slack_[p] || slack_[p] > admitted_slack_) return;
        if (height > f.farthest_distance || (height == f.farthest_distance && p < f.farthest)) {
            f.farthest = p;
            f.farthest_distance = height;
        }
    }

    // Lists tell only the facet near which a point was last seen to stand out farthest. Around blades and needles
    // another one can be farther below it: all facets are searched for the few points that are left on lists. Too much
    // work only for huge clouds of near duplicates, whose facets are no blades.
    bool find_overlooked() {
        constexpr size_t affordable = 5'000'000;
        std::vector<uint32_t> left, alive;
        for (uint32_t id = 0; id < facets_.size(); ++id) {
            if (!facets_[id].alive) continue;
            alive.push_back(id);
            for (uint32_t p = facets_[id].first; p != none; p = next_[p]) left.push_back(p);
        }
        if (left.size() * alive.size() > affordable) return false;
        for (uint32_t id : alive) facets_[id].first = none;
        fresh_.swap(alive);
        for (uint32_t p : left) assign(p);
        fresh_.swap(alive);
        for (uint32_t id : alive)
            if (facets_[id].farthest != none) pending_.push_back(id);
        return !pending_.empty();
    }

    uint32_t add_facet(uint32_t a, uint32_t b, uint32_t c) {
        uint32_t id;
        if (free_.empty()) {
            id = static_cast<uint32_t>(facets_.size());
            facets_.emplace_back();
        } else {
            id = free_.back();
            free_.pop_back();
        }
        Facet& f = facets_[id];
        f = Facet{};
        f.corner[0] = a, f.corner[1] = b, f.corner[2] = c;
        // A narrow facet's normal is a small difference of large products: rounded once, it has the right direction.
        Exact3 exact = exact_normal(points_[a], points_[b], points_[c]);
        Vec3d n{static_cast<double>(exact.x), static_cast<double>(exact.y), static_cast<double>(exact.z)};
        f.unit = (1.0 / norm(n)) * n;
        return id;
    }
    void join(uint32_t edge, uint32_t twin) {
        facets_[edge / 3].twin[edge % 3] = twin;
        facets_[twin / 3].twin[twin % 3] = edge;
    }

    void make_simplex(const std::array<uint32_t, 4>& s) {
        uint32_t base = add_facet(s[0], s[1], s[2]);
        uint32_t side[3];
        for (int i = 0; i < 3; ++i) side[i] = add_facet(s[(i + 1) % 3], s[i], s[3]);
        for (uint32_t i = 0; i < 3; ++i) {
            join(3 * base + i, 3 * side[i]);
            join(3 * side[i] + 2, 3 * side[(i + 1) % 3] + 1);
        }
        fresh_ = {base, side[0], side[1], side[2]};
        for (uint32_t p = 0; p < points_.size(); ++p)
            if (p != s[0] && p != s[1] && p != s[2] && p != s[3]) assign(p);
        pending_.insert(pending_.end(), fresh_.begin(), fresh_.end());
    }

    // Puts a point on the list of the facet it stands out of farthest, or nowhere if it is inside. Points within their
    // slack stay on the lists too: beyond a sharp edge, one that hardly stands out of either face can stand far out of
    // a face that cuts the edge off later.
    void assign(uint32_t p) {
        uint32_t facet = fresh_[0];
        double height = distance(facets_[facet], p);
        for (size_t i = 1; i < fresh_.size(); ++i) {
            double d = distance(facets_[fresh_[i]], p);
            if (d > height) height = d, facet = fresh_[i];
        }
        constexpr double inside = 0.5;
        if (height <= inside) return;
        if (height <= slack_[p]) climb(p, facet, height);
        Facet& f = facets_[facet];
        next_[p] = f.first;
        f.first = p;
        offer(f, p, height);
    }

    // A point that hardly stands out of any new facet can still stand far out of an old one beyond them.
    void climb(uint32_t p, uint32_t& facet, double& height) const {
        for (bool moved = true; moved;) {
            moved = false;
            for (int i = 0; i < 3 && !moved; ++i) {
                uint32_t other = facets_[facet].twin[i] / 3;
                double d = distance(facets_[other], p);
                if (d > height) height = d, facet = other, moved = true;
            }
        }
    }

    // Replaces all facets that p sees by a cone from their outline to p.
    void insert(uint32_t p, uint32_t start) {
        collect_visible(p, start);
        fresh_.clear();
        for (uint32_t twin : horizon_) {  // half edge b -> a of a facet that stays
            const Facet& outer = facets_[twin / 3];
            uint32_t b = outer.corner[twin % 3], a = outer.corner[(twin % 3 + 1) % 3];
            uint32_t f = add_facet(a, b, p);
            join(3 * f, twin);
            cone_at_[a] = f;
            fresh_.push_back(f);
        }
        for (uint32_t f : fresh_) {
            LENDULET_ASSERT(cone_at_[facets_[f].corner[1]] != none);
            join(3 * f + 1, 3 * cone_at_[facets_[f].corner[1]] + 2);
        }
        for (uint32_t v : visible_) {
            for (uint32_t q = facets_[v].first, after; q != none; q = after) {
                after = next_[q];
                if (q != p) assign(q);
            }
            facets_[v].first = none;
        }
        for (uint32_t v : visible_) {
            facets_[v].alive = false;
            free_.push_back(v);
        }
        for (uint32_t f : fresh_) pending_.push_back(f);
    }

    void collect_visible(uint32_t p, uint32_t start) {
        ++insertion_;
        visible_.assign(1, start);
        horizon_.clear();
        facets_[start].visit = insertion_;
        facets_[start].visible = true;
        for (size_t i = 0; i < visible_.size(); ++i) {
            for (uint32_t twin : facets_[visible_[i]].twin) {
                Facet& other = facets_[twin / 3];
                if (other.visit != insertion_) {
                    other.visit = insertion_;
                    other.visible = sees(p, other);
                    if (other.visible) visible_.push_back(twin / 3);
                }
                if (!other.visible) horizon_.push_back(twin);
            }
        }
    }

    void write(TriangleSurface& surface) const {
        std::vector<uint32_t> number(facets_.size(), none);
        uint32_t count = 0;
        for (size_t f = 0; f < facets_.size(); ++f)
            if (facets_[f].alive) number[f] = count++;
        surface.corner.resize(3 * size_t{count});
        surface.twin.resize(3 * size_t{count});
        for (size_t f = 0; f < facets_.size(); ++f) {
            if (!facets_[f].alive) continue;
            for (size_t i = 0; i < 3; ++i) {
                uint32_t twin = facets_[f].twin[i];
                surface.corner[3 * number[f] + i] = facets_[f].corner[i];
                surface.twin[3 * number[f] + i] = 3 * number[twin / 3] + twin % 3;
            }
        }
    }

    std::span<const LatticePoint> points_;
    std::span<const double> slack_;
    double admitted_slack_ = 1e300;  // points with more may not become corners yet; at first the least of all
    std::vector<Facet> facets_;
    std::vector<uint32_t> free_, pending_;  // facets to reuse; facets to look at
    std::vector<uint32_t> next_;            // by point: the next one on the same facet's list
    std::vector<uint32_t> cone_at_;         // by point: the cone's facet whose horizon edge starts there
    std::vector<uint32_t> visible_, horizon_, fresh_;
    uint32_t insertion_ = 0;
};

}  // namespace

int side_of(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
    Exact3 n = exact_normal(a, b, c);
    Wide3 v = difference(d, a);
    Int128 height = dot(n, Exact3{v.x, v.y, v.z});
    return height > 0 ? 1 : height < 0 ? -1 : 0;
}

Rank quickhull(std::span<const LatticePoint> points, std::span<const double> slack, double flat,
               TriangleSurface& surface) {
    surface = {};
    if (points.empty()) return Rank::point;
    return Builder(points, slack).run(flat, surface);
}

}  // namespace lendulet
