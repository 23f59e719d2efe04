// Reference integrators for a body that touches nothing: explicit Euler as the thesis describes it (3.1, 3.2),
// symplectic Euler, and the classical Runge-Kutta method. They exist to be compared with the momentum integrator of the
// solver.
#pragma once

#include "lendulet/math.h"
#include "lendulet/options.h"

namespace lendulet {

struct FlightState {
    Vec3 x;  // displacement since the start, m
    Quat q;  // orientation of the principal axes
    Vec3 p, L;
};

struct FlightBody {
    float inverse_mass;
    Vec3 inverse_inertia;                   // principal
    Vec3 force, torque;                     // constant, world axes
    float linear_damping, angular_damping;  // 1/s
};

// Advances by h with one of the reference methods (not Integrator::momentum).
FlightState advance(const FlightState& state, const FlightBody& body, Integrator method, float h);

}  // namespace lendulet
