// Repro files: a scene, what was done to it by hand and before which step, and the hash at the end. The viewer's page
// writes them; the same run has the same bits wherever it is made again.
#pragma once

#include "apps/lendulet/view/request.h"
#include "scenes/scene.h"

namespace lendulet::cli {

struct Repro {
    std::string scene;
    int steps = 0;
    std::string hash;  // after these steps, sixteen hexadecimal digits
    struct Deed {
        int step;      // done before the step of this number
        Json command;  // see change.h
    };
    std::vector<Deed> deeds;  // in order of steps
};

// Refuses what is no repro file, or one of a dropped file, with a sentence.
Result<Repro> read_repro(const std::string& path);

// Does what is to be done after `steps` steps, from the deed of number `next` on; returns the number of the next one.
// A sentence where the engine refuses.
Result<size_t> act(lendulet_world& world, const Repro& repro, int steps, size_t next);

}  // namespace lendulet::cli
