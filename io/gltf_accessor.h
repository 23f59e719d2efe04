// Numbers out of glTF accessors. Every range is checked before a byte is read; sparse accessors are applied.
#pragma once

#include <cstdint>
#include <vector>

#include "io/gltf_container.h"
#include "lendulet/math.h"

namespace lendulet {

// The accessor's elements as points: VEC3 of floats, or of integers as KHR_mesh_quantization allows.
std::vector<Vec3> read_points(const GltfContainer& container, int accessor);

// The accessor's elements as indices: SCALAR of unsigned bytes, shorts or ints.
std::vector<uint32_t> read_indices(const GltfContainer& container, int accessor);

}  // namespace lendulet
