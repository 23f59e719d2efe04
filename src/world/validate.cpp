#include "world/validate.h"

#include "world/world_data.h"

namespace lendulet {

Result<Quat> unit_quaternion(Quat q, const char* call) {
    float size2 = dot(q, q);
    if (!is_finite(size2)) return Error{ErrorCode::non_finite, std::string(call) + ": orientation must be finite"};
    float size = square_root(size2);
    if (absolute(size - 1.0f) > 1e-3f)
        return Error{ErrorCode::bad_rotation,
                     std::string(call) + ": orientation has length " + text(size) + ", must be 1"};
    // Left alone where it is exact, so that a pose given is the pose read.
    if (absolute(size2 - 1.0f) < 1e-6f) return q;
    return normalize(q);
}

namespace {

Status valid_place(Vec3 v, const char* what, const char* from, const char* call) {
    if (!is_finite(v)) return Error{ErrorCode::non_finite, std::string(call) + ": " + what + " must be finite"};
    if (max_component(absolute(v)) > world_extent)
        return Error{ErrorCode::out_of_world,
                     std::string(call) + ": " + what + " is farther than " + text(world_extent) + " m from " + from};
    return {};
}

}  // namespace

Status valid_position(Position p, const char* call) {
    return valid_place(from_origin(p), "position", "the origin", call);
}

Status valid_offset(Vec3 offset, const char* what, const char* call) {
    return valid_place(offset, what, "the body's own", call);
}

Error no_such(const Slots& slots, uint32_t generation, const char* call, const char* what) {
    if (generation == 0) return {ErrorCode::stale_id, std::string(call) + ": " + what + " is a null handle"};
    if (slots.foreign(generation))
        return {ErrorCode::wrong_world, std::string(call) + ": that " + what + " belongs to another world"};
    return {ErrorCode::stale_id, std::string(call) + ": there is no such " + what + " any more"};
}

namespace {

Result<float> coefficient(std::optional<float> given, float fallback, float most, const char* what, const char* call) {
    float value = given.value_or(fallback);
    if (!is_finite(value) || value < 0.0f || value > most)
        return Error{ErrorCode::bad_material,
                     std::string(call) + ": " + what + " is " + text(value) + ", must be between 0 and " + text(most)};
    return value;
}

}  // namespace

Result<Surface> make_surface(const WorldConfig& config, const Material& m, const char* call) {
    Result<float> fixed = coefficient(m.static_friction, config.friction, max_friction, "static friction", call);
    if (!fixed) return fixed.error();
    Result<float> sliding = coefficient(m.dynamic_friction, m.static_friction.value_or(config.friction), max_friction,
                                        "dynamic friction", call);
    if (!sliding) return sliding.error();
    Result<float> bounce = coefficient(m.restitution, config.restitution, 1.0f, "restitution", call);
    if (!bounce) return bounce.error();
    Result<float> rolling = coefficient(m.rolling_friction, 0.0f, max_friction, "rolling friction", call);
    if (!rolling) return rolling.error();
    Result<float> spinning = coefficient(m.spinning_friction, 0.0f, max_friction, "spinning friction", call);
    if (!spinning) return spinning.error();
    Result<float> turned = coefficient(m.tangential_restitution, 0.0f, 1.0f, "tangential restitution", call);
    if (!turned) return turned.error();
    if (!is_finite(m.surface_velocity))
        return Error{ErrorCode::bad_material, std::string(call) + ": surface velocity must be finite"};
    if (m.friction_combine > CombineRule::multiply || m.restitution_combine > CombineRule::multiply)
        return Error{ErrorCode::bad_material, std::string(call) + ": that combine rule is none"};
    return with_defaults(m, config.friction, config.restitution);
}

Status check_mass(float mass, const char* call) {
    constexpr float least = 1e-9f, most = 1e12f;
    if (mass >= least && mass <= most) return {};
    return Error{ErrorCode::bad_mass, std::string(call) + ": mass is " + text(mass) + " kg, must be between " +
                                          text(least) + " and " + text(most)};
}
bool can_be_inverted(Vec3 inertia) { return is_finite(inertia) && min_component(inertia) > 1e-36f; }

Status check_events(Events events, const char* call) {
    if (events <= Events::all) return {};
    return Error{ErrorCode::bad_collider, std::string(call) + ": such events are none"};
}

Status check_drag(float linear_damping, float angular_damping, float gravity_factor, const char* call) {
    if (!is_finite(linear_damping) || !is_finite(angular_damping) || !is_finite(gravity_factor))
        return Error{ErrorCode::non_finite, std::string(call) + ": damping and gravity factor must be finite"};
    if (linear_damping < 0.0f || angular_damping < 0.0f)
        return Error{ErrorCode::bad_material, std::string(call) + ": damping must not be negative"};
    return {};
}

}  // namespace lendulet
