// What a viewer's page may ask of the native engine: one session is one connection with a world of its own.
//
// A request is JSON text, an object; everything in it may be missing:
//   id      number that the answer carries
//   open    name of a built-in scene; "" is the scene or file that the program was started with
//   go      key of a snapshot to go back to
//   do      list of changes, objects with a member "do": see change.h, and Session::change() for forks
//   steps   how many steps to do, at most 64
//   keep    key under which to keep a snapshot; forget: list of keys
//   body    index of the body that is looked into
//   world   1 to 9: all of this is for the fork of that number, 0: for the world itself
//   explain {what, simplex, a, b}: what the collision algorithms do with two shapes, as `lendulet explain` takes them
//   want    list of what the answer is to hold, by the names in session.cpp
// The answer is binary, little endian: u32 magic, u32 id, then sections, each u32 kind, u32 bytes, and the structures
// of lendulet_c.h as they are in memory, padded to eight bytes. What is refused is in a section of its own, as a
// sentence.
//
// A page asks again when it has the answer: whoever is slow waits for nobody but himself, and nothing piles up.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bindings/c/handle.h"

namespace lendulet::cli {

struct Asked;

inline constexpr size_t max_request_bytes = 64 * 1024;
inline constexpr int max_steps_per_request = 64;
inline constexpr int most_forks = 9;                             // one to compare with by eye, one for each broad phase
inline constexpr size_t max_snapshot_bytes = size_t{768} << 20;  // of one session
inline constexpr uint32_t reply_magic = 0x56444e4c;              // "LNDV"

enum class Section : uint32_t {
    error = 1,  // text
    state,      // SessionState
    poses,
    bodies,
    colliders,
    mesh,  // u32 number, vertices, triangles, 0; then the two lists
    contacts,
    statistics,
    body,
    grab,  // 3 floats; empty where nothing is held
    joints,
    boxes,
    groups,
    motions,
    settings,
    names,    // of bodies that have one: u32 index, u32 bytes, the name, padded to four bytes
    lists,    // JSON: scenes, stages, choices
    explain,  // see explain/flat.h
    nodes     // pairs of i32: the node of the glTF file, its body
};

struct SessionState {
    double time;
    uint64_t steps, hash;  // hash: 0 where it was not wanted
    float step_size;
    uint32_t forked;          // 1: there is the fork of number 1
    uint64_t snapshot_bytes;  // kept
};

// The scene of a name; "" is that of the command line.
using OpenScene = std::function<Result<Scene>(const std::string& name)>;

class Session {
public:
    explicit Session(OpenScene open) : open_(std::move(open)) {}
    // Never throws; what is wrong with a request is said in the answer.
    std::string answer(std::string_view request);

private:
    void perform(const Asked& request);
    void open(const std::string& name);
    void change(const Asked& command);
    void keep(uint32_t key);
    void go(uint32_t key);
    lendulet_world* world();

    OpenScene open_;
    std::unique_ptr<lendulet_world> worlds_[1 + most_forks];  // the world, and its forks
    size_t chosen_ = 0;
    std::map<uint32_t, std::vector<uint8_t>> kept_;
    size_t kept_bytes_ = 0;
};

}  // namespace lendulet::cli
