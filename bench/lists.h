// Lists on the command line: "10,100,1000".
#pragma once

#include <string>
#include <vector>

#include "lendulet/result.h"

namespace lendulet::bench {

// The parts between commas; an empty part stays, so that it is refused.
std::vector<std::string> parts_of(const std::string& list);
// "a, b, c"
std::string joined(const std::vector<std::string>& names);
// Whole numbers from `least` to `most`, ascending, each once. Error: bad_config, naming the option.
Result<std::vector<int>> read_numbers(const std::string& option, const std::string& list, int least, int most);

}  // namespace lendulet::bench
