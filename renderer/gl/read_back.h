#pragma once
// What the GPU sends back. A ReadBack copies results into a ring of a persistently mapped buffer,
// each behind a fence, so that nobody need wait for them; every call that does wait is counted here
// by name, so that a test can say that a frame makes none.

#include <epoxy/gl.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderer/gl/buffer.h"

namespace mv::gl {

// How a renderer takes what it asked the GPU for. Waited for, it belongs to this frame, to the bit;
// late, it arrives with a later frame, and no frame waits.
enum class Results { waited, late };

// Calls that made the CPU wait for the GPU since forgetWaits(), by "call, for whom".
const std::map<std::string, std::uint64_t>& waits();
void forgetWaits();
void countWait(const std::string& call, const std::string& whom);
// For tests, where the GPU is never behind: what is asked for from here on does not arrive until
// the next call.
void holdResults(bool on);
std::string objectLabel(GLenum kind, GLuint id);

class ReadBack {
  public:
    ReadBack() = default;
    // The label names the buffer and, where results are waited for, the waits.
    ReadBack(std::string label, Results results);
    ~ReadBack();
    ReadBack(ReadBack&& other) noexcept;
    ReadBack& operator=(ReadBack&& other) noexcept;

    // Asks for bytes that shaders or copies have written. With as many requests under way as the
    // ring holds, the oldest is forgotten.
    void request(const Buffer& from, std::uint64_t offset, std::uint64_t bytes);
    // The oldest request that has not been taken: now where results are waited for, else when it
    // has arrived.
    template <typename T>
    std::optional<std::vector<T>> take() {
        return copyOf<T>(takeOldest(results_ == Results::waited));
    }
    // The same, waiting for it in any case.
    template <typename T>
    std::optional<std::vector<T>> takeNow() {
        return copyOf<T>(takeOldest(true));
    }
    // Nothing that was asked for is still under way; asks, and never waits.
    bool arrived();
    bool requested() const { return count_ > 0; }  // and not taken
    void forget();                                 // every request

  private:
    static constexpr std::size_t kSlots = 4;
    struct Arrived {
        const std::byte* data = nullptr;
        std::uint64_t bytes = 0;
    };
    struct Slot {
        GLsync fence = nullptr;
        std::uint64_t bytes = 0;
        std::uint64_t number = 0;  // of all requests
    };
    static bool signalled(const Slot& slot);
    std::optional<Arrived> takeOldest(bool wait);
    template <typename T>
    static std::optional<std::vector<T>> copyOf(const std::optional<Arrived>& arrived) {
        if (!arrived) return std::nullopt;
        std::vector<T> out(arrived->bytes / sizeof(T));
        if (!out.empty()) std::memcpy(out.data(), arrived->data, out.size() * sizeof(T));
        return out;
    }
    void release();
    std::string label_;
    Results results_ = Results::waited;
    GLuint id_ = 0;
    std::byte* mapped_ = nullptr;
    std::uint64_t slotBytes_ = 0;
    Slot slots_[kSlots];
    std::size_t first_ = 0, count_ = 0;  // the oldest request, and how many there are
};

}  // namespace mv::gl
