#include "collision/gjk_newton.h"

namespace lendulet {

// Looks for the direction d whose support point y lies on the line through the origin along d. The tangential part of
// y(d) - h(d) d vanishes there; its derivative along t is y'(t) - h t, taken by differences.
Tangency find_smooth_tangency(const CoreDifference& difference, Vec3d direction) {
    constexpr int max_rounds = 6;
    constexpr double step = 1e-5, accepted = 1e-12;  // rad; of S
    Tangency now{direction, {}, 0.0, 0.0};
    for (int round = 0;; ++round) {
        Vec3d d = now.direction, t1, t2;
        complete_frame(d, t1, t2);
        now.p = difference.support(d);
        now.height = dot(d, now.p.y);
        double f1 = dot(t1, now.p.y), f2 = dot(t2, now.p.y);
        now.miss = square_root(f1 * f1 + f2 * f2);
        if (round == max_rounds || now.miss <= accepted * difference.size) return now;
        Vec3d y1 = (1.0 / step) * (difference.support(d + step * t1).y - now.p.y);
        Vec3d y2 = (1.0 / step) * (difference.support(d + step * t2).y - now.p.y);
        double j11 = dot(t1, y1) - now.height, j22 = dot(t2, y2) - now.height, j12 = dot(t1, y2), j21 = dot(t2, y1);
        double determinant = j11 * j22 - j12 * j21;
        if (!(determinant > 0.0) || !(j11 > 0.0)) return now;  // not towards a minimum
        double a1 = (f2 * j12 - f1 * j22) / determinant, a2 = (f1 * j21 - f2 * j11) / determinant;
        double length_a = square_root(a1 * a1 + a2 * a2), limit = length_a > 0.5 ? 0.5 / length_a : 1.0;
        Vec3d next = d + (limit * a1) * t1 + (limit * a2) * t2;
        now.direction = (1.0 / length(next)) * next;
    }
}

}  // namespace lendulet
