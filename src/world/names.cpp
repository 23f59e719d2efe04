// Names of choices and stages, for command lines and reports.
#include <string>

#include "lendulet/options.h"
#include "lendulet/world.h"

namespace lendulet {

std::string_view name_of(SimplexSolver s) { return s == SimplexSolver::barycentric ? "barycentric" : "half-space"; }

std::string_view name_of(Integrator i) {
    switch (i) {
        case Integrator::momentum:
            return "momentum";
        case Integrator::explicit_euler:
            return "explicit-euler";
        case Integrator::symplectic_euler:
            return "symplectic-euler";
        case Integrator::runge_kutta_4:
            return "runge-kutta-4";
    }
    return "";
}

std::string_view name_of(Stage stage) {
    constexpr std::string_view names[] = {"bounds",  "broad_phase", "pairs", "narrow_phase",
                                          "islands", "prepare",     "solve", "finish"};
    return stage < Stage::count ? names[static_cast<int>(stage)] : std::string_view{};
}

Result<SimplexSolver> simplex_from_name(std::string_view name) {
    for (SimplexSolver s : {SimplexSolver::barycentric, SimplexSolver::half_space})
        if (name == name_of(s)) return s;
    return Error{ErrorCode::unknown_name,
                 "there is no simplex solver \"" + std::string(name) + "\"; there are barycentric, half-space"};
}

Result<Integrator> integrator_from_name(std::string_view name) {
    for (Integrator i :
         {Integrator::momentum, Integrator::explicit_euler, Integrator::symplectic_euler, Integrator::runge_kutta_4})
        if (name == name_of(i)) return i;
    return Error{ErrorCode::unknown_name,
                 "there is no integrator \"" + std::string(name) +
                     "\"; there are momentum, explicit-euler, symplectic-euler, runge-kutta-4"};
}

}  // namespace lendulet
