#include "broad_phase/broad_phase.h"

#include <utility>

#include "broad_phase/query.h"

namespace lendulet {

namespace {

BroadPhaseStructure make_structure(BroadPhaseType type, const Memory* memory) {
    auto rtree = [&](RtreePolicy policy) {
        return BroadPhaseStructure(std::in_place_type<TwoTrees<RTree>>, memory, policy);
    };
    switch (type) {
        case BroadPhaseType::all_pairs:
            return BroadPhaseStructure(std::in_place_type<AllPairs>, memory);
        case BroadPhaseType::sweep_1:
            return BroadPhaseStructure(std::in_place_type<Sweep1>, memory);
        case BroadPhaseType::sweep_3:
            return BroadPhaseStructure(std::in_place_type<Sweep3>, memory);
        case BroadPhaseType::rtree_quadratic:
            return rtree(RtreePolicy::quadratic);
        case BroadPhaseType::rtree_star:
            return rtree(RtreePolicy::star);
        case BroadPhaseType::rtree_str:
            return rtree(RtreePolicy::str);
        case BroadPhaseType::rtree_omt:
            return BroadPhaseStructure(std::in_place_type<RtreeOmt>, memory);
        case BroadPhaseType::wide_tree:
            break;
    }
    return BroadPhaseStructure(std::in_place_type<WideTree>, memory);
}

constexpr int queries_per_task = 32;

}  // namespace

BroadPhase::BroadPhase(BroadPhaseType type, const Memory* memory)
    : structure_(make_structure(type, memory)), query_chunks_(memory), query_hits_(memory) {}

void BroadPhase::set_fixed(const BroadBox* boxes, int count, TaskPool* tasks) {
    std::visit([&](auto& s) { s.set_fixed(boxes, count, tasks); }, structure_);
}

void BroadPhase::set_moving(const BroadBox* boxes, int count, TaskPool* tasks) {
    std::visit([&](auto& s) { s.set_moving(boxes, count, tasks); }, structure_);
}

void BroadPhase::move_all(const BroadBox* boxes, int count, TaskPool* tasks) {
    std::visit(
        [&](auto& s) {
            if constexpr (requires { s.move_all(boxes, count, tasks); }) s.move_all(boxes, count, tasks);
            else s.set_moving(boxes, count, tasks);
        },
        structure_);
}

void BroadPhase::find_pairs(TaskPool& tasks, Array<BoxPair>& out) {
    std::visit([&](auto& s) { s.find_pairs(tasks, out); }, structure_);
}

void BroadPhase::update(TaskPool& tasks, const BroadBox* boxes, int count, const uint32_t* changed, int changed_count,
                        Array<BoxPair>& begun, Array<BoxPair>& ended) {
    std::visit([&](auto& s) { s.update(tasks, boxes, count, changed, changed_count, begun, ended); }, structure_);
}

// ---------------------------------------------------------------------------------------------------------------------
// Queries

void BroadPhase::query_box(const float lower[3], const float upper[3], Array<uint32_t>& out) const {
    const Meetings meetings(out);
    std::visit([&](const auto& s) { s.visit_overlapping(lower, upper, meetings); }, structure_);
}

uint32_t BroadPhase::ray(const float origin[3], const float translation[3], float max_t, float& t) const {
    return cast_box(origin, origin, translation, max_t, t);
}

uint32_t BroadPhase::cast_box(const float lower[3], const float upper[3], const float translation[3], float max_t,
                              float& t) const {
    BoxCast cast(lower, upper, translation, max_t);
    std::visit([&](const auto& s) { s.cast(cast); }, structure_);
    if (cast.best_index != no_box) t = cast.best_t;
    return cast.best_index;
}

uint32_t BroadPhase::nearest(const float point[3], float max_distance, float& distance) const {
    NearestBox query(point, max_distance);
    std::visit([&](const auto& s) { s.nearest(query); }, structure_);
    if (query.best_index != no_box) distance = query.distance();
    return query.best_index;
}

void BroadPhase::query_boxes(TaskPool& tasks, const BoxQuery* queries, int count, Array<uint32_t>& offsets,
                             Array<uint32_t>& out) {
    query_hits_.clear();
    query_chunks_.search(tasks, count, queries_per_task, query_hits_, [&](int begin, int end, PairList& list) {
        std::visit(
            [&](const auto& s) {
                if constexpr (requires { s.find_hits(queries, begin, end, list); })
                    return s.find_hits(queries, begin, end, list);
                for (int i = begin; i < end; ++i) {
                    const Meetings meetings(list, static_cast<uint32_t>(i), false);
                    s.visit_overlapping(queries[i].lower, queries[i].upper, meetings);
                }
            },
            structure_);
    });
    // Dealt to their queries. offsets[i + 1] counts the hits of query i, then says where the next of them goes.
    offsets.assign(static_cast<size_t>(count) + 1, 0);
    for (const BoxPair& hit : query_hits_) ++offsets[hit.a + 1];
    uint32_t begin = static_cast<uint32_t>(out.size());
    offsets[0] = begin;
    for (int i = 1; i <= count; ++i) begin += std::exchange(offsets[i], begin);
    out.resize_unset(out.size() + query_hits_.size());
    for (const BoxPair& hit : query_hits_) out[offsets[hit.a + 1]++] = hit.b;
}

void BroadPhase::rays(TaskPool& tasks, const RayQuery* queries, int count, BroadPhaseHit* hits) const {
    tasks.for_each(count, queries_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            const RayQuery& q = queries[i];
            hits[i].index = ray(q.origin, q.translation, q.max_t, hits[i].at);
        }
    });
}

void BroadPhase::cast_boxes(TaskPool& tasks, const CastQuery* queries, int count, BroadPhaseHit* hits) const {
    tasks.for_each(count, queries_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            const CastQuery& q = queries[i];
            hits[i].index = cast_box(q.lower, q.upper, q.translation, q.max_t, hits[i].at);
        }
    });
}

void BroadPhase::nearest_boxes(TaskPool& tasks, const NearestQuery* queries, int count, BroadPhaseHit* hits) const {
    tasks.for_each(count, queries_per_task, [&](int begin, int end, int) {
        for (int i = begin; i < end; ++i) {
            hits[i].index = nearest(queries[i].point, queries[i].max_distance, hits[i].at);
        }
    });
}

// ---------------------------------------------------------------------------------------------------------------------

void BroadPhase::boxes(Array<BroadPhaseBox>& out) const {
    std::visit([&](const auto& s) { s.boxes(out); }, structure_);
}

size_t BroadPhase::bytes() const {
    size_t own = query_chunks_.bytes() + query_hits_.bytes();
    return own + std::visit([](const auto& s) { return s.bytes(); }, structure_);
}

const char* BroadPhase::check() const {
    return std::visit([](const auto& s) { return s.check(); }, structure_);
}

}  // namespace lendulet
