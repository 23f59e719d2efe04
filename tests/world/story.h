// Random stories: worlds to which all sorts of bodies and joints come and go while they run, each told the same way to
// any number of worlds. A story never looks at the world that it is told to, so that worlds which differ differ by
// themselves.
#pragma once

#include <vector>

#include "lendulet/lendulet.h"
#include "numbers.h"

namespace lendulet::test {

// What may come into a story.
struct StoryCast {
    bool kinematic = true;    // bodies that turn and wander, with all that they crush
    bool driven = true;       // motors and springs, impulses, teleports, other gravity, bodies that are removed
    bool extremes = true;     // masses of grams beside tonnes, and bullets
    bool six_degrees = true;  // joints of any freedoms
};

class Story {
public:
    Story(uint32_t seed, StoryCast cast);
    // The ground: a plane, a mesh with thin and empty triangles, a height field.
    void begin(World& world);
    // Something happens to the world.
    void go_on(World& world);
    // ... and it makes a step.
    void go_on(World& world, float dt);

private:
    Shape shape();
    void add_body(World& world);
    void add_joint(World& world);
    void drive(World& world);
    void disturb(World& world);
    int one_of(int n) { return static_cast<int>(numbers_.in(0.0f, static_cast<float>(n) * 0.999999f)); }
    bool once_in(int n) { return one_of(n) == 0; }

    RandomNumbers numbers_;
    StoryCast cast_;
    std::vector<ConvexHull> hulls_;
    std::vector<BodyId> bodies_;
    std::vector<JointId> joints_;
};

}  // namespace lendulet::test
