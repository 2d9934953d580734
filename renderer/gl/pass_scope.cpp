#include "renderer/gl/pass_scope.h"

#include <algorithm>
#include <utility>

#include "renderer/gl/context.h"

namespace mv::gl {

Profiler::Profiler() : wallClock_(limits().software) {}

Profiler::~Profiler() {
    for (const Pending& p : pending_) {
        if (p.begin) freeQueries_.push_back(p.begin);
        if (p.end) freeQueries_.push_back(p.end);
    }
    glDeleteQueries(static_cast<GLsizei>(freeQueries_.size()), freeQueries_.data());
}

const char* Profiler::clock() const {
    return wallClock_ ? "wall clock, synchronised" : "gpu timer";
}

GLuint Profiler::takeQuery() {
    GLuint query = 0;
    if (freeQueries_.empty()) {
        glCreateQueries(GL_TIMESTAMP, 1, &query);
    } else {
        query = freeQueries_.back();
        freeQueries_.pop_back();
    }
    return query;
}

std::vector<StageTime> Profiler::take() {
    std::vector<StageTime> stages;
    for (const Pending& p : std::exchange(pending_, {})) {
        double ms = p.ms;
        if (p.begin) {
            GLuint64 begin = 0, end = 0;
            glGetQueryObjectui64v(p.begin, GL_QUERY_RESULT, &begin);
            glGetQueryObjectui64v(p.end, GL_QUERY_RESULT, &end);
            ms = end > begin ? static_cast<double>(end - begin) * 1e-6 : 0.0;
            freeQueries_.push_back(p.begin);
            freeQueries_.push_back(p.end);
        }
        const auto same = std::find_if(stages.begin(), stages.end(),
                                       [&](const StageTime& s) { return s.name == p.name; });
        if (same == stages.end()) {
            stages.push_back({p.name, ms});
        } else {
            same->ms += ms;
        }
    }
    return stages;
}

PassScope::PassScope(Profiler& profiler, std::string name)
    : profiler_(profiler), name_(std::move(name)), timed_(profiler.enabled) {
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(name_.size()),
                     name_.data());
    if (!timed_) return;
    if (profiler_.wallClock_) {
        glFinish();  // what was issued before is not ours
        start_ = std::chrono::steady_clock::now();
    } else {
        begin_ = profiler_.takeQuery();
        glQueryCounter(begin_, GL_TIMESTAMP);
    }
}

PassScope::~PassScope() {
    if (timed_) {
        Profiler::Pending pending;
        pending.name = std::move(name_);
        if (begin_) {
            pending.begin = begin_;
            pending.end = profiler_.takeQuery();
            glQueryCounter(pending.end, GL_TIMESTAMP);
        } else {
            glFinish();
            const std::chrono::duration<double, std::milli> elapsed =
                std::chrono::steady_clock::now() - start_;
            pending.ms = elapsed.count();
        }
        profiler_.pending_.push_back(std::move(pending));
    }
    glPopDebugGroup();
}

}  // namespace mv::gl
