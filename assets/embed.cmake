# Writes OUTPUT: files as byte arrays, each behind a function `std::span<const unsigned char> NAME()`
# that HEADER declares in NAMESPACE. ITEMS: NAME=FILE,NAME=FILE,...
string(REPLACE "," ";" items "${ITEMS}")
set(data "")
set(functions "")
foreach(item IN LISTS items)
    string(REGEX MATCH "^([^=]+)=(.+)$" matched "${item}")
    set(name "${CMAKE_MATCH_1}")
    file(READ "${CMAKE_MATCH_2}" hex HEX)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    # Lines of a length that any compiler and editor takes.
    string(REGEX REPLACE "(................................................................................)"
           "\\1\n" bytes "${bytes}")
    string(APPEND data "constexpr unsigned char ${name}Bytes[] = {\n${bytes}\n};\n")
    string(APPEND functions
           "std::span<const unsigned char> ${name}() { return ${name}Bytes; }\n")
endforeach()
file(WRITE "${OUTPUT}"
     "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\nnamespace {\n${data}}  // namespace\n\n"
     "${functions}\n}  // namespace ${NAMESPACE}\n")
