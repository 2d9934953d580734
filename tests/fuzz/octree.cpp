#include <stdexcept>
#include "fuzz/fuzz.h"

#include "megaviews/hierarchy/scene_hierarchy_cache.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mv;
    const fuzz::MemoryFile file(data, size);
    try {
        loadHierarchy("0123456789abcdef0123456789abcdef", file.path());
    } catch (const std::runtime_error&) {
    }
    return 0;
}
