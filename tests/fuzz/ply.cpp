#include "megaviews/io/ply.h"
#include "fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mv;
    const RootCube root{glm::dvec3(0), 1};
    const std::string bytes(fuzz::textOf(data, size));
    return fuzz::tryTo([&] { parseViews(bytes, "fuzz", root, nullptr); });
}
