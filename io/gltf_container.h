// The container of a glTF file: text or GLB chunks, buffers (embedded, beside the file, or in the binary chunk), buffer
// views, accessors and meshes. What stands above them (nodes, scenes, physics) stays JSON and is read by others.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include "io/json_field.h"

namespace lendulet {

struct GltfContainer {
    Json json;                            // asset, scene, scenes, nodes, extensions, extensionsRequired
    tinygltf::Model model;                // buffers, bufferViews, accessors, meshes
    std::vector<bool> compressed_meshes;  // those whose geometry is in a form that is not read
    bool has_animations = false, has_skins = false;
    uint64_t memory_limit = 0;  // bytes that loading may take in all: 4 times the file and 64 MB

    Field root() const { return {&json, ""}; }
};

// Takes a file apart. `directory` is where buffers beside it are looked for. Throws LoadFailure.
GltfContainer read_container(std::string file, const std::string& directory);

}  // namespace lendulet
