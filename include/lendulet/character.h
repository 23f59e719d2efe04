// A character that walks: a convex shape with a wanted velocity which slides along walls, climbs steps, stays on
// slopes, rides on what carries it and pushes with bounded force. An optional part of the library: it asks a world the
// questions that everybody may ask (query.h), and costs nothing where there is none. See docs/character.md.
//
// Every frame: character.update(world, move, dt), then world.update(dt) with the same dt. Kinematic bodies that carry
// or push are told where they go (move_to) before both. All state is in CharacterState and in the world: worlds that
// get the same calls compute the same bits.
//
// Errors are those of the rest: a sentence, and nothing has changed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "lendulet/body.h"
#include "lendulet/query.h"
#include "lendulet/world.h"

namespace lendulet {

// What a character is like.
struct CharacterDef {
    // Convex; its y axis is up. Where `stances` are given they replace it.
    Shape shape = Capsule{0.6f, 0.3f};
    // Shapes that it may change between, at most 4: standing, crouching, swimming. All with their lowest point at its
    // feet.
    std::span<const Shape> stances{};
    Position position{};  // of its feet: the point of the shape's y axis at the height of its lowest point, m
    std::optional<Quat>
        orientation{};          // its y axis is up; unset: the shortest turn of that against the world's gravity
    float mass = 80.0f;         // kg, > 0; what dynamic bodies feel of it
    float max_slope = 0.8f;     // rad, 0 .. 1.5: what is steeper is a wall
    float step_height = 0.35f;  // m, >= 0: climbed, and gone down without leaving the ground
    float push_force = 500.0f;  // N, >= 0: of its legs, on all dynamic bodies in its way together
    float grip = 1.0f;          // of its feet on dynamic bodies, >= 0: they feel at most this times its weight
    float skin = 0.0f;          // m, kept from everything; 0: a fiftieth of the shape's half width
    CollisionFilter filter{};   // of its body, and of what it meets
    uint64_t pushed_by = ~uint64_t{0};  // categories of kinematic bodies that push it; others only are in its way
    // A kinematic body that goes with it, by which rays, triggers, other bodies and characters meet it.
    bool body = true;
    uint64_t user_data = 0;  // of that body
};

// What it is told for one update.
struct CharacterMove {
    // On the ground: how it walks over it, m/s; what of it is along `up` does not count. Elsewhere it does nothing.
    Vec3 velocity{};
    float jump = 0.0f;    // m/s, >= 0: upwards from the ground, where it stands
    Vec3 acceleration{};  // m/s^2 in the air, beside gravity: air control, wind, flight. Lifts off where it beats
                          // gravity
};

enum class CharacterGround : uint8_t {
    air,
    steep,  // touches what is too steep to stand on, and slides down
    stands
};

// All that the next update depends on, beside the world: plain data to be kept with a snapshot.
struct CharacterState {
    Position position{};  // of its feet, m
    Quat orientation{};
    Vec3 velocity{};          // at which it moved, without steps, m/s
    Vec3 inertia_velocity{};  // its momentum over its mass as dynamic ground has felt it; elsewhere `velocity`
    CharacterGround ground = CharacterGround::air;
    float ahead = 0.0f;     // farther than it would be on its way, after a short step up, m
    bool squeezed = false;  // two things that do not yield press it
    int stance = 0;
    // What it stands on, or slides down; null in the air.
    BodyId ground_body{};
    ColliderId ground_collider{};
    Position ground_point{};
    Vec3 ground_normal{};    // of the face, unit
    Vec3 ground_velocity{};  // at that point, m/s
    BodyId body{};           // of its own
};

// Something that it met in the last update.
struct CharacterContact {
    BodyId body{};
    ColliderId collider{};
    Position point{};
    Vec3 normal{};   // unit, towards the character
    Vec3 impulse{};  // on the body, N s
};

class Character {
public:
    // Errors: bad_collider (no convex shape, more than 4 stances), bad_extent, bad_mass, bad_material (push_force,
    // grip), bad_rotation, non_finite, and those of World::add_rigid_body().
    static Result<Character> add(World& world, const CharacterDef& def = {});
    // Removes its body. The character is of no use then.
    Status remove(World& world);

    // One step of `dt` seconds, above 0 and at most 1. Impulses on dynamic bodies are given at once. About three casts;
    // more where something is in the way. Errors: stale_id (its body was removed), non_finite, bad_time_step,
    // out_of_world, bad_query (a place that is no number).
    Status update(World& world, const CharacterMove& move, float dt);

    const CharacterState& state() const { return state_; }
    // Back to a state of this character. Goes with World::restore(). Errors: non_finite, bad_rotation, bad_collider (no
    // such stance), stale_id.
    Status set_state(World& world, const CharacterState& state);
    Position position() const { return state_.position; }
    Vec3 velocity() const { return state_.velocity; }
    Vec3 up() const { return rotate(state_.orientation, Vec3{0.0f, 1.0f, 0.0f}); }
    bool stands() const { return state_.ground == CharacterGround::stands; }
    BodyId body() const { return state_.body; }
    float skin() const { return skin_; }
    std::span<const CharacterContact> contacts() const {
        return {contacts_.data(), static_cast<size_t>(contact_count_)};
    }

    // Somewhere else, in the air until the next update finds ground. What it lies in then it comes out of as it can.
    // Errors: non_finite, stale_id, out_of_world.
    Status set_position(World& world, Position feet);
    // Of a jump pad, a blow: it leaves the ground where that leads up. Error: non_finite.
    Status set_velocity(Vec3 velocity);
    // Another shape or direction of up: false, and nothing has changed, where there is no room. Errors: bad_collider
    // (no such stance), bad_rotation, non_finite, stale_id.
    Result<bool> set_stance(World& world, int stance);
    Result<bool> set_orientation(World& world, Quat orientation);
    // Whether nothing is in the way of a stance at a place, its skin left aside. Errors as above.
    Result<bool> fits(const World& world, int stance, Position feet, Quat orientation) const;

private:
    friend struct CharacterStep;
    struct Stance {
        Shape shape, outer;   // as given, and grown by the skin
        float centre = 0.0f;  // of the shape's origin above the feet
        float reach = 0.0f;   // of a ball about the shape's origin that holds it
        float across = 0.0f;  // the farthest from its y axis
    };
    Character() = default;
    Status check_alive(const World& world) const;
    Status take_stance(World& world, int stance);
    Result<bool> change(World& world, int stance, Quat orientation);

    std::array<Stance, 4> stances_{};
    int stance_count_ = 0;
    float mass_ = 0.0f, least_cosine_ = 0.0f, step_height_ = 0.0f, push_force_ = 0.0f, grip_ = 0.0f, skin_ = 0.0f;
    CollisionFilter filter_{};
    uint64_t pushed_by_ = 0;
    CharacterState state_{};
    std::array<CharacterContact, 16> contacts_{};
    int contact_count_ = 0;
};

}  // namespace lendulet
