// Time, camera and lights of the scene: sections of the controls.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

std::string speedText(double speed) {
    return speed >= 1 ? fixedText(speed, 0) + " x" : "1/" + fixedText(1 / speed, 0) + " x";
}

// One of the scene's parts by name: `of` are their names, `empty` says what no choice means, and
// `also` is a further word that the setting takes, or null.
void partChoice(Context& c, const std::string& key, std::string& chosen,
                const std::vector<std::string>& of, const char* empty, const char* also) {
    const SettingInfo& setting = *findSetting(key);
    const std::string title(setting.label);
    rowLabel(c, title.c_str(), !chosen.empty());
    const float width = rowFieldWidth();
    std::string shown = chosen.empty() ? empty : chosen;
    for (std::size_t i = 0; i < of.size(); ++i) {
        if (chosen == std::to_string(i) && !of[i].empty()) shown = of[i];
    }
    if (beginCombo(c, ("##" + key).c_str(), shown, width)) {
        const auto entry = [&](const std::string& value, const char* name) {
            if (ImGui::Selectable(name, value == chosen)) chosen = value;
            c.named(key + "=" + value);
        };
        entry("", empty);
        for (std::size_t i = 0; i < of.size(); ++i) {
            // Names may be missing or alike; numbers are neither.
            ImGui::PushID(static_cast<int>(i));
            const std::string& name = of[i];
            entry(std::to_string(i), name.empty() ? std::to_string(i).c_str() : name.c_str());
            ImGui::PopID();
        }
        if (also) entry(also, also);
        ImGui::EndCombo();
    }
    c.named(key + "-choice");
    tooltip(title.c_str(), settingTooltip(c, setting));
}

}  // namespace

void transport(Context& c) {
    Model& m = c.model;
    SceneSettings& scene = c.settings.scene;
    if (!m.variants.empty()) {
        partChoice(c, "variant", scene.variant, m.variants, "the file's own", nullptr);
    }
    if (m.animations.size() > 1) {
        partChoice(c, "animation", scene.animation, m.animations, "all, or the first", "none");
    }
    if (m.animationS <= 0) {
        rowLabel(c, "Animation");
        ImGui::AlignTextToFramePadding();
        elidedText("nothing moves here", rowFieldWidth(), palette::kFaint);
        return;
    }
    const float gap = c.px(3), whole = ImGui::GetContentRegionAvail().x;
    const float speedWidth = ImGui::CalcTextSize("1/16 x").x + c.px(6);
    const float one = (whole - speedWidth - 6 * gap) / 6;
    const auto control = [&](Action action, Icon icon, bool on = false) {
        const ActionInfo& info = infoOf(action);
        const std::string help = std::string(info.name) +
                                 (info.key.empty() ? "" : "   (" + std::string(info.key) + ")") +
                                 "\n" + std::string(info.help);
        if (iconButton(c, idOf(info), icon, one, help, on)) c.act(action);
        ImGui::SameLine(0, gap);
    };
    control(Action::restart, Icon::toStart);
    control(Action::stepBackward, Icon::backward);
    control(Action::playPause, m.playing ? Icon::pause : Icon::play, m.playing);
    control(Action::stepForward, Icon::forward);
    control(Action::slower, Icon::slower);
    control(Action::faster, Icon::faster);
    ImGui::AlignTextToFramePadding();
    rightText(c, speedText(m.speed), palette::kDim);
    c.named("speed");
    tooltip("Speed of the animation");

    float time = static_cast<float>(m.timeS);
    const std::string format = "%.2f / " + fixedText(m.animationS, 2) + " s";
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##time", &time, 0, static_cast<float>(m.animationS), format.c_str(),
                           ImGuiSliderFlags_AlwaysClamp)) {
        m.timeS = static_cast<double>(time);
        c.requests.timeChanged = true;
    }
    c.named("scrub");
    tooltip("Time", "Drag to any moment of the animation.");
}

void cameraControls(Context& c) {
    rowLabel(c, "Camera", !c.settings.camera.name.empty());
    const auto& names = c.model.cameras;
    const std::optional<std::size_t> current = c.model.sceneCamera;
    const std::string shown = !current                  ? "free"
                              : names[*current].empty() ? std::to_string(*current)
                                                        : names[*current];
    const float width = rowFieldWidth(), fit = c.px(38), gap = c.px(4);
    const float combo = width - fit - gap;
    if (beginCombo(c, "##camera", shown, combo)) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            // Names may be missing or alike; numbers are neither.
            const auto first = std::find(names.begin(), names.end(), names[i]) - names.begin();
            const bool named = !names[i].empty() && first == static_cast<std::ptrdiff_t>(i);
            const std::string name = named ? names[i] : std::to_string(i);
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Selectable(names[i].empty() ? name.c_str() : names[i].c_str(),
                                  current == i)) {
                c.settings.camera.name = name;
            }
            c.named("camera=" + name);
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    c.named("camera");
    tooltip("Camera", settingTooltip(c, *findSetting("camera")));
    ImGui::SameLine(0, gap);
    actionButton(c, Action::frameScene, "Fit", fit);

    // Bookmarks: a click goes there, Ctrl+click remembers.
    rowLabel(c, "Bookmarks");
    const float each = (rowFieldWidth() - 8 * c.px(2)) / 9;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, std::round(c.px(kFramePaddingY))});
    for (int i = 0; i < 9; ++i) {
        if (i > 0) ImGui::SameLine(0, c.px(2));
        const bool stored = c.model.bookmarks[static_cast<std::size_t>(i)];
        const std::string number = std::to_string(i + 1);
        if (!stored) ImGui::PushStyleColor(ImGuiCol_Text, palette::kFaint);
        if (toggleButton(c, "bookmark-" + number, number.c_str(), stored, each)) {
            const bool store = ImGui::GetIO().KeyCtrl || !stored;
            const Action first = store ? Action::storeBookmark1 : Action::recallBookmark1;
            c.act(static_cast<Action>(static_cast<int>(first) + i));
        }
        if (!stored) ImGui::PopStyleColor();
        tooltip("Bookmark " + number,
                stored ? "A click goes to this camera, Ctrl+click stores the present one."
                       : "Empty: a click stores the present camera.");
    }
    ImGui::PopStyleVar();
}

namespace {

struct EnvironmentChoice {
    const char *source, *title;
};
constexpr EnvironmentChoice kEnvironments[] = {
    {"auto", "as the scene needs"}, {"none", "none"}, {"sky", "sky"}, {"white", "white"}};

}  // namespace

void environmentControls(Context& c) {
    EnvironmentSettings& environment = c.settings.scene.environment;
    const std::string file = environmentFile(environment);
    rowLabel(c, "Sky", environment.source != "auto");
    std::string shown = file;
    for (const EnvironmentChoice& choice : kEnvironments) {
        if (environment.source == choice.source) shown = choice.title;
    }
    if (!file.empty()) shown = std::filesystem::path(file).filename().string();
    if (beginCombo(c, "##environment", shown, rowFieldWidth())) {
        for (const EnvironmentChoice& choice : kEnvironments) {
            if (ImGui::Selectable(choice.title, environment.source == choice.source)) {
                environment.source = choice.source;
            }
            c.named(std::string("environment=") + choice.source);
        }
        if (ImGui::Selectable("an image...", !file.empty())) c.act(Action::open);
        c.named("environment=image");
        ImGui::EndCombo();
    }
    c.named("environment");
    const SettingInfo& setting = *findSetting("environment");
    ImGui::PushID("environment");
    settingMenu(c, setting);
    ImGui::PopID();
    tooltip("Sky",
            settingTooltip(c, setting) + "\nAn EXR or HDR file may also be dropped on the window.");
    if (environment.source == "none" || environment.source == "auto") return;
    if (!file.empty()) settingRow(c, "sky-rotation");
    settingRow(c, "sky-scale");
}

namespace {

// Colour and strength apart: their product is what the light gives.
void lightPower(Context& c, const LightRow& light, double brightest, const std::string& id,
                LightEdit& edit) {
    float colour[3];
    for (std::size_t i = 0; i < 3; ++i) {
        colour[i] = static_cast<float>(light.intensity[i] / brightest);
    }
    rowLabel(c, "  colour");
    ImGui::SetNextItemWidth(rowFieldWidth());
    bool edited = ImGui::ColorEdit3("##colour", colour, ImGuiColorEditFlags_Float);
    c.named(id + ".colour");
    tooltip("Colour", "Of the light, linear; its brightest channel counts as 1.");
    rowLabel(c, "  intensity");
    ImGui::SetNextItemWidth(rowFieldWidth());
    double strength = brightest;
    const double least = 1e-6, most = 1e9;
    edited |= ImGui::DragScalar("##intensity", ImGuiDataType_Double, &strength,
                                static_cast<float>(brightest * 0.01), &least, &most,
                                light.kind == "directional" ? "%.4g W/m²" : "%.4g W/sr",
                                ImGuiSliderFlags_AlwaysClamp);
    c.named(id + ".intensity");
    tooltip("Intensity", "Of the brightest channel. Drag, or double-click to type it.");
    if (!edited) return;
    const float top = std::max({colour[0], colour[1], colour[2], 1e-6f});
    edit.intensity.emplace();
    for (std::size_t i = 0; i < 3; ++i) {
        (*edit.intensity)[i] = strength * static_cast<double>(std::max(colour[i], 0.0f) / top);
    }
}

void lightCone(Context& c, const LightRow& light, const std::string& id, LightEdit& edit) {
    std::array<double, 2> cone = light.cone;
    const double least = 0, most = 90;
    rowLabel(c, "  cone");
    ImGui::SetNextItemWidth(rowFieldWidth());
    const bool edited = ImGui::DragScalarN("##cone", ImGuiDataType_Double, cone.data(), 2, 0.2f,
                                           &least, &most, "%.1f°", ImGuiSliderFlags_AlwaysClamp);
    c.named(id + ".cone");
    tooltip("Cone", "Half angles within which the spot has its full light, and where it ends.");
    if (!edited) return;
    if (cone[0] != light.cone[0]) cone[1] = std::max(cone[0], cone[1]);
    cone[0] = std::min(cone[0], cone[1]);
    edit.cone = cone;
}

}  // namespace

void lightControls(Context& c) {
    if (c.model.lights.empty()) return;
    const std::string title =
        "Lights (" + withThousands(std::uint64_t{c.model.lights.size()}) + ")";
    const bool open = groupHeader(c, title);
    c.named("group:Lights");
    c.model.lightsOpen = open;
    if (!open) return;
    for (std::size_t i = 0; i < c.model.lights.size(); ++i) {
        const LightRow& light = c.model.lights[i];
        const std::string id = "light." + std::to_string(i);
        ImGui::PushID(static_cast<int>(i));
        LightEdit edit;
        edit.light = i;
        rowLabel(c, light.name.empty() ? "light" : light.name, light.edited);
        const double brightest = *std::max_element(light.intensity.begin(), light.intensity.end());
        bool on = brightest > 0;
        if (ImGui::Checkbox("##on", &on)) edit.on = on;
        c.named(id + ".on");
        tooltip("On", "Puts the light out; on again, it is as bright as the scene has it.");
        ImGui::SameLine();
        ImGui::AlignTextToFramePadding();
        text(c, light.kind, palette::kDim);
        if (light.edited) {
            ImGui::SameLine();
            edit.reset = button(c, id + ".reset", "Reset");
            tooltip("Takes the light back to where the scene has it.");
        }
        const auto vector = [&](const char* label, const char* part, std::array<double, 3> value,
                                std::optional<std::array<double, 3>>& into, double step,
                                const char* help) {
            rowLabel(c, label);
            // What is nothing beside the rest is 0: an exponent would not fit.
            const auto size = [](double v) { return std::abs(v); };
            const double largest = std::max({size(value[0]), size(value[1]), size(value[2])});
            for (double& v : value) {
                if (size(v) < 1e-6 * largest) v = 0;
            }
            ImGui::SetNextItemWidth(rowFieldWidth());
            if (ImGui::DragScalarN(part, ImGuiDataType_Double, value.data(), 3,
                                   static_cast<float>(step), nullptr, nullptr, "%.3g")) {
                into = value;
            }
            c.named(id + (part + 2));
            tooltip(label, help);
        };
        if (light.hasPosition) {
            double size = 0;
            for (const double x : light.position) size = std::max(size, std::abs(x));
            vector("  position", "##.position", light.position, edit.position,
                   std::max(size * 0.01, 0.001),
                   "World units. Drag a number, or double-click to type it.");
        }
        if (light.hasDirection) {
            vector("  direction", "##.direction", light.direction, edit.direction, 0.01,
                   "Where the light shines; its length does not matter.");
        }
        if (brightest > 0) lightPower(c, light, brightest, id, edit);
        if (light.hasCone) lightCone(c, light, id, edit);
        if (edit.position || edit.direction || edit.intensity || edit.cone || edit.on ||
            edit.reset) {
            c.requests.lights.push_back(edit);
        }
        ImGui::PopID();
    }
    ImGui::Dummy({0, c.px(4)});
}

}  // namespace mv::ui
