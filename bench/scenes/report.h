// Results of scenes as a table for people and as CSV for machines.
#pragma once

#include <string>
#include <vector>

#include "bench/scenes/run.h"

namespace lendulet::bench {

void print_table_head();
// One line for each engine; engines other than the first with their time as a multiple of the first one's.
void print_table_rows(const std::vector<RunResult>& results);
// engine,scene,threads,bodies,median_ms,p99_ms,first_ms,mean_ms,contacts,pen_mean_mm,pen_p99_mm,pen_max_mm,
// joint_error_mean_mm,joint_error_max_mm,top_error_mm,drift_mm,stands,hash
std::string scenes_csv(const std::vector<RunResult>& results);

}  // namespace lendulet::bench
