// The triangles of a mesh or of a height field, by number, whichever it is.
#pragma once

#include "geometry/geometry.h"
#include "geometry/height_field.h"
#include "geometry/mesh.h"

namespace lendulet {

class TriangleSurface {
public:
    // Of a geometry of kind mesh or height_field, which must outlive it.
    explicit TriangleSurface(const Geometry& g) : mesh_(g.mesh), field_(g.field) {}

    const MeshData* mesh() const { return mesh_; }  // null: a height field
    const HeightFieldData& field() const { return *field_; }
    bool one_sided() const { return mesh_ ? mesh_->one_sided : field_->one_sided; }

    void corners(uint32_t t, Vec3 (&out)[3]) const {
        if (!mesh_) return field_->corners(t, out);
        for (int k = 0; k < 3; ++k) out[k] = mesh_->vertices[mesh_->triangles[t].vertex[k]];
    }
    // Unit, of the front.
    Vec3 normal(uint32_t t) const {
        if (mesh_) return mesh_->normals[t];
        Vec3 p[3];
        field_->corners(t, p);
        return normal_of_triangle(p[0], p[1], p[2]);
    }
    // Fetch what is to be read soon, first of the triangle and then, from there, of its corners.
    void ask_for(uint32_t t) const {
        if (mesh_) prefetch(&mesh_->triangles[t]), prefetch(&mesh_->normals[t]);
    }
    void ask_for_corners(uint32_t t) const {
        for (int k = 0; mesh_ && k < 3; ++k) prefetch(&mesh_->vertices[mesh_->triangles[t].vertex[k]]);
    }
    // Its number in the user's list.
    uint32_t original(uint32_t t) const { return mesh_ ? mesh_->triangles[t].original : t; }
    uint32_t index_of(uint32_t original) const { return mesh_ ? mesh_->place[original] : original; }
    uint8_t convex_edges(uint32_t t) const {
        return mesh_ ? mesh_->triangles[t].convex_edges : static_cast<uint8_t>(field_->edges[t] & 7u);
    }
    uint8_t concave_edges(uint32_t t) const {
        return mesh_ ? mesh_->triangles[t].concave_edges : static_cast<uint8_t>(field_->edges[t] >> 3 & 7u);
    }
    uint8_t sharp_edges(uint32_t t) const {
        return mesh_ ? mesh_->triangles[t].sharp_edges : static_cast<uint8_t>(field_->edges[t] >> 6 & 7u);
    }
    // Across the edge from corner k to the next; -1: none.
    int32_t neighbour(uint32_t t, int k) const {
        return mesh_ ? mesh_->triangles[t].neighbour[k] : field_->neighbour(t, k);
    }
    // A name of a corner, the same for all triangles that have it.
    uint32_t vertex(uint32_t t, int k) const {
        if (mesh_) return mesh_->triangles[t].vertex[k];
        HeightFieldData::Corner c = field_->corner(t, k);
        return field_->sample(c.column, c.row);
    }
    // By the number in the user's list; 0 where there is none.
    uint8_t material(uint32_t original) const {
        const std::vector<uint8_t>& materials = mesh_ ? mesh_->materials : field_->materials;
        return original < materials.size() ? materials[original] : uint8_t{0};
    }
    uint8_t most_material() const { return mesh_ ? mesh_->most_material : field_->most_material; }

private:
    const MeshData* mesh_;
    const HeightFieldData* field_;
};

template <class Visit>
void for_each_triangle(const TriangleSurface& s, Vec3 lower, Vec3 upper, Visit&& visit) {
    if (s.mesh()) for_each_triangle(*s.mesh(), lower, upper, visit);
    else for_each_triangle(s.field(), lower, upper, visit);
}

}  // namespace lendulet
