# Writes OUTPUT: the font files below ROOT as byte arrays, for ui/font_data.h.
set(text "#include \"ui/font_data.h\"\n\nnamespace mv::ui {\nnamespace {\n")
foreach(name Regular Medium)
    file(READ "${ROOT}/Roboto-${name}.ttf" hex HEX)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    # Lines of a length that any compiler and editor takes.
    string(REGEX REPLACE "(................................................................................)"
           "\\1\n" bytes "${bytes}")
    string(APPEND text "constexpr unsigned char k${name}[] = {\n${bytes}\n};\n")
endforeach()
string(APPEND text "}  // namespace\n\n"
    "std::span<const unsigned char> interfaceFont() { return kRegular; }\n"
    "std::span<const unsigned char> interfaceFontMedium() { return kMedium; }\n\n"
    "}  // namespace mv::ui\n")
file(WRITE "${OUTPUT}" "${text}")
