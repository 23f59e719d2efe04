// The character as its users see it: what is refused, and what changes it beside its steps.
#include "lendulet/character.h"

#include <string>

#include "character/outline.h"
#include "character/step.h"

namespace lendulet {
namespace {

bool is_finite(float x) { return x - x == 0.0f; }
bool is_finite(Vec3 v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }

Error refused(ErrorCode code, const std::string& what) { return {code, "character: " + what}; }

Status check_rotation(Quat q) {
    const float size = dot(q, q);
    if (!is_finite(size)) return refused(ErrorCode::non_finite, "the orientation must be finite");
    if (!(absolute(size - 1.0f) <= 2e-3f))
        return refused(ErrorCode::bad_rotation, "the orientation must have length 1");
    return {};
}

Status check_def(const CharacterDef& def) {
    const float numbers[] = {def.mass, def.max_slope, def.step_height, def.push_force, def.grip, def.skin};
    for (float x : numbers)
        if (!is_finite(x)) return refused(ErrorCode::non_finite, "all numbers must be finite");
    if (!is_finite(from_origin(def.position))) return refused(ErrorCode::non_finite, "its position must be finite");
    if (!(def.mass >= 1e-9f && def.mass <= 1e12f))
        return refused(ErrorCode::bad_mass, "its mass must be 1e-9 .. 1e12 kg");
    if (!(def.max_slope >= 0.0f && def.max_slope <= 1.5f))
        return refused(ErrorCode::bad_extent, "max_slope must be 0 .. 1.5 rad");
    if (!(def.step_height >= 0.0f && def.step_height <= 1e4f) || !(def.skin >= 0.0f))
        return refused(ErrorCode::bad_extent, "step_height and skin must not be negative");
    if (!(def.push_force >= 0.0f) || !(def.grip >= 0.0f))
        return refused(ErrorCode::bad_material, "push_force and grip must not be negative");
    if (def.stances.size() > 4) return refused(ErrorCode::bad_collider, "it has more than 4 stances");
    return def.orientation ? check_rotation(*def.orientation) : Status{};
}

// A stance that is not in use meets nothing.
CollisionFilter filter_of(const CollisionFilter& given, bool in_use) {
    return in_use ? given : CollisionFilter{0, 0, given.group};
}

}  // namespace

Result<Character> Character::add(World& world, const CharacterDef& def) {
    if (Status s = check_def(def); !s) return s.error();
    const std::span<const Shape> shapes = def.stances.empty() ? std::span<const Shape>(&def.shape, 1) : def.stances;
    Character c;
    float width = 1e4f;
    for (const Shape& shape : shapes) {
        // The world knows which shapes there are.
        if (Result<bool> fit = world.overlap_any({shape, {def.position, {}}}); !fit)
            return refused(ErrorCode::bad_collider, fit.error().message);
        width = minimum(width, outline_of(shape).width);
    }
    c.skin_ = def.skin > 0.0f ? def.skin : 0.02f * width;
    if (!(c.skin_ < 0.5f * width))
        return refused(ErrorCode::bad_extent, "the skin must be less than half its half width");
    c.mass_ = def.mass, c.push_force_ = def.push_force, c.grip_ = def.grip;
    c.least_cosine_ = sin_cos(def.max_slope).cos - 1e-4f;  // what is as steep as that can be stood on
    c.step_height_ = def.step_height;
    c.filter_ = def.filter, c.pushed_by_ = def.pushed_by;
    const Vec3 gravity = world.config().gravity;
    const Vec3 y{0.0f, 1.0f, 0.0f};
    c.state_.orientation = def.orientation ? normalize(*def.orientation) : rotation_between(y, normalize(-gravity, y));
    c.state_.position = def.position;
    ColliderDef colliders[4];
    for (const Shape& shape : shapes) {
        const Outline outline = outline_of(shape);
        const auto i = static_cast<size_t>(c.stance_count_++);
        c.stances_[i] = {shape, grown(shape, c.skin_), -outline.lowest, outline.reach, outline.across};
        colliders[i].shape = shape;
        colliders[i].local.translation = {0.0f, -outline.lowest, 0.0f};
        colliders[i].filter = filter_of(def.filter, i == 0);
    }
    if (!def.body) return c;
    Result<BodyId> body = world.add_rigid_body({.position = def.position,
                                                .orientation = c.state_.orientation,
                                                .colliders = {colliders, static_cast<size_t>(c.stance_count_)},
                                                .kinematic = true,
                                                .user_data = def.user_data});
    if (!body) return body.error();
    c.state_.body = body.value();
    return c;
}

Status Character::check_alive(const World& world) const {
    if (!state_.body || world.alive(state_.body)) return {};
    return refused(ErrorCode::stale_id, "its body was removed from this world, or is of another");
}

Status Character::remove(World& world) {
    if (Status s = check_alive(world); !s || !state_.body) return s;
    return world.remove_body(state_.body);
}

Status Character::update(World& world, const CharacterMove& move, float dt) {
    if (Status s = check_alive(world); !s) return s;
    if (!is_finite(move.velocity) || !is_finite(move.acceleration) || !is_finite(move.jump) || !(move.jump >= 0.0f))
        return refused(ErrorCode::non_finite, "what it is told must be finite, and its jump not negative");
    if (!(dt > 0.0f && dt <= 1.0f)) return refused(ErrorCode::bad_time_step, "dt must be above 0 and at most 1 s");
    CharacterStep step(*this, world, move, dt);
    step.run();
    if (!is_finite(from_origin(step.s.position)) || !is_finite(step.s.velocity))
        return refused(ErrorCode::out_of_world, "it would go where no world is");
    if (state_.body) {
        RigidBodyRef body = world.get(state_.body);
        const Vec3 way = step.s.position - body.position();
        const Quat q = body.orientation();
        // A body that is where it belongs and stands still is not woken.
        const bool rests = dot(way, way) == 0.0f && dot(body.velocity(), body.velocity()) == 0.0f &&
                           absolute(dot(q, step.s.orientation)) > 0.9999999f;
        if (!rests)
            if (Status s = body.move_to(step.s.position, step.s.orientation, dt); !s) return s;
    }
    step.give_impulses();
    state_ = step.s;
    contact_count_ = step.contact_count;
    for (int i = 0; i < contact_count_; ++i) contacts_[static_cast<size_t>(i)] = step.contacts[i];
    return {};
}

Status Character::take_stance(World& world, int stance) {
    if (!state_.body || stance == state_.stance) return {};
    const StaticBodyRef body = world.get_static(state_.body);
    if (Status s = world.set_filter(body.collider(state_.stance), filter_of(filter_, false)); !s) return s;
    return world.set_filter(body.collider(stance), filter_of(filter_, true));
}

Status Character::set_state(World& world, const CharacterState& state) {
    const Vec3 vectors[] = {from_origin(state.position), state.velocity,        state.inertia_velocity,
                            state.ground_normal,         state.ground_velocity, from_origin(state.ground_point),
                            {state.ahead, 0.0f, 0.0f}};
    for (Vec3 v : vectors)
        if (!is_finite(v)) return refused(ErrorCode::non_finite, "a state must be finite");
    if (Status s = check_rotation(state.orientation); !s) return s;
    if (state.stance < 0 || state.stance >= stance_count_) return refused(ErrorCode::bad_collider, "no such stance");
    if (!(state.body == state_.body)) return refused(ErrorCode::stale_id, "the state is that of another character");
    if (Status s = check_alive(world); !s) return s;
    // Snapshots hold filters too: whatever it was, the stance is that of the state.
    for (int i = 0; state_.body && i < stance_count_; ++i)
        if (Status s =
                world.set_filter(world.get_static(state_.body).collider(i), filter_of(filter_, i == state.stance));
            !s)
            return s;
    state_ = state;
    contact_count_ = 0;
    return {};
}

Status Character::set_position(World& world, Position feet) {
    if (Status s = check_alive(world); !s) return s;
    if (!is_finite(from_origin(feet))) return refused(ErrorCode::non_finite, "its position must be finite");
    if (state_.body)
        if (Status s = world.get(state_.body).set_pose(feet, state_.orientation); !s) return s;
    state_.position = feet;
    state_.ground = CharacterGround::air;
    state_.ground_body = {}, state_.ground_collider = {};
    state_.ahead = 0.0f;
    contact_count_ = 0;
    return {};
}

Status Character::set_velocity(Vec3 velocity) {
    if (!is_finite(velocity)) return refused(ErrorCode::non_finite, "its velocity must be finite");
    if (dot(velocity - state_.ground_velocity, up()) > 0.0f) {
        state_.ground = CharacterGround::air;
        state_.ground_body = {}, state_.ground_collider = {};
    }
    state_.velocity = state_.inertia_velocity = velocity;
    return {};
}

Result<bool> Character::fits(const World& world, int stance, Position feet, Quat orientation) const {
    if (stance < 0 || stance >= stance_count_) return refused(ErrorCode::bad_collider, "no such stance");
    if (Status s = check_rotation(orientation); !s) return s.error();
    const Stance& st = stances_[static_cast<size_t>(stance)];
    QueryFilter others;
    others.collision = filter_;
    others.ignore_body = state_.body;
    Result<bool> met = world.overlap_any(
        {st.shape, {feet + st.centre * rotate(orientation, Vec3{0.0f, 1.0f, 0.0f}), orientation}}, others);
    if (!met) return met.error();
    return !met.value();
}

Result<bool> Character::change(World& world, int stance, Quat orientation) {
    if (Status s = check_alive(world); !s) return s.error();
    Result<bool> room = fits(world, stance, state_.position, orientation);
    if (!room || !room.value()) return room;
    if (Status s = take_stance(world, stance); !s) return s.error();
    state_.stance = stance;
    state_.orientation = normalize(orientation);
    return true;
}

Result<bool> Character::set_stance(World& world, int stance) { return change(world, stance, state_.orientation); }

Result<bool> Character::set_orientation(World& world, Quat orientation) {
    return change(world, state_.stance, orientation);
}

}  // namespace lendulet
