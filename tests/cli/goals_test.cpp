// What people come for, as docs/viewer.md tells them to do it.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/process.h"

namespace mv::test {
namespace {

// The scripts below "Three goals", in order.
std::vector<std::string> goals() {
    std::ifstream page(MEGAVIEWS_SOURCE_DIR "/docs/viewer.md");
    std::vector<std::string> scripts;
    bool below = false, inside = false;
    for (std::string line; std::getline(page, line);) {
        below = below || line.starts_with("Three goals");
        if (below && line.starts_with("```") && std::exchange(inside, !inside)) break;
        if (inside && !line.starts_with("```") && !line.starts_with("#")) scripts.push_back(line);
    }
    return scripts;
}

int actionsIn(const std::string& script) {
    int count = 0;
    std::istringstream parts(script);
    for (std::string part; std::getline(parts, part, ';');) {
        count += part.find("wait") == std::string::npos;
    }
    return count;
}

ProcessResult perform(const Sandbox& sandbox, const std::string& script,
                      const std::string& size = "720x420") {
    return sandbox.megaviews({"builtin:cornell", "--headless", "--ui", "--resolution", size,
                              "--vpls", "64", "--view-res", "8", "--scene-depth", "6",
                              "--accumulate", "2", "--gather-samples", "2", "--no-cache",
                              "--actions", script});
}

TEST(Goals, AreReachedAsTheManualSays) {
    const auto scripts = goals();
    ASSERT_EQ(scripts.size(), 3u);
    for (const std::string& script : scripts) EXPECT_LE(actionsIn(script), 10) << script;
    const Sandbox sandbox;

    const ProcessResult researcher = perform(sandbox, scripts[0], "240x160");
    MV_SKIP_WITHOUT_GL(researcher);
    ASSERT_EQ(researcher.code, 0) << researcher.err;
    const auto numbers = nlohmann::json::parse(sandbox.text("megaviews-1.json"));
    EXPECT_EQ(numbers["frames"]["measured"], 32);
    EXPECT_EQ(numbers["methods"].size(), 2u);
    EXPECT_GT(numbers["methods"][1]["ms"]["traverse"]["median"], 0);
    ASSERT_GE(numbers["errors"].size(), 3u) << "against each other, and each against exact light";
    for (std::size_t i = 1; i < 3; ++i) {
        EXPECT_NE(numbers["errors"][i]["against"].get<std::string>().find("kept"),
                  std::string::npos);
        EXPECT_GT(numbers["errors"][i]["values"]["relMSE"], 0) << i;
    }

    const ProcessResult student = perform(sandbox, scripts[1], "560x340");
    ASSERT_EQ(student.code, 0) << student.err;
    for (const char* file : {"sharing.png", "pair.png"}) {
        EXPECT_GT(std::filesystem::file_size(sandbox.file(file)), 10000u) << file;
    }

    const ProcessResult made =
        sandbox.megaviews(smallPicture({"--save-scene", "scene.glb", "-o", "before.png"}));
    ASSERT_EQ(made.code, 0) << made.err;
    const ProcessResult engineer = perform(sandbox, scripts[2]);
    ASSERT_EQ(engineer.code, 0) << engineer.err;
    EXPECT_GT(std::filesystem::file_size(sandbox.file("picture.png")), 10000u);
}

}  // namespace
}  // namespace mv::test
