// What takes longer than a moment: a scene that is loaded, a picture that is made. How far it is,
// how long it still takes, and a way out.

#include <algorithm>
#include <cmath>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

constexpr double kLeastS = 1;  // what is sooner needs no word

std::string secondsText(double seconds) {
    return fixedText(std::max(std::round(seconds), 1.0), 0) + " s";
}

// A line with the share that is done, a bar, what is known of the time, and a button if it has one.
bool progressPlate(Context& c, const char* id, const std::string& stage, float done,
                   const std::string& time, const char* button, const char* help) {
    const Rect& view = c.layout.picture;
    const float width = std::min(c.px(380), view.width - c.px(40));
    beginPlate(c, id, view.x + view.width / 2, view.y + view.height / 2, {0.5f, 0.5f});
    const int percent = static_cast<int>(std::clamp(done, 0.0f, 1.0f) * 100);
    const std::string share = std::to_string(percent) + " %";
    const float left = ImGui::GetCursorPosX();
    elidedText(stage, width - c.px(60));
    ImGui::SameLine(left + width - ImGui::CalcTextSize(share.c_str()).x, 0);
    text(c, share, palette::kDim);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    bar({at.x, at.y + c.px(3), width, c.px(6)}, done, palette::kAccent);
    ImGui::Dummy({width, c.px(14)});
    const float wide = c.px(90);
    ImGui::AlignTextToFramePadding();
    text(c, time, palette::kDim);
    ImGui::SameLine(left + width - wide, 0);
    const bool pressed = button && ui::button(c, button, "Cancel", wide);
    if (button) tooltip("Cancel", help);
    endPlate(c, id);
    return pressed;
}

}  // namespace

std::string TimeLeft::after(const std::string& stage, float done) {
    const double now = ImGui::GetTime();
    if (stage != stage_ || done < begun_) {
        stage_ = stage;
        begun_ = done;
        sinceS_ = now;
    }
    const double elapsedS = now - sinceS_, made = done - begun_;
    if (elapsedS < kLeastS || made < 0.02) return {};
    return "about " + secondsText(elapsedS * (1 - done) / made) + " left";
}

void loadingOverlay(Context& c) {
    const Model& m = c.model;
    if (m.loadingStage.empty()) return;
    const std::string left = c.state.loading.after(m.loadingStage, m.loadingFraction);
    c.requests.cancelLoading |= progressPlate(c, "loading", m.loadingStage, m.loadingFraction, left,
                                              "loading.cancel", "Keeps the scene that is shown.");
}

void pictureOverlay(Context& c) {
    const Model& m = c.model;
    if (!m.loadingStage.empty()) return;
    const Rect& view = c.layout.picture;
    const float x = view.x + view.width / 2, y = view.y + view.height / 2;
    if (m.work) {
        if (m.work->elapsedS < kLeastS / 2) return;
        const double left = m.work->wholeS - m.work->elapsedS;
        const std::string time = left > 0 ? "up to " + secondsText(left) + " left"
                                          : secondsText(m.work->elapsedS) + " so far";
        const std::string what = m.work->draft ? "a draft: " : "the whole picture: ";
        c.requests.cancelPicture |= progressPlate(
            c, "work", what + m.work->stage, m.work->done,
            m.work->draft ? time + "; Esc takes the change back" : time,
            m.work->draft ? nullptr : "work.cancel", "Keeps the draft. Esc does the same.");
    } else if (m.settled && m.draft) {
        beginPlate(c, "settled", x, view.bottom() - c.px(12), {0.5f, 1});
        ImGui::AlignTextToFramePadding();
        text(c, "a draft; the whole picture was given up", palette::kNotice);
        ImGui::SameLine();
        if (button(c, "work.whole", "Make it", c.px(76))) c.requests.wholePicture = true;
        endPlate(c, "settled");
    } else if (m.foreseenS >= kLeastS) {
        beginPlate(c, "foreseen", x, y, {0.5f, 0.5f}, ImGuiWindowFlags_NoInputs);
        text(c, "the whole picture follows, in up to " + secondsText(m.foreseenS),
             palette::kNotice);
        endPlate(c, "foreseen");
    }
}

}  // namespace mv::ui
