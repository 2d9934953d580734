#include "app/common/script.h"
#include "fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mv;
    return fuzz::tryTo([&] { script::parse(fuzz::textOf(data, size), "fuzz"); });
}
