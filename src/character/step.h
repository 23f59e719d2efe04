// One update of a character. It works on a copy of the state, and gives impulses to bodies when all has gone well.
#pragma once

#include "character/motion_bounds.h"
#include "character/surroundings.h"

namespace lendulet {

// A way through the surroundings: what is left of it, and the bounds found so far.
struct Travel {
    Vec3 walk{}, carry{};  // left: of its own, and of what takes it along
    float done = 0.0f;     // share of the step
    bool walks = false;    // steep faces are walls, level ones are followed, steps are climbed, bodies pushed
    bool acts = true;      // false: only a trial, which pushes nobody
    Vec3 moved{};          // so far, but for steps
    bool possible = true;
    MotionBound bounds[12];
    int count = 0;
    Vec3 way() const { return walk + carry; }
    void add(MotionBound bound);
    // What is left of all when `moved` is behind it.
    void advance(Vec3 by, float share);
    // The velocity that is left of `velocity` by what is nearer than `near` in the end.
    Vec3 after(Vec3 velocity, float near) const;
    NearestMotion nearest(Vec3 wanted) const { return nearest_motion(wanted, {bounds, static_cast<size_t>(count)}); }
};

struct CharacterStep {
    Character& who;
    World& world;
    const CharacterMove& move;
    const float dt;
    CharacterState s;
    const Vec3 up;
    QueryFilter others;
    Surroundings around;
    Vec3 pushed{};   // impulses on the character that its legs or its mass gave, N s
    float strength;  // left of its push in this step, N s
    CharacterContact contacts[16];
    int contact_count = 0;
    int loaded = -1;  // that of them which bears its weight

    CharacterStep(Character& c, World& w, const CharacterMove& m, float step);
    void run();
    void give_impulses();

private:
    static QueryFilter others_of(const Character& c);
    const Character::Stance& stance() const { return who.stances_[static_cast<size_t>(s.stance)]; }
    PosedShape shape() const { return {stance().shape, {s.position + stance().centre * up, s.orientation}}; }
    Vec3 level(Vec3 v) const { return v - dot(v, up) * up; }
    Vec3 along_ground(Vec3 level_way, Vec3 normal) const;
    bool is_level(Vec3 normal) const { return dot(normal, up) >= who.least_cosine_; }

    // motion.cpp
    void come_out();
    void travel(Travel& t);
    bool stands_on(Meeting& meeting, float done);
    bool step_up(Travel& t);
    Vec3 wall(Vec3 normal) const;
    void make_way(Travel& t);

    // ground.cpp
    void look_at_ground();
    void find_ground(float reach);
    bool is_held();
    void weigh_on_ground(Vec3 walked, bool jumps);
    bool on_dynamic(BodyId body) const;

    // push.cpp
    void push(Neighbour& b, Vec3 normal, Position point, Vec3 velocity, bool walks);
    void note(BodyId body, ColliderId collider, Position point, Vec3 normal, Vec3 impulse);
};

}  // namespace lendulet
