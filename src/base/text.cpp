#include "base/text.h"

#include <cstdio>

namespace lendulet {

std::string text(float value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%g", static_cast<double>(value));
    return buffer;
}

}  // namespace lendulet
