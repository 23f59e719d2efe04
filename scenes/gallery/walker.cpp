// Gallery: Theo Jansen's walking linkage, "The Great Pretender" (2007): twelve legs of eleven bars each on one
// crankshaft. A leg's foot goes back on a nearly straight line and forward through the air.
#include "scenes/builders.h"
#include "scenes/parts.h"

namespace lendulet::scenes {
namespace {

constexpr float unit = 0.03f;  // m: the bars' lengths below are multiples of this
constexpr float link_radius = 0.045f, foot_radius = 0.09f, part_density = 500.0f;
constexpr uint32_t group = 1;  // the walker's parts do not meet each other

struct Point {
    float x, y;  // in units, from the crankshaft
};

// Where circles about p and q meet, on the left of the way from p to q.
Point meet(Point p, float from_p, Point q, float from_q) {
    const float dx = q.x - p.x, dy = q.y - p.y, apart = square_root(dx * dx + dy * dy);
    const float along = (from_p * from_p - from_q * from_q + apart * apart) / (2.0f * apart);
    const float across = square_root(maximum(from_p * from_p - along * along, 0.0f));
    return {p.x + (along * dx - across * dy) / apart, p.y + (along * dy + across * dx) / apart};
}

// The joints of a leg on the side of negative x, by the angle of its crank.
struct Leg {
    Point crank, fixed, top, back, knee, shin, foot;
};
Leg leg_at(float angle) {
    const SinCos s = sin_cos(angle);
    Leg leg{};
    leg.crank = {15.0f * s.cos, 15.0f * s.sin};
    leg.fixed = {-38.0f, -7.8f};
    leg.top = meet(leg.fixed, 41.5f, leg.crank, 50.0f);
    leg.back = meet(leg.fixed, 40.1f, leg.top, 55.8f);
    leg.knee = meet(leg.crank, 61.9f, leg.fixed, 39.3f);
    leg.shin = meet(leg.knee, 36.7f, leg.back, 39.4f);
    leg.foot = meet(leg.knee, 49.0f, leg.shin, 65.7f);
    return leg;
}

class Walker {
public:
    Walker(SceneDescription& scene, float height) : scene_(scene), origin_{0.0f, height, 0.0f} {
        SceneBody& chassis = add_body(scene, Box{{0.5f, 0.12f, 1.25f}}, at({0.0f, 14.0f}, 0.0f), part_density);
        for (float side : {-38.0f, 38.0f})
            add_part(chassis, Capsule{1.25f, link_radius},
                     {{side * unit, (-7.8f - 14.0f) * unit, 0.0f}, rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi)},
                     part_density);
        chassis.name = "chassis";
        finish(chassis);
        chassis_ = last_body(scene);
    }
    // The shaft and its cranks at places z with their angles.
    void add_shaft(const float (&places)[6], const float (&angles)[6], float speed) {
        SceneBody& shaft = add_body(scene_, Capsule{1.25f, 0.06f}, at({0.0f, 0.0f}, 0.0f), 2.0f * part_density);
        shaft.orientation = rotation_about({1.0f, 0.0f, 0.0f}, 0.5f * pi);
        for (int i = 0; i < 6; ++i) {
            SinCos s = sin_cos(angles[i]);
            Vec3 half{7.5f * unit * s.cos, 7.5f * unit * s.sin, places[i]};
            Quat turn = conjugate(shaft.orientation);
            add_part(shaft, Box{{7.5f * unit, 0.05f, 0.05f}},
                     {rotate(turn, half), turn * rotation_about(along_z, angles[i])}, part_density);
        }
        finish(shaft);
        shaft_ = last_body(scene_);
        hinge(chassis_, shaft_, {0.0f, 0.0f}, 0.0f).motor = {speed, 4000.0f};
    }
    // `mirror`: -1 for the side of positive x.
    void add_leg(float angle, float z, float mirror) {
        Leg leg = leg_at(mirror > 0.0f ? angle : pi - angle);
        for (Point* p : {&leg.crank, &leg.fixed, &leg.top, &leg.back, &leg.knee, &leg.shin, &leg.foot}) p->x *= mirror;
        const int upper = bars({{leg.fixed, leg.top}, {leg.top, leg.back}, {leg.back, leg.fixed}}, z);
        const int lower = bars({{leg.knee, leg.shin}, {leg.shin, leg.foot}, {leg.foot, leg.knee}}, z);
        SceneBody& shin = scene_.bodies.back();
        ColliderDef& foot = add_part(shin, Sphere{foot_radius}, {at(leg.foot, z) - shin.position, {}}, part_density);
        foot.material.static_friction = 1.0f;
        foot.filter.group = group;
        const int to_top = bars({{leg.crank, leg.top}}, z), to_knee = bars({{leg.crank, leg.knee}}, z);
        const int support = bars({{leg.fixed, leg.knee}}, z), link = bars({{leg.back, leg.shin}}, z);
        hinge(chassis_, upper, leg.fixed, z), hinge(chassis_, support, leg.fixed, z);
        hinge(shaft_, to_top, leg.crank, z), hinge(shaft_, to_knee, leg.crank, z);
        hinge(to_top, upper, leg.top, z), hinge(to_knee, lower, leg.knee, z), hinge(support, lower, leg.knee, z);
        hinge(upper, link, leg.back, z), hinge(link, lower, leg.shin, z);
    }

private:
    Position at(Point p, float z) const { return origin_ + Vec3{unit * p.x, unit * p.y, z}; }
    static void finish(SceneBody& body) {
        body.allow_sleep = false;
        for (ColliderDef& part : body.colliders) part.filter.group = group;
    }
    SceneJoint& hinge(int a, int b, Point p, float z) { return add_hinge(scene_, a, b, at(p, z), along_z); }

    struct Bar {
        Point from, to;
    };
    // A body of bars in the plane at z; its index.
    int bars(std::initializer_list<Bar> list, float z) {
        SceneBody& body = scene_.bodies.emplace_back();
        body.position = at(list.begin()->from, z);
        for (const Bar& bar : list) {
            const Vec3 from = at(bar.from, z) - body.position, to = at(bar.to, z) - body.position;
            const float size = length(to - from);
            add_part(body, Capsule{0.5f * size, link_radius},
                     {0.5f * (from + to), rotation_between({0.0f, 1.0f, 0.0f}, (1.0f / size) * (to - from))},
                     part_density);
        }
        finish(body);
        return last_body(scene_);
    }

    SceneDescription& scene_;
    Position origin_;
    int chassis_ = 0, shaft_ = 0;
};

}  // namespace

SceneDescription walker(int) {
    constexpr float places[6] = {-1.1f, -0.75f, -0.4f, 0.4f, 0.75f, 1.1f};
    constexpr float third = 2.0f * pi / 3.0f;
    constexpr float angles[6] = {0.0f, third, 2.0f * third, 2.0f * third, third, 0.0f};
    SceneDescription scene;
    scene.steps = 1200;
    scene.friction = 0.9f;
    add_ground(scene, 60.0f);
    float lowest = 0.0f;
    for (float angle : angles)
        for (float crank : {angle, pi - angle}) lowest = minimum(lowest, unit * leg_at(crank).foot.y);
    Walker machine(scene, foot_radius - lowest + 0.01f);
    machine.add_shaft(places, angles, 2.0f);
    for (int i = 0; i < 6; ++i)
        for (float mirror : {1.0f, -1.0f}) machine.add_leg(angles[i], places[i], mirror);
    return scene;
}

}  // namespace lendulet::scenes
