#include "app/viewer/tour.h"

#include <array>

#include "megaviews/core/error.h"

namespace mv {
namespace {

struct Step {
    const char *title, *text, *script;
    const char* withView = nullptr;  // what follows once a view is picked: the first of the list
};

// Each script starts from a window without instruments, whatever step was shown before.
constexpr std::array<Step, 5> kSteps = {{
    {"1 of 5: views",
     "Light leaves the lamp and is stopped by surfaces. Each point where it arrives lights the "
     "rest "
     "of the scene: a virtual point light. What it can see has to be known, so each one is a view "
     "of the whole scene. The lines are the views, along their normals.",
     "views; pick-a=none; pick-b=none; show-views=on; wait 2"},
    {"2 of 5: one map a view",
     "This is what one view sees: a depth map of both half spaces, 16 texels wide, coloured by how "
     "coarse the scene's octree was taken. Thousands of such maps are made anew in every frame; a "
     "surface is lit by a view if the map says that nothing stands between.",
     "views; show-views=off; pick-b=none; wait 3", "wait 2"},
    {"3 of 5: why neighbours share",
     "Views that lie together see the far parts of the scene alike. MegaViews groups them in a "
     "hierarchy of views and renders what is far once for the group: green here, with the shares "
     "below the maps. Only what is near is rendered for each.",
     "views; show-views=off; wait 3", "wait 3; click @views.nearest; wait 2; view=shared"},
    {"4 of 5: culling thins the gather",
     "No pixel asks all views. The hierarchy is cut once for each tile of pixels: groups that lie "
     "behind the surface or cannot light it go. The colours say how many views are left for a "
     "pixel to draw its samples from.",
     "view=candidates; pick-a=none; pick-b=none; wait 2"},
    {"5 of 5: what the error is",
     "Left is this picture, right the same views with exact visibility, gathered one by one. The "
     "panel measures one against the other. What differs is what maps, sharing and sampling cost.",
     "errors; compare=exact; wait 2"},
}};

}  // namespace

Tour::Tour(Session& session, Host& host)
    : session_(session),
      host_(host),
      before_(session.stateAsAsked()),
      instrumentBefore_(session.model().instrument) {
    begin();
}

void Tour::begin() {
    const std::string home =
        step_ == 0 ? "open builtin:atrium; wait-loading; reset-all-settings; vpls=4K; "
                   : "compare=off; view=final; ";
    session_.showInstrument({});
    viewPicked_ = kSteps[step_].withView == nullptr;
    run(home + kSteps[step_].script);
}

void Tour::run(const std::string& commands) {
    script_ = std::make_unique<ScriptRunner>(script::parse(commands, "tour"), session_, host_);
}

void Tour::pickView() {
    viewPicked_ = true;
    auto& picked = session_.editSettings().inspect.pickA;
    const auto& rows = session_.model().views.rows;
    if (!picked && !rows.empty()) picked = rows.front().slot;
    run(kSteps[step_].withView);
}

void Tour::advance(int width, int height) {
    if (script_ && script_->done() && !viewPicked_) pickView();
    if (!script_ || script_->done()) return;
    try {
        script_->step(width, height);
    } catch (const Error&) {
        script_.reset();  // a hand closed what it needs: the step shows what it has
    }
}

void Tour::move(int steps) {
    const auto to = static_cast<std::ptrdiff_t>(step_) + steps;
    if (to < 0 || to >= static_cast<std::ptrdiff_t>(kSteps.size())) return;
    step_ = static_cast<std::size_t>(to);
    begin();
}

void Tour::restart() {
    step_ = 0;
    begin();
}

void Tour::leave() {
    session_.showInstrument(instrumentBefore_);
    session_.restore(before_);
}

ui::TourStep Tour::shown() const {
    return {kSteps[step_].title, kSteps[step_].text, step_ > 0, step_ + 1 < kSteps.size()};
}

}  // namespace mv
