// The C interface: contacts, joints, boxes of the broad phase, islands and colours, momenta.
#include "bindings/c/handle.h"

using namespace lendulet;
using namespace lendulet::c;

namespace {

// Places in the list of bodies, by slot.
std::vector<int32_t> places(const World& world) {
    std::vector<int32_t> place;
    for (int i = 0; i < world.body_count(); ++i) {
        const uint32_t slot = world.body(i).index;
        if (slot >= place.size()) place.resize(slot + 1, -1);
        place[slot] = i;
    }
    return place;
}

static_assert(static_cast<int>(JointType::fixed) == LENDULET_RIGID &&
              static_cast<int>(JointType::ball) == LENDULET_BALL &&
              static_cast<int>(JointType::hinge) == LENDULET_HINGE &&
              static_cast<int>(JointType::slider) == LENDULET_SLIDER);

Pose frame_on(const World& world, BodyId body, const Transform& local) {
    StaticBodyRef ref = world.get_static(body);
    return Pose{ref.position(), ref.orientation()} * local;
}

lendulet_joint_state state_of(const World& world, JointId id, const std::vector<int32_t>& place) {
    const JointDef def = world.joint_def(id);
    const JointState now = world.joint(id);
    const Pose a = frame_on(world, def.body_a, def.frame_a), b = frame_on(world, def.body_b, def.frame_b);
    lendulet_joint_state out{};
    out.body_a = place[def.body_a.index], out.body_b = place[def.body_b.index];
    out.type = static_cast<int32_t>(def.type);
    put(out.position, a.position), put(out.orientation, a.orientation);
    put(out.position_b, b.position), put(out.orientation_b, b.orientation);
    out.value = now.position, out.velocity = now.velocity;
    out.limit[0] = def.limit.lower, out.limit[1] = def.limit.upper;
    out.swing = def.swing_limit;
    out.twist[0] = def.twist_limit.lower, out.twist[1] = def.twist_limit.upper;
    put(out.force, now.force), put(out.torque, now.torque);
    return out;
}

lendulet_motion motion_of(const World& world, BodyId id) {
    lendulet_motion out{};
    StaticBodyRef fixed = world.get_static(id);
    put(out.centre, fixed.position());
    if (fixed.type() == BodyType::fixed) return out;
    const RigidBodyRef body = world.get(id);
    put(out.centre, body.centre_of_mass());
    const Aabb box = body.aabb();
    out.reach = 0.5f * length(box.upper - box.lower);
    if (fixed.type() == BodyType::kinematic) return out;
    out.mass = body.mass();
    out.kinetic_energy = body.kinetic_energy();
    put(out.momentum, body.momentum());
    put(out.angular_momentum, body.angular_momentum());
    return out;
}

}  // namespace

extern "C" {

lendulet_result lendulet_read_contacts(lendulet_world* world, const lendulet_contact** out) {
    if (!world || !out) return refuse_null("read_contacts");
    const World& w = world->scene.world;
    const std::vector<int32_t> place = places(w);
    world->contacts.clear();
    for (int i = 0; i < w.contact_count(); ++i) {
        const Contact c = w.contact(i);
        lendulet_contact point{};
        put(point.normal, c.normal);
        point.body_a = place[c.body_a.index], point.body_b = place[c.body_b.index];
        point.manifold = i;
        point.friction_impulse = length(c.friction_impulse);
        for (int j = 0; j < c.point_count; ++j) {
            put(point.position, c.points[j].position);
            point.separation = c.points[j].separation, point.normal_impulse = c.points[j].normal_impulse;
            world->contacts.push_back(point);
        }
    }
    return give(world->contacts, out);
}

lendulet_result lendulet_read_joints(lendulet_world* world, const lendulet_joint_state** out) {
    if (!world || !out) return refuse_null("read_joints");
    const World& w = world->scene.world;
    const std::vector<int32_t> place = places(w);
    world->joints.clear();
    for (int i = 0; i < w.joint_count(); ++i) world->joints.push_back(state_of(w, w.joint_id(i), place));
    return give(world->joints, out);
}

lendulet_result lendulet_read_boxes(lendulet_world* world, const lendulet_box** out) {
    if (!world || !out) return refuse_null("read_boxes");
    world->boxes.clear();
    world->scene.world.for_each_aabb([&](const AabbView& view) {
        lendulet_box box{{}, view.depth, {}, view.leaf};
        put(box.lower, view.box.lower), put(box.upper, view.box.upper);
        world->boxes.push_back(box);
    });
    return give(world->boxes, out);
}

lendulet_result lendulet_read_groups(lendulet_world* world, const lendulet_group** out) {
    if (!world || !out) return refuse_null("read_groups");
    const World& w = world->scene.world;
    const std::vector<int32_t> place = places(w);
    world->groups.clear();
    for (int i = 0; i < w.body_count(); ++i) world->groups.push_back({static_cast<int32_t>(w.island(w.body(i))), -1});
    const std::vector<int> colours = w.contact_colours();
    for (int i = 0; i < w.contact_count(); ++i) {
        const Contact contact = w.contact(i);
        const int colour = colours[static_cast<size_t>(i)];
        for (BodyId body : {contact.body_a, contact.body_b}) {
            int32_t& first = world->groups[static_cast<size_t>(place[body.index])].colour;
            if (colour >= 0 && (first < 0 || colour < first)) first = colour;
        }
    }
    return give(world->groups, out);
}

lendulet_result lendulet_read_motions(lendulet_world* world, const lendulet_motion** out) {
    if (!world || !out) return refuse_null("read_motions");
    const World& w = world->scene.world;
    world->motions.clear();
    for (int i = 0; i < w.body_count(); ++i) world->motions.push_back(motion_of(w, w.body(i)));
    return give(world->motions, out);
}

}  // extern "C"
