// Stage 3: where colliders touch.
//
// Each pair owns its records, its cache and its kept pose; nothing else is written for it, and its results depend on
// the poses and on what it owns. So pairs may be taken in any order by any worker, and gathered into batches at will.
#include <new>

#include "base/prefetch.h"
#include "world/narrow/manifold_records.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

constexpr int fewest_per_task = 32;
// A manifold is kept while no surface has moved by more than this part of the distance at which points are listed.
constexpr float kept_share = 0.25f;

uint32_t collider_a(const ColliderPair& p) { return p.flipped ? p.b : p.a; }
uint32_t collider_b(const ColliderPair& p) { return p.flipped ? p.a : p.b; }

// A contact is swift where in a substep the arm of one of its bodies grows by more than this part of what that reaches.
constexpr float swift_share = 0.5f;

// Collided by the frames, of which one line tells all.
CollidePair collide_input(const WorldData& world, const ColliderPair& p, float margin) {
    uint32_t a = collider_a(p), b = collider_b(p);
    const ShapeFrame &fa = world.frames[a], &fb = world.frames[b];
    auto quat = [](const float* q) { return Quat{q[0], q[1], q[2], q[3]}; };
    auto vector = [](const float* v) { return Vec3{v[0], v[1], v[2]}; };
    Vec3 offset = between_centres(vector(fa.centre), vector(fa.low), vector(fb.centre), vector(fb.low)) +
                  (vector(fb.arm) - vector(fa.arm));
    return {&world.colliders.geometry[a],
            &world.colliders.geometry[b],
            quat(fa.rotation),
            quat(fb.rotation),
            offset,
            margin};
}

// One chunk of pairs, from the test whether they have moved to their records.
class Chunk {
public:
    Chunk(WorldData& world, NarrowScratch& scratch, float dt, float scale)
        : world_(world), scratch_(scratch), h_(dt / static_cast<float>(world.config.solver_steps)), scale_(scale) {
        scratch_.motion.frames = scratch_.kept.frames = world.frames.data();
        scratch_.motion.poses = scratch_.kept.poses = world.pairs.poses.data();
        scratch_.motion.dt = dt;
        scratch_.motion.fall = 0.5f * dt * dt * length(world.config.gravity);
        for (RoundBatch* batch : {&scratch.segments, &scratch.box_balls}) {
            batch->frames = scratch_.motion.frames;
            batch->dt = dt, batch->fall = scratch_.motion.fall;
        }
        scratch_.kept.found = world.found_separations.data();
        scratch_.kept.records = world.records.data();
    }

    void run(int begin, int end) {
        gather(static_cast<uint32_t>(begin), static_cast<uint32_t>(end));
        world_.narrow_kernels.test_motion(scratch_.motion);
        scratch_.kept.count = boxed_ = 0;
        for (int i = 0; i < scratch_.motion.count; ++i) sort(i);
        flush_kept();
        collide_boxes();
        collide_round(scratch_.segments, scratch_.rounded[0], world_.narrow_kernels.collide_segments);
        collide_round(scratch_.box_balls, scratch_.rounded[1], world_.narrow_kernels.collide_box_balls);
    }

private:
    // Asks triggers, lists round pairs for their batches and the others for the test whether they have moved.
    void gather(uint32_t begin, uint32_t end) {
        const Array<ListedPair>& listed = world_.pairs.listed;
        scratch_.motion.count = scratch_.segments.count = scratch_.box_balls.count = 0;
        for (uint32_t i = begin; i < end; ++i) {
            const uint32_t number = listed[i].pair;
            if (i + prefetch_distance < listed.size())
                prefetch(&world_.pairs.pairs[listed[i + prefetch_distance].pair]);
            ColliderPair& p = world_.pairs.pairs[number];
            p.begun = false;
            const auto a = static_cast<int32_t>(collider_a(p)), b = static_cast<int32_t>(collider_b(p));
            switch (p.kind) {
                case PairKind::trigger:
                    p.hit = overlap(collide_input(world_, p, 0.0f), world_.pairs.caches[number], settings());
                    break;
                case PairKind::segments:
                    list_round(scratch_.segments, scratch_.rounded[0], number, a, b, 0.0f);
                    break;
                case PairKind::box_ball:
                    list_round(scratch_.box_balls, scratch_.rounded[1], number, a, b, 0.0f);
                    break;
                case PairKind::ball_box:
                    list_round(scratch_.box_balls, scratch_.rounded[1], number, b, a, 1.0f);
                    break;
                default:
                    list_tested(number, a, b);
            }
        }
    }
    void list_tested(uint32_t number, int32_t a, int32_t b) {
        MotionBatch& motion = scratch_.motion;
        int k = motion.count++;
        scratch_.tested[k] = number;
        motion.a[k] = a, motion.b[k] = b;
        motion.pose[k] = static_cast<int32_t>(number);
    }
    static void list_round(RoundBatch& batch, uint32_t* numbers, uint32_t number, int32_t a, int32_t b,
                           float exchanged) {
        int k = batch.count++;
        numbers[k] = number;
        batch.a[k] = a, batch.b[k] = b;
        batch.exchanged[k] = exchanged;
    }

    // Asks for the records that the pair some places ahead in a list has.
    void ask_for_records(const uint32_t* numbers, int i, int count) const {
        if (i + prefetch_distance >= count) return;
        prefetch<3>(&world_.records[world_.pairs.pairs[numbers[i + prefetch_distance]].first_record]);
    }

    // And for what a tested pair is collided by, where it will be and not in a batch.
    void ask_for_input(int i) const {
        if (i >= scratch_.motion.count || scratch_.motion.kept[i] > 0.0f) return;
        const uint32_t number = scratch_.tested[i];
        const ColliderPair& p = world_.pairs.pairs[number];
        if (p.kind == PairKind::boxes) return;
        prefetch(&world_.colliders.geometry[p.a]);
        prefetch(&world_.colliders.geometry[p.b]);
        if (p.capacity > 1) prefetch<9>(&world_.pairs.near_triangles[p.surface]);
        else prefetch<2>(&world_.pairs.caches[number]);
    }

    void sort(int i) {
        const MotionBatch& motion = scratch_.motion;
        ask_for_records(scratch_.tested, i, motion.count);
        ask_for_input(i + prefetch_distance);
        uint32_t index = scratch_.tested[i];
        ColliderPair& p = world_.pairs.pairs[index];
        if (motion.kept[i] > 0.0f) {
            keep(p, i);
        } else if (p.kind == PairKind::boxes) {
            auto& boxes = scratch_.boxes;
            int k = boxed_++;
            scratch_.boxed[k] = index;
            boxes.a[k] = motion.a[i], boxes.b[k] = motion.b[i];
            boxes.margin[k] = motion.margin[i];
            boxes.way[k] = way_of(p, motion.margin[i]);
            boxes.feature[k] = world_.pairs.poses[index].feature;
        } else if (p.capacity == 1) {
            collide_single(p, index, motion.margin[i]);
        } else {
            collide_mesh(p, index, motion.margin[i]);
        }
    }

    // How far two boxes may come within the step, or 0 where that is no farther than where all get points. Those that
    // bounce do so where they are nearest: at a point that is not yet there they would by a direction that is a guess.
    float way_of(const ColliderPair& p, float margin) const {
        const float near = minimum(world_.frames[p.a].near, world_.frames[p.b].near), way = margin - near;
        return way <= near || p.bounces ? 0.0f : way;
    }

    void keep(const ColliderPair& p, int i) {
        RefreshBatch& kept = scratch_.kept;
        if (kept.count + p.count > batch_capacity) flush_kept();
        for (uint32_t m = 0; m < p.count; ++m) {
            int k = kept.count++;
            kept.a[k] = scratch_.motion.a[i], kept.b[k] = scratch_.motion.b[i];
            kept.pose[k] = scratch_.motion.pose[i];
            kept.record[k] = static_cast<int32_t>(p.first_record + m);
            ContactRecord& r = world_.records[p.first_record + m];
            r.flags &= ~(contact_swift | contact_passes);
            if (scale_ != 1.0f) scale_impulses(r, scale_);
        }
    }
    void flush_kept() {
        world_.narrow_kernels.refresh(scratch_.kept);
        for (int k = 0; k < scratch_.kept.count; ++k) tally(static_cast<uint32_t>(scratch_.kept.record[k]));
        scratch_.kept.count = 0;
    }

    // For the statistics of the step; whole numbers and a maximum, so the order does not matter.
    void tally(uint32_t record) {
        const ContactRecord& r = world_.records[record];
        for (const ContactPointRecord& p : r.points) {
            scratch_.contact_points += p.separation <= 0.0f;
            scratch_.max_penetration = maximum(scratch_.max_penetration, -p.separation);
        }
    }

    // A pair of convex shapes, or one with a plane.
    void collide_single(ColliderPair& p, uint32_t index, float margin) {
        PairCache& cache = world_.pairs.caches[index];
        Manifold manifold;
        CollidePair pair = collide_input(world_, p, margin);
        if (p.count > 0) {
            const ContactRecord& r = world_.records[p.first_record];
            for (int j = 0; j < r.point_count; ++j)
                if (r.normal_impulse[j] > 0.0f) pair.carried.ids[pair.carried.count++] = r.id[j];
        }
        int count = collide(pair, cache, settings(), &manifold, 1);
        if (count > 0) write_single(p, index, manifold);
        finish(p, index, count, margin, cache.clearance);
    }

    template <class SomeManifold>
    void write_single(ColliderPair& p, uint32_t index, const SomeManifold& manifold) {
        const ShapeFrame &a = world_.frames[collider_a(p)], &b = world_.frames[collider_b(p)];
        ContactRecord& r = record(p, 0);
        if (p.count > 0 && is_same_point(r, manifold)) {
            fill_record(r, a, b, manifold);
            if (scale_ != 1.0f) scale_impulses(r, scale_);
        } else if (p.count > 0) {
            const OldContact old(r);
            fill_record(r, a, b, manifold);
            warm_start(r, old, a, b, scale_);
        } else {
            fill_record(r, a, b, manifold);
            clear_impulses(r);
        }
        r.pair = index;
        tell_speed(p, r, a, b);
        const bool past = passes(manifold);
        r.flags = past ? r.flags | contact_passes : r.flags & ~contact_passes;
        if (past) clear_impulses(r);
    }
    static bool passes(const Manifold&) { return false; }
    static bool passes(const BatchManifold& m) { return m.passes > 0.0f; }

    // Bodies whose arms stay are those whose surface the points ride on.
    void tell_speed(const ColliderPair& p, ContactRecord& r, const ShapeFrame& a, const ShapeFrame& b) const {
        const Vec3 v = velocity_of(b) - velocity_of(a);
        const float way2 = (h_ * h_) * length_squared(v);
        auto grows = [&](float reach) { return way2 > (swift_share * swift_share) * (reach * reach); };
        const bool swift = (!p.fixed_a && r.follow > 0.0f && grows(a.reach)) || (r.follow < 1.0f && grows(b.reach));
        r.flags = swift ? r.flags | contact_swift : r.flags & ~contact_swift;
    }

    static Vec3 velocity_of(const ShapeFrame& f) { return {f.velocity[0], f.velocity[1], f.velocity[2]}; }
    void collide_mesh(ColliderPair& p, uint32_t index, float margin) {
        for (uint32_t i = 1; i < p.count; ++i) prefetch<3>(&world_.records[p.first_record + i]);
        PairCache& cache = world_.pairs.caches[index];
        // Without initial values, as the room for old contacts.
        alignas(Manifold) std::byte manifold_room[max_mesh_manifolds * sizeof(Manifold)];
        auto* manifolds = reinterpret_cast<Manifold*>(manifold_room);
        CollidePair pair = collide_input(world_, p, margin);
        const ShapeFrame &a = world_.frames[collider_a(p)], &b = world_.frames[collider_b(p)];
        pair.ahead = (0.5f * scratch_.motion.dt) * (velocity_of(b) - velocity_of(a));
        int count = collide(pair, cache, settings(), manifolds, p.capacity, &world_.pairs.near_triangles[p.surface]);
        alignas(OldContact) std::byte room[max_mesh_manifolds * sizeof(OldContact)];
        auto* old = reinterpret_cast<OldContact*>(room);
        for (int i = 0; i < p.count; ++i) new (old + i) OldContact(world_.records[p.first_record + i]);
        for (int i = 0; i < count; ++i) {
            ContactRecord& r = record(p, i);
            fill_record(r, a, b, manifolds[i]);
            set_surface(world_, p, r);
            int k = 0;
            while (k < p.count && old[k].key != r.key) ++k;
            if (k < p.count) warm_start(r, old[k], a, b, scale_);
            else clear_impulses(r);
            r.pair = index;
            tell_speed(p, r, a, b);
        }
        finish(p, index, count, margin, cache.clearance);
        mark_covered(world_, p);
    }

    // The pair's record number `i`, with its lasting parts filled in.
    ContactRecord& record(ColliderPair& p, int i) {
        ContactRecord& r = world_.records[p.first_record + static_cast<uint32_t>(i)];
        if (i < p.prepared) return r;
        prepare_record(world_, p, r);
        p.prepared = static_cast<uint8_t>(i + 1);
        return r;
    }

    void collide_boxes() {
        auto& boxes = scratch_.boxes;
        BoxBatch batch = boxes.batch(world_.frames.data(), boxed_);
        world_.narrow_kernels.collide_boxes(batch);
        for (int k = 0; k < boxed_; ++k) {
            ask_for_records(scratch_.boxed, k, boxed_);
            uint32_t index = scratch_.boxed[k];
            ColliderPair& p = world_.pairs.pairs[index];
            KeptPose& pose = world_.pairs.poses[index];
            if (boxes.clearance[k] > boxes.margin[k]) {
                finish(p, index, 0, boxes.margin[k], boxes.clearance[k]);
            } else if (boxes.out[k].count == 0) {
                // The faces or edges that face each other do not overlap: the boxes are apart, corner to edge or corner
                // to corner, and the separating axis is not the direction of the shortest distance.
                pose.feature = 0.0f;
                collide_single(p, index, boxes.margin[k]);
            } else {
                pose.feature = boxes.feature[k];
                write_single(p, index, boxes.out[k]);
                finish(p, index, 1, boxes.margin[k], 0.0f);
            }
        }
    }

    void collide_round(RoundBatch& batch, const uint32_t* numbers, void (*collide_batch)(RoundBatch&, BatchManifold*)) {
        if (batch.count == 0) return;
        BatchManifold* out = scratch_.boxes.out;
        collide_batch(batch, out);
        for (int k = 0; k < batch.count; ++k) {
            ask_for_records(numbers, k, batch.count);
            ColliderPair& p = world_.pairs.pairs[numbers[k]];
            if (out[k].count > 0) write_single(p, numbers[k], out[k]);
            finish(p, numbers[k], out[k].count > 0 ? 1 : 0, 0.0f, 0.0f);
        }
    }

    // `clearance`: least distance of the surfaces, where there are no manifolds.
    void finish(ColliderPair& p, uint32_t index, int count, float margin, float clearance) {
        p.count = static_cast<uint8_t>(count);
        for (int i = 0; i < count; ++i) tally(p.first_record + static_cast<uint32_t>(i));
        if (has_found_separations(p)) remember_separations(p, count);
        if (!may_be_kept(p)) return;
        KeptPose& pose = world_.pairs.poses[index];
        uint32_t a = collider_a(p), b = collider_b(p);
        const ShapeFrame &fa = world_.frames[a], &fb = world_.frames[b];
        float near = minimum(fa.near, fb.near);
        for (int k = 0; k < 4; ++k) pose.rotation_a[k] = fa.rotation[k], pose.rotation_b[k] = fb.rotation[k];
        for (int k = 0; k < 3; ++k) pose.offset[k] = between_centres(fa.centre[k], fa.low[k], fb.centre[k], fb.low[k]);
        pose.tolerance = count > 0 ? kept_share * near : any_motion;
        pose.clearance = count > 0 ? margin + near : clearance;
    }

    void remember_separations(const ColliderPair& p, int count) {
        for (int i = 0; i < count; ++i) {
            uint32_t record = p.first_record + static_cast<uint32_t>(i);
            for (int j = 0; j < 4; ++j)
                world_.found_separations[record].s[j] = world_.records[record].points[j].separation;
        }
    }

    CollideSettings settings() const {
        const NarrowKernels& kernels = world_.narrow_kernels;
        return {world_.config.simplex, kernels.filter_triangles, kernels.clip_over_triangles};
    }

    WorldData& world_;
    NarrowScratch& scratch_;
    int boxed_ = 0;  // pairs in the lists of boxes
    float h_;        // longest substep, s
    float scale_;
};

void add_overlap(WorldData& world, const ColliderPair& p) {
    bool first_is_trigger = world.colliders.info[p.a].is_trigger;
    uint32_t trigger = first_is_trigger ? p.a : p.b, other = first_is_trigger ? p.b : p.a;
    world.overlaps.push_back({world.bodies.id(world.colliders.info[trigger].body),
                              world.bodies.id(world.colliders.info[other].body), world.colliders.id(trigger),
                              world.colliders.id(other)});
}

}  // namespace

void list_contacts(WorldData& world) {
    RestingContacts& rest = world.resting;
    world.seams.clear();
    if (rest.hits_changed) {
        world.overlaps.clear();
        for (uint32_t number : rest.hits) add_overlap(world, world.pairs.pairs[number]);
        rest.listed_hits = world.overlaps.count();
        rest.hits_changed = false;
    }
    world.overlaps.resize_unset(static_cast<size_t>(rest.listed_hits));
    world.touching.reserve(world.records.size());
    world.touching_bodies.reserve(world.records.size());
    const ListedPair* listed = world.pairs.listed.data();
    const ColliderPair* pairs = world.pairs.pairs.data();
    uint32_t *place = rest.place.data(), *touching = world.touching.data(), count = 0;
    TouchingBodies* bodies = world.touching_bodies.data();
    const size_t listed_count = world.pairs.listed.size();
    for (size_t i = 0; i < listed_count; ++i) {
        if (i + prefetch_distance < listed_count) prefetch(&pairs[listed[i + prefetch_distance].pair]);
        const ColliderPair& p = pairs[listed[i].pair];
        for (uint32_t record = p.first_record; record < p.first_record + p.count; ++record, ++count) {
            place[record] = count;
            touching[count] = record;
            bodies[count] = {.a = p.body_a, .b = p.body_b, .fixed_a = p.fixed_a};
        }
        if (p.fixed_a) world.seams.add(listed[i].pair, p);
        if (p.hit) add_overlap(world, p);
    }
    world.touching.resize_unset(count);
    world.touching_bodies.resize_unset(count);
}

void find_contacts(WorldData& world, float dt) {
    float h = dt / static_cast<float>(world.config.solver_steps);
    float scale = world.last_h > 0.0f ? h / world.last_h : 0.0f;
    world.last_h = h;
    expect_mesh_contacts(world);
    world.records.resize_unset(world.pairs.record_count());
    world.found_separations.resize_unset(world.records.size());
    world.resting.place.resize_unset(world.records.size());
    for (Array<uint32_t>* list :
         {&world.touching, &world.active, &world.unsorted, &world.eased, &world.resting.records})
        list->reserve(world.records.capacity());
    for (Array<ContactEnds>* list : {&world.active_ends, &world.unsorted_ends}) list->reserve(world.records.capacity());
    for (Array<TouchingBodies>* list : {&world.touching_bodies, &world.active_bodies})
        list->reserve(world.records.capacity());
    world.touched_sleepers.reserve(world.records.capacity());
    world.seams.reserve(world.frames.size(), world.records.capacity());
    world.narrow_scratch.resize_unset(static_cast<size_t>(world.tasks.workers()));
    for (NarrowScratch& s : world.narrow_scratch) s.contact_points = 0, s.max_penetration = 0.0f;
    int count = world.pairs.listed.count();
    int grain = count / (8 * world.tasks.workers());
    grain = grain < fewest_per_task ? fewest_per_task : grain > batch_capacity ? batch_capacity : grain;
    world.tasks.for_each(count, grain, [&](int begin, int end, int worker) {
        Chunk chunk(world, world.narrow_scratch[static_cast<size_t>(worker)], dt, scale);
        for (int i = begin; i < end; i += batch_capacity)
            chunk.run(i, end - i < batch_capacity ? end : i + batch_capacity);
    });
    list_contacts(world);
    silence_seams(world);
    world.awake_points = 0;
    world.awake_penetration = 0.0f;
    for (const NarrowScratch& s : world.narrow_scratch) {
        world.awake_points += s.contact_points;
        world.awake_penetration = maximum(world.awake_penetration, s.max_penetration);
    }
}

}  // namespace lendulet
