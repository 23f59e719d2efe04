// What a benchmark needs of a physics engine. Every engine gets the same SceneDescription and builds its world from it.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/description.h"

namespace lendulet::bench {

struct EngineSettings {
    int threads = 1;
    Configure configure;  // this engine's own options; others ignore it
};

class Engine {
public:
    virtual ~Engine() = default;
    virtual std::string_view name() const = 0;
    // One step with what the scene does before it; both are timed.
    virtual void step(int number) = 0;
    virtual Pose pose(int body) const = 0;  // of bodies as counted in the description
    virtual int contact_points() const = 0;
    // Of the whole state, where the engine has such a hash; else 0, and the poses are hashed.
    virtual uint64_t hash() const { return 0; }
    // What the engine itself says of its last step, for tables by stage; null where it says nothing.
    virtual const StepStatistics* statistics() const { return nullptr; }
};

// Null, with a sentence in `why`, where the engine cannot run the scene with these settings.
using MakeEngine = std::unique_ptr<Engine> (*)(const scenes::SceneDescription&, const EngineSettings&,
                                               std::string* why);
std::unique_ptr<Engine> make_lendulet(const scenes::SceneDescription&, const EngineSettings&, std::string* why);
std::unique_ptr<Engine> make_bullet(const scenes::SceneDescription&, const EngineSettings&, std::string* why);

}  // namespace lendulet::bench
