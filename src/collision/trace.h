// What the distance query and the clipping tell as they go, for `lendulet explain`. The algorithms are templates on an
// observer and are compiled twice from one source: with a silent one, which leaves nothing behind, and with a recorder.
#pragma once

#include <array>
#include <vector>

#include "collision/clip.h"
#include "collision/epa_polytope.h"
#include "collision/gjk.h"
#include "collision/gjk_difference.h"
#include "lendulet/options.h"

namespace lendulet {

struct SilentObserver {
    void simplex(const Simplex&, Vec3d) {}
    void support(const DifferencePoint&) {}
    void polytope(const Polytope&, int, const DifferencePoint&) {}
    template <class Corners>
    void clip_start(const Corners&, int, const Corners&, int) {}
    template <class Corners>
    void clip_side(int, const Corners&, int) {}
};

// Steps in the order in which they were taken. Points of the Minkowski difference are in the frame of A.
struct Recorder {
    struct SimplexStep {
        std::vector<Vec3d> points;  // those that the nearest point lies between
        Vec3d nearest;              // to the origin
        Vec3d support{};            // the point that was found beyond it
        bool has_support = false;
    };
    struct PolytopeStep {
        std::vector<std::array<Vec3d, 3>> faces;
        int nearest;    // of the faces, to the origin
        Vec3d support;  // found beyond that
    };
    // Corners as (u, v, height) over the reference plane.
    struct ClipStep {
        int side;  // of the reference face; -1: before the first
        std::vector<Vec3> polygon;
    };
    std::vector<SimplexStep> simplices;
    std::vector<PolytopeStep> polytopes;
    std::vector<Vec3> reference;
    std::vector<ClipStep> clips;

    void simplex(const Simplex& s, Vec3d nearest) {
        SimplexStep step;
        for (int i = 0; i < s.count; ++i) step.points.push_back(s.y[i]);
        step.nearest = nearest;
        simplices.push_back(step);
    }
    void support(const DifferencePoint& p) {
        simplices.back().support = p.y;
        simplices.back().has_support = true;
    }
    void polytope(const Polytope& p, int nearest, const DifferencePoint& support) {
        PolytopeStep step{{}, 0, support.y};
        for (int f = 0; f < p.face_end(); ++f) {
            if (!p.alive(f)) continue;
            if (f == nearest) step.nearest = static_cast<int>(step.faces.size());
            Simplex t = p.triangle(f);
            step.faces.push_back({t.y[0], t.y[1], t.y[2]});
        }
        polytopes.push_back(step);
    }
    // Corners are anything with u, v and w.
    template <class Corners>
    void clip_start(const Corners& sides, int side_count, const Corners& polygon, int count) {
        reference = points_of(sides, side_count);
        clips.assign(1, {-1, points_of(polygon, count)});
    }
    template <class Corners>
    void clip_side(int side, const Corners& polygon, int count) {
        clips.push_back({side, points_of(polygon, count)});
    }

private:
    template <class Corners>
    static std::vector<Vec3> points_of(const Corners& corners, int count) {
        std::vector<Vec3> points;
        for (int i = 0; i < count; ++i) points.push_back({corners[i].u, corners[i].v, corners[i].w});
        return points;
    }
};

// distance() and clip_face(), recorded.
ConvexDistance distance(const ConvexPair& pair, GjkCache& cache, SimplexSolver method, float max_distance,
                        Recorder& recorder);
void clip_face(const Face& reference, const Face& incident, bool reference_is_b, float limit, ClippedFace& out,
               Recorder& recorder);

}  // namespace lendulet
