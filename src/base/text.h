// Numbers as text for messages.
#pragma once

#include <string>

namespace lendulet {

// As short as %g makes it, so that it can be recognised however small or large it is.
std::string text(float value);

}  // namespace lendulet
