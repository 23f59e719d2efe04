#include "collision/mesh/manifolds.h"

namespace lendulet {
namespace {

// Cosine of the angle between normals that count as one, 1.8 degrees: more and a fine terrain's curvature is flattened,
// less and its facets take many manifolds.
constexpr float same_normal = 0.9995f;

// A name for a face's normal and material that lasts while the shape slides from triangle to triangle: components in
// steps of 1/256, finer than groups are apart. The normals of axis-aligned faces are in the middle of a step.
uint32_t name_of_face(Vec3 n, uint8_t material) {
    auto step = [](float x) { return static_cast<uint32_t>(static_cast<int>(x * 256.0f + 512.5f)); };
    uint32_t normal = (step(n.x) & 0x3ffu) | (step(n.y) & 0x3ffu) << 10 | (step(n.z) & 0x3ffu) << 20;
    return normal ^ ((material * 0x00841fefu) & 0x3fffffffu);
}

// Whether a point is a corner of the shape over any face.
bool names_corner(uint32_t id) { return id >> 16 == face_feature(0); }

float deepest_of(const TriangleContact& contact) {
    float deepest = contact.points[0].separation - contact.nears;
    for (int i = 1; i < contact.count; ++i) deepest = minimum(deepest, contact.points[i].separation);
    return deepest;
}

}  // namespace

void MeshManifolds::reduce(Group& group) {
    Vec3 u = perpendicular(group.normal), v = cross(group.normal, u);
    FacePoint flat[max_points];
    for (int i = 0; i < group.count; ++i) {
        const MeshPoint& p = group.points[i];
        flat[i] = {dot(p.position(), u), dot(p.position(), v), p.separation, static_cast<uint32_t>(i)};
    }
    int kept = thin_points(flat, group.count);
    MeshPoint chosen[4];
    for (int i = 0; i < kept; ++i) chosen[i] = group.points[flat[i].id];
    for (int i = 0; i < kept; ++i) group.points[i] = chosen[i];
    group.count = kept;
}

// The group with this normal, or a new one; null where there is no room and all others are deeper.
MeshManifolds::Group* MeshManifolds::group_for(const TriangleContact& contact) {
    for (int i = 0; i < count_; ++i) {
        if (groups_[i].material == contact.material && dot(groups_[i].normal, contact.normal) > same_normal)
            return &groups_[i];
    }
    float deepest = deepest_of(contact);
    Group* group = &groups_[0];
    if (count_ < max_groups) {
        group = &groups_[count_++];
    } else {
        for (int i = 1; i < count_; ++i) {
            if (groups_[i].deepest > group->deepest) group = &groups_[i];
        }
        if (group->deepest <= deepest) return nullptr;
    }
    group->normal = contact.normal, group->front = contact.front;
    group->face = contact.face;
    group->material = contact.material;
    group->radius = contact.radius, group->follow = contact.follow;
    group->deepest = deepest;
    group->lowest_original = group->deepest_original = contact.original;
    group->count = 0;
    return group;
}

void MeshManifolds::add_point(Group& group, const MeshPoint& point) {
    for (int i = 0; i < group.count; ++i) {
        MeshPoint& p = group.points[i];
        if (p.id != point.id && length_squared(p.position() - point.position()) > near_squared_) continue;
        // Where a corner of the shape meets an edge of the mesh, the corner's name is the one that lasts.
        bool corner = names_corner(point.id), was_corner = names_corner(p.id);
        if (corner != was_corner ? corner : point.separation < p.separation) p = point;
        return;
    }
    if (group.count == max_points) reduce(group);
    group.points[group.count++] = point;
}

void MeshManifolds::add(const TriangleContact& contact) {
    if (contact.count == 0) return;
    Group* group = group_for(contact);
    if (group == nullptr) return;
    float deepest = deepest_of(contact);
    // A face's normal is exact, an edge's is that of the nearest points.
    bool leads = contact.face != group->face ? contact.face : deepest < group->deepest;
    if (leads) {
        group->normal = contact.normal, group->front = contact.front;
        group->face = contact.face;
        group->radius = contact.radius, group->follow = contact.follow;
        group->deepest_original = contact.original;
    }
    group->deepest = minimum(group->deepest, deepest);
    if (contact.single) {
        if (!leads && group->count > 0) return;
        group->count = 0;
    }
    if (contact.original < group->lowest_original) group->lowest_original = contact.original;
    for (int i = 0; i < contact.count; ++i) add_point(*group, contact.points[i]);
}

int MeshManifolds::write(const Placing& placing, Manifold* out, int capacity) {
    // By depth only where some must go: else the order in which they were found is steadier.
    int order[max_groups];
    for (int i = 0; i < count_; ++i) order[i] = i;
    int written = count_ < capacity ? count_ : capacity;
    for (int k = 0; count_ > capacity && k < written; ++k) {
        int best = k;
        for (int i = k + 1; i < count_; ++i) {
            if (groups_[order[i]].deepest < groups_[order[best]].deepest) best = i;
        }
        int found = order[best];
        for (int i = best; i > k; --i) order[i] = order[i - 1];
        order[k] = found;
    }
    const Mat3 turn = rotation_matrix(placing.from_contact);
    for (int k = 0; k < written; ++k) {
        Group& group = groups_[order[k]];
        if (group.count > 1) reduce(group);
        Manifold& m = out[k];
        m.normal = group.face ? rotate(placing.from_mesh, group.front) : turn * group.normal;
        m.count = group.count;
        for (int i = 0; i < group.count; ++i) {
            const MeshPoint& p = group.points[i];
            m.points[i] = {placing.position + turn * p.position(), p.separation, p.id};
        }
        m.radius_a = 0.0f;
        m.radius_b = group.radius;
        m.follow = group.follow;
        m.triangle = static_cast<int32_t>(group.deepest_original);
        m.key = group.face ? name_of_face(group.front, group.material) : 0x80000000u | group.lowest_original;
    }
    return written;
}

}  // namespace lendulet
