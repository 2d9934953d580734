// The whole interface drawn offscreen at the sizes and scales it is made for. The pictures are left
// in the build folder, for eyes.

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <imgui_impl_opengl3.h>
#include <stb_image_write.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/gl/texture.h"
#include "screen.h"

namespace mv::ui {
namespace {

struct Case {
    const char* name;
    int width, height;
    float scale;
    std::function<void(Screen&)> prepare;
};

void compare(Screen& s) {
    compareWith(s.settings, Method::manylods);
    s.settings.display.split = 0.55;
    s.statistics.methods.push_back(s.statistics.methods[0]);
    MethodStatistics& right = s.statistics.methods[1];
    for (PairCounts& p : right.pairsPerLevel) {
        p.processed *= 3;
        p.culled *= 2;
        p.rendered *= 3;
        p.subdivided *= 4;
    }
    right.stages[0].ms *= 3.5;
    for (auto& o : right.occupancy) o *= 3;
    right.pairs.processed *= 3;
}

std::vector<Float3> ramp() {
    std::vector<Float3> colours;
    for (int i = 0; i < 16; ++i) {
        const float t = static_cast<float>(i) / 15;
        colours.push_back({0.27f + 0.72f * t * t, 0.9f * t, 0.33f + 0.4f * t * (1 - t)});
    }
    return colours;
}

std::vector<Case> cases() {
    std::vector<Case> out;
    const auto add = [&](const char* name, int w, int h, float scale, auto prepare) {
        out.push_back({name, w, h, scale, prepare});
    };
    const auto none = [](Screen&) {};
    add("default-1280", 1280, 720, 1, none);
    add("default-1000", 1000, 600, 1, none);
    add("default-1.5", 1280, 720, 1.5f, none);
    add("default-2", 1280, 720, 2, none);
    add("default-2560", 2560, 1440, 1, none);
    add("default-2560-2", 2560, 1440, 2, none);
    add("compare", 1280, 720, 1, compare);
    add("difference", 1280, 720, 1, [](Screen& s) {
        compare(s);
        s.settings.display.difference = Difference::absolute;
        s.model.difference =
            Legend{"Right minus left, absolute", "radiance", 0, 0.125, false, ramp(), {}};
    });
    static constexpr Instrument kAll[] = {
        Instrument::profiler, Instrument::traversal, Instrument::memory, Instrument::views,
        Instrument::pixel,    Instrument::steps,     Instrument::errors};
    static constexpr const char* kNames[] = {"profiler", "traversal", "memory", "views",
                                             "pixel",    "steps",     "errors"};
    for (std::size_t i = 0; i < 7; ++i) {
        add(kNames[i], 1280, 720, 1, [i](Screen& s) {
            compare(s);
            s.model.instrument = kAll[i];
            s.settings.inspect.pickA = 1204;
            s.settings.inspect.pickB = 2551;
            s.settings.inspect.step = i == 5 ? 6 : 0;
        });
    }
    add("views-1000", 1000, 600, 1, [](Screen& s) { s.model.instrument = Instrument::views; });
    add("profiler-1.5", 1280, 720, 1.5f,
        [](Screen& s) { s.model.instrument = Instrument::profiler; });
    add("traversal-2560-1.5", 2560, 1440, 1.5f, [](Screen& s) {
        compare(s);
        s.model.instrument = Instrument::traversal;
    });
    add("loading", 1280, 720, 1, [](Screen& s) {
        s.model.loadingStage = "building the octree";
        s.model.loadingFraction = 0.43f;
        s.model.toasts = {{"picture written: /home/user/megaviews-12.png"}, {"shaders reloaded"}};
        s.model.legends = {
            {"Views that share a pair", "views", 1, 512, true, ramp(), {}},
            {"Pairs",
             "",
             0,
             0,
             false,
             {},
             {{"rendered", {0.3f, 0.7f, 0.9f}, 5100}, {"culled", {0.5f, 0.5f, 0.55f}, 4200}}}};
        s.model.shaderErrors = {
            "shaders/passes/gather.frag:42: 'irradiance' : undeclared identifier"};
    });
    add("all-1000", 1000, 600, 1, [](Screen& s) {
        compare(s);
        s.model.instrument = Instrument::profiler;
        s.model.toasts = {{"picture written: /home/somebody/megaviews-1.png"}, {"short"}};
        s.model.shaderErrors = {"shaders/passes/gather.frag:12: undeclared"};
        s.model.legends = {{"Views that share a pair", "views", 1, 512, true, ramp(), {}}};
    });
    add("error", 1000, 600, 1, [](Screen& s) {
        s.model.error = "The scene cannot be read: /scene/nodes/3/mesh is 12, of 4 meshes.";
        s.model.errorHint = "The scene shown before is kept. Check the file with a validator.";
    });
    add("help", 1280, 720, 1, [](Screen& s) { s.model.help = true; });
    add("help-search", 1000, 600, 1, [](Screen& s) {
        s.model.help = true;
        s.frame(3);
        s.type("step");
    });
    add("browser", 1280, 720, 1, [](Screen& s) {
        s.model.browse = Browse::open;
        s.model.browseFolder = MEGAVIEWS_SOURCE_DIR "/tests";
    });
    add("menu", 1280, 720, 1, [](Screen& s) {
        s.frame(2);
        s.click("menu:Animation");
        s.point("menu:File");
    });
    add("tooltip", 1280, 720, 1, [](Screen& s) {
        s.frame(2);
        s.point("vpls");
    });
    add("groups", 1280, 1400, 1, [](Screen& s) {
        s.settings.display.exposureEv = 0.5;
        s.frame(2);
        for (const char* group :
             {"Instruments", "Picture", "Gather", "Views", "Method", "Scene", "Lights"}) {
            s.click(std::string("group:") + group);
        }
    });
    return out;
}

class Offscreen {
  public:
    Offscreen(int width, int height) : texture_("ui", GL_TEXTURE_2D, GL_RGBA8, width, height) {
        framebuffer_ = gl::Framebuffer("ui", {&texture_});
        ImGui_ImplOpenGL3_Init("#version 450 core");
        ImGui_ImplOpenGL3_NewFrame();
    }
    ~Offscreen() { ImGui_ImplOpenGL3_Shutdown(); }

    // Top row first.
    std::vector<std::uint8_t> draw() {
        framebuffer_.bind();
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0.33f, 0.36f, 0.34f, 1);  // where the picture would be
        glClear(GL_COLOR_BUFFER_BIT);
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
        const auto bottomUp = texture_.readBytes(4);
        std::vector<std::uint8_t> out(bottomUp.size());
        const std::size_t row = static_cast<std::size_t>(texture_.width()) * 4;
        for (std::size_t y = 0; y * row < out.size(); ++y) {
            std::copy_n(bottomUp.end() - static_cast<std::ptrdiff_t>((y + 1) * row), row,
                        out.begin() + static_cast<std::ptrdiff_t>(y * row));
        }
        for (std::size_t i = 3; i < out.size(); i += 4) out[i] = 255;
        return out;
    }

  private:
    gl::Texture texture_;
    gl::Framebuffer framebuffer_;
};

// Something with texels to look at, as maps and the magnifier show.
gl::Texture sampleTexture() {
    gl::Texture texture("sample", GL_TEXTURE_2D, GL_RGBA8, 64, 32);
    std::vector<std::uint8_t> bytes;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            const int dx = x % 32 - 16, dy = y - 16;
            const bool inside = dx * dx + dy * dy < 256;
            const auto v = static_cast<std::uint8_t>((x * 7 + y * 5) % 200);
            for (const int channel : {60 + v / 2, 40 + v, 200 - v}) {
                bytes.push_back(static_cast<std::uint8_t>(channel));
            }
            bytes.push_back(inside ? 255 : 0);
        }
    }
    texture.writeBytes(4, bytes);
    texture.parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

class Pictures : public ::testing::TestWithParam<std::size_t> {
  protected:
    void SetUp() override {
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
        } catch (const Error& e) {
            GTEST_SKIP() << e.what();
        }
    }
    std::unique_ptr<gl::HeadlessContext> context_;
};

TEST_P(Pictures, AreDrawnWithoutErrors) {
    const Case one = cases()[GetParam()];
    Screen screen(one.width, one.height, one.scale);
    Offscreen offscreen(one.width, one.height);
    const gl::Texture sample = sampleTexture();
    const auto id = reinterpret_cast<void*>(static_cast<std::uintptr_t>(sample.id()));
    screen.model.pixel.magnified = {id, sample.width(), sample.height(), true};
    for (auto* picked : {&screen.model.views.a, &screen.model.views.b}) {
        for (MapPicture& map : (*picked)->maps) map.picture.texture = id;
    }
    for (auto* p : {&screen.model.pixel.hover, &screen.model.pixel.picked}) {
        (*p)->x = 20;
        (*p)->y = 12;
    }
    one.prepare(screen);
    for (int i = 0; i < 300; ++i) {
        FrameStatistics s = screen.statistics;
        s.frameMs *= 0.9 + 0.1 * std::sin(i * 0.3) + (i % 41 == 0 ? 0.4 : 0);
        for (StageTime& stage : s.stagesOfBothSides) stage.ms *= 1 + 0.1 * std::sin(i * 0.7);
        screen.panels.addFrame(s, {}, false);
    }
    screen.model.budgetMs = 400;
    screen.frame(4);
    const auto pixels = offscreen.draw();
    const std::string folder = MEGAVIEWS_BINARY_DIR "/ui_pictures/";
    std::filesystem::create_directories(folder);
    ASSERT_TRUE(stbi_write_png((folder + one.name + ".png").c_str(), one.width, one.height, 4,
                               pixels.data(), one.width * 4));
    EXPECT_EQ(gl::reportedErrors(), 0u);
    // Text, panels and picture: many colours, none of them everywhere.
    std::set<std::uint32_t> colours;
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
        colours.insert(
            static_cast<std::uint32_t>(pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2]));
    }
    EXPECT_GT(colours.size(), 100u);
    EXPECT_EQ(screen.panels.clippedTexts(), std::vector<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(Ui, Pictures, ::testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& one) {
                             std::string name = cases()[one.param].name;
                             std::replace_if(
                                 name.begin(), name.end(),
                                 [](char c) { return c == '-' || c == '.'; }, '_');
                             return name;
                         });

}  // namespace
}  // namespace mv::ui
