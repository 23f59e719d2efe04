// Files that are malformed, truncated or hostile: each is refused with one sentence, or loads; none crashes.
#include <filesystem>
#include <fstream>

#include "io/file.h"
#include "io/gltf_buffers.h"
#include "io/gltf_fixture.h"
#include "tests/scale.h"

namespace lendulet::test {
namespace {

std::string quoted(std::string text) {
    for (char& c : text) c = c == '\'' ? '"' : c;
    return text;
}

// The sentence with which `text` is refused; empty where it loads.
std::string refusal(const std::string& text) {
    Result<Scene> loaded = load_gltf_bytes(text, "/nowhere", "test.gltf");
    if (loaded.ok()) return "";
    const std::string& sentence = loaded.error().message;
    EXPECT_EQ(sentence.rfind("test.gltf: ", 0), 0u) << sentence;
    EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    EXPECT_LT(sentence.size(), 500u);
    return sentence.substr(std::min<size_t>(sentence.size(), 11));
}

void expect_refused(const std::string& text, const std::string& part) {
    std::string sentence = refusal(quoted(text));
    EXPECT_NE(sentence.find(part), std::string::npos) << "wanted: " << part << "\ngot: " << sentence;
}

std::string body(const std::string& physics, const std::string& rest = "") {
    return "{'extensions':{'KHR_physics_rigid_bodies':" + physics + "}" + rest + "}";
}
void expect_node_refused(const std::string& nodes, const std::string& part, const std::string& shapes = "",
                         const std::string& physics = "") {
    expect_refused(gltf_text(nodes, shapes, physics), part);
}
std::string one_shape(const std::string& motion = "") {
    return body("{" + motion + "'collider':{'geometry':{'shape':0}}}");
}

TEST(GltfMalformed, NotGltf) {
    expect_refused("", "is not valid JSON");
    expect_refused("{'asset':", "is not valid JSON at line 1");
    expect_refused("{\n'asset': {'version':'2.0'},\n oops}", "at line 3, column");
    expect_refused("[1,2]", "is not a JSON object");
    expect_refused("{}", "asset.version: is missing");
    expect_refused("{'asset':{'version':'1.0'}}", "asset.version: is \"1.0\", not 2.x");
    expect_refused("{'asset':{'version':2}}", "asset.version: must be a string");
    expect_refused("{'asset':{'version':'2.0'},'nodes':{}}", "nodes: must be an array");
    expect_refused("{'asset':{'version':'2.0'},'nodes':[3]}", "nodes[0]: must be an object");
    expect_refused("{'asset':{'version':'2.0'},'nodes':[{'name':'\xff\xfe'}]}", "is not valid JSON");
    expect_refused("{'asset':{'version':'2.0'},'nodes':[{'translation':[1e999,0,0]}]}", "is not valid JSON");
}

TEST(GltfMalformed, NodeTrees) {
    expect_node_refused("{'children':[0]}", "its own child");
    expect_node_refused("{'children':[1]},{'children':[2]},{'children':[1]}", "a second parent");
    expect_node_refused("{'children':[1]},{'children':[0]}", "is its own ancestor");
    expect_node_refused("{'children':[7]}", "nodes[0].children[0]: names element 7 of nodes, which has 1");
    expect_node_refused("{'children':[-1]}", "whole number");
    expect_node_refused("{'children':[0.5]}", "whole number");
    expect_node_refused("{'translation':[1,2]}", "must have 3 numbers");
    expect_node_refused("{'translation':[1,2,'x']}", "must be a number");
    expect_node_refused("{'rotation':[0,0,0,0]}", "no unit quaternion");
    expect_node_refused("{'scale':[1e300,1,1]}", "out of range");
    expect_node_refused("{'scale':[1e38,1,1],'children':[1]},{'scale':[1e38,1,1]}", "stands at no finite place");
    expect_node_refused("{'matrix':[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}", "no affine transform");
    expect_node_refused("{'mesh':0}", "names element 0 of meshes");
    expect_refused("{'asset':{'version':'2.0'},'scene':1,'scenes':[{'nodes':[]}]}", "names element 1 of scenes");
    expect_refused("{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,0]}],'nodes':[{}]}", "is listed twice");
    expect_refused("{'asset':{'version':'2.0'},'scenes':[{'nodes':[1]}],'nodes':[{'children':[1]},{}]}",
                   "no root node");
}

TEST(GltfMalformed, Physics) {
    const std::string box = "{'type':'box'}";
    expect_node_refused(body("3"), "nodes[0].extensions.KHR_physics_rigid_bodies: must be an object");
    expect_node_refused(body("{'collider':{}}"), "collider.geometry: is missing");
    expect_node_refused(body("{'collider':{'geometry':{}}}"), "either a shape or a node");
    expect_node_refused(body("{'collider':{'geometry':{'shape':0,'node':0}}}"), "either a shape or a node", box);
    expect_node_refused(one_shape(), "names element 0 of shapes, which has 0");
    expect_node_refused(body("{'collider':{'geometry':{'node':4}}}"), "names element 4 of nodes");
    expect_node_refused(body("{'collider':{'geometry':{'shape':0},'physicsMaterial':0}}"), "physicsMaterials", box);
    expect_node_refused(body("{'collider':{'geometry':{'shape':0},'collisionFilter':2}}"), "collisionFilters", box);
    expect_node_refused(one_shape("'motion':{'mass':-1},"), "motion.mass: must not be negative", box);
    expect_node_refused(one_shape("'motion':{'mass':'x'},"), "motion.mass: must be a number", box);
    expect_node_refused(one_shape("'motion':{'mass':1e30},"), "nodes[0]", box);
    expect_node_refused(one_shape("'motion':{'inertiaDiagonal':[1,1]},"), "must have 3 numbers", box);
    expect_node_refused(one_shape("'motion':{'inertiaDiagonal':[1,-1,1]},"), "must not be negative", box);
    expect_node_refused(one_shape("'motion':{'linearVelocity':[1e39,0,0]},"), "out of range", box);
    expect_node_refused(one_shape("'motion':{'isKinematic':1},"), "must be true or false", box);
    expect_node_refused(one_shape("'motion':7,"), "motion: must be an object", box);
    expect_node_refused(
        "{'translation':[1e20,0,0],'extensions':{'KHR_physics_rigid_bodies':{'collider':{'geometry':"
        "{'shape':0}}}}}",
        "nodes[0]", box);
    for (const char* shape : {"{'type':'box','box':{'size':[1,0,1]}}", "{'type':'sphere','sphere':{'radius':-1}}",
                              "{'type':'capsule','capsule':{'height':0}}", "{'type':'plane','plane':{'sizeX':0}}",
                              "{'type':'cylinder','cylinder':{'radiusTop':0,'radiusBottom':0}}", "{'type':5}", "{}",
                              "{'type':'sphere','sphere':{'radius':1e9}}", "{'type':'sphere','sphere':[]}"}) {
        EXPECT_NE(refusal(gltf_text(quoted(one_shape()), quoted(shape))), "") << shape;
    }
    expect_node_refused(one_shape(), "staticFriction: must not be negative", box,
                        "'physicsMaterials':[{'staticFriction':-0.1}]");
    expect_node_refused(one_shape(), "frictionCombine: is \"best\"", box,
                        "'physicsMaterials':[{'frictionCombine':'best'}]");
    expect_node_refused(body("{'joint':{'connectedNode':0,'joint':0}}"), "names element 0 of physicsJoints");
    expect_node_refused(body("{'joint':{'joint':0}}"), "connectedNode: is missing", "", "'physicsJoints':[{}]");
    expect_node_refused(body("{'trigger':{'nodes':[9]}}"), "names element 9 of nodes");
}

// A mesh of one triangle with the given accessors, views and buffers.
std::string mesh_text(const std::string& accessors, const std::string& views, const std::string& buffers,
                      const std::string& primitive = "{'attributes':{'POSITION':0}}") {
    return quoted(
        "{'asset':{'version':'2.0'},'nodes':[{'mesh':0,'extensions':{'KHR_physics_rigid_bodies':{'collider':"
        "{'geometry':{'node':0}}}}}],'meshes':[{'primitives':[" +
        primitive + "]}],'accessors':[" + accessors + "],'bufferViews':[" + views + "],'buffers':[" + buffers + "]}");
}
const std::string vec3 = "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}";
const std::string view36 = "{'buffer':0,'byteLength':36}";
// (0, 0, 0), (1, 0, 0), (0, 0, 1)
const std::string triangle =
    "{'byteLength':36,'uri':'data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/'}";

TEST(GltfMalformed, TheTriangleOfTheseTestsLoads) {
    Result<Scene> scene = load_gltf_bytes(mesh_text(vec3, view36, triangle), "", "test.gltf");
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    ASSERT_EQ(scene.value().world.body_count(), 1);
    auto& shape = scene.value().world.get_static(scene.value().world.body(0)).shape();
    EXPECT_EQ(std::get<TriangleMesh>(shape).triangle_count(), 1);
}

TEST(GltfMalformed, AccessorsAndBuffers) {
    auto accessor = [](const std::string& count, const std::string& more = "") {
        return "{'bufferView':0,'componentType':5126,'type':'VEC3','count':" + count + more + "}";
    };
    auto refused = [](const std::string& text, const std::string& part) {
        std::string sentence = refusal(text);
        EXPECT_NE(sentence.find(part), std::string::npos) << "wanted: " << part << "\ngot: " << sentence;
    };
    refused(mesh_text(accessor("4"), view36, triangle), "accessors[0]: reaches past the end of bufferViews[0]");
    refused(mesh_text(accessor("4000000000"), view36, triangle), "reaches past the end");
    refused(mesh_text(accessor("0"), view36, triangle), "count of 0");
    refused(mesh_text(accessor("1e30"), view36, triangle), "accessors[0].count: must be a whole number");
    refused(mesh_text(accessor("3", ",'byteOffset':4"), view36, triangle), "reaches past the end");
    refused(mesh_text(accessor("3", ",'byteOffset':18446744073709551615"), view36, triangle), "must be a whole number");
    refused(mesh_text("{'bufferView':5,'componentType':5126,'count':3,'type':'VEC3'}", view36, triangle),
            "accessors[0].bufferView: names element 5 of bufferViews, which has 1");
    refused(mesh_text("{'bufferView':0,'componentType':5126,'count':3,'type':'VEC2'}", view36, triangle),
            "is not of the type");
    EXPECT_NE(refusal(mesh_text("{'bufferView':0,'componentType':77,'count':3,'type':'VEC3'}", view36, triangle)), "");
    refused(mesh_text(vec3, "{'buffer':3,'byteLength':36}", triangle),
            "bufferViews[0].buffer: names element 3 of buffers");
    refused(mesh_text(vec3, "{'buffer':0,'byteLength':37}", triangle), "reaches past the end of buffers[0]");
    refused(mesh_text(vec3, "{'buffer':0,'byteLength':36,'byteOffset':4294967295}", triangle), "reaches past the end");
    refused(mesh_text(vec3, "{'buffer':0,'byteLength':36,'byteStride':8}", triangle), "byteStride");
    refused(mesh_text(vec3, view36, "{'byteLength':36}"), "neither a uri nor a binary chunk");
    refused(mesh_text(vec3, view36, "{'byteLength':99,'uri':'data:a/b;base64,AAAA'}"), "holds no 99 bytes");
    refused(mesh_text(vec3, view36, "{'byteLength':3,'uri':'data:a/b;base64,!!!!'}"), "holds no 3 bytes");
    refused(mesh_text(vec3, view36, "{'byteLength':36,'uri':'data:text/plain,hello'}"), "without base64");
    refused(mesh_text(vec3, view36, "{'byteLength':1e15,'uri':'data:a/b;base64,AAAA'}"),
            "holds no 1000000000000000 bytes");
    refused(mesh_text(vec3, view36, "{'byteLength':36,'uri':'missing.bin'}"), "no such file");
    // NaN and infinity as coordinates
    refused(mesh_text(vec3, view36,
                      "{'byteLength':36,'uri':'data:a/b;base64,"
                      "AADAfwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/'}"),
            "not a finite number");
    refused(mesh_text(vec3, view36, triangle, "{'attributes':{'POSITION':7}}"), "names element 7 of accessors");
    EXPECT_NE(refusal(mesh_text(vec3, view36, triangle, "{'attributes':{'POSITION':0},'indices':9}")), "");
    refused(mesh_text(vec3, view36, triangle, "{'attributes':{'POSITION':0},'indices':0}"), "not of the type");
    refused(mesh_text(vec3 + ",{'bufferView':0,'componentType':5121,'count':36,'type':'SCALAR'}", view36, triangle,
                      "{'attributes':{'POSITION':0},'indices':1}"),
            "has index 128 among 3 vertices");
    refused(mesh_text(vec3, view36, triangle,
                      "{'attributes':{'POSITION':0},'extensions':{'KHR_draco_mesh_compression':{}}}"),
            "compressed");
}

TEST(GltfMalformed, SparseAccessors) {
    // A second point list: 3 zeros, of which element 2 becomes (0, 0, 1) from the triangle's own bytes.
    auto sparse = [](const std::string& index_offset, const std::string& count, const std::string& total) {
        return mesh_text("{'componentType':5126,'count':" + total + ",'type':'VEC3','sparse':{'count':" + count +
                             ",'indices':{'bufferView':1,'componentType':5121,'byteOffset':" + index_offset +
                             "},'values':{'bufferView':0,'byteOffset':24}}}",
                         view36 + ",{'buffer':0,'byteLength':36}", triangle);
    };
    EXPECT_EQ(refusal(sparse("0", "1", "3")), "");  // element 0; a flat mesh, left out
    EXPECT_NE(refusal(sparse("14", "1", "3")).find("index out of range"), std::string::npos);  // byte 14 is 0x80
    EXPECT_NE(refusal(sparse("0", "2", "3")).find("values"), std::string::npos);
    EXPECT_NE(refusal(sparse("0", "9", "3")).find("out of range"), std::string::npos);
    EXPECT_NE(refusal(sparse("0", "1", "4000000000")).find("more elements than the file's size allows"),
              std::string::npos);
}

TEST(GltfMalformed, UrisStayInTheDirectory) {
    for (const char* uri : {"/etc/passwd", "../secret.bin", "a/../../secret.bin", "%2e%2e/secret.bin", "%2Fetc/passwd",
                            "file:///etc/passwd", "http://example.org/a.bin", "C:\\a.bin", "..\\a.bin", "a/..", ""}) {
        std::string text = mesh_text(vec3, view36, std::string("{'byteLength':36,'uri':'") + uri + "'}");
        if (std::string(uri).find('\\') != std::string::npos) text = "";  // needs an escape of its own, below
        if (text.empty()) continue;
        EXPECT_NE(refusal(text).find("uri: "), std::string::npos) << uri << ": " << refusal(text);
    }
    EXPECT_NE(refusal(mesh_text(vec3, view36, R"({'byteLength':36,'uri':'..\\a.bin'})")).find("is no file name"),
              std::string::npos);
    EXPECT_NE(refusal(mesh_text(vec3, view36, R"({'byteLength':36,'uri':'a\u0000b'})")).find("is no file name"),
              std::string::npos);
}

std::string little_endian(uint32_t v) {
    return {static_cast<char>(v), static_cast<char>(v >> 8), static_cast<char>(v >> 16), static_cast<char>(v >> 24)};
}

// A GLB of the given JSON and binary chunk, with headers that say what they should unless told otherwise.
std::string glb(std::string json, std::string binary, uint32_t total_more = 0, uint32_t json_more = 0) {
    while (json.size() % 4) json += ' ';
    while (binary.size() % 4) binary += '\0';
    std::string chunks = little_endian(static_cast<uint32_t>(json.size()) + json_more) + "JSON" + json +
                         little_endian(static_cast<uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
    return "glTF" + little_endian(2) + little_endian(static_cast<uint32_t>(12 + chunks.size()) + total_more) + chunks;
}

TEST(GltfBinary, ChunksAreRead) {
    std::string bytes(36, '\0');
    bytes[14] = '\x80', bytes[15] = '\x3f', bytes[34] = '\x80', bytes[35] = '\x3f';
    std::string json = mesh_text(vec3, view36, "{'byteLength':36}");
    EXPECT_EQ(refusal(glb(json, bytes)), "");
    EXPECT_NE(refusal(glb(json, bytes.substr(0, 20))).find("buffers[0]: has 20 of 36 bytes"), std::string::npos);
    EXPECT_NE(refusal(glb(json, bytes, 100)).find("ends after"), std::string::npos);
    EXPECT_NE(refusal(glb(json, bytes, 0, 1 << 20)).find("ends inside GLB chunk 0"), std::string::npos);
    EXPECT_NE(refusal(glb(json, bytes, 0, 0xfffffff0u)), "");
    std::string other = glb(json, bytes);
    other[4] = 3;
    EXPECT_NE(refusal(other).find("is GLB version 3"), std::string::npos);
    other = glb(json, bytes);
    other[16] = 'X';
    EXPECT_NE(refusal(other).find("no JSON as its first"), std::string::npos);
    EXPECT_NE(refusal("glTF"), "");
}

TEST(GltfHostile, DeepNestingIsRefused) {
    std::string deep(100000, '[');
    EXPECT_NE(refusal("{\"extras\":" + deep).find("nested deeper than 64"), std::string::npos);
    EXPECT_NE(refusal("{\"nodes\":" + deep).find("nested deeper than 64"), std::string::npos);
    std::string objects;
    for (int i = 0; i < 1000; ++i) objects += "{\"a\":";
    EXPECT_NE(refusal(objects).find("nested deeper than 64"), std::string::npos);
}

// A long chain of nodes and many values cost time and memory in proportion to the file.
TEST(GltfHostile, LongChainsAndManyValues) {
    int count = scaled(20000, 2000);
    std::string nodes = "{'children':[1]}";
    for (int i = 1; i < count; ++i) {
        nodes += ",{'extensions':{'KHR_physics_rigid_bodies':{}}";
        if (i + 1 < count) nodes += ",'children':[" + std::to_string(i + 1) + "]";
        nodes += "}";
    }
    EXPECT_EQ(refusal(gltf_text(nodes)), "");
    std::string values = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[";
    for (int i = 0; i < 3000000; ++i) values += "{},";
    EXPECT_NE(refusal(values + "{}]}").find("too many values for its size"), std::string::npos);
    std::string dropped = "{\"asset\":{\"version\":\"2.0\"},\"extras\":[";
    for (int i = 0; i < 300000; ++i) dropped += "{},";
    EXPECT_EQ(refusal(dropped + "{}]}"), "");  // what nobody reads is not stored
}

std::vector<std::string> own_files() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator("scenes/files")) {
        if (entry.path().extension() == ".gltf") files.push_back(entry.path().string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

TEST(GltfHostile, TruncatedFilesAreRefused) {
    for (const std::string& file : own_files()) {
        std::string bytes = read_file(file).value();
        while (bytes.back() == '\n') bytes.pop_back();
        int cuts = scaled(60, 10);
        for (int i = 0; i < cuts; ++i) {
            size_t length = bytes.size() * static_cast<size_t>(i) / static_cast<size_t>(cuts);
            Result<Scene> loaded = load_gltf_bytes(bytes.substr(0, length), "scenes/files", file);
            EXPECT_FALSE(loaded.ok()) << file << " cut to " << length;
        }
    }
}

// Whatever a changed byte makes of a file, it loads or is refused with a sentence; where it loads, it also runs.
TEST(GltfHostile, ChangedBytesNeverCrash) {
    uint64_t random = 12345;
    auto next = [&](uint64_t below) {
        random = random * 6364136223846793005ull + 1442695040888963407ull;
        return (random >> 33) % below;
    };
    int loaded_count = 0, refused_count = 0;
    for (const std::string& file : own_files()) {
        std::string original = read_file(file).value();
        for (int i = 0; i < scaled(120, 12); ++i) {
            std::string bytes = original;
            for (uint64_t k = 0; k <= next(3); ++k) {
                const char* digits = "0123456789-.e,[]{}\"";
                bytes[next(bytes.size())] = i % 2 ? digits[next(19)] : static_cast<char>(next(256));
            }
            Result<Scene> loaded = load_gltf_bytes(bytes, "scenes/files", file);
            if (!loaded.ok()) {
                EXPECT_FALSE(loaded.error().message.empty());
                ++refused_count;
                continue;
            }
            ++loaded_count;
            if (i % 10 == 0) {
                EXPECT_TRUE(loaded.value().world.update(1.0f / 60.0f).ok());
            }
        }
    }
    EXPECT_GT(loaded_count, scaled(20, 5));
    EXPECT_GT(refused_count, scaled(20, 5));
}

TEST(Files, AreCheckedBeforeTheyAreRead) {
    EXPECT_NE(read_file("no/such/file").error().message.find("no such file"), std::string::npos);
    EXPECT_NE(read_file("scenes").error().message.find("not a regular file"), std::string::npos);
    EXPECT_NE(read_file("/dev/zero").error().message.find("not a regular file"), std::string::npos);
    EXPECT_NE(read_file("CMakeLists.txt", 10).error().message.find("larger than"), std::string::npos);
    EXPECT_EQ(printable("a\nb\x01\xff"), "a?b??");
}

// What `lendulet view` hands out beside a file: nothing that the file may not name.
TEST(GltfFiles, OnlyWhatLiesBelow) {
    const std::string path = testing::TempDir() + "files_of.gltf";
    ASSERT_TRUE(
        write_file(path, R"({"buffers": [{"uri": "a%20b.bin"}, {"uri": "data:;base64,AA=="}, {}, {"uri": "../x"}],
        "images": [{"uri": "wood/oak.png"}, {"uri": "/etc/passwd"}, {"uri": "file:x"}, {"uri": "wood/%2e%2e/../y"}]})"));
    const auto files = files_of_gltf(path);
    ASSERT_EQ(files.size(), 2u);
    EXPECT_EQ(files[0].first, "a%20b.bin");
    EXPECT_EQ(files[0].second, path.substr(0, path.rfind('/')) + "/a b.bin");
    EXPECT_EQ(files[1].first, "wood/oak.png");
    EXPECT_TRUE(files_of_gltf("scenes/files/no_such.gltf").empty());
    ASSERT_TRUE(write_file(path, "[1, 2"));
    EXPECT_TRUE(files_of_gltf(path).empty());
    ASSERT_TRUE(write_file(path, R"({"buffers": [{"uri": 3}], "images": 4})"));
    EXPECT_TRUE(files_of_gltf(path).empty());
}

}  // namespace
}  // namespace lendulet::test
