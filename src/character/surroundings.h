// What is around a character within one step: things that stand, and bodies that move on while it moves.
//
// Queries see bodies where they are when the step begins. A body that moves by `motion` within the step is therefore
// met in its own frame: the character is cast against it with what is left of its way less what is left of the body's.
#pragma once

#include "lendulet/character.h"

namespace lendulet {

// A body near the character that may move.
struct Neighbour {
    BodyId body;
    BodyType type;
    Vec3 motion;  // of its material at the character, over the whole step
    float gap;    // between the two when the step begins, negative where they overlap
    Vec3 normal;  // there, towards the character
    Position point;
    ColliderId collider;
    bool met = false;  // impulses have been exchanged
};

struct Meeting {
    QueryHit hit{};  // its fraction is of the way, and may be above 1
    Neighbour* neighbour = nullptr;
    Vec3 way{};  // relative to what is met
    explicit operator bool() const { return hit.hit; }
    // The share of the way after which a gap `skin` is left; where it is nearer already, 0. The plane between the two
    // is a bound of their distance, so that gap is kept from round things too.
    float share(float skin) const { return clamp(hit.fraction - skin / approach(), 0.0f, 1.0f); }
    // How fast the way leads into it, m for the whole of the way.
    float approach() const { return -dot(way, hit.normal); }
};

class Surroundings {
public:
    // Casts look `beyond` the end of the way, m.
    Surroundings(const World& world, const QueryFilter& others, float beyond)
        : world_(world), others_(others), beyond_(beyond) {}

    // Looks for bodies that may come in the way of the shape within `margin` and `below` it. `carried`: how far the
    // ground takes the character.
    void look(const PosedShape& shape, Vec3 margin, float dt, BodyId ground, Vec3 carried);
    std::span<Neighbour> neighbours() { return {neighbours_, static_cast<size_t>(count_)}; }
    Neighbour* find(BodyId body);

    // What the shape meets first on its way when the share `done` of the step is over. What it touches but moves away
    // from does not count.
    Meeting first(const PosedShape& shape, Vec3 way, float done);
    // The face at `point` of what was met there, seen from above: where it is level enough to stand on, its normal.
    Result<QueryHit> face_at(const Meeting& meeting, Position point, Vec3 up, float depth, float done) const;

private:
    Meeting first_of(const PosedShape& shape, Vec3 way, const QueryFilter& filter) const;

    const World& world_;
    QueryFilter others_;
    float beyond_;
    Neighbour neighbours_[32];
    int count_ = 0;
    bool all_still_ = true;  // nothing near moves: one cast sees all
};

// How far a rigid body takes the point `p` of it in `dt`.
Vec3 taken_by(const RigidBodyRef& body, Position p, float dt);

}  // namespace lendulet
