// Charts are well-formed XML whatever they show, and hold what they were given.
#include "bench/chart.h"

#include <gtest/gtest.h>

namespace lendulet::bench {
namespace {

// Elements nest and close, attributes are quoted, no bare & or <. Empty where all is well.
std::string xml_problem(const std::string& text) {
    std::vector<std::string> open;
    for (size_t i = 0; i < text.size();) {
        if (text[i] == '&' && text.find(';', i) > i + 6) return "bare & at " + std::to_string(i);
        if (text[i] == '>') return "bare > at " + std::to_string(i);
        if (text[i] != '<') {
            ++i;
            continue;
        }
        size_t end = i + 1;
        bool quoted = false;
        for (; end < text.size() && (quoted || text[end] != '>'); ++end) {
            quoted ^= text[end] == '"';
            if (text[end] == '<') return "< inside a tag at " + std::to_string(end);
        }
        if (end == text.size()) return "a tag does not end";
        std::string tag = text.substr(i + 1, end - i - 1);
        std::string name = tag.substr(0, tag.find(' '));
        if (tag[0] == '/') {
            if (open.empty() || "/" + open.back() != tag) return "closes " + tag;
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(name);
        }
        i = end + 1;
    }
    return open.empty() ? "" : "does not close " + open.back();
}

TEST(Chart, IsWellFormed) {
    EXPECT_EQ(xml_problem(chart_svg("nothing", {})), "");
    EXPECT_EQ(xml_problem(chart_svg("empty", {{"a panel", {}}})), "");
    Panel panel{"<tags> & \"quotes\"",
                {{"one & two", Stroke::dashed, {{10, 5}, {1000, 7e6}}}, {"dot", {}, {{10, 10}}}}};
    std::string svg = chart_svg("a < b", {panel, panel, panel});
    EXPECT_EQ(xml_problem(svg), "");
    EXPECT_NE(svg.find("one &amp; two"), std::string::npos);
    EXPECT_NE(svg.find("polyline"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Chart, TimesAndCountsAsText) {
    EXPECT_EQ(time_text(7.25), "7.25 ns");
    EXPECT_EQ(time_text(999.96), "1000 ns");
    EXPECT_EQ(time_text(12345), "12.3 µs");
    EXPECT_EQ(time_text(1e6), "1 ms");
    EXPECT_EQ(time_text(2.5e9), "2.5 s");
    EXPECT_EQ(count_text(1000), "1000");
    EXPECT_EQ(count_text(10000), "10 000");
    EXPECT_EQ(count_text(1234567), "1 234 567");
}

}  // namespace
}  // namespace lendulet::bench
