// Named choices of a world: which algorithm does a job. Each has a name for command lines and files.
#pragma once

#include <cstdint>
#include <string_view>

#include "lendulet/result.h"

namespace lendulet {

// The structure that finds pairs of overlapping boxes.
enum class BroadPhaseType : uint8_t {
    all_pairs,
    sweep_1,
    sweep_3,
    rtree_quadratic,
    rtree_star,
    rtree_str,
    rtree_omt,
    wide_tree,  // named "default"
};
// The sub-algorithm of GJK that finds the closest point of a simplex (thesis 4.1).
enum class SimplexSolver : uint8_t { barycentric, half_space };
// How free rotation and translation are integrated. `momentum` (default) keeps L exactly, turns by the implicit
// midpoint rule at constant L and moves ballistically; the others are references for tables and demos.
enum class Integrator : uint8_t { momentum, explicit_euler, symplectic_euler, runge_kutta_4 };

// The names used on the command line: "rtree-omt", "half-space", "runge-kutta-4".
std::string_view name_of(BroadPhaseType);
std::string_view name_of(SimplexSolver);
std::string_view name_of(Integrator);
// The choice of that name, or ErrorCode::unknown_name listing the names there are.
Result<BroadPhaseType> broad_phase_from_name(std::string_view);
Result<SimplexSolver> simplex_from_name(std::string_view);
Result<Integrator> integrator_from_name(std::string_view);

}  // namespace lendulet
