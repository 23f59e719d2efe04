#include "io/gltf_container.h"

#include <algorithm>

#include "io/file.h"
#include "io/gltf_buffers.h"

namespace lendulet {

namespace {

// Copies the listed members that are there.
Json pick(const Field& from, std::initializer_list<const char*> members) {
    Json out = Json::object();
    for (const char* member : members) {
        if (Field value = from[member]) out[member] = value.json();
    }
    return out;
}

// Copies members that are whole numbers of at least 0, so that what comes after reads nothing else.
void pick_counts(const Field& from, Json& out, std::initializer_list<const char*> members) {
    for (const char* member : members) {
        if (Field value = from[member]) out[member] = value.count();
    }
}

Json pick_views(const Field& views, size_t buffer_count) {
    Json out = Json::array();
    for (size_t i = 0; i < views.size(); ++i) {
        Field view = views.at(i);
        Json kept = Json::object();
        kept["buffer"] = view["buffer"].index(buffer_count, "buffers");
        kept["byteLength"] = view["byteLength"].count();
        pick_counts(view, kept, {"byteOffset", "byteStride"});
        out.push_back(std::move(kept));
    }
    return out;
}

Json pick_accessors(const Field& accessors, size_t view_count) {
    Json out = Json::array();
    for (size_t i = 0; i < accessors.size(); ++i) {
        Field accessor = accessors.at(i);
        Json kept = pick(accessor, {"type", "normalized", "sparse"});
        if (Field view = accessor["bufferView"]) kept["bufferView"] = view.index(view_count, "bufferViews");
        kept["componentType"] = accessor["componentType"].index(5127, "the component types");
        kept["count"] = accessor["count"].count();
        pick_counts(accessor, kept, {"byteOffset"});
        out.push_back(std::move(kept));
    }
    return out;
}

// Meshes with their positions alone: what collides needs no normals, colours or materials.
Json pick_meshes(const Field& meshes, size_t accessor_count, std::vector<bool>& compressed) {
    Json out = Json::array();
    for (size_t i = 0; i < meshes.size(); ++i) {
        Field mesh = meshes.at(i), primitives = mesh["primitives"];
        bool is_compressed = false;
        Json kept = Json::array();
        for (size_t j = 0; j < primitives.size(); ++j) {
            Field primitive = primitives.at(j);
            is_compressed |= primitive["extensions"]["KHR_draco_mesh_compression"].present();
            if (is_compressed) continue;
            Json part = Json::object();
            if (Field indices = primitive["indices"]) part["indices"] = indices.index(accessor_count, "accessors");
            if (Field mode = primitive["mode"]) part["mode"] = mode.index(7, "the modes");
            part["attributes"] = Json::object();
            if (Field position = primitive["attributes"]["POSITION"]) {
                part["attributes"]["POSITION"] = position.index(accessor_count, "accessors");
            }
            kept.push_back(std::move(part));
        }
        compressed.push_back(is_compressed);
        out.push_back(Json{{"primitives", std::move(kept)}});
    }
    return out;
}

// What tinygltf asks for when it wants buffer i: it is handed the document with each buffer's uri replaced by its
// number.
struct BufferServer {
    const Field& buffers;
    const GltfParts& parts;
    const std::string& directory;
    std::exception_ptr failure;
};

bool serve_buffer(std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
    auto& server = *static_cast<BufferServer*>(user);
    try {
        int index = std::stoi(name.substr(name.rfind('/') + 1));
        *out = read_buffer(server.buffers.at(static_cast<size_t>(index)), index, server.parts, server.directory);
        return true;
    } catch (...) {
        server.failure = std::current_exception();  // thrown again once tinygltf has returned
        return false;
    }
}

Json reduced_document(const Field& root, std::vector<bool>& compressed) {
    Json out;
    out["asset"] = Json{{"version", "2.0"}};
    out["buffers"] = Json::array();
    Field buffers = root["buffers"];
    for (size_t i = 0; i < buffers.size(); ++i) {
        Json buffer{{"byteLength", buffers.at(i)["byteLength"].count()}};
        buffer["uri"] = std::to_string(i);
        out["buffers"].push_back(std::move(buffer));
    }
    out["bufferViews"] = pick_views(root["bufferViews"], buffers.size());
    out["accessors"] = pick_accessors(root["accessors"], root["bufferViews"].size());
    out["meshes"] = pick_meshes(root["meshes"], root["accessors"].size(), compressed);
    return out;
}

void read_model(GltfContainer& container, const Json& document, BufferServer& server) {
    tinygltf::TinyGLTF reader;
    tinygltf::FsCallbacks callbacks;
    callbacks.FileExists = [](const std::string&, void*) { return true; };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = serve_buffer;
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    callbacks.user_data = &server;
    reader.SetFsCallbacks(callbacks);
    std::string text = document.dump(), errors, warnings;
    bool read = reader.LoadASCIIFromString(&container.model, &errors, &warnings, text.c_str(),
                                           static_cast<unsigned>(text.size()), "");
    if (server.failure) std::rethrow_exception(server.failure);
    if (!read) refuse("", printable(errors.substr(0, errors.find('\n'))));
}

// Memory that tinygltf takes for one accessor, view, buffer or primitive with its extension slots, about.
constexpr uint64_t bytes_per_entry = 1200;

void check_entry_count(const Field& root, uint64_t limit) {
    uint64_t entries = root["buffers"].size() + root["bufferViews"].size() + root["accessors"].size();
    Field meshes = root["meshes"];
    for (size_t i = 0; i < meshes.size(); ++i) entries += 1 + meshes.at(i)["primitives"].size();
    if (entries * bytes_per_entry > limit) refuse("", "lists more meshes and accessors than its size allows");
}

}  // namespace

GltfContainer read_container(std::string file, const std::string& directory) {
    uint64_t size = file.size();
    GltfParts parts = split_chunks(file);
    GltfContainer container;
    container.memory_limit = 4 * size + (uint64_t{64} << 20);
    // Half of the memory there is may go into the value tree; text and buffers take the rest.
    ParsedJson parsed = parse_json(parts.json,
                                   {"asset", "scene", "scenes", "nodes", "meshes", "accessors", "bufferViews",
                                    "buffers", "extensions", "extensionsRequired"},
                                   container.memory_limit / 2);
    container.json = std::move(parsed.root);
    auto was_dropped = [&](const char* name) {
        return std::find(parsed.dropped.begin(), parsed.dropped.end(), name) != parsed.dropped.end();
    };
    container.has_animations = was_dropped("animations");
    container.has_skins = was_dropped("skins");
    if (!parts.has_binary) std::string().swap(file);  // the text is not needed any more

    Field root = container.root();
    Field version = root["asset"]["version"];
    if (version.text().rfind("2.", 0) != 0) version.refuse("is \"" + printable(version.text()) + "\", not 2.x");
    check_entry_count(root, container.memory_limit / 4);
    Field buffers = root["buffers"];
    BufferServer server{buffers, parts, directory, nullptr};
    Json document = reduced_document(root, container.compressed_meshes);
    read_model(container, document, server);
    for (const char* member : {"meshes", "accessors", "bufferViews", "buffers"}) container.json.erase(member);
    return container;
}

}  // namespace lendulet
