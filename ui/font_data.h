#pragma once
// The interface's font inside the program, so that it looks alike on every machine and from every
// folder: Roboto, whose digits are all of one width. TrueType files as they are; the licence is in
// assets/fonts.

#include <span>

namespace mv::ui {

std::span<const unsigned char> interfaceFont();
std::span<const unsigned char> interfaceFontMedium();  // a little bolder, for titles

}  // namespace mv::ui
