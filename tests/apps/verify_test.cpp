// `lendulet verify`: the table, the JSON, the page and the exit code.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "program.h"

namespace lendulet::test {
namespace {

using Json = nlohmann::json;

TEST(Verify, WritesJsonOfTheCasesAskedFor) {
    Outcome outcome = lendulet({"verify", "--cases", "A12,A08,A35", "--json", "-"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    Json rows = Json::parse(outcome.out);
    const std::set<std::string> keys{"case", "quality", "quantity", "measured", "exact", "error", "tolerance", "pass"};
    std::set<std::string> cases;
    for (const Json& row : rows) {
        std::set<std::string> found;
        for (const auto& [key, value] : row.items()) found.insert(key);
        EXPECT_EQ(found, keys);
        EXPECT_EQ(row["quality"], "d60");
        cases.insert(row["case"]);
        if (row["case"] == "A35") EXPECT_TRUE(row["pass"].is_null() && row["measured"].is_null());
        else EXPECT_EQ(row["pass"], row["error"].get<double>() <= row["tolerance"].get<double>()) << row;
    }
    EXPECT_EQ(cases, (std::set<std::string>{"A08", "A12", "A35"}));
}

TEST(Verify, WritesAPageAndAPicture) {
    std::string html = scratch("page.html"), svg = scratch("curves.svg"), json = scratch("rows.json");
    Outcome outcome = lendulet({"verify", "--cases", "A08", "--quality", "hq", "--html", html, "--svg", svg, "--json",
                                json, "--threads", "1"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("0 outside their tolerance"), std::string::npos) << outcome.out;
    EXPECT_EQ(Json::parse(content(json))[0]["quality"], "hq");
    std::string page = content(html);
    EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
    for (const char* part : {"<table>", "<svg", "<polyline", "<circle", "</html>"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    EXPECT_EQ(page.find("src="), std::string::npos) << "it needs nothing beside it";
    EXPECT_EQ(content(svg).rfind("<svg", 0), 0u);
}

}  // namespace
}  // namespace lendulet::test
