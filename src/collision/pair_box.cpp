// Two sharp boxes: the wide kernel of batches with one lane, and the distance query where the features that face each
// other do not overlap.
#include "base/prefetch.h"
#include "collision/batch/boxes.h"
#include "collision/pair.h"
#include "math/wide/gather.h"
#include "math/wide/mask.h"
#include "math/wide/wide.h"

namespace lendulet {
namespace {

#include "collision/batch/boxes.inl"

void store(float* to, Vec3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

ShapeFrame frame_of(const Geometry& box, Quat q, Vec3 centre) {
    ShapeFrame f{};
    f.rotation[0] = q.x, f.rotation[1] = q.y, f.rotation[2] = q.z, f.rotation[3] = q.w;
    store(f.centre, centre);
    store(f.half, box.size);
    return f;
}

void write(const BatchManifold& m, Manifold& out) {
    out.normal = {m.normal[0], m.normal[1], m.normal[2]};
    out.count = m.count;
    for (int i = 0; i < m.count; ++i) {
        const float* p = m.points[i].position;
        out.points[i] = {{p[0], p[1], p[2]}, m.points[i].separation, m.id[i]};
    }
    out.radius_a = out.radius_b = 0.0f;
    out.follow = m.follow;
    out.triangle = -1;
    out.key = 0;
}

}  // namespace

int collide_box_box(const CollidePair& pair, PairCache& cache, const CollideSettings& settings, Manifold& out) {
    const ShapeFrame frames[2] = {frame_of(*pair.a, pair.rotation_a, {}),
                                  frame_of(*pair.b, pair.rotation_b, pair.offset)};
    BoxLists<1, 1> lists;
    lists.a[0] = 0, lists.b[0] = 1;
    lists.margin[0] = pair.margin;
    lists.way[0] = 0.0f;
    lists.feature[0] = static_cast<float>(cache.feature);
    BoxBatch batch = lists.batch(frames, 1);
    collide_boxes<1>(batch);
    if (lists.clearance[0] > pair.margin) {
        cache.clearance = lists.clearance[0];
        return 0;
    }
    if (lists.out[0].count > 0) {
        cache.feature = static_cast<uint32_t>(lists.feature[0]);
        write(lists.out[0], out);
        return 1;
    }
    // The faces or edges that face each other do not overlap: the boxes are apart, corner to edge or corner to corner,
    // and the separating axis is not the direction of the shortest distance.
    cache.feature = 0;
    return collide_convex_convex(pair, cache, settings, out);
}

}  // namespace lendulet
