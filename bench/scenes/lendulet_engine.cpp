// This engine, as the benchmark sees it.
#include "bench/scenes/engine.h"

namespace lendulet::bench {
namespace {

class LenduletEngine final : public Engine {
public:
    explicit LenduletEngine(Scene scene) : scene_(std::move(scene)) {}

    std::string_view name() const override { return "lendulet"; }
    void step(int number) override {
        if (scene_.before_step) scene_.before_step(scene_.world, number);
        scene_.world.update(scene_.dt).value();
    }
    Pose pose(int body) const override {
        StaticBodyRef ref = scene_.world.get_static(scene_.world.body(body));
        return {ref.position(), ref.orientation()};
    }
    int contact_points() const override { return scene_.world.statistics().contact_points; }
    uint64_t hash() const override { return scene_.world.hash(); }
    const StepStatistics* statistics() const override { return &scene_.world.statistics(); }

private:
    Scene scene_;
};

}  // namespace

std::unique_ptr<Engine> make_lendulet(const scenes::SceneDescription& description, const EngineSettings& settings,
                                      std::string* why) {
    Result<Scene> scene = scenes::instantiate(description, [&](WorldBuilder& builder) {
        builder.workers(settings.threads).sleep(description.about_sleep);
        if (settings.configure) settings.configure(builder);
    });
    if (scene) return std::make_unique<LenduletEngine>(std::move(scene).value());
    *why = scene.error().message;
    return nullptr;
}

}  // namespace lendulet::bench
