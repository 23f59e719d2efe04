#include "io/gltf_buffers.h"

#include <cstring>

#include "io/file.h"

namespace lendulet {

namespace {

uint32_t word_at(std::string_view bytes, size_t offset) {
    auto byte = [&](size_t i) { return static_cast<uint32_t>(static_cast<unsigned char>(bytes[offset + i])); };
    return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

int base64_value(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

// Decodes until `wanted` bytes are there; empty where the text holds fewer or is not base64.
std::vector<unsigned char> decode_base64(std::string_view text, uint64_t wanted) {
    std::vector<unsigned char> out;
    if (wanted > text.size() / 4 * 3 + 3) return out;
    out.reserve(static_cast<size_t>(wanted));
    uint32_t bits = 0;
    int held = 0;
    for (char c : text) {
        if (c == '=' || out.size() == wanted) break;
        int value = base64_value(c);
        if (value < 0) return {};
        bits = bits << 6 | static_cast<uint32_t>(value);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        out.push_back(static_cast<unsigned char>(bits >> held & 0xff));
    }
    if (out.size() != wanted) out.clear();
    return out;
}

int hex_value(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string decode_percent(std::string_view uri) {
    std::string out;
    for (size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && hex_value(uri[i + 1]) >= 0 && hex_value(uri[i + 2]) >= 0) {
            out += static_cast<char>(hex_value(uri[i + 1]) * 16 + hex_value(uri[i + 2]));
            i += 2;
        } else {
            out += uri[i];
        }
    }
    return out;
}

// A relative path that stays below the file's directory, or a refusal. Checked after decoding, as "%2e%2e" means "..".
std::string checked_path(const Field& uri) {
    std::string path = decode_percent(uri.text());
    auto refuse = [&](const char* why) { uri.refuse("\"" + printable(path) + "\" " + why); };
    if (path.empty()) refuse("is no file name");
    if (path.front() == '/' || path.front() == '\\' || path.find(':') != std::string::npos) {
        refuse("is absolute; only files beside the scene are read");
    }
    if (path.find('\\') != std::string::npos || path.find('\0') != std::string::npos) refuse("is no file name");
    size_t begin = 0;
    while (begin <= path.size()) {
        size_t end = std::min(path.find('/', begin), path.size());
        if (path.substr(begin, end - begin) == "..") refuse("leaves the scene's directory");
        begin = end + 1;
    }
    return path;
}

std::vector<unsigned char> read_data_uri(const Field& uri, uint64_t byte_length) {
    std::string_view text = uri.text();
    size_t comma = text.find(',');
    if (comma == std::string_view::npos || text.substr(0, comma).find(";base64") == std::string_view::npos) {
        uri.refuse("is a data URI without base64 content");
    }
    std::vector<unsigned char> bytes = decode_base64(text.substr(comma + 1), byte_length);
    if (bytes.empty()) uri.refuse("holds no " + std::to_string(byte_length) + " bytes in base64");
    return bytes;
}

}  // namespace

std::string file_beside(const Field& uri, const std::string& directory) {
    std::string path = checked_path(uri);
    return directory.empty() ? path : directory + "/" + path;
}

GltfParts split_chunks(std::string_view file) {
    constexpr uint32_t chunk_json = 0x4e4f534a, chunk_bin = 0x004e4942;
    if (file.size() < 4 || std::memcmp(file.data(), "glTF", 4) != 0) return {file, {}, false};
    if (file.size() < 20) refuse("", "ends inside its GLB header");
    if (word_at(file, 4) != 2) refuse("", "is GLB version " + std::to_string(word_at(file, 4)) + ", not 2");
    if (word_at(file, 8) > file.size()) {
        refuse("", "ends after " + std::to_string(file.size()) + " of " + std::to_string(word_at(file, 8)) + " bytes");
    }
    file = file.substr(0, word_at(file, 8));
    GltfParts parts;
    size_t offset = 12;
    for (int chunk = 0; offset + 8 <= file.size(); ++chunk) {
        uint64_t length = word_at(file, offset);
        uint32_t type = word_at(file, offset + 4);
        offset += 8;
        if (length > file.size() - offset) refuse("", "ends inside GLB chunk " + std::to_string(chunk));
        std::string_view content = file.substr(offset, length);
        if (chunk == 0 && type != chunk_json) refuse("", "has no JSON as its first GLB chunk");
        if (chunk == 0) parts.json = content;
        if (chunk == 1 && type == chunk_bin) parts.binary = content, parts.has_binary = true;
        offset += length;
    }
    return parts;
}

std::vector<unsigned char> read_buffer(const Field& buffer, int index, const GltfParts& parts,
                                       const std::string& directory) {
    uint64_t byte_length = buffer["byteLength"].count();
    if (byte_length == 0) buffer["byteLength"].refuse("must be at least 1");
    Field uri = buffer["uri"];
    std::string_view bytes;
    std::string file;
    if (!uri) {
        if (index != 0 || !parts.has_binary) buffer.refuse("has neither a uri nor a binary chunk");
        bytes = parts.binary;
    } else if (uri.text().rfind("data:", 0) == 0) {
        return read_data_uri(uri, byte_length);
    } else {
        Result<std::string> content = read_file(file_beside(uri, directory));
        if (!content.ok()) refuse(uri.where(), content.error().message, ErrorCode::io);
        file = std::move(content).value();
        bytes = file;
    }
    if (bytes.size() < byte_length) {
        buffer.refuse("has " + std::to_string(bytes.size()) + " of " + std::to_string(byte_length) + " bytes");
    }
    return {bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(byte_length)};
}

}  // namespace lendulet
