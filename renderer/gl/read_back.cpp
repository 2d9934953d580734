#include "renderer/gl/read_back.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/gl/memory.h"

namespace mv::gl {
namespace {

std::map<std::string, std::uint64_t>& counted() {
    static std::map<std::string, std::uint64_t> calls;
    return calls;
}

std::uint64_t requests = 0;
std::optional<std::uint64_t> lastToArrive;

}  // namespace

const std::map<std::string, std::uint64_t>& waits() { return counted(); }
void forgetWaits() { counted().clear(); }
void countWait(const std::string& call, const std::string& whom) {
    ++counted()[call + ", " + whom];
}

std::string objectLabel(GLenum kind, GLuint id) {
    char text[128] = "";
    glGetObjectLabel(kind, id, sizeof text, nullptr, text);
    return text;
}

void holdResults(bool on) {
    lastToArrive.reset();
    if (on) lastToArrive = requests;
}

bool ReadBack::signalled(const Slot& slot) {
    if (lastToArrive && slot.number > *lastToArrive) return false;
    const GLenum state = glClientWaitSync(slot.fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
    return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
}

ReadBack::ReadBack(std::string label, Results results)
    : label_(std::move(label)), results_(results) {}

ReadBack::~ReadBack() { release(); }

ReadBack::ReadBack(ReadBack&& other) noexcept { *this = std::move(other); }

ReadBack& ReadBack::operator=(ReadBack&& other) noexcept {
    std::swap(label_, other.label_);
    std::swap(results_, other.results_);
    std::swap(id_, other.id_);
    std::swap(mapped_, other.mapped_);
    std::swap(slotBytes_, other.slotBytes_);
    std::swap(slots_, other.slots_);
    std::swap(first_, other.first_);
    std::swap(count_, other.count_);
    return *this;
}

void ReadBack::forget() {
    for (Slot& slot : slots_) {
        if (slot.fence) glDeleteSync(std::exchange(slot.fence, nullptr));
    }
    first_ = count_ = 0;
}

void ReadBack::release() {
    forget();
    if (!id_) return;
    glDeleteBuffers(1, &id_);  // unmaps it
    countMemory(-static_cast<std::int64_t>(kSlots * slotBytes_));
    id_ = 0;
}

void ReadBack::request(const Buffer& from, std::uint64_t offset, std::uint64_t bytes) {
    assert(offset + bytes <= from.bytes());
    if (bytes > slotBytes_ || !id_) {
        release();
        slotBytes_ = std::max<std::uint64_t>(bytes, 64);
        const auto size = static_cast<GLsizeiptr>(kSlots * slotBytes_);
        const GLbitfield access = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
        const ErrorsHandledHere handled;
        glCreateBuffers(1, &id_);
        countMemory(size);
        glNamedBufferStorage(id_, size, nullptr, access);
        glObjectLabel(GL_BUFFER, id_, static_cast<GLsizei>(label_.size()), label_.data());
        mapped_ = static_cast<std::byte*>(glMapNamedBufferRange(id_, 0, size, access));
        if (glGetError() != GL_NO_ERROR || !mapped_) {
            release();
            throw Error(ExitCode::impossible, "there is no memory to read back \"" + label_ +
                                                  "\", " + std::to_string(size >> 10) + " KiB");
        }
    }
    if (count_ == kSlots) {
        glDeleteSync(std::exchange(slots_[first_].fence, nullptr));
        first_ = (first_ + 1) % kSlots;
        --count_;
    }
    const std::size_t at = (first_ + count_++) % kSlots;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    if (bytes > 0) {
        glCopyNamedBufferSubData(from.id(), id_, static_cast<GLintptr>(offset),
                                 static_cast<GLintptr>(at * slotBytes_),
                                 static_cast<GLsizeiptr>(bytes));
    }
    slots_[at] = {glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0), bytes, ++requests};
}

bool ReadBack::arrived() {
    // Fences are passed in order: the newest speaks for all.
    return count_ == 0 || signalled(slots_[(first_ + count_ - 1) % kSlots]);
}

std::optional<ReadBack::Arrived> ReadBack::takeOldest(bool wait) {
    if (count_ == 0) return std::nullopt;
    Slot& slot = slots_[first_];
    if (wait && (results_ == Results::waited || !signalled(slot))) {
        countWait("fence", label_);
        constexpr GLuint64 kLong = 1'000'000'000;  // ns; asked again until it has passed
        while (glClientWaitSync(slot.fence, GL_SYNC_FLUSH_COMMANDS_BIT, kLong) ==
               GL_TIMEOUT_EXPIRED) {
        }
    } else if (!wait && !signalled(slot)) {
        return std::nullopt;
    }
    glDeleteSync(std::exchange(slot.fence, nullptr));
    const Arrived out{mapped_ + first_ * slotBytes_, slot.bytes};
    first_ = (first_ + 1) % kSlots;
    --count_;
    return out;
}

}  // namespace mv::gl
