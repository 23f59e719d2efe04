#include <cmath>
#include <cstring>
#include <filesystem>

#include "io/file.h"
#include "io/recording.h"

namespace lendulet {

void RecordingReader::get_bytes(char* out, size_t count) {
    in_->read(out, static_cast<std::streamsize>(count));
    if (static_cast<size_t>(in_->gcount()) != count) throw Broken{"ends too early"};
    for (size_t i = 0; i < count; ++i) checksum_ = (checksum_ ^ static_cast<unsigned char>(out[i])) * 1099511628211ull;
    offset_ += count;
}

template <class T>
T RecordingReader::get() {
    char bytes[sizeof(T)];
    get_bytes(bytes, sizeof bytes);
    uint64_t bits = 0;
    for (size_t i = 0; i < sizeof(T); ++i) {
        bits |= static_cast<uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
    }
    T value;
    if constexpr (std::is_same_v<T, float>) {
        uint32_t low = static_cast<uint32_t>(bits);
        std::memcpy(&value, &low, sizeof value);
    } else if constexpr (std::is_same_v<T, double>) {
        std::memcpy(&value, &bits, sizeof value);
    } else {
        value = static_cast<T>(bits);
    }
    return value;
}

RecordedPose RecordingReader::get_pose() {
    RecordedPose pose;
    pose.position = {get<float>(), get<float>(), get<float>()};
    float size = 0.0f;
    for (int16_t& part : pose.orientation) {
        part = get<int16_t>();
        size += static_cast<float>(part) * static_cast<float>(part);
    }
    if (!std::isfinite(pose.position.x) || !std::isfinite(pose.position.y) || !std::isfinite(pose.position.z)) {
        throw Broken{"holds a position that is not finite"};
    }
    size = square_root(size) / 32767.0f;
    if (!(size > 0.99f && size < 1.01f)) throw Broken{"holds an orientation that is no rotation"};
    return pose;
}

void RecordingReader::read_header() {
    char magic[8];
    get_bytes(magic, sizeof magic);
    if (std::memcmp(magic, "LENDREC\n", sizeof magic) != 0) throw Broken{"is no recording"};
    version_ = get<uint32_t>();
    if (version_ != 1 && version_ != 2)
        throw Broken{"is a recording of version " + std::to_string(version_) + ", not 1 or 2"};
    uint32_t length = get<uint32_t>();
    if (length > 255) throw Broken{"gives the scene a name of " + std::to_string(length) + " bytes"};
    dt_ = get<double>();
    if (!(dt_ > 0.0 && dt_ <= 1.0)) throw Broken{"gives a step that is not between 0 and 1 s"};
    scene_.resize(length);
    get_bytes(scene_.data(), length);
}

void RecordingReader::read_body() {
    if (bodies_.size() >= max_recorded_bodies) throw Broken{"holds more than 1048576 bodies"};
    uint8_t type = get<uint8_t>(), length = get<uint8_t>();
    if (type > 2) throw Broken{"holds a body of unknown type"};
    Body body{};
    body.type = type == 0 ? BodyType::fixed : type == 1 ? BodyType::kinematic : BodyType::dynamic;
    body.name_begin = static_cast<uint32_t>(names_.size());
    body.name_length = length;
    names_.resize(names_.size() + length);
    get_bytes(names_.data() + body.name_begin, length);
    body.live = true;
    body.pose = get_pose();
    bodies_.push_back(body);
}

// Surfaces and shapes are checked, not kept: they are for viewers.
void RecordingReader::read_surface() {
    const uint32_t vertices = get<uint32_t>(), triangles = get<uint32_t>();
    for (uint64_t i = 0; i < 3 * uint64_t{vertices}; ++i)
        if (!std::isfinite(get<float>())) throw Broken{"holds a vertex that is not finite"};
    for (uint64_t i = 0; i < 3 * uint64_t{triangles}; ++i)
        if (get<uint32_t>() >= vertices) throw Broken{"holds a triangle of a vertex that is not there"};
    ++surfaces_;
}

void RecordingReader::read_shape() {
    const uint32_t body = get<uint32_t>();
    const uint8_t type = get<uint8_t>(), trigger = get<uint8_t>();
    const uint32_t surface = get<uint32_t>();
    constexpr size_t hull = 7, mesh = 9, field = 10;  // among the alternatives of Shape
    static_assert(std::is_same_v<std::variant_alternative_t<hull, Shape>, ConvexHull> &&
                  std::is_same_v<std::variant_alternative_t<mesh, Shape>, TriangleMesh> &&
                  std::is_same_v<std::variant_alternative_t<field, Shape>, HeightField>);
    const bool has_surface = type == hull || type == mesh || type == field;
    if (body >= bodies_.size() || type >= std::variant_size_v<Shape> || trigger > 1 ||
        (has_surface ? surface >= surfaces_ : surface != ~0u))
        throw Broken{"holds a shape that cannot be"};
    for (int i = 0; i < 12; ++i)
        if (!std::isfinite(get<float>())) throw Broken{"holds a shape that is not finite"};
    ++shapes_;
}

void RecordingReader::read_step() {
    uint32_t count = get<uint32_t>();
    if (count > bodies_.size()) throw Broken{"moves more bodies than there are"};
    int64_t last = -1;
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t number = get<uint32_t>();
        if (number >= bodies_.size() || number <= last) throw Broken{"moves a body that is not there or out of order"};
        if (!bodies_[number].live) throw Broken{"moves a body that was removed"};
        bodies_[number].pose = get_pose();
        last = number;
    }
    poses_read_ += count;
    ++steps_;
}

void RecordingReader::read_end() {
    if (get<uint32_t>() != steps_) throw Broken{"ends with another number of steps than it holds"};
    if (get<uint32_t>() != bodies_.size()) throw Broken{"ends with another number of bodies than it holds"};
    hash_ = get<uint64_t>();
    uint64_t expected = checksum_;
    if (get<uint64_t>() != expected) throw Broken{"does not match its checksum"};
    if (in_->peek() != std::ifstream::traits_type::eof()) throw Broken{"goes on after its end"};
    ended_ = true;
}

Error RecordingReader::error(const Broken& broken) const {
    return {ErrorCode::parse, printable(path_) + ": " + broken.what + ", at byte " + std::to_string(offset_)};
}

Result<RecordingReader> RecordingReader::open(const std::string& path) {
    RecordingReader reader;
    reader.path_ = path;
    std::error_code error;
    if (!std::filesystem::exists(path, error) || error) return Error{ErrorCode::io, printable(path) + ": no such file"};
    if (!std::filesystem::is_regular_file(path, error)) {
        return Error{ErrorCode::io, printable(path) + ": not a regular file"};
    }
    reader.in_ = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (!*reader.in_) return Error{ErrorCode::io, printable(path) + ": cannot be opened for reading"};
    try {
        reader.read_header();
    } catch (const Broken& broken) {
        return reader.error(broken);
    }
    return reader;
}

Result<bool> RecordingReader::next_step() {
    try {
        while (!ended_) {
            switch (get<char>()) {
                case 'B':
                    read_body();
                    break;
                case 'M':
                    read_surface();
                    break;
                case 'S':
                    read_shape();
                    break;
                case 'X': {
                    uint32_t number = get<uint32_t>();
                    if (number >= bodies_.size() || !bodies_[number].live)
                        throw Broken{"removes a body that is not there"};
                    bodies_[number].live = false;
                    break;
                }
                case 'F':
                    read_step();
                    return true;
                case 'E':
                    read_end();
                    break;
                default:
                    throw Broken{"holds a chunk of unknown kind"};
            }
        }
    } catch (const Broken& broken) {
        return error(broken);
    }
    return false;
}

std::string_view RecordingReader::name(size_t body) const {
    return std::string_view(names_).substr(bodies_[body].name_begin, bodies_[body].name_length);
}

}  // namespace lendulet
