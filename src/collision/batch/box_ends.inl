// Where two edges cross, one point is nearest. Boxes that move fast may turn about it within the step and meet beside
// it, by other features than these edges: so the ends of both become points of the manifold as well, each as far from
// the other box as a line along the normal finds its surface, unless that is farther than both can come within the
// step. Boxes that lie still get none. Part of boxes.inl.

// A pair's two edges: middles, directions, half lengths, and the outward normals of the faces that meet in each.
template <class F>
struct CrossingEdges {
    Vec3T<F> normal;  // from A to B
    Vec3T<F> middle_a, middle_b, along_a, along_b;
    F half_a, half_b;
    Vec3T<F> faces_a[2], faces_b[2];
    F name_a, name_b;
};

// Points beside the first one, from the middle of the shape A, world axes.
template <class F>
struct EdgeEnds {
    Vec3T<F> position[4];
    F separation[4], name[4];  // absent_separation: none
};

// How far below `p` along -n the faces of an edge through `middle` are; they fall off from it on both sides.
template <class F>
LENDULET_FORCE_INLINE F height_above(Vec3T<F> p, Vec3T<F> middle, const Vec3T<F>* faces, Vec3T<F> n) {
    const F least = splat<F>(1e-6f);
    Vec3T<F> r = p - middle;
    return maximum(dot(r, faces[0]) / maximum(dot(n, faces[0]), least),
                   dot(r, faces[1]) / maximum(dot(n, faces[1]), least));
}

template <class F>
LENDULET_FORCE_INLINE EdgeEnds<F> ends_of(const CrossingEdges<F>& e, F reach) {
    const F none = splat<F>(absent_separation), half = splat<F>(0.5f);
    EdgeEnds<F> out;
    F largest = splat<F>(lowest_score);
    for (int k = 0; k < 4; ++k) {
        const F side = splat<F>(k & 1 ? 1.0f : -1.0f), other = splat<F>(k & 1 ? 64.0f : 32.0f);
        F height, along;
        if (k < 2) {
            Vec3T<F> p = e.middle_b + (side * e.half_b) * e.along_b;
            height = height_above(p, e.middle_a, e.faces_a, e.normal);
            along = e.half_a - absolute(dot(p - e.middle_a, e.along_a));
            out.position[k] = p - (half * height) * e.normal;
            out.name[k] = name_of_point(e.name_a, other + e.name_b);
        } else {
            Vec3T<F> p = e.middle_a + (side * e.half_a) * e.along_a;
            height = height_above(p, e.middle_b, e.faces_b, -e.normal);
            along = e.half_b - absolute(dot(p - e.middle_b, e.along_b));
            out.position[k] = p + (half * height) * e.normal;
            out.name[k] = name_of_point(other + e.name_a, e.name_b);
        }
        auto there = (along >= splat<F>(0.0f)) & (height <= reach);
        out.separation[k] = select(there, height, none);
        largest = maximum(largest, out.separation[k]);
    }
    // A manifold has room for three of them: the farthest is left out.
    for (int k = 3; k >= 0; --k) {
        auto farthest = out.separation[k] == largest;
        out.separation[k] = select(farthest, none, out.separation[k]);
        largest = select(farthest, splat<F>(lowest_score), largest);
    }
    return out;
}

// Puts those that are there behind the first point, `from` being the place of A's shape from its body's centre of mass.
template <class F>
LENDULET_FORCE_INLINE void append_ends(const EdgeEnds<F>& ends, Vec3T<F> from, WideManifold<F>& m) {
    const F one = splat<F>(1.0f), none = splat<F>(0.5f * absent_separation);
    for (int k = 0; k < 4; ++k) {
        auto there = (ends.separation[k] < none) & (m.count > splat<F>(0.0f));
        for (int q = 1; q < 4; ++q) {
            auto here = there & (m.count == splat<F>(static_cast<float>(q)));
            m.position[q] = select(here, from + ends.position[k], m.position[q]);
            m.separation[q] = select(here, ends.separation[k], m.separation[q]);
            m.name[q] = select(here, ends.name[k], m.name[q]);
        }
        m.count = select(there, m.count + one, m.count);
    }
}
