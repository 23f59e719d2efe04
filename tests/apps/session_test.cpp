// What the viewer's page asks of the native engine: answers, refusals, and what nobody should send.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/lendulet/view/session.h"
#include "io/gltf.h"

namespace lendulet::cli {
namespace {

using Json = nlohmann::json;

struct Answer {
    uint32_t id = 0;
    std::map<Section, std::string> sections;

    bool has(Section kind) const { return sections.count(kind) > 0; }
    std::string error() const { return has(Section::error) ? sections.at(Section::error) : ""; }
    template <class T>
    T read(Section kind) const {
        T out{};
        const std::string& bytes = sections.at(kind);
        EXPECT_EQ(bytes.size(), sizeof out);
        std::memcpy(&out, bytes.data(), std::min(bytes.size(), sizeof out));
        return out;
    }
    SessionState state() const { return read<SessionState>(Section::state); }
};

Answer parse(const std::string& bytes) {
    auto word = [&](size_t at) {
        uint32_t value = 0;
        EXPECT_LE(at + 4, bytes.size());
        std::memcpy(&value, bytes.data() + at, 4);
        return value;
    };
    Answer answer;
    EXPECT_EQ(word(0), reply_magic);
    answer.id = word(4);
    for (size_t at = 8; at < bytes.size();) {
        uint32_t size = word(at + 4);
        answer.sections[static_cast<Section>(word(at))] = bytes.substr(at + 8, size);
        at += 8 + (size + 7) / 8 * 8;
    }
    return answer;
}

Result<Scene> by_name(const std::string& name) { return build_scene(name.empty() ? "stack:3" : name); }

struct Client {
    Session session{by_name};
    Answer ask(const Json& request) { return parse(session.answer(request.dump())); }
};

TEST(Session, ComputesTheBitsOfTheScene) {
    Client client;
    Answer first = client.ask({{"id", 7}, {"open", "wall_ball:3"}, {"want", {"shapes", "poses", "hash"}}});
    EXPECT_EQ(first.id, 7u);
    EXPECT_EQ(first.error(), "");
    Scene scene = build_scene("wall_ball:3").value();
    EXPECT_EQ(first.state().hash, scene.world.hash());
    const size_t bodies = static_cast<size_t>(scene.world.body_count());
    EXPECT_EQ(first.sections[Section::poses].size(), bodies * sizeof(lendulet_pose));
    EXPECT_EQ(first.sections[Section::bodies].size(), bodies * sizeof(lendulet_body));
    EXPECT_EQ(first.sections[Section::colliders].size(), bodies * sizeof(lendulet_collider));
    for (int i = 0; i < 40; ++i) scene.world.update(scene.dt).value();
    Answer later = client.ask({{"steps", 40}, {"want", {"hash", "statistics"}}});
    EXPECT_EQ(later.state().hash, scene.world.hash());
    EXPECT_EQ(later.state().steps, 40u);
    EXPECT_EQ(later.read<lendulet_statistics>(Section::statistics).bodies, scene.world.body_count());
}

TEST(Session, GoesBackForksAndTunes) {
    Client client;
    client.ask({{"open", ""}, {"steps", 10}, {"keep", 1}});
    const uint64_t later = client.ask({{"steps", 20}, {"want", {"hash"}}}).state().hash;
    EXPECT_EQ(client.ask({{"go", 1}, {"steps", 20}, {"want", {"hash"}}}).state().hash, later);
    // The fork goes on alone; what is thrown into the world does not touch it.
    EXPECT_EQ(client.ask({{"do", {{{"do", "fork"}}}}}).state().forked, 1u);
    Json ball{{"do", "sphere"}, {"radius", 0.3}, {"at", {0, 6, 0}}, {"velocity", {0, -9, 0}}, {"density", 500}};
    const uint64_t struck = client.ask({{"do", {ball}}, {"steps", 30}, {"want", {"hash"}}}).state().hash;
    const uint64_t alone = client.ask({{"world", 1}, {"steps", 30}, {"want", {"hash"}}}).state().hash;
    EXPECT_NE(struck, alone);
    EXPECT_EQ(client.ask({{"go", 1}, {"steps", 50}, {"want", {"hash"}}}).state().hash, alone);
    Answer tuned = client.ask({{"do", {{{"do", "set"}, {"solverSteps", 3}, {"gravity", {0, 1, 0}}, {"broadPhase", 2}}}},
                               {"want", {"settings"}}});
    EXPECT_EQ(tuned.error(), "");
    EXPECT_EQ(tuned.read<lendulet_settings>(Section::settings).solver_steps, 3);
    EXPECT_EQ(tuned.read<lendulet_settings>(Section::settings).gravity[1], 1.0f);
    EXPECT_NE(client.ask({{"forget", {1}}, {"go", 1}}).error(), "") << "forgotten after it, but not going back twice";
}

// One fork for each broad phase: they keep the bits of the world, with a capsule that falls into all of them.
TEST(Session, ForksForEachBroadPhase) {
    Client client;
    client.ask({{"open", "box_pile:40"}, {"steps", 20}});
    const Json capsule{{"do", "shape"},   {"type", LENDULET_CAPSULE}, {"size", {0.3, 0.2}}, {"rounding", 0},
                       {"at", {0, 8, 0}}, {"velocity", {0, -5, 0}},   {"density", 400}};
    int forks = 0;
    for (; lendulet_choice_name(LENDULET_BROAD_PHASES, forks); ++forks) {
        const int number = forks + 1;
        ASSERT_LE(number, most_forks);
        EXPECT_EQ(client.ask({{"do", {{{"do", "fork"}, {"to", number}}}}}).error(), "");
        const Json set{{"do", "set"}, {"broadPhase", forks}};
        EXPECT_EQ(client.ask({{"world", number}, {"do", {set, capsule}}, {"steps", 60}}).error(), "");
    }
    EXPECT_EQ(forks, 8);
    Answer own = client.ask({{"do", {capsule}}, {"steps", 60}, {"want", {"hash", "poses"}}});
    EXPECT_EQ(own.error(), "");
    EXPECT_EQ(own.sections[Section::poses].size(), 46 * sizeof(lendulet_pose));
    for (int i = 1; i <= forks; ++i)
        EXPECT_EQ(client.ask({{"world", i}, {"want", {"hash"}}}).state().hash, own.state().hash) << i;
    client.ask({{"do", {{{"do", "join"}, {"to", 3}}}}});
    EXPECT_NE(client.ask({{"world", 3}, {"steps", 1}}).error(), "");
}

TEST(Session, RefusesWithASentence) {
    Client client;
    EXPECT_NE(client.ask({{"steps", 1}}).error().find("open a scene"), std::string::npos);
    EXPECT_NE(client.ask({{"open", "no_such_scene"}}).error().find("no_such_scene"), std::string::npos);
    client.ask({{"open", ""}});
    const Json wrong[] = {{{"steps", 65}},
                          {{"steps", -1}},
                          {{"steps", 1.5}},
                          {{"steps", "many"}},
                          {{"go", 99}},
                          {{"world", 2}, {"steps", 1}},
                          {{"world", 10}},
                          {{"do", {{{"do", "fork"}, {"to", 0}}}}},
                          {{"do", {{{"do", "shape"}, {"type", 7}, {"size", {1}}, {"rounding", 0}}}}},
                          {{"do", {{{"do", "shape"}, {"type", 1}, {"size", {1, 1, 1, 1, 1}}, {"rounding", 0}}}}},
                          {{"world", 1}, {"steps", 1}},
                          {{"do", "sphere"}},
                          {{"do", {1}}},
                          {{"do", {{{"do", "explode"}}}}},
                          {{"do", {{{"do", "sphere"}, {"at", {0, 0}}}}}},
                          {{"do", {{{"do", "set"}, {"solverSteps", 0}}}}},
                          {{"do", {{{"do", "set"}, {"broadPhase", 99}}}}},
                          {{"do", {{{"do", "grab"}, {"body", 99}, {"point", {0, 0, 0}}}}}},
                          {{"explain", "gjk"}},
                          {{"explain", {{"what", "gjk"}, {"simplex", "half-space"}, {"a", "box:1,1,1"}}}},
                          {{"explain", {{"what", "gjk"}, {"simplex", "fast"}, {"a", "box:1,1,1"}, {"b", "sphere:1"}}}},
                          {{"want", 3}},
                          {{"want", {"body"}}, {"body", "first"}}};
    for (const Json& request : wrong) EXPECT_NE(client.ask(request).error(), "") << request;
    Answer still = client.ask({{"want", {"poses", "nothing", 7}}});
    EXPECT_EQ(still.error(), "");
    EXPECT_EQ(still.state().steps, 0u);
}

// Counts and places within the block are those of its head, also without a world.
TEST(Session, ExplainsTwoShapes) {
    Client client;
    Answer answer = client.ask(
        {{"explain",
          {{"what", "distance"}, {"simplex", "barycentric"}, {"a", "hull:20,0.6"}, {"b", "cone:0.5,0.4@0.3,0.4,0"}}}});
    EXPECT_EQ(answer.error(), "");
    ASSERT_TRUE(answer.has(Section::explain));
    const std::string& bytes = answer.sections.at(Section::explain);
    std::vector<uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), 4 * words.size());
    ASSERT_GT(words.size(), 6u);
    const uint32_t solids = words[0], steps = words[1], marks = words[2], points = words[3], indices = words[4];
    EXPECT_EQ(solids, 3u);
    EXPECT_GT(steps, 3u);
    ASSERT_EQ(bytes.size(), 4 * (6 + 5 * solids + 6 * steps + 10 * marks + 3 * points + indices) + words[5]);
    uint32_t next = 0;
    for (uint32_t s = 0; s < steps; ++s) {
        const uint32_t* step = &words[6 + 5 * solids + 6 * s];
        EXPECT_EQ(step[4], next);
        next += step[5];
        EXPECT_LE(step[2] + step[3], words[5]);
    }
    EXPECT_EQ(next, marks);
    EXPECT_NE(bytes.find("polytope 1"), std::string::npos);
}

TEST(Session, NamesTheBodiesOfNodes) {
    Session session([](const std::string&) { return load_gltf("scenes/files/meshes.gltf"); });
    Answer answer = parse(session.answer(R"({"open": "", "want": ["nodes"]})"));
    EXPECT_EQ(answer.error(), "");
    std::vector<int32_t> pairs(answer.sections.at(Section::nodes).size() / 4);
    std::memcpy(pairs.data(), answer.sections.at(Section::nodes).data(), 4 * pairs.size());
    EXPECT_EQ(pairs, (std::vector<int32_t>{4, 0, 5, 1, 6, 2, 7, 3, 8, 4, 10, 5}));
}

TEST(Session, SurvivesWhatIsNoRequest) {
    Client client;
    std::string deep(30000, '[');
    for (const std::string& text : {std::string(), std::string("[]"), std::string("{"), std::string("\xff\xfe\x00", 3),
                                    std::string("{\"id\": 1e400}"), std::string("null"), deep}) {
        Answer answer = parse(client.session.answer(text));
        EXPECT_NE(answer.error(), "") << text.substr(0, 20);
    }
    EXPECT_EQ(client.ask({{"open", ""}, {"steps", 1}}).state().steps, 1u);
}

}  // namespace
}  // namespace lendulet::cli
