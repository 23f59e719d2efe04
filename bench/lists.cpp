#include "bench/lists.h"

#include <algorithm>
#include <charconv>

#include "io/file.h"

namespace lendulet::bench {

std::vector<std::string> parts_of(const std::string& list) {
    std::vector<std::string> parts;
    for (size_t begin = 0; begin <= list.size();) {
        size_t end = std::min(list.find(',', begin), list.size());
        parts.push_back(list.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

Result<std::vector<int>> read_numbers(const std::string& option, const std::string& list, int least, int most) {
    std::vector<int> numbers;
    for (const std::string& part : parts_of(list)) {
        int number = 0;
        auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
        if (error != std::errc() || end != part.data() + part.size() || number < least || number > most) {
            return Error{ErrorCode::bad_config, option + " must be whole numbers from " + std::to_string(least) +
                                                    " to " + std::to_string(most) + ", not \"" + printable(part) +
                                                    "\""};
        }
        numbers.push_back(number);
    }
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
}

}  // namespace lendulet::bench
