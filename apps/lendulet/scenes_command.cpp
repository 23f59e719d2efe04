// `lendulet scenes`: the built-in scenes.
#include <cstdio>

#include "apps/lendulet/commands.h"
#include "scenes/scene.h"

namespace lendulet::cli {

int list_scenes() {
    for (const SceneInfo& scene : built_in_scenes()) {
        std::string name(scene.name);
        if (scene.default_size) name += ":" + std::to_string(scene.default_size);
        std::printf("%-24s %.*s\n", name.c_str(), static_cast<int>(scene.description.size()), scene.description.data());
    }
    return 0;
}

}  // namespace lendulet::cli
