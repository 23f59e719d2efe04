// Where the bytes of a glTF buffer come from.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/json_field.h"

namespace lendulet {

// A GLB file's two parts, or a text file's one.
struct GltfParts {
    std::string_view json, binary;
    bool has_binary = false;
};
GltfParts split_chunks(std::string_view file);

// The `byte_length` bytes of buffers[index]: the binary chunk, a base64 data URI, or a file in `directory`. URIs that
// are absolute, name a scheme or leave the directory are refused.
std::vector<unsigned char> read_buffer(const Field& buffer, int index, const GltfParts& parts,
                                       const std::string& directory);

// The file in `directory` that a URI names, under the same rules.
std::string file_beside(const Field& uri, const std::string& directory);

}  // namespace lendulet
