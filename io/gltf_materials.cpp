#include "io/gltf_materials.h"

#include "io/file.h"

namespace lendulet {

namespace {

float coefficient(const Field& field, double fallback) {
    double v = field.number_or(fallback);
    if (v < 0.0) field.refuse("must not be negative");
    return static_cast<float>(v);
}

CombineRule combine_rule(const Field& field, CombineRule fallback) {
    if (!field) return fallback;
    const std::string& name = field.text();
    if (name == "average") return CombineRule::average;
    if (name == "minimum") return CombineRule::minimum;
    if (name == "maximum") return CombineRule::maximum;
    if (name == "multiply") return CombineRule::multiply;
    field.refuse("is \"" + printable(name) + "\", not average, minimum, maximum or multiply");
}

// Gives every name of a collision system a bit of its own.
class SystemBits {
public:
    explicit SystemBits(Warnings& warnings) : warnings_(warnings) {}

    // Colliders in no system at all, and those without a filter.
    static constexpr uint64_t no_system = 1;

    uint64_t of(const Field& names) {
        uint64_t bits = 0;
        for (size_t i = 0; i < names.size(); ++i) bits |= bit(names.at(i));
        return bits;
    }

private:
    uint64_t bit(const Field& name) {
        auto found = bits_.find(name.text());
        if (found != bits_.end()) return found->second;
        constexpr size_t most = 63;
        if (bits_.size() == most) {
            warnings_.add(name.where(),
                          "there are more than 63 collision systems; \"" + printable(name.text()) + "\" is ignored");
            return 0;
        }
        uint64_t next = no_system << (bits_.size() + 1);
        bits_.emplace(name.text(), next);
        return next;
    }

    std::map<std::string, uint64_t> bits_;
    Warnings& warnings_;
};

}  // namespace

std::vector<Material> read_materials(const Field& list, Warnings& warnings) {
    std::vector<Material> out;
    for (size_t i = 0; i < list.size(); ++i) {
        Field field = list.at(i);
        Material m;
        m.static_friction = coefficient(field["staticFriction"], 0.6);
        m.dynamic_friction = coefficient(field["dynamicFriction"], 0.6);
        float restitution = coefficient(field["restitution"], 0.0);
        if (restitution > 1.0f) warnings.add(field["restitution"].where(), "is more than 1; 1 is used");
        m.restitution = minimum(restitution, 1.0f);
        m.friction_combine = combine_rule(field["frictionCombine"], m.friction_combine);
        m.restitution_combine = combine_rule(field["restitutionCombine"], m.restitution_combine);
        out.push_back(m);
    }
    return out;
}

std::vector<CollisionFilter> read_filters(const Field& list, Warnings& warnings) {
    SystemBits bits(warnings);
    std::vector<CollisionFilter> out;
    for (size_t i = 0; i < list.size(); ++i) {
        Field field = list.at(i);
        CollisionFilter filter;
        filter.category = bits.of(field["collisionSystems"]);
        if (filter.category == 0) filter.category = SystemBits::no_system;
        Field with = field["collideWithSystems"], without = field["notCollideWithSystems"];
        if (with) filter.mask = bits.of(with);
        if (without) filter.mask &= ~bits.of(without);
        if (with && without) warnings.add(field.where(), "says both what it collides with and what not");
        out.push_back(filter);
    }
    return out;
}

}  // namespace lendulet
