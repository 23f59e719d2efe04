// Apart from files, which WebAssembly has none of.
#include "io/file.h"

namespace lendulet {

std::string printable(std::string_view text) {
    constexpr size_t longest = 200;
    std::string out(text.substr(0, longest));
    for (char& c : out) {
        if (c < 0x20 || c > 0x7e) c = '?';
    }
    if (text.size() > longest) out += "...";
    return out;
}

}  // namespace lendulet
