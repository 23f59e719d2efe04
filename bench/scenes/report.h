// Results as a table for people and as CSV for machines.
#pragma once

#include <string>
#include <vector>

#include "bench/scenes/run.h"

namespace lendulet::bench {

void print_table_head();
// One line for each engine; engines other than the first with their time as a multiple of the first one's.
void print_table_rows(const std::vector<RunResult>& results);
// Medians of this engine's stages.
void print_stages(const RunResult& result);
// False, with a sentence on standard error, where the file cannot be written.
bool write_csv(const std::string& path, const std::vector<RunResult>& results);

}  // namespace lendulet::bench
