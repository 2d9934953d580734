#include <spdlog/spdlog.h>
#include "fuzz/fuzz.h"

#include <fstream>

#include "megaviews/measure/reference_store.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mv;
    static const bool quiet = (spdlog::set_level(spdlog::level::off), true);
    static_cast<void>(quiet);
    // An array, and behind it what lies beside it as its hash.
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("megaviews-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    constexpr std::size_t kHash = 33;
    const std::string_view all = fuzz::textOf(data, size);
    const std::size_t array = size > kHash ? size - kHash : size;
    for (const char* ending : {".npy", ".partial.npy"}) {
        const std::string name = (folder / "reference").string() + ending;
        std::ofstream(name, std::ios::binary) << all.substr(0, array);
        std::ofstream(name + ".xxh", std::ios::binary) << all.substr(array);
        ReferenceStore(folder).load(folder / "reference", 2, 2);
        std::filesystem::remove(name);
    }
    std::filesystem::remove_all(folder);
    return 0;
}
