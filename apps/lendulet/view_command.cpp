// `lendulet view SCENE|FILE`: the viewer's page with a native world behind it, for a browser on this machine.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/lendulet/commands.h"
#include "apps/lendulet/view/repro.h"
#include "apps/lendulet/view/server.h"
#include "io/file.h"
#include "io/gltf.h"

namespace lendulet::cli {

namespace {

// Beside the program as it is built: build/release/bin/lendulet and build/web.
std::string built_page() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::string() : (program.parent_path() / "../../web").lexically_normal().string();
}

bool is_recording(const std::string& bytes) { return bytes.rfind("LENDREC\n", 0) == 0; }

// Text inside a quoted attribute.
std::string attribute(std::string_view text) {
    std::string out;
    for (char c : text) {
        if (c == '"') out += "&quot;";
        else if (c == '&') out += "&amp;";
        else if (c == '<') out += "&lt;";
        else out += c;
    }
    return out;
}

std::string meta(const char* name, const std::string& content) {
    return std::string("\n<meta name=\"") + name + "\" content=\"" + attribute(content) + "\">";
}

// A file that is no glTF and looks like a recording; empty where the scene is none.
Result<std::string> read_recording(const std::string& scene) {
    std::error_code error;
    if (is_gltf(scene) || is_repro(scene) || !std::filesystem::is_regular_file(scene, error)) return std::string();
    Result<std::string> bytes = read_file(scene);
    if (!bytes.ok()) return bytes;
    if (!is_recording(bytes.value()))
        return Error{ErrorCode::parse, printable(scene) + ": neither a glTF file nor a recording nor a repro file"};
    return bytes;
}

// What the page draws of a glTF file: itself as "gltf", what lies beside it below that, as browsers ask for it.
std::map<std::string, std::string> drawn_files(const std::string& scene) {
    std::map<std::string, std::string> files{{"gltf", scene}};
    for (auto& [uri, path] : files_of_gltf(scene)) {
        std::string asked = "gltf/";
        for (char c : uri) {
            if (c == ' ') asked += "%20";
            else asked += c;
        }
        files[asked] = path;
    }
    return files;
}

}  // namespace

int view(const ViewOptions& options) {
    ServerOptions server;
    server.port = static_cast<uint16_t>(options.port);
    server.any_port = options.any_port;
    server.give_up = options.give_up;
    server.folder = options.page.empty() ? built_page() : options.page;
    std::error_code error;
    if (!std::filesystem::is_regular_file(server.folder + "/index.html", error))
        return fail(printable(server.folder) + ": the page is not there; ./dev web builds it, --page says where it is");
    Result<std::string> recording = read_recording(options.scene);
    if (!recording.ok()) return fail(recording.error().message);
    server.recording = std::move(recording).value();

    std::string shown = options.scene;
    if (is_repro(options.scene)) {
        Result<Repro> repro = read_repro(options.scene);
        if (!repro.ok()) return fail(repro.error().message);
        shown = repro.value().scene;
    }

    const OpenScene open = [&options, &shown](const std::string& name) -> Result<Scene> {
        const Configure configure = [&options](WorldBuilder& builder) { builder.workers(options.threads); };
        if (!name.empty()) return build_scene(name, configure);
        if (is_gltf(options.scene)) return load_gltf(options.scene, configure);
        return build_scene(shown, configure);
    };
    if (server.recording.empty()) {
        // A wrong name is said here and not in the page.
        Result<Scene> scene = open("");
        if (!scene.ok()) return fail(scene.error().message);
        if (is_gltf(options.scene)) server.files = drawn_files(options.scene);
        server.head = meta("lendulet-stream", is_gltf(options.scene) ? "" : shown) +
                      meta("lendulet-title", std::filesystem::path(options.scene).filename().string());
        if (!server.files.empty()) server.head += meta("lendulet-gltf", "gltf");
        if (is_repro(options.scene)) {
            server.files["repro"] = options.scene;
            server.head += meta("lendulet-repro", std::filesystem::path(options.scene).filename().string());
        }
    } else {
        server.head = meta("lendulet-recording", std::filesystem::path(options.scene).filename().string());
    }
    Status served = serve(server, open, [&](uint16_t port) {
        std::printf("http://localhost:%d/ shows %s (Ctrl-C ends it)\n", port, printable(options.scene).c_str());
        if (options.give_up > 0.0)
            std::printf("Without a visitor it ends after %g s; --give-up S changes that.\n", options.give_up);
        std::fflush(stdout);
    });
    return served.ok() ? 0 : fail(served.error().message);
}

}  // namespace lendulet::cli
