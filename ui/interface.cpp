#include "ui/interface.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "megaviews/core/error.h"
#include "ui/context.h"
#include "ui/panels.h"
#include "ui/style.h"

namespace mv::ui {

struct Interface::State : PanelState {};

Interface::Interface() : state_(std::make_unique<State>()) {}
Interface::~Interface() = default;

void Interface::addFrame(const FrameStatistics& statistics, const Settings& made, bool draft) {
    if (!state_->frozen) state_->history.add(statistics, {made, draft});
}

void Interface::forgetFrames() { state_->history.clear(); }

void Interface::freezeFrames(bool frozen) { state_->frozen = frozen; }

const std::vector<ItemRect>& Interface::itemRects() const { return state_->drawn.items; }

std::optional<ItemRect> Interface::findItem(std::string_view name) const {
    const auto& items = state_->drawn.items;
    const auto it = std::find_if(items.rbegin(), items.rend(),
                                 [&](const ItemRect& item) { return item.name == name; });
    return it == items.rend() ? std::nullopt : std::optional(*it);
}

const std::vector<Figure>& Interface::figures() const { return state_->drawn.figures; }
const std::set<char32_t>& Interface::missingCharacters() const { return state_->drawn.missing; }

const std::vector<std::string>& Interface::clippedTexts() const { return state_->drawn.clipped; }

const std::vector<std::string>& Interface::outOfReach() const { return state_->drawn.outOfReach; }

float fittingScale(int windowWidth, int windowHeight, float scale) {
    constexpr float kLeastWidth = 640, kLeastHeight = 360;  // at scale 1
    const float most = std::min(static_cast<float>(windowWidth) / kLeastWidth,
                                static_cast<float>(windowHeight) / kLeastHeight);
    // In steps: each is a font of its own.
    return std::min(scale, std::max(std::floor(8 * most) / 8, 1.0f));
}

Viewport pictureViewport(int windowWidth, int windowHeight, float scale, const Model& model) {
    const Rect r =
        layoutOf(static_cast<float>(windowWidth), static_cast<float>(windowHeight), scale, model)
            .picture;
    const auto whole = [](float v) { return static_cast<int>(std::lround(v)); };
    return {whole(r.x), whole(r.y), std::max(whole(r.width), 1), std::max(whole(r.height), 1)};
}

Requests Interface::draw(Settings& settings, Model& model, const FrameStatistics& statistics,
                         int windowWidth, int windowHeight, float scale) {
    Requests requests;
    state_->drawn = {};
    state_->plates.clear();
    const Settings before = settings;
    Context c{
        settings,
        model,
        statistics,
        requests,
        *state_,
        layoutOf(static_cast<float>(windowWidth), static_cast<float>(windowHeight), scale, model),
        scale};
    noteTyped(c);
    c.named("panel:picture", c.layout.picture);
    if (!model.hidden) {
        splitOverlay(c);
        lightHandles(c);
        legendOverlay(c);
        outsideHint(c);
        if (c.layout.controlsShown) controlsPanel(c);
        if (model.instrument) dock(c);
        statusBar(c);
        menuBar(c);  // last: what its menus name lies above everything
    }
    tour(c);
    pictureOverlay(c);
    shaderErrors(c);
    loadingOverlay(c);
    toasts(c);
    helpOverlay(c);
    browserDialog(c);
    commandPalette(c);
    aboutScene(c);
    startPage(c);
    errorDialog(c);
    noteMissing(c);

    // A combination that contradicts itself is not taken over; why is said in passing.
    if (!(settings == before)) {
        try {
            validate(settings);
        } catch (const Error& error) {
            settings = before;
            model.toasts.push_back({error.what()});
        }
    }
    return requests;
}

// ---------------------------------------------------------------- windows

bool beginFixed(Context& c, const char* id, const Rect& rect, ImGuiWindowFlags flags) {
    ImGui::SetNextWindowPos({rect.x, rect.y});
    ImGui::SetNextWindowSize({rect.width, rect.height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    const bool open = ImGui::Begin(id, nullptr, kFixedWindow | flags);
    ImGui::PopStyleVar(3);
    c.named("panel:" + std::string(id), rect);
    return open;
}

void endFixed() { ImGui::End(); }

bool beginPlate(Context& c, const char* id, float x, float y, ImVec2 pivot,
                ImGuiWindowFlags flags) {
    if (const ImGuiWindow* last = ImGui::FindWindowByName(id)) {
        const ImVec2 size = last->Size;
        Rect rect{x - pivot.x * size.x, y - pivot.y * size.y, size.x, size.y};
        const float gap = c.px(6);
        const bool stays = last->WasActive && !(flags & ImGuiWindowFlags_NoInputs) &&
                           last->Rect().Contains(ImGui::GetMousePos());
        const auto inTheWay = [&](const Rect& r) {
            return r.x < rect.right() && rect.x < r.right() && r.y < rect.bottom() &&
                   rect.y < r.bottom();
        };
        if (stays) rect.y = last->Pos.y;
        for (std::size_t moves = 0; !stays && moves <= c.state.plates.size(); ++moves) {
            const auto it = std::find_if(c.state.plates.begin(), c.state.plates.end(), inTheWay);
            if (it == c.state.plates.end()) break;
            rect.y = pivot.y > 0.75f ? it->y - gap - size.y : it->bottom() + gap;
        }
        const Rect& view = c.layout.picture;
        rect.y = std::clamp(rect.y, view.y, std::max(view.bottom() - size.y, view.y));
        y = rect.y + pivot.y * size.y;
    }
    ImGui::SetNextWindowPos({x, y}, ImGuiCond_Always, pivot);
    // What would be higher than the picture is scrolled by the wheel.
    const ImGuiNextWindowData& next = ImGui::GetCurrentContext()->NextWindowData;
    if (!(next.Flags & ImGuiNextWindowDataFlags_HasSizeConstraint)) {
        const float most = std::max(c.layout.picture.height, 1.0f);
        ImGui::SetNextWindowSizeConstraints({0, 0}, {1e6f, most});
    }
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {c.px(10), c.px(7)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, palette::kOverlay);
    const bool open = ImGui::Begin(
        id, nullptr,
        ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
            ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
            ImGuiWindowFlags_NoBringToFrontOnFocus | flags);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
    return open;
}

void endPlate(Context& c, const char* id) {
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    c.state.plates.push_back({at.x, at.y, size.x, size.y});
    c.named("plate:" + std::string(id), c.state.plates.back());
    ImGui::End();
}

}  // namespace mv::ui
