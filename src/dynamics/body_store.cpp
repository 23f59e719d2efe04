#include "dynamics/body_store.h"

#include "math/turned.h"

namespace lendulet {

bool BodyMass::symmetric() const {
    const Vec3 i = inverse_inertia;
    const float near = equal_moments * max_component(i);
    return absolute(i.x - i.y) <= near || absolute(i.y - i.z) <= near || absolute(i.z - i.x) <= near;
}

uint32_t BodyStore::add() {
    uint32_t slot = slots.add();
    size_t n = slots.capacity();
    pose.resize(n);
    momenta.resize(n);
    mass.resize(n);
    forces.resize(n);
    change.resize(n);
    info.resize(n);
    principal.resize(n);
    if (name.size() < n) name.resize(n);
    pose[slot] = {};
    clear_motion(slot);
    mass[slot] = {};
    info[slot] = {};
    principal[slot] = {};
    name[slot].clear();
    return slot;
}

void BodyStore::copy(const BodyStore& o) {
    slots.copy(o.slots);
    copy_array(o.pose, pose);
    copy_array(o.momenta, momenta);
    copy_array(o.mass, mass);
    copy_array(o.own_mass, own_mass);
    copy_array(o.first_pose, first_pose);
    copy_array(o.first_mass, first_mass);
    copy_array(o.forces, forces);
    copy_array(o.change, change);
    copy_array(o.info, info);
    copy_array(o.principal, principal);
    name = o.name;
}

void BodyStore::alter_mass(uint32_t slot, const BodyMass& other) {
    const Vec3 v = velocity(slot), w = angular_velocity(slot);
    if (!info[slot].altered) {
        first_mass.resize(slots.capacity());
        first_mass[slot] = mass_as_dynamic(slot);
        info[slot].altered = true;
    }
    if (info[slot].type == BodyType::kinematic) {
        own_mass[slot] = other;
        return;
    }
    change[slot].L = (other.mass * mass[slot].inverse_mass) * change[slot].L;
    mass[slot] = other;
    momenta[slot].p = other.mass * v;
    momenta[slot].L = inertia_times(slot, w);
    momenta[slot].p_low = {};
}

void BodyStore::alter_pose(uint32_t slot, const Pose& other) {
    if (!info[slot].altered) {
        first_pose.resize(slots.capacity());
        first_pose[slot] = pose[slot];
        info[slot].altered = true;
    }
    pose[slot] = other;
}

void BodyStore::set_type(uint32_t slot, BodyType type) {
    const Vec3 v = velocity(slot), w = angular_velocity(slot);
    const bool kinematic = type == BodyType::kinematic;
    if (kinematic) {
        own_mass.resize(slots.capacity());
        own_mass[slot] = mass[slot];
    }
    mass[slot] = kinematic ? BodyMass{} : own_mass[slot];
    info[slot].type = type;
    BodyMomenta& m = momenta[slot];
    m.p = kinematic ? v : mass[slot].mass * v;
    m.L = kinematic ? w : inertia_times(slot, w);
    m.p_low = {};
    change[slot] = {};
    forces[slot] = {};
    info[slot].has_forces = info[slot].capped = false;
}

Pose BodyStore::user_pose(uint32_t slot) const { return pose[slot] * inverse(principal[slot]); }

void BodyStore::set_user_pose(uint32_t slot, Pose user) {
    pose[slot] = user * principal[slot];
    momenta[slot].x_low = momenta[slot].turn_low = {};
}

Vec3 BodyStore::velocity(uint32_t slot) const {
    const BodyMomenta& m = momenta[slot];
    return info[slot].type == BodyType::kinematic ? m.p : mass[slot].inverse_mass * m.p;
}

Vec3 BodyStore::angular_velocity(uint32_t slot) const {
    const BodyMomenta& m = momenta[slot];
    return info[slot].type == BodyType::kinematic ? m.L : angular_velocity_of(slot, m.L);
}

Vec3 BodyStore::angular_velocity_of(uint32_t slot, Vec3 L) const {
    if (mass[slot].round()) return mass[slot].inverse_inertia.x * L;
    Quat q = pose[slot].orientation;
    return rotate(q, multiply(mass[slot].inverse_inertia, rotate_inverse(q, L)));
}

SymMat3 BodyStore::inverse_inertia_world(uint32_t slot) const {
    const float inverse = mass[slot].inverse_inertia.x;
    if (mass[slot].round()) return {inverse, inverse, inverse, 0.0f, 0.0f, 0.0f};
    return rotate_diagonal(rotation_matrix<float>(QuatT<float>(pose[slot].orientation), 1.0f),
                           mass[slot].inverse_inertia);
}

Vec3 BodyStore::inertia_times(uint32_t slot, Vec3 w) const {
    if (mass[slot].round()) return mass[slot].inertia.x * w;
    Quat q = pose[slot].orientation;
    return rotate(q, multiply(mass[slot].inertia, rotate_inverse(q, w)));
}

size_t BodyStore::bytes_per_body() {
    return sizeof(Pose) + sizeof(BodyMomenta) + sizeof(BodyMass) + sizeof(BodyForces) + sizeof(BodyChange) +
           sizeof(BodyInfo) + sizeof(Transform) + sizeof(std::string) + 3 * sizeof(uint32_t);
}

}  // namespace lendulet
