// The commands of the program. Each returns the exit code: 0, or 2 after one sentence about bad input on stderr; verify
// and the run of a repro file also 1.
#pragma once

#include <string>
#include <string_view>

#include "io/summary.h"
#include "lendulet/lendulet.h"
#include "scenes/scene.h"
#include "verify/verify.h"

namespace lendulet::cli {

struct RunOptions {
    std::string scene;  // a built-in scene's name, a .gltf or .glb file, or a repro file
    double seconds = 10.0;
    double dt = 1.0 / 60.0;  // s
    WorldConfig world;       // where an option was given; see `given`
    struct Given {
        bool threads = false, solver_steps = false, broad_phase = false, simplex = false, integrator = false,
             width = false, no_sleep = false, seconds = false, dt = false;
    } given;
    std::string json;    // file, "-" for standard output, empty for none
    std::string record;  // file, empty for none
    bool quiet = false;
};

struct VerifyOptions {
    verify::Options run;
    std::string json, html, svg;  // files, empty for none; json "-": standard output
};

struct ViewOptions {
    std::string scene;  // a built-in scene's name, a .gltf or .glb file, a recording or a repro file
    std::string page;   // folder; empty: the one that was built beside the program
    int port = 8080;
    bool any_port = false;  // another one where that is taken
    int threads = 1;
    double give_up = 0.0;  // s without a visitor after which it ends; 0: never
};

// Whether a name is that of a glTF file, or of a repro file.
bool is_gltf(const std::string& name);
bool is_repro(const std::string& name);

// A built-in scene or a glTF file. What the command line says wins over what the scene chose.
Result<Scene> open_scene(const std::string& name, const RunOptions& options);
// The JSON, if asked for, and the page for people, unless standard output is the JSON's.
Status report(const RunSummary& summary, const RunOptions& options);

// Before a run that may be long: whether all that is to be written can be, each to a file of its own.
Status check_outputs(const RunOptions& options);

int run(const RunOptions& options);
int replay(const RunOptions& options);  // of a repro file; 1 where its bits are not those that were saved
int view(const ViewOptions& options);
int verify(const VerifyOptions& options);  // 1 where a figure is outside its tolerance
int info(const std::string& file);
int list_scenes();

// Prints "lendulet: SENTENCE" on stderr, on one line, and returns 2.
int fail(std::string_view sentence);

// What the command line asks for, done. Returns the exit code.
int execute(int argc, char** argv);

}  // namespace lendulet::cli
