#include "renderer/gl/pass_scope.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "megaviews/settings/statistics_table.h"
#include "renderer/gl/context.h"
#include "renderer/gl/workarounds.h"

namespace mv::gl {
namespace {

constexpr std::size_t kMostFramesUnderWay = 8;  // of timestamps that nobody has taken

}  // namespace

Profiler::Profiler(Results results)
    : results_(results), wallClock_(results == Results::waited && isOn(Workaround::wallClock)) {}

Profiler::~Profiler() {
    underWay_.push_back(std::move(open_));
    for (const Frame& frame : underWay_) discard(frame);
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

bool Profiler::arrived(const Frame& frame) {
    return std::all_of(frame.begin(), frame.end(), [](const Scope& scope) {
        GLint there = GL_TRUE;
        if (scope.end) glGetQueryObjectiv(scope.end, GL_QUERY_RESULT_AVAILABLE, &there);
        return there == GL_TRUE;
    });
}

void Profiler::read(Frame& frame) {
    for (Scope& scope : frame) {
        if (!scope.begin) continue;
        if (results_ == Results::waited) {
            countWait("timestamp", std::string(infoOf(scope.stage).name));
        }
        GLuint64 begin = 0, end = 0;
        glGetQueryObjectui64v(scope.begin, GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(scope.end, GL_QUERY_RESULT, &end);
        scope.ms = end > begin ? static_cast<double>(end - begin) * 1e-6 : 0.0;
        freeQueries_.insert(freeQueries_.end(), {scope.begin, scope.end});
        scope.begin = scope.end = 0;
    }
}

void Profiler::discard(const Frame& frame) {
    for (const Scope& scope : frame) {
        if (scope.begin) freeQueries_.insert(freeQueries_.end(), {scope.begin, scope.end});
    }
}

void Profiler::discardOpen() { discard(std::exchange(open_, {})); }

bool Profiler::endFrame() {
    underWay_.push_back(std::exchange(open_, {}));
    while (underWay_.size() > kMostFramesUnderWay) {
        discard(underWay_.front());
        underWay_.pop_front();
    }
    bool found = false;
    while (!underWay_.empty() && (results_ == Results::waited || arrived(underWay_.front()))) {
        read_ = std::move(underWay_.front());
        underWay_.pop_front();
        read(read_);
        found = true;
    }
    return found;
}

void Profiler::add(const Scope& scope, std::vector<StageTime>& stages) {
    const auto same = std::find_if(stages.begin(), stages.end(),
                                   [&](const StageTime& s) { return s.stage == scope.stage; });
    if (same == stages.end()) {
        stages.push_back({scope.stage, scope.ms});
    } else {
        same->ms += scope.ms;
    }
}

std::vector<StageTime> Profiler::stages(int ofOwner) const {
    std::vector<StageTime> out;
    for (const Scope& scope : read_) {
        if (scope.owner == ofOwner) add(scope, out);
    }
    return out;
}

std::vector<StageTime> Profiler::take() {
    if (results_ == Results::late) return {};
    Frame frame = std::exchange(open_, {});
    read(frame);
    std::vector<StageTime> out;
    for (const Scope& scope : frame) add(scope, out);
    return out;
}

void Profiler::report(Stage stage, double done) {
    if (!watch_) return;
    countWait("watch", std::string(infoOf(stage).name));
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    watch_(stage, done);
    watchMs_ +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

WatchScope::WatchScope(Profiler& profiler, const Watch& watch)
    : profiler_(profiler), exceptions_(std::uncaught_exceptions()) {
    profiler_.watch_ = watch;
    profiler_.watchMs_ = 0;
}

WatchScope::~WatchScope() {
    if (std::uncaught_exceptions() > exceptions_) profiler_.discardOpen();
    profiler_.watch_ = {};
}

PassScope::PassScope(Profiler& profiler, Stage stage)
    : profiler_(profiler), stage_(stage), timed_(profiler.enabled) {
    throwErrorWhereAsserted();
    profiler.report(stage, 0);
    const std::string_view name = infoOf(stage).name;
    outerPass_ = namePass(std::string(name));
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(name.size()),
                     name.data());
    if (!timed_) return;
    if (profiler_.wallClock_) {
        finish();  // what was issued before is not ours
        start_ = std::chrono::steady_clock::now();
        watchMs_ = profiler.watchMs_;
    } else {
        begin_ = profiler_.takeQuery();
        glQueryCounter(begin_, GL_TIMESTAMP);
    }
}

PassScope::~PassScope() {
    if (timed_) {
        Profiler::Scope scope{stage_, profiler_.owner_, begin_, 0, 0};
        if (begin_) {
            scope.end = profiler_.takeQuery();
            glQueryCounter(scope.end, GL_TIMESTAMP);
        } else {
            finish();
            const std::chrono::duration<double, std::milli> elapsed =
                std::chrono::steady_clock::now() - start_;
            scope.ms = elapsed.count() - (profiler_.watchMs_ - watchMs_);
        }
        profiler_.open_.push_back(scope);
    }
    glPopDebugGroup();
    namePass(std::move(outerPass_));
}

void PassScope::finish() const {
    countWait("clock", std::string(infoOf(stage_).name));
    glFinish();
}

}  // namespace mv::gl
