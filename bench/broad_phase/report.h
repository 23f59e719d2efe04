// Measured cells as a table for people, as CSV for machines and as a chart.
#pragma once

#include <string>
#include <vector>

#include "bench/broad_phase/measure.h"

namespace lendulet::bench {

// The table of one cell: times, and how many times as long btDbvt and Boost's packing take, where they ran.
std::string cell_table(const CellResult& result);

// structure,distribution,n,mode,median_ns,pairs
std::string broad_phase_csv(const std::vector<Row>& rows);

// A panel for each mode and distribution measured; beside `uniform, rebuild` and `uniform, split` the thesis's times.
std::string broad_phase_chart(const std::vector<Row>& rows);

}  // namespace lendulet::bench
