// A world with a character that walks in it.
#pragma once

#include "lendulet/character.h"
#include "world/support.h"

namespace lendulet::test {

struct Walk {
    World world;
    Character who;
    float step = dt;

    explicit Walk(const CharacterDef& def = {}, bool floor = true)
        : world(WorldBuilder{}.build().value()), who(make(world, def, floor)) {}
    static Character make(World& world, const CharacterDef& def, bool floor) {
        if (floor) add_floor(world);
        return Character::add(world, def).value();
    }
    Position at() const { return who.position(); }
    void once(const CharacterMove& move = {}) {
        who.update(world, move, step).value();
        world.update(step).value();
    }
    void go(Vec3 velocity, float seconds) {
        for (int i = 0; i < static_cast<int>(seconds / step + 0.5f); ++i) once({.velocity = velocity});
    }
    BodyId put(const Shape& shape, Position place, Quat turn = {}) {
        return world.add_static_body({.shape = shape, .position = place, .orientation = turn}).value();
    }
    BodyId crate(Position place, float mass, Vec3 half = {0.5f, 0.5f, 0.5f}) {
        return world.add_rigid_body({.shape = Box{half}, .position = place, .mass = mass}).value();
    }
    BodyId lift(const Shape& shape, Position place, Vec3 velocity = {}, Vec3 turn = {}) {
        return world
            .add_rigid_body(
                {.shape = shape, .position = place, .velocity = velocity, .angular_velocity = turn, .kinematic = true})
            .value();
    }
};

}  // namespace lendulet::test
