#include "apps/lendulet/view/session.h"

#include "apps/lendulet/view/change.h"
#include "apps/lendulet/view/reply.h"
#include "explain/flat.h"
#include "io/file.h"

namespace lendulet::cli {

namespace {

// A section that is a list by its read function.
template <class T>
void add_list(Reply& reply, Section kind, lendulet_world* world, lendulet_result (*read)(lendulet_world*, const T**)) {
    const T* items = nullptr;
    int count = read(world, &items);
    if (count >= 0) reply.list(kind, items, static_cast<size_t>(count));
}
template <class T>
void add_one(Reply& reply, Section kind, lendulet_world* world, lendulet_result (*read)(const lendulet_world*, T*)) {
    T item{};
    if (read(world, &item) >= 0) reply.one(kind, item);
}

void add_names(Reply& reply, const World& world) {
    std::string list;
    auto word = [&](size_t value) {
        const uint32_t bits = static_cast<uint32_t>(value);
        list.append(reinterpret_cast<const char*>(&bits), sizeof bits);
    };
    for (int i = 0; i < world.body_count(); ++i) {
        const std::string_view name = world.get_static(world.body(i)).name();
        if (name.empty()) continue;
        word(static_cast<size_t>(i)), word(name.size());
        list += name;
        list.resize((list.size() + 3) / 4 * 4);
    }
    reply.text(Section::names, list);
}

// What there is to choose from, whether or not a scene is open.
std::string lists() {
    Json out{{"scenes", Json::array()}, {"stages", Json::array()}, {"choices", Json::array()}};
    for (const SceneInfo& scene : built_in_scenes())
        out["scenes"].push_back(
            {{"name", scene.name}, {"description", scene.description}, {"size", scene.default_size}});
    for (int32_t i = 0; lendulet_stage_name(i); ++i) out["stages"].push_back(lendulet_stage_name(i));
    for (int32_t kind = 0; kind < 3; ++kind) {
        out["choices"].push_back(Json::array());
        for (int32_t i = 0; lendulet_choice_name(kind, i); ++i)
            out["choices"].back().push_back(lendulet_choice_name(kind, i));
    }
    return out.dump();
}

std::string explained(const Asked& asked) {
    Result<explain::Sequence> made =
        explain::sequence({asked.text("what"), asked.text("a"), asked.text("b"), asked.text("simplex")});
    if (!made) throw Asked::Refused{made.error().message};
    return explain::flat(made.value());
}

void add_shapes(Reply& reply, lendulet_world* world) {
    add_names(reply, world->scene.world);
    add_list(reply, Section::bodies, world, lendulet_read_bodies);
    add_list(reply, Section::colliders, world, lendulet_read_colliders);
    lendulet_mesh mesh{};
    for (uint32_t i = 0; lendulet_read_mesh(world, static_cast<int32_t>(i), &mesh) >= 0; ++i) reply.mesh(i, mesh);
}

void add_nodes(Reply& reply, lendulet_world* world) {
    const World& w = world->scene.world;
    std::vector<int32_t> pairs;
    std::map<uint32_t, int32_t> place;  // in the list of bodies, by slot
    for (int32_t i = 0; i < w.body_count(); ++i) place[w.body(i).index] = i;
    for (auto [node, body] : world->scene.nodes)
        if (auto it = place.find(body.index); it != place.end() && w.body(it->second) == body)
            pairs.insert(pairs.end(), {node, it->second});
    reply.list(Section::nodes, pairs.data(), pairs.size());
}

void add_wanted(Reply& reply, lendulet_world* world, const std::string& what, int body) {
    if (what == "shapes") return add_shapes(reply, world);
    if (what == "nodes") return add_nodes(reply, world);
    if (what == "poses") return add_list(reply, Section::poses, world, lendulet_read_poses);
    if (what == "contacts") return add_list(reply, Section::contacts, world, lendulet_read_contacts);
    if (what == "joints") return add_list(reply, Section::joints, world, lendulet_read_joints);
    if (what == "boxes") return add_list(reply, Section::boxes, world, lendulet_read_boxes);
    if (what == "groups") return add_list(reply, Section::groups, world, lendulet_read_groups);
    if (what == "motions") return add_list(reply, Section::motions, world, lendulet_read_motions);
    if (what == "statistics") return add_one(reply, Section::statistics, world, lendulet_read_statistics);
    if (what == "settings") return add_one(reply, Section::settings, world, lendulet_read_settings);
    if (what == "grab") {
        float point[3];
        return reply.list(Section::grab, point, lendulet_read_grab(world, point) > 0 ? 3 : 0);
    }
    if (what == "body") {
        lendulet_body_state state;
        if (lendulet_read_body(world, body_at(*world, body), &state) >= 0) reply.one(Section::body, state);
    }
}

}  // namespace

lendulet_world* Session::world() {
    if (!worlds_[chosen_]) throw Asked::Refused{"there is no world yet: open a scene first"};
    return worlds_[chosen_].get();
}

void Session::open(const std::string& name) {
    Result<Scene> scene = open_(name);
    if (!scene) throw Asked::Refused{scene.error().message};
    worlds_[0] = std::make_unique<lendulet_world>(std::move(scene).value());
    for (size_t i = 1; i < std::size(worlds_); ++i) worlds_[i].reset();
    kept_.clear();
    kept_bytes_ = 0;
}

void Session::keep(uint32_t key) {
    const uint8_t* bytes = nullptr;
    int size = lendulet_read_snapshot(world(), &bytes);
    must(size);
    std::vector<uint8_t>& place = kept_[key];
    kept_bytes_ -= place.size();
    place.clear();
    if (kept_bytes_ + static_cast<size_t>(size) > max_snapshot_bytes)
        throw Asked::Refused{"there is no more room for snapshots"};
    place.assign(bytes, bytes + size);
    kept_bytes_ += place.size();
}

void Session::go(uint32_t key) {
    auto it = kept_.find(key);
    if (it == kept_.end()) throw Asked::Refused{"there is no snapshot of that key"};
    must(lendulet_restore(world(), it->second.data(), it->second.size()));
}

// {"do": "fork", to}, {"do": "join", to} (ends that fork), or what change.h describes. `to`: 1 where it is missing.
void Session::change(const Asked& command) {
    const std::string what = command.text("do");
    if (what != "fork" && what != "join") return lendulet::cli::change(*world(), command);
    const int to = command.has("to") ? command.whole("to", most_forks) : 1;
    if (to == 0) throw Asked::Refused{"a fork's number must be 1 or more"};
    std::unique_ptr<lendulet_world>& place = worlds_[static_cast<size_t>(to)];
    if (what == "join") return place.reset();
    place.reset(lendulet_fork(worlds_[0] ? worlds_[0].get() : world()));
}

void Session::perform(const Asked& request) {
    if (request.has("open")) open(request.text("open"));
    chosen_ = request.has("world") ? static_cast<size_t>(request.whole("world", most_forks)) : 0;
    if (request.has("go")) go(static_cast<uint32_t>(request.whole("go", most_bodies)));
    if (request.has("do"))
        for (const Json& command : request.list("do")) {
            if (!command.is_object()) throw Asked::Refused{"a change must be an object"};
            change(Asked{command});
        }
    const int steps = request.has("steps") ? request.whole("steps", max_steps_per_request) : 0;
    for (int i = 0; i < steps; ++i) must(lendulet_step(world()));
    if (request.has("keep")) keep(static_cast<uint32_t>(request.whole("keep", most_bodies)));
    if (request.has("forget"))
        for (const Json& key : request.list("forget")) {
            auto it = key.is_number_unsigned() ? kept_.find(key.get<uint32_t>()) : kept_.end();
            if (it == kept_.end()) continue;
            kept_bytes_ -= it->second.size();
            kept_.erase(it);
        }
}

std::string Session::answer(std::string_view text) {
    const Json json = Json::parse(text, nullptr, false);
    const bool good = json.is_object();
    auto id = good ? json.find("id") : json.end();
    Reply reply(good && id != json.end() && id->is_number_unsigned() ? id->get<uint32_t>() : 0);
    if (!good) {
        reply.text(Section::error, "a request must be a JSON object");
        return reply.take();
    }
    try {
        const Asked request{json};
        try {
            perform(request);
            if (request.has("explain")) reply.text(Section::explain, explained(Asked{request.object("explain")}));
        } catch (const Asked::Refused& refused) {
            reply.text(Section::error, refused.sentence);
        }
        lendulet_world* w = worlds_[chosen_].get();
        const int body = request.has("body") ? request.whole("body", most_bodies) : 0;
        bool hash = false;
        const Json none = Json::array();
        for (const Json& what : request.has("want") ? request.list("want") : none) {
            if (what == "lists") reply.text(Section::lists, lists());
            else if (w && what.is_string()) add_wanted(reply, w, what.get<std::string>(), body);
            hash |= what == "hash";
        }
        if (!w) return reply.take();
        reply.one(Section::state, SessionState{lendulet_time(w), lendulet_step_count(w), hash ? lendulet_hash(w) : 0,
                                               lendulet_step_size(w), worlds_[1] ? 1u : 0u, kept_bytes_});
    } catch (const Asked::Refused& refused) {
        reply.text(Section::error, refused.sentence);
    } catch (const std::exception& problem) {  // such as running out of memory
        reply.text(Section::error, problem.what());
    }
    return reply.take();
}

}  // namespace lendulet::cli
