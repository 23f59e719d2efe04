#include "broad_phase/broad_phase.h"

namespace lendulet {

namespace {

using Structure = std::variant<AllPairs, Sweep, RtreeOmt>;

Structure make_structure(BroadPhaseType type, const Memory* memory) {
    switch (type) {
        case BroadPhaseType::all_pairs:
            return Structure(std::in_place_type<AllPairs>, memory);
        case BroadPhaseType::sweep_1:
            return Structure(std::in_place_type<Sweep>, memory);
        case BroadPhaseType::rtree_omt:
            break;
    }
    return Structure(std::in_place_type<RtreeOmt>, memory);
}

}  // namespace

BroadPhase::BroadPhase(BroadPhaseType type, const Memory* memory) : structure_(make_structure(type, memory)) {}

void BroadPhase::set_fixed(const BroadBox* boxes, int count, TaskPool* tasks) {
    std::visit([&](auto& s) { s.set_fixed(boxes, count, tasks); }, structure_);
}

void BroadPhase::set_moving(const BroadBox* boxes, int count, TaskPool* tasks) {
    std::visit([&](auto& s) { s.set_moving(boxes, count, tasks); }, structure_);
}

void BroadPhase::find_pairs(TaskPool& tasks, Array<BoxPair>& out) {
    std::visit([&](auto& s) { s.find_pairs(tasks, out); }, structure_);
}

void BroadPhase::query_box(const float lower[3], const float upper[3], Array<uint32_t>& out) const {
    std::visit([&](const auto& s) { s.query_box(lower, upper, out); }, structure_);
}

uint32_t BroadPhase::ray(const float origin[3], const float translation[3], float max_t, float& t) const {
    return std::visit([&](const auto& s) { return s.ray(origin, translation, max_t, t); }, structure_);
}

void BroadPhase::boxes(Array<BroadPhaseBox>& out) const {
    std::visit([&](const auto& s) { s.boxes(out); }, structure_);
}

size_t BroadPhase::bytes() const {
    return std::visit([](const auto& s) { return s.bytes(); }, structure_);
}

}  // namespace lendulet
