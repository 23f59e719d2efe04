// `lendulet info FILE`: reads a recording from end to end, checks everything in it and describes it.
#include <cstdio>

#include "apps/lendulet/commands.h"
#include "io/file.h"
#include "io/recording.h"

namespace lendulet::cli {

int info(const std::string& file) {
    Result<RecordingReader> opened = RecordingReader::open(file);
    if (!opened.ok()) return fail(opened.error().message);
    RecordingReader& recording = opened.value();
    while (true) {
        Result<bool> more = recording.next_step();
        if (!more.ok()) return fail(more.error().message);
        if (!more.value()) break;
    }
    int counts[3] = {0, 0, 0}, removed = 0;
    for (const RecordingReader::Body& body : recording.bodies()) {
        ++counts[static_cast<int>(body.type)];
        removed += !body.live;
    }
    double seconds = recording.steps() * recording.dt();
    std::printf("%s: recording of %s\n", printable(file).c_str(), printable(recording.scene()).c_str());
    std::printf("  steps       %u of %.6g s, %.6g s in all\n", recording.steps(), recording.dt(), seconds);
    std::printf("  bodies      %d static, %d kinematic, %d dynamic, %d of them removed on the way\n", counts[0],
                counts[1], counts[2], removed);
    std::printf("  shapes      %u\n", recording.shapes());
    std::printf("  poses       %llu that differ from the step before\n",
                static_cast<unsigned long long>(recording.poses_read()));
    std::printf("  size        %llu bytes, checksum right\n", static_cast<unsigned long long>(recording.bytes()));
    std::printf("  state hash  %016llx\n", static_cast<unsigned long long>(recording.world_hash()));
    return 0;
}

}  // namespace lendulet::cli
