#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/file.h"
#include "io/recording.h"
#include "scenes/plain_shape.h"

namespace lendulet {

namespace {

constexpr size_t flush_bytes = 1 << 16;
constexpr uint32_t no_surface = ~0u;

uint64_t key_of(BodyId id) { return static_cast<uint64_t>(id.index) << 32 | id.generation; }

uint64_t fnv(uint64_t hash, std::string_view bytes) {
    for (char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    return hash;
}

uint8_t type_number(BodyType type) { return type == BodyType::fixed ? 0 : type == BodyType::kinematic ? 1 : 2; }

}  // namespace

RecordedPose quantised(Position position, Quat orientation) {
    RecordedPose pose;
    pose.position = position;
    float parts[4] = {orientation.x, orientation.y, orientation.z, orientation.w};
    for (int i = 0; i < 4; ++i) {
        pose.orientation[i] = static_cast<int16_t>(std::lround(32767.0f * clamp(parts[i], -1.0f, 1.0f)));
    }
    return pose;
}

Quat RecordedPose::rotation() const {
    Quat q{static_cast<float>(orientation[0]), static_cast<float>(orientation[1]), static_cast<float>(orientation[2]),
           static_cast<float>(orientation[3])};
    return normalize(q);
}

template <class T>
void RecordingWriter::put(T value) {
    using Bits = std::conditional_t<
        sizeof(T) == 8, uint64_t,
        std::conditional_t<sizeof(T) == 4, uint32_t, std::conditional_t<sizeof(T) == 2, uint16_t, uint8_t>>>;
    Bits bits;
    std::memcpy(&bits, &value, sizeof bits);
    for (size_t i = 0; i < sizeof bits; ++i) pending_ += static_cast<char>(bits >> (8 * i) & 0xff);
}

void RecordingWriter::put_pose(const RecordedPose& pose) {
    put(pose.position.x), put(pose.position.y), put(pose.position.z);
    for (int16_t part : pose.orientation) put(part);
}

Result<RecordingWriter> RecordingWriter::create(const std::string& path, std::string_view scene, double dt) {
    RecordingWriter writer;
    writer.path_ = path;
    writer.out_ = std::make_unique<std::ofstream>(path, std::ios::binary | std::ios::trunc);
    writer.pending_ = "LENDREC\n";
    writer.put(uint32_t{2});
    scene = scene.substr(0, 255);
    writer.put(static_cast<uint32_t>(scene.size()));
    writer.put(dt);
    writer.pending_ += scene;
    Status written = writer.flush();
    if (!written.ok()) return written.error();
    return writer;
}

Status RecordingWriter::flush() {
    checksum_ = fnv(checksum_, pending_);
    out_->write(pending_.data(), static_cast<std::streamsize>(pending_.size()));
    pending_.clear();
    out_->flush();
    if (!*out_) return Error{ErrorCode::io, printable(path_) + ": cannot be written"};
    return {};
}

Status RecordingWriter::begin(const World& world) { return sync_bodies(world); }

// Announces bodies that are new and bodies that are gone.
Status RecordingWriter::sync_bodies(const World& world) {
    for (auto it = numbers_.begin(); it != numbers_.end();) {
        BodyId id{static_cast<uint32_t>(it->first >> 32), static_cast<uint32_t>(it->first)};
        if (world.alive(id)) {
            ++it;
            continue;
        }
        pending_ += 'X';
        put(it->second);
        it = numbers_.erase(it);
    }
    if (numbers_.size() == static_cast<size_t>(world.body_count())) return {};
    for (int i = 0; i < world.body_count(); ++i) {
        StaticBodyRef body = world.get_static(world.body(i));
        uint32_t number = static_cast<uint32_t>(poses_.size());
        if (!numbers_.try_emplace(key_of(body.id()), number).second) continue;
        if (number >= max_recorded_bodies) {
            return Error{ErrorCode::bad_config, printable(path_) + ": a recording holds at most 1048576 bodies"};
        }
        std::string_view name = body.name().substr(0, 255);
        pending_ += 'B';
        put(type_number(body.type()));
        put(static_cast<uint8_t>(name.size()));
        pending_ += name;
        poses_.push_back(quantised(body.position(), body.orientation()));
        put_pose(poses_.back());
        put_shapes(body, number);
    }
    return {};
}

uint32_t RecordingWriter::put_surface(const Shape& shape) {
    const void* surface = surface_of(shape);
    if (!surface) return no_surface;
    auto [it, is_new] = surfaces_.try_emplace(surface, static_cast<uint32_t>(surfaces_.size()));
    if (!is_new) return it->second;
    shapes_.push_back(shape);
    auto write = [&](const auto& s) {
        const auto vertices = s.vertices();
        const std::vector<uint32_t> indices = s.triangles();
        pending_ += 'M';
        put(static_cast<uint32_t>(vertices.size())), put(static_cast<uint32_t>(indices.size() / 3));
        for (Vec3 v : vertices) put(v.x), put(v.y), put(v.z);
        for (uint32_t i : indices) put(i);
    };
    if (const auto* hull = std::get_if<ConvexHull>(&shape)) write(*hull);
    else if (const auto* field = std::get_if<HeightField>(&shape)) write(*field);
    else write(std::get<TriangleMesh>(shape));
    return it->second;
}

void RecordingWriter::put_shapes(const StaticBodyRef& body, uint32_t number) {
    for (int i = 0; i < body.collider_count(); ++i) {
        const uint32_t surface = put_surface(body.shape(i));
        const PlainShape shape = plain(body.shape(i));
        const Transform local = body.collider_pose(i);
        pending_ += 'S';
        put(number), put(static_cast<uint8_t>(shape.type)), put(static_cast<uint8_t>(body.is_trigger(i))), put(surface);
        for (float size : shape.size) put(size);
        put(shape.rounding);
        put(local.translation.x), put(local.translation.y), put(local.translation.z);
        put(local.rotation.x), put(local.rotation.y), put(local.rotation.z), put(local.rotation.w);
    }
}

Status RecordingWriter::add_step(const World& world) {
    Status synced = sync_bodies(world);
    if (!synced.ok()) return synced;
    std::vector<uint32_t> moved;
    for (int i = 0; i < world.body_count(); ++i) {
        StaticBodyRef body = world.get_static(world.body(i));
        if (body.type() == BodyType::fixed) continue;
        uint32_t number = numbers_.at(key_of(body.id()));
        RecordedPose pose = quantised(body.position(), body.orientation());
        if (pose == poses_[number]) continue;
        poses_[number] = pose;
        moved.push_back(number);
    }
    // Creation order is the order of numbers, except where a world puts new bodies into the places of removed ones.
    if (!std::is_sorted(moved.begin(), moved.end())) std::sort(moved.begin(), moved.end());
    pending_ += 'F';
    put(static_cast<uint32_t>(moved.size()));
    for (uint32_t number : moved) {
        put(number);
        put_pose(poses_[number]);
    }
    ++steps_;
    return pending_.size() >= flush_bytes ? flush() : Status{};
}

Status RecordingWriter::finish(const World& world) {
    pending_ += 'E';
    put(steps_);
    put(static_cast<uint32_t>(poses_.size()));
    put(world.hash());
    Status written = flush();
    if (!written.ok()) return written;
    put(checksum_);
    written = flush();
    out_->close();
    if (written.ok() && !*out_) return Error{ErrorCode::io, printable(path_) + ": cannot be written"};
    return written;
}

}  // namespace lendulet
