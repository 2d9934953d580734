#include "megaviews/io/npy.h"
#include "fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mv;
    const fuzz::MemoryFile file(data, size);
    fuzz::tryTo([&] { readNpy<float>(file.path()); });
    return fuzz::tryTo([&] { readNpy<std::uint32_t>(file.path()); });
}
