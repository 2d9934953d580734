#include "app/common/state.h"
#include "fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace mv;
    return fuzz::tryTo([&] { stateFromText(fuzz::textOf(data, size), "fuzz"); });
}
