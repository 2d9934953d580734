#pragma once
// Fonts of the system for names that the built-in font cannot write, such as Chinese, Japanese and
// Korean ones.

#include <set>
#include <vector>

#include "ui/interface.h"

namespace mv {

// As few as draw these characters, best first by the system's own choice for the user's language.
// Characters that no font has are left out.
std::vector<ui::FontFile> systemFonts(std::set<char32_t> characters);

}  // namespace mv
