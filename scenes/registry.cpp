// The table of built-in scenes and the reading of their names.
#include <algorithm>
#include <charconv>
#include <span>

#include "scenes/builders.h"

namespace lendulet {
namespace scenes {
namespace {

struct Entry {
    SceneInfo info;
    int largest_size;
    SceneDescription (*describe)(int size);
};

constexpr Entry entries[] = {
    {{"large_pyramid", "A pyramid of unit boxes; size: boxes in its base.", 100}, 1000, large_pyramid},
    {{"many_pyramids", "A square field of pyramids of base 10; size: pyramids along a side.", 14}, 100, many_pyramids},
    {{"box_pile", "Unit boxes dropped into a container; size: boxes.", 1000}, 1000000, box_pile},
    {{"sphere_pile", "Balls dropped into a container; size: balls.", 4000}, 1000000, sphere_pile},
    {{"capsule_pile", "Capsules dropped into a container; size: capsules.", 4000}, 1000000, capsule_pile},
    {{"convex_pile", "Rocks (hulls of 24 points) dropped into a container; size: rocks.", 4000}, 1000000, convex_pile},
    {{"mixed_pile", "Boxes, balls, capsules and rocks dropped into a container; size: bodies.", 4000},
     1000000,
     mixed_pile},
    {{"joint_grid", "A hanging net of balls and ball joints; size: balls along a side.", 100}, 500, joint_grid},
    {{"ragdolls", "Ragdolls of eleven parts falling onto each other; size: ragdolls.", 100}, 10000, ragdolls},
    {{"tumbler", "Cubes in a slowly turning drum; size: cubes along an edge of the block they start as.", 20},
     24,
     tumbler},
    {{"mesh_terrain", "Bodies of all kinds falling onto hills of 100352 triangles; size: bodies.", 2000},
     100000,
     mesh_terrain},
    {{"height_field", "A heap that rolls down a hill of a height field of 50176 cells; size: bodies.", 1000},
     100000,
     height_field},
    {{"large_world_sleep", "Boxes that sleep, and 200 bodies that do not; size: sleeping boxes.", 20000},
     40000,
     large_world_sleep},
    {{"stack", "A column of unit boxes; size: boxes.", 20}, 1000, stack},
    {{"mass_ratio", "Five light boxes under a heavy one; size: ratio of their masses.", 100}, 1000000, mass_ratio},
    {{"chain_heavy", "A chain of 20 links with a heavy ball; size: ratio of their masses.", 100}, 1000000, chain_heavy},
    {{"wall_ball", "A brick wall struck by a heavy ball at 80 m/s; size: rows of bricks.", 20}, 200, wall_ball},
    {{"many_things", "Boxes and balls of all sizes above a floor; size: bodies along an edge of their cube.", 15},
     50,
     many_things},
    {{"two_spheres", "Two balls meeting off centre, without gravity.", 0}, 0, two_spheres},
    {{"sphere_and_box", "A ball and a box meeting off centre, without gravity.", 0}, 0, sphere_and_box},
    {{"two_boxes", "Two boxes meeting off centre, without gravity.", 0}, 0, two_boxes},
    {{"wrecking_ball", "A wall of boxes struck by a large box, without gravity; size: boxes along a side.", 15},
     60,
     wrecking_ball},
    {{"carpet_bomb", "A carpet of boxes struck by 49 large boxes one after another; size: boxes along a side.", 101},
     401,
     carpet_bomb},
    {{"spinning_ball", "Balls meeting a great spinning ball; size: balls along a side.", 11}, 51, spinning_ball},
    {{"rotating_board", "Balls swept away by a turning board; size: balls along a side.", 11}, 51, rotating_board},
    {{"newtons_cradle", "Touching balls on rods, the first one lifted; size: balls.", 5}, 100, newtons_cradle},
    {{"dzhanibekov", "A box turning about its middle axis of inertia, which flips over every 4 s.", 0}, 0, dzhanibekov},
    {{"dominoes", "A row of dominoes, the first one pushed; size: dominoes.", 60}, 10000, dominoes},
    {{"domino_spiral", "Dominoes on a spiral, the outermost pushed; size: dominoes.", 300}, 5000, domino_spiral},
    {{"brick_tower", "A round tower of bricks struck by a swinging ball; size: courses.", 20}, 200, brick_tower},
    {{"arch", "An arch of wedge-shaped stones without mortar, and crates falling on it; size: stones.", 15}, 99, arch},
    {{"card_house", "A house of leaning cards; size: storeys.", 4}, 12, card_house},
    {{"ragdoll_avalanche", "Ragdolls sliding down a slope between posts; size: ragdolls.", 60},
     2000,
     ragdoll_avalanche},
    {{"bridge", "A hanging bridge of planks, and a loaded lorry driving over it; size: planks.", 26}, 60, bridge},
    {{"car", "A car with sprung wheels driving in circles over hills.", 0}, 0, car},
    {{"gear_train", "Gears driving each other by their teeth alone; size: gears.", 5}, 40, gear_train},
    {{"walker", "Theo Jansen's walking linkage: twelve legs on one crankshaft.", 0}, 0, walker},
    {{"hourglass", "Grains running through a glass that is turned over every 15 s; size: grains.", 900},
     1000,
     hourglass},
    {{"marble_machine", "Marbles in a zigzag of channels, lifted by a wheel of buckets; size: marbles.", 40},
     100,
     marble_machine},
    {{"t_handle", "A tumbling T-handle, and beside it a naive integrator at the same task.", 0}, 0, t_handle},
    {{"ten_thousand_boxes", "Ten thousand boxes dropped into a container.", 0}, 0, ten_thousand_boxes},
};

const Entry* find(std::string_view name) {
    const Entry* entry =
        std::find_if(std::begin(entries), std::end(entries), [&](const Entry& e) { return e.info.name == name; });
    return entry == std::end(entries) ? nullptr : entry;
}

// Number of letters to insert, drop or change to get from a to b (Levenshtein 1966), row by row.
size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < b.size(); ++j) {
            size_t changed = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
        }
    }
    return row[b.size()];
}

// Names that were probably meant: those that contain what was asked for, or differ from it in a third of the letters.
std::string near_names(std::string_view name) {
    std::string text;
    name = name.substr(0, 64);
    for (const Entry& entry : entries) {
        std::string_view other = entry.info.name;
        bool near = edit_distance(name, other) <= 1 + other.size() / 3;
        if (name.size() >= 3) near = near || other.find(name) != other.npos || name.find(other) != name.npos;
        if (near) text += (text.empty() ? "" : ", ") + std::string(other);
    }
    return text;
}

Error unknown(std::string_view name) {
    std::string shown(name.substr(0, 64));
    for (char& c : shown)
        if (c < ' ' || c > '~') c = '?';
    std::string near = near_names(name);
    std::string sentence = "There is no built-in scene \"" + shown + "\"";
    sentence += near.empty() ? "; `lendulet scenes` lists them." : "; near names are " + near + ".";
    return {ErrorCode::unknown_name, sentence};
}

bool all_digits(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

struct Parsed {
    const Entry* entry = nullptr;  // null: no such scene
    std::string_view size;         // empty: none given
    bool sized = false;
};

// NAME, NAME:N or NAME_N; a name that is a scene's as it stands is never cut.
Parsed parse(std::string_view name) {
    if (const Entry* entry = find(name)) return {entry, {}, false};
    if (size_t colon = name.find(':'); colon != name.npos)
        return {find(name.substr(0, colon)), name.substr(colon + 1), true};
    size_t underscore = name.rfind('_');
    if (underscore == name.npos || !all_digits(name.substr(underscore + 1))) return {};
    return {find(name.substr(0, underscore)), name.substr(underscore + 1), true};
}

Result<int> size_of(const Parsed& parsed) {
    const SceneInfo& info = parsed.entry->info;
    if (!parsed.sized) return info.default_size;
    if (info.default_size == 0)
        return Error{ErrorCode::bad_config, "Scene \"" + std::string(info.name) + "\" has no size."};
    int size = 0;
    const char* end = parsed.size.data() + parsed.size.size();
    auto [rest, status] = std::from_chars(parsed.size.data(), end, size);
    if (!all_digits(parsed.size) || status != std::errc{} || rest != end || size < 1 ||
        size > parsed.entry->largest_size)
        return Error{ErrorCode::bad_config, "The size of scene \"" + std::string(info.name) +
                                                "\" must be a whole number from 1 to " +
                                                std::to_string(parsed.entry->largest_size) + "."};
    return size;
}

}  // namespace

Result<SceneDescription> describe_scene(std::string_view name) {
    Parsed parsed = parse(name);
    if (!parsed.entry) return unknown(name);
    Result<int> size = size_of(parsed);
    if (!size) return size.error();
    SceneDescription description = parsed.entry->describe(size.value());
    description.name = std::string(parsed.entry->info.name);
    if (parsed.sized) description.name += ":" + std::to_string(size.value());
    return description;
}

}  // namespace scenes

std::vector<SceneInfo> built_in_scenes() {
    std::vector<SceneInfo> infos;
    for (const scenes::Entry& entry : scenes::entries) infos.push_back(entry.info);
    return infos;
}

Result<Scene> build_scene(std::string_view name, const Configure& configure) {
    Result<scenes::SceneDescription> description = scenes::describe_scene(name);
    if (!description) return description.error();
    return scenes::instantiate(description.value(), configure);
}

}  // namespace lendulet
