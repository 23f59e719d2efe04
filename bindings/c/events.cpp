// The C interface: what may change while a world runs, and what a step tells.
#include "bindings/c/handle.h"

using namespace lendulet;
using namespace lendulet::c;

namespace {

static_assert(static_cast<int>(Coordinate::x) == LENDULET_ALONG_X &&
              static_cast<int>(Coordinate::swing) == LENDULET_SWING);
static_assert(static_cast<int>(Events::contacts) == LENDULET_CONTACT_EVENTS &&
              static_cast<int>(Events::hits) == LENDULET_HIT_EVENTS);
static_assert(static_cast<int>(BodyType::kinematic) == LENDULET_KINEMATIC &&
              static_cast<int>(BodyType::dynamic) == LENDULET_DYNAMIC);

// Calls set(id) or set(id, coordinate).
template <class Set>
lendulet_result set_coordinate(lendulet_joint joint, int32_t coordinate, const char* call, Set&& set) {
    const JointId id = id_of<JointId>(joint);
    if (coordinate == LENDULET_ONLY) return result_of(set(id));
    if (coordinate < 0 || coordinate > LENDULET_SWING)
        return refuse({ErrorCode::bad_joint, std::string(call) + ": there is no such coordinate"});
    return result_of(set(id, static_cast<Coordinate>(coordinate)));
}

lendulet_touch touch_of(const Overlap& o) {
    return {number_of(o.trigger_body), number_of(o.other_body), number_of(o.trigger), number_of(o.other)};
}
template <class Event>
lendulet_touch touch_of(const Event& e) {
    return {number_of(e.body_a), number_of(e.body_b), number_of(e.collider_a), number_of(e.collider_b)};
}

}  // namespace

extern "C" {

lendulet_result lendulet_read_joint_numbers(lendulet_world* world, const lendulet_joint** out) {
    if (!world || !out) return refuse_null("read_joint_numbers");
    const World& w = world->scene.world;
    world->joint_numbers.clear();
    for (int i = 0; i < w.joint_count(); ++i) world->joint_numbers.push_back(number_of(w.joint_id(i)));
    return give(world->joint_numbers, out);
}

lendulet_result lendulet_read_shapes(lendulet_world* world, lendulet_body body, const lendulet_shape** out) {
    if (!world || !out) return refuse_null("read_shapes");
    const World& w = world->scene.world;
    if (!w.alive(id_of(body))) return refuse_body("read_shapes");
    const StaticBodyRef ref = w.get_static(id_of(body));
    world->shapes.clear();
    for (int i = 0; i < ref.collider_count(); ++i) world->shapes.push_back(number_of(ref.collider(i)));
    return give(world->shapes, out);
}

lendulet_result lendulet_set_motor(lendulet_world* world, lendulet_joint joint, int32_t coordinate, float velocity,
                                   float max_force) {
    if (!world) return refuse_null("set_motor");
    return set_coordinate(joint, coordinate, "set_motor", [&](auto... at) {
        return world->scene.world.set_motor(at..., Motor{velocity, max_force});
    });
}

lendulet_result lendulet_set_spring(lendulet_world* world, lendulet_joint joint, int32_t coordinate,
                                    const lendulet_spring* s) {
    if (!world || !s) return refuse_null("set_spring");
    const Spring spring{s->stiffness, s->damping, s->target, s->max_force, s->target_velocity};
    return set_coordinate(joint, coordinate, "set_spring",
                          [&](auto... at) { return world->scene.world.set_spring(at..., spring); });
}

lendulet_result lendulet_set_limit(lendulet_world* world, lendulet_joint joint, int32_t coordinate, float lower,
                                   float upper) {
    if (!world) return refuse_null("set_limit");
    return set_coordinate(joint, coordinate, "set_limit", [&](auto... at) {
        return world->scene.world.set_limit(at..., Limit{lower, upper});
    });
}

lendulet_result lendulet_set_joint_friction(lendulet_world* world, lendulet_joint joint, int32_t coordinate,
                                            float friction) {
    if (!world) return refuse_null("set_joint_friction");
    return set_coordinate(joint, coordinate, "set_joint_friction",
                          [&](auto... at) { return world->scene.world.set_friction(at..., friction); });
}

lendulet_result lendulet_set_body_type(lendulet_world* world, lendulet_body body, int32_t type) {
    if (!world) return refuse_null("set_body_type");
    World& w = world->scene.world;
    if (!w.alive(id_of(body)) || w.get_static(id_of(body)).type() == BodyType::fixed)
        return refuse_body("set_body_type");
    const bool known = type == LENDULET_KINEMATIC || type == LENDULET_DYNAMIC;
    return result_of(w.get(id_of(body)).set_type(known ? static_cast<BodyType>(type) : BodyType::fixed));
}

lendulet_result lendulet_remove_joint(lendulet_world* world, lendulet_joint joint) {
    if (!world) return refuse_null("remove_joint");
    return result_of(world->scene.world.remove_joint(id_of<JointId>(joint)));
}

lendulet_result lendulet_set_material(lendulet_world* world, lendulet_shape shape, const lendulet_material* material) {
    if (!world || !material) return refuse_null("set_material");
    const lendulet_material& m = *material;
    Material to;
    if (!(m.static_friction < 0.0f)) to.static_friction = m.static_friction;
    if (!(m.dynamic_friction < 0.0f)) to.dynamic_friction = m.dynamic_friction;
    if (!(m.restitution < 0.0f)) to.restitution = m.restitution;
    to.rolling_friction = m.rolling_friction, to.spinning_friction = m.spinning_friction;
    to.tangential_restitution = m.tangential_restitution;
    to.surface_velocity = vector(m.surface_velocity);
    return result_of(world->scene.world.set_material(id_of<ColliderId>(shape), to));
}

lendulet_result lendulet_set_filter(lendulet_world* world, lendulet_shape shape, uint64_t category, uint64_t mask,
                                    uint32_t group) {
    if (!world) return refuse_null("set_filter");
    return result_of(world->scene.world.set_filter(id_of<ColliderId>(shape), {category, mask, group}));
}

lendulet_result lendulet_set_events(lendulet_world* world, lendulet_shape shape, int32_t events) {
    if (!world) return refuse_null("set_events");
    const bool known = events >= 0 && events <= static_cast<int32_t>(Events::all);
    const auto asked = static_cast<Events>(known ? events : 0xff);  // which is refused
    return result_of(world->scene.world.set_events(id_of<ColliderId>(shape), asked));
}

lendulet_result lendulet_read_touches(lendulet_world* world, int32_t kind, const lendulet_touch** out) {
    if (!world || !out || kind < LENDULET_CONTACT_BEGINS || kind > LENDULET_TRIGGER_ENDS)
        return refuse_null("read_touches");
    const World& w = world->scene.world;
    world->touches.clear();
    if (kind <= LENDULET_CONTACT_ENDS) {
        for (const ContactEvent& e : kind == LENDULET_CONTACT_BEGINS ? w.contact_begins() : w.contact_ends())
            world->touches.push_back(touch_of(e));
    } else {
        for (const Overlap& o : kind == LENDULET_TRIGGER_BEGINS ? w.trigger_begins() : w.trigger_ends())
            world->touches.push_back(touch_of(o));
    }
    return give(world->touches, out);
}

lendulet_result lendulet_read_hits(lendulet_world* world, const lendulet_blow** out) {
    if (!world || !out) return refuse_null("read_hits");
    world->hits.clear();
    for (const ContactHit& h : world->scene.world.contact_hits()) {
        lendulet_blow blow{touch_of(h), {}, {}, h.speed, h.impulse};
        put(blow.position, h.position), put(blow.normal, h.normal);
        world->hits.push_back(blow);
    }
    return give(world->hits, out);
}

lendulet_result lendulet_read_sleep_events(lendulet_world* world, const lendulet_sleep** out) {
    if (!world || !out) return refuse_null("read_sleep_events");
    world->sleeps.clear();
    for (const SleepEvent& e : world->scene.world.sleep_events())
        world->sleeps.push_back({number_of(e.body), e.asleep ? 1 : 0});
    return give(world->sleeps, out);
}

lendulet_result lendulet_read_joint_breaks(lendulet_world* world, const lendulet_break** out) {
    if (!world || !out) return refuse_null("read_joint_breaks");
    world->breaks.clear();
    for (const JointBreak& b : world->scene.world.joint_breaks()) {
        lendulet_break entry{number_of(b.joint), number_of(b.body_a), number_of(b.body_b), {}, {}};
        put(entry.force, b.force), put(entry.torque, b.torque);
        world->breaks.push_back(entry);
    }
    return give(world->breaks, out);
}

}  // extern "C"
