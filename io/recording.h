// Recordings: the poses of all bodies after every step, compact enough to keep and simple enough to read anywhere.
//
// Little endian throughout; f32 and f64 are IEEE 754. A file is a header and a list of chunks:
//   header  8 bytes "LENDREC\n", u32 version = 2 (1: without shapes), u32 length of the scene's name, f64 dt (s), the
//   name (UTF-8) 'B'     a body, numbered from 0 in the order of these chunks: u8 type (0 static, 1 kinematic, 2
//   dynamic),
//           u8 length of the name, the name, then its pose: 3 f32 position (m), 4 i16 orientation (x y z w, in 1/32767)
//   'M'     the surface of a hull or a mesh, numbered from 0: u32 vertices, u32 triangles, 3 f32 a vertex (m), 3 u32 a
//           triangle
//   'S'     a shape of a body, before its first step: u32 body, u8 type (as PlainShape), u8 1 for a trigger, u32
//   surface
//           or 2^32 - 1, 4 f32 size, f32 rounding, 3 f32 position and 4 f32 orientation on the body
//   'X'     u32 number of a body that is removed
//   'F'     a step: u32 count, then for each body whose pose is not that of the step before, in ascending order:
//           u32 number, and its pose as above
//   'E'     the end: u32 steps, u32 bodies, u64 state hash of the world, u64 checksum of all bytes before this field
//           (FNV-1a, 64 bits)
// A body's pose costs 24 bytes in a step in which it moves and nothing in one in which it rests.
#pragma once

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lendulet/world.h"

namespace lendulet {

inline constexpr uint32_t max_recorded_bodies = 1u << 20;

struct RecordedPose {
    Position position;
    int16_t orientation[4] = {0, 0, 0, 32767};
    bool operator==(const RecordedPose&) const = default;
    Quat rotation() const;  // of unit length
};
RecordedPose quantised(Position position, Quat orientation);

// Writes a recording as the world goes on. Errors: io (the file cannot be written), bad_config (too many bodies).
class RecordingWriter {
public:
    static Result<RecordingWriter> create(const std::string& path, std::string_view scene, double dt);
    // Adds the bodies that are there before the first step.
    Status begin(const World& world);
    Status add_step(const World& world);
    Status finish(const World& world);

private:
    RecordingWriter() = default;
    Status sync_bodies(const World& world);
    void put_shapes(const StaticBodyRef& body, uint32_t number);
    uint32_t put_surface(const Shape& shape);
    Status flush();
    template <class T>
    void put(T value);
    void put_pose(const RecordedPose& pose);

    std::unique_ptr<std::ofstream> out_;
    std::string path_, pending_;  // bytes not yet written
    uint64_t checksum_ = 14695981039346656037ull;
    uint32_t steps_ = 0;
    std::map<uint64_t, uint32_t> numbers_;  // of the live bodies, by body id
    std::vector<RecordedPose> poses_;
    std::map<const void*, uint32_t> surfaces_;  // numbers of those written
    std::vector<Shape> shapes_;                 // keeps them alive
};

// Reads a recording step by step. Everything is checked: a file that is truncated, altered or no recording gives an
// Error (io, parse) that names the byte where it went wrong.
class RecordingReader {
public:
    struct Body {
        BodyType type;
        bool live = true;
        RecordedPose pose;
        uint32_t name_begin, name_length;
    };

    static Result<RecordingReader> open(const std::string& path);
    // Advances to the next step; false at the end of the recording.
    Result<bool> next_step();

    const std::string& scene() const { return scene_; }
    double dt() const { return dt_; }
    uint32_t steps() const { return steps_; }    // read so far
    uint32_t shapes() const { return shapes_; }  // read so far
    uint64_t poses_read() const { return poses_read_; }
    uint64_t world_hash() const { return hash_; }  // once next_step() has given false
    uint64_t bytes() const { return offset_; }
    const std::vector<Body>& bodies() const { return bodies_; }  // as of the step last read
    std::string_view name(size_t body) const;

private:
    RecordingReader() = default;
    struct Broken {
        std::string what;
    };
    template <class T>
    T get();
    void get_bytes(char* out, size_t count);
    RecordedPose get_pose();
    void read_header();
    void read_body();
    void read_surface();
    void read_shape();
    void read_step();
    void read_end();
    Error error(const Broken& broken) const;

    std::unique_ptr<std::ifstream> in_;
    std::string path_, scene_, names_;
    double dt_ = 0.0;
    uint32_t steps_ = 0, version_ = 0, shapes_ = 0, surfaces_ = 0;
    uint64_t hash_ = 0, poses_read_ = 0, offset_ = 0, checksum_ = 14695981039346656037ull;
    bool ended_ = false;
    std::vector<Body> bodies_;
};

}  // namespace lendulet
