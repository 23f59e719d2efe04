// Runs a built-in scene for a number of steps and prints the world's hash: shows that WebAssembly computes the same
// bits as a native build. Usage: lendulet_wasm SCENE STEPS
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "scenes/scene.h"

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: lendulet_wasm SCENE STEPS\n");
        return 2;
    }
    auto configure = [](lendulet::WorldBuilder& builder) { builder.sleep(false); };
    lendulet::Scene scene = lendulet::build_scene(argv[1], configure).value();
    int steps = std::atoi(argv[2]);
    for (int step = 0; step < steps; ++step) {
        if (scene.before_step) scene.before_step(scene.world, step);
        scene.world.update(1.0f / 60.0f).value();
    }
    std::printf("%016llx\n", static_cast<unsigned long long>(scene.world.hash()));
    return 0;
}
