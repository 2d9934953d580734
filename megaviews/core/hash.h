#pragma once
// XXH3 with 128 bits: names the content of scenes and keys caches. Not cryptographic. Takes data in
// parts, any number of times.

#include <xxhash.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace mv {

class Hash {
  public:
    Hash();
    template <typename T, std::size_t N>
    Hash& add(std::span<T, N> values) {
        return addBytes(values.data(), values.size_bytes());
    }
    Hash& add(std::string_view text) { return addBytes(text.data(), text.size()); }
    std::string hex() const;  // of all so far: 32 lower-case hexadecimal digits

  private:
    Hash& addBytes(const void* data, std::size_t bytes);
    struct Free {
        void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
    };
    std::unique_ptr<XXH3_state_t, Free> state_;
};

}  // namespace mv
