// The one unit that holds the code of tinygltf, which is a header. It reads no images and touches no file: buffers are
// served by gltf_container.cpp.
#include <fstream>
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include "io/gltf_container.h"
