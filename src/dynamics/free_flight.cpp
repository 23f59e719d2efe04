#include "dynamics/free_flight.h"

namespace lendulet {
namespace {

struct Rates {
    Vec3 x, w, p, L;
};

Rates rates(const FlightState& s, const FlightBody& b) {
    Rates r;
    r.x = b.inverse_mass * s.p;
    Quat q = normalize(s.q);
    r.w = rotate(q, multiply(b.inverse_inertia, rotate_inverse(q, s.L)));  // w = R I^-1 R^T L, thesis 3.2
    r.p = b.force - b.linear_damping * s.p;
    r.L = b.torque - b.angular_damping * s.L;
    return r;
}

// q' = w q / 2: the quaternion form of R' = w* R.
Quat turn(Quat q, Vec3 w, float h) {
    Quat d = Quat{w.x, w.y, w.z, 0.0f} * q;
    float s = 0.5f * h;
    return {q.x + s * d.x, q.y + s * d.y, q.z + s * d.z, q.w + s * d.w};
}

FlightState moved(const FlightState& s, Quat at, const Rates& r, float h) {
    Quat d = Quat{r.w.x, r.w.y, r.w.z, 0.0f} * at;
    float k = 0.5f * h;
    return {s.x + h * r.x,
            {s.q.x + k * d.x, s.q.y + k * d.y, s.q.z + k * d.z, s.q.w + k * d.w},
            s.p + h * r.p,
            s.L + h * r.L};
}

FlightState runge_kutta(const FlightState& s, const FlightBody& b, float h) {
    Rates k1 = rates(s, b);
    FlightState s2 = moved(s, s.q, k1, 0.5f * h);
    Rates k2 = rates(s2, b);
    FlightState s3 = moved(s, s2.q, k2, 0.5f * h);
    Rates k3 = rates(s3, b);
    FlightState s4 = moved(s, s3.q, k3, h);
    Rates k4 = rates(s4, b);
    auto mean = [](Vec3 a, Vec3 c, Vec3 d, Vec3 e) { return (1.0f / 6.0f) * (a + 2.0f * (c + d) + e); };
    FlightState out = s;
    out.x += h * mean(k1.x, k2.x, k3.x, k4.x);
    out.p += h * mean(k1.p, k2.p, k3.p, k4.p);
    out.L += h * mean(k1.L, k2.L, k3.L, k4.L);
    auto dq = [](Vec3 w, Quat q) { return Quat{w.x, w.y, w.z, 0.0f} * q; };
    Quat a = dq(k1.w, s.q), c = dq(k2.w, s2.q), d = dq(k3.w, s3.q), e = dq(k4.w, s4.q);
    float k = 0.5f * h / 6.0f;
    out.q = {s.q.x + k * (a.x + 2.0f * (c.x + d.x) + e.x), s.q.y + k * (a.y + 2.0f * (c.y + d.y) + e.y),
             s.q.z + k * (a.z + 2.0f * (c.z + d.z) + e.z), s.q.w + k * (a.w + 2.0f * (c.w + d.w) + e.w)};
    return out;
}

}  // namespace

FlightState advance(const FlightState& state, const FlightBody& body, Integrator method, float h) {
    FlightState out = state;
    if (method == Integrator::runge_kutta_4) {
        out = runge_kutta(state, body, h);
    } else {
        Rates r = rates(state, body);
        out.p += h * r.p;
        out.L += h * r.L;
        // Symplectic Euler moves with the new velocities, explicit Euler with the old ones.
        Rates use = method == Integrator::symplectic_euler ? rates(out, body) : r;
        out.x += h * use.x;
        out.q = turn(state.q, use.w, h);
    }
    out.q = normalize(out.q);
    return out;
}

}  // namespace lendulet
