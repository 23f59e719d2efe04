// Checks of the caller's data at the door. Every refusal names the call, the argument and what is allowed.
#pragma once

#include <string>

#include "base/text.h"
#include "dynamics/collider_store.h"
#include "dynamics/slots.h"
#include "lendulet/math.h"
#include "lendulet/result.h"
#include "lendulet/world.h"

namespace lendulet {

// Of every material.
inline constexpr float max_friction = 1e6f;  // a coefficient, or m for rolling and spinning

inline bool is_finite(float x) { return x - x == 0.0f; }
inline bool is_finite(Vec3 v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }

// The normalised quaternion where its length is 1 within 1e-3, else bad_rotation or non_finite.
Result<Quat> unit_quaternion(Quat q, const char* call);
// Finite and within the extent of the world.
Status valid_position(Position p, const char* call);
// The same of a place in a body's frame, `what`.
Status valid_offset(Vec3 offset, const char* what, const char* call);
// Refusal of a handle of this generation that is not alive: null, removed, of another world, or never given out.
Error no_such(const Slots& slots, uint32_t generation, const char* call, const char* what);
// A material with the world's defaults, where its coefficients are in range: bad_material.
Result<Surface> make_surface(const WorldConfig& config, const Material& material, const char* call);
// Of a body, kg. Error: bad_mass (out of range, not a number).
Status check_mass(float mass, const char* call);
// Principal moments of inertia, kg m^2: finite, and so are their inverses.
bool can_be_inverted(Vec3 inertia);
// Error: bad_collider (bits that are none).
Status check_events(Events events, const char* call);
// Of a body: finite, damping not negative.
Status check_drag(float linear_damping, float angular_damping, float gravity_factor, const char* call);
}  // namespace lendulet
