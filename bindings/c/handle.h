// What stands behind a world's handle in the C interface, and what all its functions share.
#pragma once

#include <string>
#include <vector>

#include "lendulet/lendulet_c.h"
#include "scenes/scene.h"

// A point of a body that is pulled.
struct lendulet_grip {
    lendulet::BodyId body{};
    lendulet::Vec3 on_body;  // in the body's frame, m
    lendulet::Position target;
};

struct lendulet_world {
    explicit lendulet_world(lendulet::Scene built) : scene(std::move(built)) {}
    lendulet::Scene scene;
    lendulet_grip grip{};
    // What read functions point to.
    std::vector<lendulet_pose> poses;
    std::vector<lendulet_body> bodies;
    std::vector<lendulet_collider> colliders;
    std::vector<lendulet::Shape> meshes;  // hulls and meshes, one for each that the colliders share
    std::vector<lendulet::Vec3> vertices;
    std::vector<uint32_t> indices;
    std::vector<lendulet_contact> contacts;
    std::vector<uint8_t> snapshot;
    std::vector<lendulet_joint_state> joints;
    std::vector<lendulet_box> boxes;
    std::vector<lendulet_group> groups;
    std::vector<lendulet_motion> motions;
    std::vector<lendulet_joint> joint_numbers;
    std::vector<lendulet_shape> shapes;
    std::vector<lendulet_touch> touches;
    std::vector<lendulet_blow> hits;
    std::vector<lendulet_sleep> sleeps;
    std::vector<lendulet_break> breaks;
    std::vector<lendulet_body> overlaps;
    std::vector<lendulet::Shape> given;  // hulls and meshes for parts
};

namespace lendulet::c {

// Remembers the sentence, returns the code.
lendulet_result refuse(const Error& error);
inline lendulet_result result_of(const Status& status) { return status.ok() ? 0 : refuse(status.error()); }
// Refusal of a null world or pointer.
lendulet_result refuse_null(const char* call);
lendulet_result refuse_body(const char* call);

template <class Id>
uint64_t number_of(Id id) {
    return uint64_t{id.generation} << 32 | id.index;
}
template <class Id = BodyId>
Id id_of(uint64_t number) {
    return {static_cast<uint32_t>(number), static_cast<uint32_t>(number >> 32)};
}
inline Vec3 vector(const float* v) { return {v[0], v[1], v[2]}; }
inline Position position(const float* v) { return {v[0], v[1], v[2]}; }
inline void put(float* out, Vec3 v) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }
inline void put(float* out, Position p) { put(out, from_origin(p)); }
inline void put(float* out, Quat q) { out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w; }

inline Quat rotation(const float* q) { return {q[0], q[1], q[2], q[3]}; }
// The shape of a part; `call` is who asks.
Status set_shape(const lendulet_world& world, const lendulet_part& part, const char* call, Shape& out);

// The force of the grip, before a step.
void pull(lendulet_world& world);

// Points `out` to a list and returns how many there are.
template <class T>
lendulet_result give(const std::vector<T>& list, const T** out) {
    *out = list.data();
    return static_cast<lendulet_result>(list.size());
}

}  // namespace lendulet::c
