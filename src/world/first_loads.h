// What new contacts between bodies at rest begin with, beside the loads that world_data.h tells of.
#pragma once

namespace lendulet {

struct WorldData;

// A contact that carries overlaps by what its leak takes (docs/solver.md). What is built at rest begins there: from the
// bottom up, every body is put down by as much as what lies beneath it and by its own contacts' overlap. Else it would
// fall that far, swing about that place for seconds, and lean. After guess_first_loads(), when islands know their
// substeps.
void settle_first_loads(WorldData& world, float dt);

}  // namespace lendulet
