// Text in XML and HTML.
#pragma once

#include <string>

namespace lendulet {

// & < > " as entities.
std::string escaped(const std::string& text);

}  // namespace lendulet
