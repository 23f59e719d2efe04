// `lendulet` over bad input: exit code 2 and one sentence on standard error, also with --quiet.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "program.h"

namespace lendulet::test {
namespace {

std::string file_with(const std::string& name, const std::string& content) {
    std::string path = scratch(name);
    std::ofstream(path, std::ios::binary) << content;
    return path;
}

TEST(BadInput, CommandsAndOptions) {
    expect_refused({}, "a command is required");
    expect_refused({"--quiet"}, "");
    expect_refused({""}, "is no command");
    expect_refused({"jump"}, "jump");
    expect_refused({"run"}, "SCENE");
    expect_refused({"run", "no_such_scene"}, "no_such_scene");
    expect_refused({"run", "no_such_scene", "--quiet"}, "no_such_scene");
    expect_refused({"run", "stack", "--what"}, "--what");
    expect_refused({"run", "stack", "extra"}, "extra");
    expect_refused({"run", "stack", "--seconds"}, "--seconds");
    expect_refused({"run", "stack:0"}, "");
    expect_refused({"run", "stack:-3"}, "");
    expect_refused({"run", "stack:99999999999999999999"}, "");
    for (const char* bad : {"x", "", "1/0", "1/", "/2", "1/2/3", "nan", "inf", "1e999", "0x10", " 1", "1,5"}) {
        expect_refused({"run", "stack", "--dt", bad}, "--dt");
        expect_refused({"run", "stack", "--seconds", bad, "--quiet"}, "--seconds");
    }
    expect_refused({"run", "stack", "--dt", "0"}, "--dt must be more than 0");
    expect_refused({"run", "stack", "--dt=-1/60"}, "--dt must be more than 0");
    expect_refused({"run", "stack", "--dt", "2"}, "at most 1 s");
    expect_refused({"run", "stack", "--seconds=-1"}, "--seconds must not be negative");
    expect_refused({"run", "stack", "--seconds", "1e30"}, "steps");
    expect_refused({"run", "stack", "--threads", "0"}, "--threads");
    expect_refused({"run", "stack", "--threads", "65"}, "--threads");
    expect_refused({"run", "stack", "--threads", "two"}, "--threads");
    expect_refused({"run", "stack", "--solver-steps", "0"}, "--solver-steps");
    expect_refused({"run", "stack", "--solver-steps", "65"}, "--solver-steps");
    expect_refused({"run", "stack", "--width", "3"}, "--width");
    expect_refused({"run", "stack", "--width", "0"}, "--width");
    expect_refused({"run", "stack", "--broad-phase", "magic"}, "magic");
    expect_refused({"run", "stack", "--broad-phase", ""}, "--broad-phase");
    expect_refused({"run", "stack", "--simplex", "magic"}, "magic");
    expect_refused({"run", "stack", "--integrator", "magic"}, "magic");
    expect_refused({"run", "stack", "--json", "/no/such/directory/x"}, "/no/such/directory/x: cannot be written");
    expect_refused({"run", "stack", "--record", "/no/such/directory/x"}, "/no/such/directory/x: cannot be written");
    expect_refused({"run", "stack", "--json", ""}, "--json must not be empty");
    expect_refused({"run", "stack", "--record", ""}, "--record must not be empty");
    expect_refused({"run", "scenes/files/motion.gltf", "--threads", "0"}, "--threads");
    expect_refused({"bench"}, "broad-phase, scenes and collision");
    expect_refused({"bench", "everything"}, "\"everything\" is no benchmark; there are broad-phase");
}

// Each output is a file of its own, and what is refused leaves none.
TEST(BadInput, OutputsOfARun) {
    const std::string out = scratch("refused.out"),
                      scene = file_with("scene.gltf", "{\"asset\": {\"version\": \"2.0\"}}");
    expect_refused({"run", "stack", "--json", out, "--record", "/no/such/directory/x"}, "/no/such/directory/x");
    EXPECT_FALSE(std::filesystem::exists(out));
    expect_refused({"run", "stack", "--json", out, "--record", scratch("./refused.out")}, "name the same file");
    EXPECT_FALSE(std::filesystem::exists(out));
    for (const char* option : {"--json", "--record"})
        expect_refused({"run", scene, option, scene}, "over the scene that is read");
    EXPECT_EQ(content(scene), "{\"asset\": {\"version\": \"2.0\"}}");
}

TEST(BadInput, Verify) {
    expect_refused({"verify", "extra"}, "extra");
    expect_refused({"verify", "--cases"}, "--cases");
    expect_refused({"verify", "--cases", ""}, "--cases must not be empty");
    expect_refused({"verify", "--cases", "A01,B99"}, "there is no case \"B99\"; there are A01, ");
    expect_refused({"verify", "--cases", "A01,"}, "there is no case \"\"");
    expect_refused({"verify", "--quality", "best"}, "there is no quality \"best\"; there are d60 and hq");
    expect_refused({"verify", "--threads", "0"}, "--threads");
    for (const char* option : {"--json", "--html", "--svg"})
        expect_refused({"verify", "--cases", "A12", option, "/no/such/directory/x"},
                       "/no/such/directory/x: cannot be written");
}

TEST(BadInput, View) {
    const std::string page = scratch("page");
    std::filesystem::create_directories(page);
    std::ofstream(page + "/index.html") << "<head></head>";
    expect_refused({"view"}, "SCENE");
    expect_refused({"view", "stack", "--page", "/nowhere"}, "/nowhere: the page is not there");
    expect_refused({"view", "no_such_scene", "--page", page}, "no_such_scene");
    expect_refused({"view", page + "/index.html", "--page", page}, "neither a glTF file nor a recording");
    expect_refused({"view", "stack", "--port", "99999"}, "--port");
    expect_refused({"view", "stack", "--threads", "0"}, "--threads");
    for (const char* bad : {"x", "-1", "1e9"})
        expect_refused({"view", "stack", std::string("--give-up=") + bad}, "--give-up");
}

TEST(BadInput, SceneFiles) {
    expect_refused({"run", "missing.gltf"}, "missing.gltf: no such file");
    expect_refused({"run", "missing.glb", "--quiet"}, "missing.glb: no such file");
    std::filesystem::create_directories(scratch("folder.gltf"));
    expect_refused({"run", scratch("folder.gltf")}, "not a regular file");
    expect_refused({"run", file_with("model.obj", "v 0 0 0")}, "model.obj: is neither a .gltf, .glb or .json file nor");
    expect_refused({"run", file_with("empty.gltf", "")}, "empty.gltf: is not valid JSON");
    expect_refused({"run", file_with("empty.glb", "")}, "empty.glb: ");
    expect_refused({"run", file_with("short.glb", "glTF\2\0\0\0"), "--json", "-"}, "short.glb: ");
    expect_refused({"run", file_with("noise.glb", std::string(5000, '\xa7'))}, "noise.glb: ");
    expect_refused({"run", file_with("deep.gltf", std::string(1000000, '['))}, "nested deeper");
    expect_refused({"run", file_with("outside.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1,)"
                                                     R"("uri":"../stdout"}]})")},
                   "leaves the scene's directory");
}

TEST(BadInput, Recordings) {
    expect_refused({"info"}, "FILE");
    expect_refused({"info", "missing"}, "missing: no such file");
    expect_refused({"info", "CMakeLists.txt"}, "CMakeLists.txt: is no recording");
    expect_refused({"info", "scenes"}, "not a regular file");
    std::string whole = scratch("whole");
    ASSERT_EQ(lendulet({"run", "stack:2", "--seconds", "0.1", "--record", whole, "--quiet"}).exit_code, 0);
    std::ifstream in(whole, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    expect_refused({"info", file_with("half", bytes.substr(0, bytes.size() / 2))}, "half: ends too early, at byte");
}

// A file that is refused may cost four times its size and 64 MB.
TEST(BadInput, HostileFilesStaySmallInMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers take memory of their own";
#endif
    auto peak = [](const std::string& name, const std::string& content) {
        Outcome outcome = lendulet({"run", file_with(name, content), "--seconds", "0", "--quiet"});
        EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 2) << name << outcome.err;
        return outcome.peak_kilobytes - static_cast<long>(4 * content.size() / 1024);
    };
    const std::string head = "{\"asset\":{\"version\":\"2.0\"},";
    auto repeated = [&](const std::string& member, const std::string& item, int count) {
        std::string text = head + "\"" + member + "\":[";
        for (int i = 0; i < count; ++i) text += item + ',';
        return text + item + "]}";
    };
    constexpr long limit = 80 * 1024;  // the program itself takes 11 of them
    EXPECT_LT(peak("nodes.gltf", repeated("nodes", "{}", 2000000)), limit);
    EXPECT_LT(peak("numbers.gltf", repeated("nodes", "0", 4000000)), limit);
    EXPECT_LT(
        peak("accessors.gltf", repeated("accessors", R"({"count":1,"type":"VEC3","componentType":5126})", 100000)),
        limit);
    EXPECT_LT(peak("textures.gltf", repeated("textures", "{}", 2000000)), limit);
    EXPECT_LT(peak("string.gltf", head + "\"extras\":\"" + std::string(30000000, 'x') + "\"}"), limit);
    EXPECT_LT(peak("buffer.gltf", head + "\"buffers\":[{\"byteLength\":22500000,\"uri\":\"data:a/b;base64," +
                                      std::string(30000000, 'A') + "\"}]}"),
              limit);
}

}  // namespace
}  // namespace lendulet::test
