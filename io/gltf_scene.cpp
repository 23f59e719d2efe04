// The loader's door: puts the parts together and turns whatever they throw into an Error.
#include "io/gltf.h"

#include <new>

#include "io/file.h"
#include "io/gltf_bodies.h"
#include "io/gltf_buffers.h"
#include "io/gltf_container.h"
#include "io/gltf_nodes.h"

namespace lendulet {

namespace {

// Extensions whose absence changes nothing that collides.
bool is_harmless(const std::string& extension) {
    for (const char* known : {"KHR_implicit_shapes", "KHR_physics_rigid_bodies", "KHR_mesh_quantization"}) {
        if (extension == known) return true;
    }
    for (const char* look : {"KHR_lights", "KHR_materials", "KHR_texture", "EXT_texture", "KHR_xmp"}) {
        if (extension.rfind(look, 0) == 0) return true;
    }
    return false;
}

void warn_about_file(const GltfContainer& container, const NodeTree& tree, Warnings& warnings) {
    if (container.has_animations) warnings.add("", "animations are not played");
    Field required = container.root()["extensionsRequired"];
    for (size_t i = 0; i < required.size(); ++i) {
        const std::string& name = required.at(i).text();
        if (!is_harmless(name)) warnings.add("", "the required extension " + printable(name) + " is not known");
    }
    bool has_physics = false;
    for (int node : tree.order) has_physics |= tree.nodes[static_cast<size_t>(node)].physics != nullptr;
    if (!has_physics) warnings.add("", "the file has no physics, so the world is empty");
}

Scene load(std::string bytes, const std::string& directory, const std::string& name, const Configure& configure) {
    Warnings warnings;
    GltfContainer container = read_container(std::move(bytes), directory);
    NodeTree tree = read_nodes(container.root(), container.model.meshes.size());
    WorldBuilder builder;
    builder.down_gravity(9.81f);
    if (configure) configure(builder);
    Result<World> world = builder.build();
    if (!world.ok()) throw LoadFailure(world.error());
    GltfBodies bodies = add_bodies(world.value(), container, tree, warnings);
    add_joints(world.value(), container, tree, bodies, warnings);
    warn_about_file(container, tree, warnings);
    Scene scene{.world = std::move(world).value(),
                .name = name,
                .dt = 1.0f / 60.0f,
                .steps = 600,
                .before_step = {},
                .warnings = warnings.take(),
                .collider_names = std::move(bodies.collider_names)};
    for (size_t i = 0; i < bodies.of_node.size(); ++i)
        if (bodies.of_node[i] != BodyId{}) scene.nodes.emplace_back(static_cast<int>(i), bodies.of_node[i]);
    return scene;
}

std::string directory_of(const std::string& path) {
    const size_t slash = path.rfind('/');
    return slash == std::string::npos ? "" : slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

Result<Scene> load_gltf_bytes(std::string bytes, const std::string& directory, const std::string& name,
                              const Configure& configure) {
    auto failed = [&](ErrorCode code, const std::string& what) { return Error{code, printable(name) + ": " + what}; };
    try {
        return load(std::move(bytes), directory, name, configure);
    } catch (const LoadFailure& failure) {
        // Settings are refused in words of their own, without the file's name.
        if (failure.error().code == ErrorCode::bad_config) return failure.error();
        return failed(failure.error().code, failure.error().message);
    } catch (const std::bad_alloc&) {
        return failed(ErrorCode::io, "there is not enough memory to load it");
    } catch (const std::exception& problem) {
        return failed(ErrorCode::parse, "is malformed (" + printable(problem.what()) + ")");
    }
}

Result<Scene> load_gltf(const std::string& path, const Configure& configure) {
    Result<std::string> bytes = read_file(path);
    if (!bytes.ok()) return bytes.error();
    return load_gltf_bytes(std::move(bytes).value(), directory_of(path), path, configure);
}

std::vector<std::pair<std::string, std::string>> files_of_gltf(const std::string& path) {
    std::vector<std::pair<std::string, std::string>> files;
    Result<std::string> bytes = read_file(path);
    if (!bytes.ok()) return files;
    try {
        const Json json = Json::parse(split_chunks(bytes.value()).json, nullptr, false);
        const Field root(&json, "");
        for (const char* list : {"buffers", "images"})
            for (size_t i = 0; i < root[list].size(); ++i) {
                const Field uri = root[list].at(i)["uri"];
                if (!uri || uri.text().rfind("data:", 0) == 0) continue;
                try {
                    files.emplace_back(uri.text(), file_beside(uri, directory_of(path)));
                } catch (const LoadFailure&) {  // the loader says it
                }
            }
    } catch (const LoadFailure&) {}
    return files;
}

}  // namespace lendulet
