// Recordings: what is written is read again, and nothing else is.
#include "io/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "io/file.h"
#include "scenes/scene.h"

namespace lendulet {
namespace {

// A file that goes when the test does.
class Scratch {
public:
    explicit Scratch(const std::string& name)
        : path_((std::filesystem::temp_directory_path() /
                 (name + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
                  std::to_string(reinterpret_cast<uintptr_t>(this))))
                    .string()) {}
    ~Scratch() { std::filesystem::remove(path_); }
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

World small_world() {
    World world = WorldBuilder{}.build().value();
    StaticBodyDef floor{};
    floor.shape = Box{{10.0f, 0.5f, 10.0f}, 0.0f};
    floor.position = {0.0f, -0.5f, 0.0f};
    floor.name = "floor";
    world.add_static_body(floor).value();
    for (int i = 0; i < 3; ++i) {
        RigidBodyDef ball{};
        ball.shape = Sphere{0.5f};
        ball.position = {2.0f * static_cast<float>(i), 2.0f + static_cast<float>(i), 0.0f};
        ball.angular_velocity = {1.0f, 2.0f, 3.0f};
        std::string name = "ball_" + std::to_string(i);
        ball.name = name;
        world.add_rigid_body(ball).value();
    }
    return world;
}

struct Frame {
    std::vector<Position> positions;
    std::vector<Quat> orientations;
};

// Records `steps` steps, in which a body comes and another goes, and returns what the world showed after each.
std::vector<Frame> record(const std::string& path, int steps) {
    World world = small_world();
    RecordingWriter writer = RecordingWriter::create(path, "test scene", 1.0 / 60.0).value();
    writer.begin(world).value();
    std::vector<Frame> frames;
    for (int i = 0; i < steps; ++i) {
        if (i == 10) {
            RigidBodyDef late{};
            late.position = {0.0f, 8.0f, 3.0f};
            late.name = "late";
            world.add_rigid_body(late).value();
        }
        if (i == 20) world.remove_body(world.body(1)).value();
        world.update(1.0f / 60.0f).value();
        writer.add_step(world).value();
        Frame frame;
        for (int k = 0; k < world.body_count(); ++k) {
            frame.positions.push_back(world.get_static(world.body(k)).position());
            frame.orientations.push_back(world.get_static(world.body(k)).orientation());
        }
        frames.push_back(frame);
    }
    writer.finish(world).value();
    return frames;
}

TEST(Recording, RoundTrip) {
    Scratch file("lendulet_round_trip");
    std::vector<Frame> frames = record(file.path(), 40);
    RecordingReader reader = RecordingReader::open(file.path()).value();
    EXPECT_EQ(reader.scene(), "test scene");
    EXPECT_EQ(reader.dt(), 1.0 / 60.0);
    for (const Frame& frame : frames) {
        ASSERT_TRUE(reader.next_step().value());
        size_t live = 0;
        for (size_t i = 0; i < reader.bodies().size(); ++i) {
            const RecordingReader::Body& body = reader.bodies()[i];
            if (!body.live) continue;
            ASSERT_LT(live, frame.positions.size());
            EXPECT_EQ(body.pose.position, frame.positions[live]);
            EXPECT_GT(std::abs(dot(body.pose.rotation(), frame.orientations[live])), 1.0f - 1e-7f);
            ++live;
        }
        EXPECT_EQ(live, frame.positions.size());
    }
    EXPECT_FALSE(reader.next_step().value());
    EXPECT_FALSE(reader.next_step().value());  // and stays at the end
    EXPECT_EQ(reader.steps(), 40u);
    EXPECT_EQ(reader.name(0), "floor");
    EXPECT_EQ(reader.name(4), "late");
    EXPECT_EQ(reader.bodies()[0].type, BodyType::fixed);
    EXPECT_FALSE(reader.bodies()[1].live);
    EXPECT_EQ(reader.bytes(), std::filesystem::file_size(file.path()));
}

TEST(Recording, RestCostsNothing) {
    Scratch file("lendulet_rest");
    World world = WorldBuilder{}.no_gravity().build().value();
    for (int i = 0; i < 50; ++i) {
        RigidBodyDef ball{};
        ball.position = {3.0f * static_cast<float>(i), 0.0f, 0.0f};
        world.add_rigid_body(ball).value();
    }
    RecordingWriter writer = RecordingWriter::create(file.path(), "rest", 1.0 / 60.0).value();
    writer.begin(world).value();
    for (int i = 0; i < 100; ++i) {
        world.update(1.0f / 60.0f).value();
        writer.add_step(world).value();
    }
    writer.finish(world).value();
    EXPECT_LT(std::filesystem::file_size(file.path()), 50u * (23 + 59) + 100u * 5 + 100u);
}

// Reads to the end; the error's sentence, or empty.
std::string problem(const std::string& path) {
    Result<RecordingReader> reader = RecordingReader::open(path);
    if (!reader.ok()) return reader.error().message;
    while (true) {
        Result<bool> more = reader.value().next_step();
        if (!more.ok()) return more.error().message;
        if (!more.value()) return "";
    }
}

TEST(Recording, EveryTruncationAndEveryChangedByteIsFound) {
    Scratch file("lendulet_whole"), other("lendulet_changed");
    record(file.path(), 25);
    std::string bytes = read_file(file.path()).value();
    ASSERT_EQ(problem(file.path()), "");
    for (size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 150) {
        write_file(other.path(), bytes.substr(0, length)).value();
        EXPECT_NE(problem(other.path()), "") << length;
    }
    for (size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 300) {
        std::string changed = bytes;
        changed[at] = static_cast<char>(changed[at] ^ (1 << (at % 8)));
        write_file(other.path(), changed).value();
        EXPECT_NE(problem(other.path()), "") << at;
    }
    write_file(other.path(), bytes + "x").value();
    EXPECT_NE(problem(other.path()).find("goes on after its end"), std::string::npos);
}

TEST(Recording, HugeCountsDoNotCostMemory) {
    Scratch file("lendulet_huge");
    std::string header = "LENDREC\n" + std::string("\x01\0\0\0\xff\xff\xff\xff", 8) + std::string(8, '\0');
    write_file(file.path(), header).value();
    EXPECT_NE(problem(file.path()).find("a name of 4294967295 bytes"), std::string::npos);
    header = "LENDREC\n" + std::string("\x01\0\0\0\0\0\0\0", 8) + std::string("\0\0\0\0\0\0\xe0\x3f", 8);
    write_file(file.path(), header + "F\xff\xff\xff\xff").value();
    EXPECT_NE(problem(file.path()).find("moves more bodies than there are, at byte 29"), std::string::npos);
    write_file(file.path(), header + "?").value();
    EXPECT_NE(problem(file.path()).find("unknown kind"), std::string::npos);
    write_file(file.path(), "glTF and so on").value();
    EXPECT_NE(problem(file.path()).find("is no recording"), std::string::npos);
}

TEST(Recording, UnwritablePathIsRefused) {
    EXPECT_EQ(RecordingWriter::create("/no/such/directory/file", "s", 0.1).error().code, ErrorCode::io);
}

}  // namespace
}  // namespace lendulet
