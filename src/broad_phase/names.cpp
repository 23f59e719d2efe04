// The names of the broad phases on command lines and in files.
#include <array>
#include <string>
#include <utility>

#include "lendulet/options.h"

namespace lendulet {

namespace {

constexpr std::array<std::pair<BroadPhaseType, std::string_view>, 8> names{{
    {BroadPhaseType::all_pairs, "all-pairs"},
    {BroadPhaseType::sweep_1, "sweep-1"},
    {BroadPhaseType::sweep_3, "sweep-3"},
    {BroadPhaseType::rtree_quadratic, "rtree-quadratic"},
    {BroadPhaseType::rtree_star, "rtree-star"},
    {BroadPhaseType::rtree_str, "rtree-str"},
    {BroadPhaseType::rtree_omt, "rtree-omt"},
    {BroadPhaseType::wide_tree, "default"},
}};

}  // namespace

std::string_view name_of(BroadPhaseType type) {
    for (const auto& [value, name] : names) {
        if (value == type) return name;
    }
    return "unknown";
}

Result<BroadPhaseType> broad_phase_from_name(std::string_view text) {
    std::string known;
    for (const auto& [value, name] : names) {
        if (name == text) return value;
        known += (known.empty() ? "" : ", ") + std::string(name);
    }
    return Error{ErrorCode::unknown_name, "there is no broad phase \"" + std::string(text) + "\"; there are " + known};
}

}  // namespace lendulet
