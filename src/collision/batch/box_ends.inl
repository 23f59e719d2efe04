// Two edges that cross touch in one point, and often almost in many: where an edge lies along a face, the point that
// SAT names is an end of a whole stretch. Bodies that rested on that point alone would turn about it until another one
// touches, and so tremble from step to step (long, thin boxes by centimetres a second). Others that move fast meet
// beside it before the step ends. So each edge is followed from the crossing both ways, over the face of the other box
// that it runs above, to its own end or the face's: these ends become points of the manifold as well, unless their
// distance along the normal is beyond the margin. Part of boxes.inl.

// Ends of a crossing nearer to it than this part of half the edge say nothing that it does not.
constexpr float nearest_end = 0.02f;

// An edge, as seen from where it crosses the other box's.
template <class F>
struct CrossingEdge {
    Vec3T<F> point, along;  // of the crossing, from the middle of A, and its direction
    F place, half;          // of the point on the edge, -half .. half
    Vec3T<F> faces[2];      // outward normals of the two faces that meet in it
    F widths[2];            // of these faces, away from the edge
    F name;
};

// Points beside the first one, from the middle of the shape A, world axes.
template <class F>
struct EdgeEnds {
    Vec3T<F> position[4];
    F separation[4], name[4];  // absent_separation: none
};

// How far one can go along an edge before it or the face beneath ends, and how fast that face falls off.
template <class F>
struct EdgeRun {
    F length, slope;
};

// `own` is followed towards `side` (1 or -1) over the faces of `other`, whose outward side is n. Of these it runs above
// the one against whose normal it rises: n is across both edges and between both normals.
template <class F>
LENDULET_FORCE_INLINE EdgeRun<F> run_along(const CrossingEdge<F>& own, const CrossingEdge<F>& other, F side,
                                           Vec3T<F> n) {
    const F zero = splat<F>(0.0f), least = splat<F>(1e-6f);
    Vec3T<F> way = side * own.along;
    F rise[2] = {dot(way, other.faces[0]), dot(way, other.faces[1])};
    F lean[2] = {maximum(dot(n, other.faces[0]), least), maximum(dot(n, other.faces[1]), least)};
    auto first = rise[0] > rise[1];
    F slope = select(first, rise[0] / lean[0], rise[1] / lean[1]);
    F inward = select(first, slope * lean[1] - rise[1], slope * lean[0] - rise[0]);
    F width = select(first, other.widths[0], other.widths[1]);
    F beside = dot(way, other.along);
    F to_side = other.half - select(beside > zero, other.place, -other.place);
    F length = own.half - side * own.place;
    length = minimum(length, width / maximum(inward, least));
    length = minimum(length, to_side / maximum(absolute(beside), least));
    return {length, slope};
}

// `separation` is that of the crossing.
template <class F>
LENDULET_FORCE_INLINE EdgeEnds<F> ends_of(const CrossingEdge<F>& a, const CrossingEdge<F>& b, Vec3T<F> n, F separation,
                                          F reach) {
    const F none = splat<F>(absent_separation), half = splat<F>(0.5f), nearest = splat<F>(nearest_end);
    EdgeEnds<F> out;
    F largest = splat<F>(lowest_score);
    for (int k = 0; k < 4; ++k) {
        const F side = splat<F>(k & 1 ? 1.0f : -1.0f), mark = splat<F>(k & 1 ? 64.0f : 32.0f);
        const bool of_b = k < 2;
        const CrossingEdge<F>&own = of_b ? b : a, &other = of_b ? a : b;
        const EdgeRun<F> run = run_along(own, other, side, of_b ? n : -n);
        const F height = separation + run.length * run.slope, down = of_b ? -half : half;
        out.position[k] = own.point + ((side * run.length) * own.along + (down * height) * n);
        out.name[k] = of_b ? name_of_point(a.name, mark + b.name) : name_of_point(mark + a.name, b.name);
        out.separation[k] = select((height <= reach) & (run.length > nearest * own.half), height, none);
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
