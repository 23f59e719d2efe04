#include "io/gltf_accessor.h"

#include <cstring>

namespace lendulet {

namespace {

// A checked range of equal elements in a buffer.
struct Elements {
    const unsigned char* data = nullptr;
    uint64_t stride = 0, count = 0;
    int component = 0;
    bool normalized = false;
};

std::string name_of_accessor(int index) { return "accessors[" + std::to_string(index) + "]"; }

uint64_t component_bytes(int component, const std::string& where) {
    int32_t bytes = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(component));
    if (bytes <= 0 || component == TINYGLTF_COMPONENT_TYPE_DOUBLE) refuse(where, "has an unknown component type");
    return static_cast<uint64_t>(bytes);
}

// `offset` bytes into buffer view `view` there must be `count` elements of `element_bytes`.
Elements elements_of(const tinygltf::Model& model, int view, uint64_t offset, uint64_t count, uint64_t element_bytes,
                     bool strided, const std::string& where) {
    if (view < 0 || static_cast<size_t>(view) >= model.bufferViews.size()) {
        refuse(where, "names bufferViews[" + std::to_string(view) + "], which is not there");
    }
    const tinygltf::BufferView& range = model.bufferViews[static_cast<size_t>(view)];
    std::string view_name = "bufferViews[" + std::to_string(view) + "]";
    if (range.buffer < 0 || static_cast<size_t>(range.buffer) >= model.buffers.size()) {
        refuse(view_name, "names buffers[" + std::to_string(range.buffer) + "], which is not there");
    }
    const std::vector<unsigned char>& bytes = model.buffers[static_cast<size_t>(range.buffer)].data;
    if (range.byteOffset > bytes.size() || range.byteLength > bytes.size() - range.byteOffset) {
        refuse(view_name, "reaches past the end of buffers[" + std::to_string(range.buffer) + "]");
    }
    uint64_t stride = strided && range.byteStride ? range.byteStride : element_bytes;
    if (stride < element_bytes || stride > 252) refuse(view_name, "has a byteStride of " + std::to_string(stride));
    // count < 2^32 and stride < 2^8: no product here overflows.
    uint64_t needed = count == 0 ? 0 : (count - 1) * stride + element_bytes;
    if (offset > range.byteLength || needed > range.byteLength - offset) {
        refuse(where, "reaches past the end of " + view_name);
    }
    return {bytes.data() + range.byteOffset + offset, stride, count, 0, false};
}

struct CheckedAccessor {
    const tinygltf::Accessor* accessor;
    std::string where;
    uint64_t components, element_bytes;
};

CheckedAccessor check(const GltfContainer& container, int index, int type) {
    if (index < 0 || static_cast<size_t>(index) >= container.model.accessors.size()) {
        refuse(name_of_accessor(index), "is not there");
    }
    CheckedAccessor out{&container.model.accessors[static_cast<size_t>(index)], name_of_accessor(index), 0, 0};
    if (out.accessor->type != type) refuse(out.where, "is not of the type that its use needs");
    out.components = static_cast<uint64_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)));
    out.element_bytes = out.components * component_bytes(out.accessor->componentType, out.where);
    if (out.accessor->count == 0 || out.accessor->count > 0xffffffffull) {
        refuse(out.where, "has a count of " + std::to_string(out.accessor->count));
    }
    // Without a buffer view all elements are 0 and no data bounds their number.
    if (out.accessor->bufferView < 0 && out.accessor->count * 16 > container.memory_limit / 4) {
        refuse(out.where, "counts more elements than the file's size allows");
    }
    return out;
}

double component_at(const unsigned char* data, int component, bool normalized) {
    auto read = [&](auto zero) {
        std::memcpy(&zero, data, sizeof zero);
        return static_cast<double>(zero);
    };
    switch (component) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return normalized ? std::max(read(int8_t{}) / 127.0, -1.0) : read(int8_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return read(uint8_t{}) / (normalized ? 255.0 : 1.0);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return normalized ? std::max(read(int16_t{}) / 32767.0, -1.0) : read(int16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return read(uint16_t{}) / (normalized ? 65535.0 : 1.0);
        case TINYGLTF_COMPONENT_TYPE_INT:
            return read(int32_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return read(uint32_t{});
        default:
            return read(float{});
    }
}

// Calls store(element, component, value) for every number of the accessor, dense ones first, then sparse replacements.
template <class Store>
void read_all(const GltfContainer& container, const CheckedAccessor& checked, Store store) {
    const tinygltf::Accessor& a = *checked.accessor;
    uint64_t step = checked.element_bytes / checked.components;
    auto copy = [&](const Elements& from, uint64_t i, uint64_t to) {
        for (uint64_t c = 0; c < checked.components; ++c) {
            store(to, c, component_at(from.data + i * from.stride + c * step, a.componentType, a.normalized));
        }
    };
    if (a.bufferView >= 0) {
        Elements dense = elements_of(container.model, a.bufferView, a.byteOffset, a.count, checked.element_bytes, true,
                                     checked.where);
        for (uint64_t i = 0; i < a.count; ++i) copy(dense, i, i);
    }
    if (!a.sparse.isSparse) return;
    std::string where = checked.where + ".sparse";
    if (a.sparse.count < 0 || static_cast<uint64_t>(a.sparse.count) > a.count || a.sparse.indices.byteOffset < 0 ||
        a.sparse.values.byteOffset < 0) {
        refuse(where, "is out of range");
    }
    uint64_t count = static_cast<uint64_t>(a.sparse.count);
    Elements indices =
        elements_of(container.model, a.sparse.indices.bufferView, static_cast<uint64_t>(a.sparse.indices.byteOffset),
                    count, component_bytes(a.sparse.indices.componentType, where), false, where + ".indices");
    Elements values =
        elements_of(container.model, a.sparse.values.bufferView, static_cast<uint64_t>(a.sparse.values.byteOffset),
                    count, checked.element_bytes, false, where + ".values");
    for (uint64_t i = 0; i < count; ++i) {
        double to = component_at(indices.data + i * indices.stride, a.sparse.indices.componentType, false);
        if (!(to >= 0.0 && to < static_cast<double>(a.count))) refuse(where + ".indices", "has an index out of range");
        copy(values, i, static_cast<uint64_t>(to));
    }
}

}  // namespace

std::vector<Vec3> read_points(const GltfContainer& container, int accessor) {
    CheckedAccessor checked = check(container, accessor, TINYGLTF_TYPE_VEC3);
    std::vector<Vec3> points;
    // Room is made only once the accessor's range is known to be there.
    if (checked.accessor->bufferView >= 0) {
        elements_of(container.model, checked.accessor->bufferView, checked.accessor->byteOffset,
                    checked.accessor->count, checked.element_bytes, true, checked.where);
    }
    points.resize(checked.accessor->count);
    read_all(container, checked, [&](uint64_t i, uint64_t c, double value) {
        float v = static_cast<float>(value);
        if (!(absolute(v) <= 3.4e38f)) refuse(checked.where, "has an element that is not a finite number");
        (c == 0 ? points[i].x : c == 1 ? points[i].y : points[i].z) = v;
    });
    return points;
}

std::vector<uint32_t> read_indices(const GltfContainer& container, int accessor) {
    CheckedAccessor checked = check(container, accessor, TINYGLTF_TYPE_SCALAR);
    int component = checked.accessor->componentType;
    if (component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        refuse(checked.where, "is no list of indices");
    }
    std::vector<uint32_t> indices;
    if (checked.accessor->bufferView >= 0) {
        elements_of(container.model, checked.accessor->bufferView, checked.accessor->byteOffset,
                    checked.accessor->count, checked.element_bytes, true, checked.where);
    }
    indices.resize(checked.accessor->count);
    read_all(container, checked,
             [&](uint64_t i, uint64_t, double value) { indices[i] = static_cast<uint32_t>(value); });
    return indices;
}

}  // namespace lendulet
