// An answer of a session, section by section.
#pragma once

#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "apps/lendulet/view/session.h"

namespace lendulet::cli {

class Reply {
public:
    explicit Reply(uint32_t id) {
        put(reply_magic);
        put(id);
    }
    template <class T>
    void list(Section kind, const T* items, size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        begin(kind, count * sizeof(T));
        if (count) bytes_.append(reinterpret_cast<const char*>(items), count * sizeof(T));
        pad();
    }
    template <class T>
    void one(Section kind, const T& item) {
        list(kind, &item, 1);
    }
    void text(Section kind, std::string_view words) { list(kind, words.data(), words.size()); }
    void mesh(uint32_t number, const lendulet_mesh& m) {
        const size_t vertices = 12 * static_cast<size_t>(m.vertex_count);
        const size_t indices = 12 * static_cast<size_t>(m.triangle_count);
        begin(Section::mesh, 16 + vertices + indices);
        put(number), put(static_cast<uint32_t>(m.vertex_count)), put(static_cast<uint32_t>(m.triangle_count)), put(0u);
        bytes_.append(reinterpret_cast<const char*>(m.vertices), vertices);
        bytes_.append(reinterpret_cast<const char*>(m.indices), indices);
        pad();
    }
    std::string take() { return std::move(bytes_); }

private:
    void put(uint32_t word) { bytes_.append(reinterpret_cast<const char*>(&word), sizeof word); }
    void begin(Section kind, size_t bytes) { put(static_cast<uint32_t>(kind)), put(static_cast<uint32_t>(bytes)); }
    void pad() { bytes_.resize((bytes_.size() + 7) / 8 * 8); }
    std::string bytes_;
};

}  // namespace lendulet::cli
