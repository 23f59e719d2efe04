#include "bench/broad_phase/report.h"

#include <cstdio>

#include "bench/chart.h"

namespace lendulet::bench {
namespace {

const Row* row_of(const CellResult& result, const std::string& structure) {
    for (const Row& row : result.rows) {
        if (row.structure == structure) return &row;
    }
    return nullptr;
}

std::string ratio_text(const Row* peer, const Row& row) {
    if (!peer || row.median_ns <= 0.0) return "-";
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", peer->median_ns / row.median_ns);
    return text;
}

// The thesis's results table, ns (AMD Ryzen 5 4500U; its boxes are not published).
struct ThesisRow {
    const char* name;
    Mode mode;
    std::vector<std::pair<double, double>> points;
};

const std::vector<ThesisRow>& thesis_rows() {
    static const std::vector<ThesisRow> rows = {
        {"thesis all pairs", Mode::rebuild, {{10, 102}, {100, 6830}, {1000, 2.1e6}, {10000, 252e6}}},
        {"thesis sweep 1", Mode::rebuild, {{10, 483}, {100, 7040}, {1000, 261e3}, {10000, 19e6}, {100000, 1830e6}}},
        {"thesis sweep 3", Mode::rebuild, {{10, 1611}, {100, 29e3}, {1000, 1829e3}, {10000, 210e6}}},
        {"thesis R-tree", Mode::rebuild, {{10, 557}, {100, 39e3}, {1000, 941e3}, {10000, 21e6}, {100000, 708e6}}},
        {"thesis OMT", Mode::rebuild, {{10, 468}, {100, 17e3}, {1000, 505e3}, {10000, 8.65e6}, {100000, 164e6}}},
        {"thesis R-tree", Mode::split, {{10, 444}, {100, 24e3}, {1000, 771e3}, {10000, 14e6}, {100000, 486e6}}},
        {"thesis OMT", Mode::split, {{10, 455}, {100, 15e3}, {1000, 453e3}, {10000, 7.98e6}, {100000, 146e6}}},
    };
    return rows;
}

bool is_ours(const std::string& structure) {
    for (const SubjectType& type : all_subjects()) {
        if (type.name == structure) return type.ours;
    }
    return false;
}

Panel panel_of(const std::vector<Row>& rows, Distribution distribution, Mode mode) {
    Panel panel{std::string(name_of(distribution)) + ", " + std::string(name_of(mode)), {}};
    for (const SubjectType& type : all_subjects()) {
        Curve curve{type.name, is_ours(type.name) ? Stroke::solid : Stroke::dashed, {}};
        for (const Row& row : rows) {
            if (row.structure != type.name || row.cell.distribution != distribution || row.cell.mode != mode) continue;
            curve.points.push_back({row.cell.n, row.median_ns});
        }
        if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
    }
    if (panel.curves.empty() || distribution != Distribution::uniform) return panel;
    for (const ThesisRow& row : thesis_rows()) {
        if (row.mode == mode) panel.curves.push_back({row.name, Stroke::dotted, row.points});
    }
    return panel;
}

}  // namespace

std::string cell_table(const CellResult& result) {
    char line[160];
    long pairs = result.rows.empty() ? 0 : result.rows.front().pairs;
    const char* what = result.cell.mode == Mode::query   ? "hits of 1000 queries"
                       : result.cell.mode == Mode::refit ? "pairs begun and ended"
                                                         : "pairs";
    std::string out = name_of(result.cell) + ": " + count_text(pairs) + " " + what + "\n";
    std::snprintf(line, sizeof line, "  %-18s %12s %14s %12s %16s\n", "structure", "median", "ns per box", "btDbvt /",
                  "boost-packing /");
    out += line;
    for (const Row& row : result.rows) {
        std::string time = time_text(row.median_ns);
        int wide = 12 + (time.find("µ") != std::string::npos);  // two bytes, one place
        std::snprintf(line, sizeof line, "  %-18s %*s %14.1f %12s %16s\n", row.structure.c_str(), wide, time.c_str(),
                      row.median_ns / row.cell.n, ratio_text(row_of(result, "btDbvt"), row).c_str(),
                      ratio_text(row_of(result, "boost-packing"), row).c_str());
        out += line;
    }
    for (const std::string& sentence : result.skipped) out += "  " + sentence + "\n";
    return out;
}

std::string broad_phase_csv(const std::vector<Row>& rows) {
    std::string out = "structure,distribution,n,mode,median_ns,pairs\n";
    for (const Row& row : rows) {
        char numbers[64];
        std::snprintf(numbers, sizeof numbers, "%.1f,%ld", row.median_ns, row.pairs);
        out += row.structure + "," + std::string(name_of(row.cell.distribution)) + "," + std::to_string(row.cell.n) +
               "," + std::string(name_of(row.cell.mode)) + "," + numbers + "\n";
    }
    return out;
}

std::string broad_phase_chart(const std::vector<Row>& rows) {
    std::vector<Panel> panels;
    for (Distribution distribution : all_distributions) {
        for (Mode mode : all_modes) {
            Panel panel = panel_of(rows, distribution, mode);
            if (!panel.curves.empty()) panels.push_back(std::move(panel));
        }
    }
    return chart_svg("Time of a frame by the number of boxes, one thread", panels);
}

}  // namespace lendulet::bench
