#include "apps/lendulet/view/repro.h"

#include "apps/lendulet/view/change.h"
#include "io/file.h"

namespace lendulet::cli {

namespace {

constexpr int most_steps = 1000000000;

Repro parse(const Json& json) {
    const Asked asked{json};
    if (!json.is_object() || !asked.has("lendulet") || asked.text("lendulet") != "repro")
        throw Asked::Refused{"is no repro file"};
    if (asked.whole("version", most_steps) != 1) throw Asked::Refused{"is of a version that is not known"};
    if (asked.has("gltf")) throw Asked::Refused{"holds a glTF file, which the viewer's page alone opens again"};
    Repro repro{asked.text("scene"), asked.whole("steps", most_steps), asked.text("hash"), {}};
    int last = 0;
    for (const Json& deed : asked.list("deeds")) {
        if (!deed.is_object()) throw Asked::Refused{"holds a deed that is no object"};
        const Asked members{deed};
        const int step = members.whole("step", most_steps);
        if (step < last) throw Asked::Refused{"holds deeds that are not in order"};
        if (step > repro.steps) throw Asked::Refused{"holds a deed that comes after its last step"};
        repro.deeds.push_back({last = step, members.object("command")});
    }
    return repro;
}

}  // namespace

Result<Repro> read_repro(const std::string& path) {
    Result<std::string> bytes = read_file(path);
    if (!bytes.ok()) return bytes.error();
    const Json json = Json::parse(bytes.value(), nullptr, false);
    if (json.is_discarded()) return Error{ErrorCode::parse, printable(path) + ": is not JSON"};
    try {
        return parse(json);
    } catch (const Asked::Refused& refused) {
        return Error{ErrorCode::parse, printable(path) + ": " + refused.sentence};
    }
}

Result<size_t> act(lendulet_world& world, const Repro& repro, int steps, size_t next) {
    for (; next < repro.deeds.size() && repro.deeds[next].step <= steps; ++next) {
        try {
            change(world, Asked{repro.deeds[next].command});
        } catch (const Asked::Refused& refused) {
            return Error{ErrorCode::parse, "deed " + std::to_string(next) + ": " + refused.sentence};
        }
    }
    return next;
}

}  // namespace lendulet::cli
