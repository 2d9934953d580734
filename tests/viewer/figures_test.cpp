// Every number in the window is that of the saved numbers, found by the place it names.

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/viewer/panel_numbers.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

struct Shown {
    double value = 0, precision = 0;  // half a unit of the last digit
};

// "1,234.50 ms", "12.3 MiB", "1.234e-05"; "-" is nothing.
std::optional<Shown> read(const std::string& text) {
    static const std::map<std::string, double> kUnits = {
        {"KiB", 1024.0}, {"MiB", 1024.0 * 1024}, {"GiB", 1024.0 * 1024 * 1024}};
    std::string digits;
    std::size_t at = 0;
    for (; at < text.size() && text[at] != ' '; ++at) {
        if (text[at] != ',') digits += text[at];
    }
    if (digits == "-" || digits == "equal") return std::nullopt;
    std::size_t used = 0;
    Shown shown{std::stod(digits, &used), 0};
    EXPECT_EQ(used, digits.size()) << text;
    const std::size_t point = digits.find('.'), exponent = digits.find('e');
    const std::size_t end = std::min(exponent, digits.size());
    const double decimals = point == std::string::npos ? 0 : static_cast<double>(end - point - 1);
    shown.precision = 0.5 * std::pow(10.0, -decimals);
    if (exponent != std::string::npos) {
        shown.precision *= std::pow(10.0, std::stod(digits.substr(exponent + 1)));
    }
    const std::string unit = at < text.size() ? text.substr(at + 1) : "";
    if (const auto it = kUnits.find(unit); it != kUnits.end()) {
        shown.value *= it->second;
        shown.precision *= it->second;
    }
    return shown;
}

// How many of a window's numbers were compared.
int compare(Viewer& viewer) {
    const auto saved = viewer.session->numbers();
    int compared = 0;
    for (const ui::Figure& figure : viewer.session->interface().figures()) {
        double sum = 0;
        bool known = true;
        for (const std::string& place : figure.places) {
            const nlohmann::ordered_json::json_pointer pointer(place);
            const bool there = saved.contains(pointer) && saved.at(pointer).is_number();
            known = known && there;
            if (there) sum += saved.at(pointer).get<double>();
        }
        const auto shown = read(figure.text);
        if (!shown) {
            EXPECT_TRUE(!known || sum == 0) << figure.places[0] << " is left out";
            continue;
        }
        EXPECT_TRUE(known) << figure.places[0] << " is not saved, shown as " << figure.text;
        EXPECT_NEAR(shown->value, sum, shown->precision * 1.0001 + std::abs(sum) * 1e-12)
            << figure.places[0] << " shown as " << figure.text;
        ++compared;
    }
    return compared;
}

class FiguresTest : public ViewerTest {};

TEST_F(FiguresTest, OfMeasuredFramesAreThoseThatAreSaved) {
    constexpr int kFrames = 5;
    Viewer viewer(1000, 600);
    viewer.run(
        "pause-rendering; side-by-side; compare-traversal=queue; profiler; pause-rendering; "
        "wait-still");
    viewer.run("drag @profiler.frames by -135,0; click @profiler.measure; wait 4; wait-still");
    ASSERT_EQ(viewer.model().frameRun.wanted, kFrames);
    EXPECT_EQ(viewer.model().frameRun.done, kFrames);
    const auto saved = viewer.session->numbers();
    EXPECT_EQ(saved["frames"]["measured"], kFrames);
    EXPECT_EQ(saved["frames"]["warmup"], 1);
    EXPECT_GT(saved["frameMs"]["max"], saved["frameMs"]["min"]);
    EXPECT_GT(compare(viewer), 50) << "stages: median, p95, max";
    // Other panels of the same width leave the picture and its measurements as they are.
    for (const auto& [panel, least] :
         {std::pair{"traversal", 20}, {"memory", 15}, {"views", 7}, {"errors", 12}}) {
        SCOPED_TRACE(panel);
        viewer.run(std::string(panel) + "; wait-still; wait 3");
        EXPECT_EQ(viewer.model().frameRun.done, kFrames);
        EXPECT_GE(compare(viewer), least);
    }
    // Of another picture nothing was measured.
    viewer.run("profiler; seed=3; wait-still");
    EXPECT_EQ(viewer.model().frameRun.done, 0);
    EXPECT_EQ(viewer.session->numbers()["frames"]["measured"], 1);
    EXPECT_GE(compare(viewer), 5) << "the last frame's";
}

TEST_F(FiguresTest, OfTheOpenPanelAreSavedAndCopiedForSpreadsheets) {
    Viewer viewer(1000, 600);
    viewer.run("views; wait-still; wait 2");
    ASSERT_GT(viewer.model().views.rows.size(), 9u);
    viewer.session->editSettings().inspect.pickA = viewer.model().views.rows[3].slot;
    viewer.session->editSettings().inspect.pickB = viewer.model().views.rows[9].slot;
    viewer.run("wait 3");
    ASSERT_TRUE(viewer.model().views.a && !viewer.model().views.shared.empty());
    auto panel = viewer.session->numbers()["panel"];
    EXPECT_EQ(panel["name"], "views");
    EXPECT_EQ(panel["a"]["slot"], viewer.model().views.a->view.slot);
    ASSERT_EQ(panel["shared"].size(), viewer.model().views.shared.size());
    EXPECT_EQ(panel["shared"][0]["pairs"][0], viewer.model().views.shared[0].pairsA);

    viewer.run("pixel; wait-still; click 55%,60%; wait 3");
    panel = viewer.session->numbers()["panel"];
    ASSERT_TRUE(viewer.model().pixel.picked);
    EXPECT_EQ(panel["picked"]["radiance"][1], viewer.model().pixel.picked->radiance[1]);
    EXPECT_EQ(panel["gathered"].size(), viewer.model().pixel.gathered.size());

    viewer.run("steps; step=4; wait-still; wait 2");
    panel = viewer.session->numbers()["panel"];
    EXPECT_EQ(panel["step"], 4);
    std::uint64_t sum = 0;
    for (const auto& [name, count] : panel["decisions"].items()) sum += count.get<std::uint64_t>();
    EXPECT_EQ(panel["pairs"], sum);

    viewer.run("traversal; wait 2");
    EXPECT_FALSE(viewer.session->numbers().contains("panel")) << "the frame has its numbers";

    // As many lines as there are values, each "place",value.
    const auto numbers = viewer.session->numbers();
    const std::string csv = toCsv(numbers);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'),
              static_cast<std::ptrdiff_t>(numbers.flatten().size() + 1));
    const std::string pairs = numbers["methods"][0]["pairs"]["processed"].dump();
    EXPECT_NE(csv.find("\"/methods/0/pairs/processed\"," + pairs + "\n"), std::string::npos);
    EXPECT_NE(toCsv({{"a", "say \"x\", y"}}).find("\"/a\",\"say \"\"x\"\", y\"\n"),
              std::string::npos);
}

}  // namespace
}  // namespace mv
