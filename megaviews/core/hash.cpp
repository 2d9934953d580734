#include "megaviews/core/hash.h"

#include <fmt/format.h>

namespace mv {

Hash::Hash() : state_(XXH3_createState()) { XXH3_128bits_reset(state_.get()); }

Hash& Hash::addBytes(const void* data, std::size_t bytes) {
    XXH3_128bits_update(state_.get(), data, bytes);
    return *this;
}

std::string Hash::hex() const {
    const XXH128_hash_t sum = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", sum.high64, sum.low64);
}

}  // namespace mv
