#include "fuzz/fuzz.h"
#include "megaviews/settings/settings_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mv;
    const fuzz::MemoryFile file(data, size);
    return fuzz::tryTo([&] {
        Settings settings;
        applyConfigFile(settings, file.path().string());
    });
}
