#include "world/validate.h"

#include <cstdio>

#include "world/world_data.h"

namespace lendulet {

std::string text(float value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%g", static_cast<double>(value));
    return buffer;
}

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

Status valid_position(Position p, const char* call) {
    Vec3 v = from_origin(p);
    if (!is_finite(v)) return Error{ErrorCode::non_finite, std::string(call) + ": position must be finite"};
    if (max_component(absolute(v)) > world_extent)
        return Error{ErrorCode::out_of_world,
                     std::string(call) + ": position is farther than " + text(world_extent) + " m from the origin"};
    return {};
}

Error no_such(const Slots& slots, uint32_t generation, const char* call, const char* what) {
    if (slots.foreign(generation))
        return {ErrorCode::wrong_world, std::string(call) + ": that " + what + " belongs to another world"};
    return {ErrorCode::stale_id, std::string(call) + ": there is no such " + what + " any more"};
}

}  // namespace lendulet
