#include <spdlog/spdlog.h>
#include "fuzz/fuzz.h"

#include "megaviews/scene/load_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mv;
    static const bool quiet = (spdlog::set_level(spdlog::level::off), true);
    static_cast<void>(quiet);
    const fuzz::MemoryFile file(data, size);
    return fuzz::tryTo([&] { loadGltf(file.path().string(), {}); });
}
