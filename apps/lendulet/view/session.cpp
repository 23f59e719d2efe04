#include "apps/lendulet/view/session.h"

#include <nlohmann/json.hpp>

#include "apps/lendulet/view/reply.h"
#include "explain/flat.h"
#include "io/file.h"

namespace lendulet::cli {

using Json = nlohmann::json;

// Reads members of a request; what is of the wrong kind ends the request with a sentence.
struct Session::Request {
    struct Refused {
        std::string sentence;
    };
    const Json& json;

    bool has(const char* name) const { return json.contains(name); }
    double number(const char* name) const {
        auto it = json.find(name);
        if (it == json.end() || !it->is_number()) throw Refused{std::string(name) + " must be a number"};
        return it->get<double>();
    }
    int whole(const char* name, int most) const {
        double value = number(name);
        if (!(value >= 0.0 && value <= most) || value != static_cast<double>(static_cast<int>(value)))
            throw Refused{std::string(name) + " must be a whole number from 0 to " + std::to_string(most)};
        return static_cast<int>(value);
    }
    float real(const char* name) const { return static_cast<float>(number(name)); }
    std::string text(const char* name) const {
        auto it = json.find(name);
        if (it == json.end() || !it->is_string()) throw Refused{std::string(name) + " must be text"};
        return it->get<std::string>();
    }
    void vector(const char* name, float out[3]) const {
        auto it = json.find(name);
        bool good = it != json.end() && it->is_array() && it->size() == 3;
        for (size_t i = 0; good && i < 3; ++i) good = (*it)[i].is_number();
        if (!good) throw Refused{std::string(name) + " must be three numbers"};
        for (size_t i = 0; i < 3; ++i) out[i] = (*it)[i].get<float>();
    }
    const Json& object(const char* name) const {
        auto it = json.find(name);
        if (it == json.end() || !it->is_object()) throw Refused{std::string(name) + " must be an object"};
        return *it;
    }
    const Json& list(const char* name) const {
        auto it = json.find(name);
        if (it == json.end() || !it->is_array()) throw Refused{std::string(name) + " must be a list"};
        return *it;
    }
};

namespace {

constexpr int most_bodies = 1 << 30;

// What the C interface refuses ends the request too.
template <class Refused>
void must(lendulet_result result) {
    if (result < 0) throw Refused{lendulet_error()};
}

lendulet_body body_at(lendulet_world* world, int index) {
    const lendulet_body* bodies = nullptr;
    int count = lendulet_read_bodies(world, &bodies);
    return index < count ? bodies[index] : 0;
}

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

template <class Request>
std::string explained(const Request& asked) {
    Result<explain::Sequence> made =
        explain::sequence({asked.text("what"), asked.text("a"), asked.text("b"), asked.text("simplex")});
    if (!made) throw typename Request::Refused{made.error().message};
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
        if (lendulet_read_body(world, body_at(world, body), &state) >= 0) reply.one(Section::body, state);
    }
}

}  // namespace

lendulet_world* Session::world() {
    if (!worlds_[chosen_]) throw Request::Refused{"there is no world yet: open a scene first"};
    return worlds_[chosen_].get();
}

void Session::open(const std::string& name) {
    Result<Scene> scene = open_(name);
    if (!scene) throw Request::Refused{scene.error().message};
    worlds_[0] = std::make_unique<lendulet_world>(std::move(scene).value());
    worlds_[1].reset();
    kept_.clear();
    kept_bytes_ = 0;
}

void Session::keep(uint32_t key) {
    const uint8_t* bytes = nullptr;
    int size = lendulet_read_snapshot(world(), &bytes);
    must<Request::Refused>(size);
    std::vector<uint8_t>& place = kept_[key];
    kept_bytes_ -= place.size();
    place.clear();
    if (kept_bytes_ + static_cast<size_t>(size) > max_snapshot_bytes)
        throw Request::Refused{"there is no more room for snapshots"};
    place.assign(bytes, bytes + size);
    kept_bytes_ += place.size();
}

void Session::go(uint32_t key) {
    auto it = kept_.find(key);
    if (it == kept_.end()) throw Request::Refused{"there is no snapshot of that key"};
    must<Request::Refused>(lendulet_restore(world(), it->second.data(), it->second.size()));
}

// {"do": "sphere", radius, at, velocity, density}, {"do": "box", half, at, velocity, density},
// {"do": "grab", body, point}, {"do": "drag", target}, {"do": "release"}, {"do": "set", settings that change},
// {"do": "fork"}, {"do": "join"} (ends the fork)
void Session::change(const Request& command) {
    using Refused = Request::Refused;
    const std::string what = command.text("do");
    float a[3], b[3], c[3];
    if (what == "sphere") {
        command.vector("at", a), command.vector("velocity", b);
        must<Refused>(lendulet_add_sphere(world(), command.real("radius"), a, b, command.real("density"), nullptr));
    } else if (what == "box") {
        command.vector("half", a), command.vector("at", b), command.vector("velocity", c);
        must<Refused>(lendulet_add_box(world(), a, b, c, command.real("density"), nullptr));
    } else if (what == "grab") {
        command.vector("point", a);
        must<Refused>(lendulet_grab(world(), body_at(world(), command.whole("body", most_bodies)), a));
    } else if (what == "drag") {
        command.vector("target", a);
        lendulet_drag(world(), a);  // may have been let go by a restore
    } else if (what == "release") {
        lendulet_release(world());
    } else if (what == "fork") {
        worlds_[1].reset(lendulet_fork(worlds_[0] ? worlds_[0].get() : world()));
    } else if (what == "join") {
        worlds_[1].reset();
    } else if (what == "set") {
        lendulet_settings s{};
        must<Refused>(lendulet_read_settings(world(), &s));
        if (command.has("gravity")) command.vector("gravity", s.gravity);
        const std::pair<const char*, float*> reals[] = {{"stepSize", &s.step_size},
                                                        {"friction", &s.friction},
                                                        {"restitution", &s.restitution},
                                                        {"rigidSpeed", &s.rigid_separation_speed},
                                                        {"staticSpeed", &s.static_separation_speed}};
        for (auto [name, value] : reals)
            if (command.has(name)) *value = command.real(name);
        const std::pair<const char*, int32_t*> wholes[] = {{"solverSteps", &s.solver_steps},
                                                           {"broadPhase", &s.broad_phase},
                                                           {"simplex", &s.simplex},
                                                           {"integrator", &s.integrator},
                                                           {"workers", &s.workers},
                                                           {"width", &s.width},
                                                           {"sleep", &s.sleep},
                                                           {"continuous", &s.continuous}};
        for (auto [name, value] : wholes)
            if (command.has(name)) *value = command.whole(name, 1000);
        must<Refused>(lendulet_set_settings(world(), &s));
    } else {
        throw Refused{"there is no change named \"" + printable(what) + "\""};
    }
}

void Session::perform(const Request& request) {
    if (request.has("open")) open(request.text("open"));
    chosen_ = request.has("world") ? static_cast<size_t>(request.whole("world", 1)) : 0;
    if (request.has("go")) go(static_cast<uint32_t>(request.whole("go", most_bodies)));
    if (request.has("do"))
        for (const Json& command : request.list("do")) {
            if (!command.is_object()) throw Request::Refused{"a change must be an object"};
            change(Request{command});
        }
    const int steps = request.has("steps") ? request.whole("steps", max_steps_per_request) : 0;
    for (int i = 0; i < steps; ++i) must<Request::Refused>(lendulet_step(world()));
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
        const Request request{json};
        try {
            perform(request);
            if (request.has("explain")) reply.text(Section::explain, explained(Request{request.object("explain")}));
        } catch (const Request::Refused& refused) {
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
    } catch (const Request::Refused& refused) {
        reply.text(Section::error, refused.sentence);
    } catch (const std::exception& problem) {  // such as running out of memory
        reply.text(Section::error, problem.what());
    }
    return reply.take();
}

}  // namespace lendulet::cli
