#include "screen.h"

#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <cmath>

namespace mv::ui {
namespace {

constexpr float kFrameS = 1.0f / 60;

}  // namespace

Screen::Screen(int w, int h, float s)
    : width(w), height(h), scale(s), context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    io.DisplaySize = {static_cast<float>(w), static_cast<float>(h)};
    for (int key = 0; key < ImGuiKey_COUNT; ++key) io.KeyMap[key] = key;  // keys are their numbers
    io.MousePos = {-1, -1};
    applyStyle(s);
    fillExample(settings, model, statistics);
}

Screen::~Screen() { ImGui::DestroyContext(context_); }

void Screen::frame(int count) {
    for (int i = 0; i < count; ++i) {
        ImGuiIO& io = ImGui::GetIO();
        io.DeltaTime = kFrameS;
        ImGui::NewFrame();
        requests = panels.draw(settings, model, statistics, width, height, scale);
        ImGui::Render();
        auto& all = everRequested;
        all.actions.insert(all.actions.end(), requests.actions.begin(), requests.actions.end());
        all.lights.insert(all.lights.end(), requests.lights.begin(), requests.lights.end());
        for (const auto text : {&Requests::openFile, &Requests::loadState, &Requests::saveState,
                                &Requests::saveScene}) {
            if (!(requests.*text).empty()) all.*text = requests.*text;
        }
        for (const auto flag : {&Requests::timeChanged, &Requests::errorDismissed,
                                &Requests::cancelLoading, &Requests::clearRecent}) {
            all.*flag |= requests.*flag;
        }
    }
}

void Screen::pointAt(float x, float y) {
    ImGui::GetIO().MousePos = {x, y};
    frame(2);
}

void Screen::show(const std::string& item) {
    const auto panel = panels.findItem("panel:controls");
    ASSERT_TRUE(panel);
    pointAt(panel->centerX(), panel->centerY());
    for (int i = 0; i < 400; ++i) {
        const auto rect = panels.findItem(item);
        ASSERT_TRUE(rect) << "nothing is called " << item;
        const float from = panel->centerY() - rect->centerY();
        if (std::abs(from) < panel->height / 3) return;
        ImGui::GetIO().MouseWheel = from > 0 ? 1.0f : -1.0f;
        frame(2);
    }
}

void Screen::point(const std::string& item) {
    const auto rect = panels.findItem(item);
    ASSERT_TRUE(rect) << "nothing is called " << item;
    pointAt(rect->centerX(), rect->centerY());
}

void Screen::click(const std::string& item, int button) {
    point(item);
    ImGui::GetIO().MouseDown[button] = true;
    frame(2);
    ImGui::GetIO().MouseDown[button] = false;
    frame(2);
}

void Screen::doubleClick(const std::string& item) {
    click(item);
    click(item);
}

void Screen::drag(const std::string& item, float dx, float dy) {
    point(item);
    ImGui::GetIO().MouseDown[0] = true;
    frame(2);
    ImGui::GetIO().MousePos.x += dx;
    ImGui::GetIO().MousePos.y += dy;
    frame(2);
    ImGui::GetIO().MouseDown[0] = false;
    frame(2);
}

const ImGuiWindow* Screen::tooltip() const {
    const ImGuiWindow* window = ImGui::FindWindowByName("##Tooltip_00");
    return window && window->Active && !window->Hidden && window->Size.x > 50 ? window : nullptr;
}

void Screen::press(ImGuiKey key) {
    ImGui::GetIO().KeysDown[key] = true;
    frame(2);
    ImGui::GetIO().KeysDown[key] = false;
    frame(2);
}

void Screen::type(const std::string& text) {
    ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
    frame(2);
}

}  // namespace mv::ui
