#pragma once
// UTF-8 as text from a file may break it: names and JSON are checked before anything relies on
// them. Serves the first stage, file -> Scene.

#include <cstddef>
#include <string>
#include <string_view>

namespace mv {

// Bytes of the valid UTF-8 sequence that `text` begins with, 1 to 4; 0 if there is none (empty
// text, stray continuation, overlong form, surrogate, beyond U+10FFFF, cut short).
std::size_t utf8SequenceLength(std::string_view text);

// Replaces each byte that belongs to no valid sequence by U+FFFD. Returns how many there were.
std::size_t repairUtf8(std::string& text);

}  // namespace mv
