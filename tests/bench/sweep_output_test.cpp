#include "app/bench/sweep_output.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/temp_folder.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

struct FakeSweep {
    std::vector<SweepAxis> axes = {sweepAxisFromText("vpls=1K,4K", ""),
                                   sweepAxisFromText("method=megaviews,none", "")};
    std::vector<SweepPoint> points = sweepPoints({}, axes);
    Json head = {{"schema", kSweepSchema},
                 {"kind", "megaviews sweep"},
                 {"command", "megaviews-bench sweep"},
                 {"program", {{"version", "1"}, {"commit", "abc"}}},
                 {"gl", {{"renderer", "r, \"x\""}, {"version", "4.5"}}},
                 {"host", {{"cpu", "c"}}},
                 {"scene", {{"name", "s"}, {"hash", "00"}}},
                 {"frames", {{"warmup", 1}, {"measured", 2}}},
                 {"axes", Json::array()},
                 {"search", nullptr},
                 {"settings", toJson(Settings{})}};
    SweepEntries entries;

    FakeSweep() {
        for (const SweepAxis& axis : axes) {
            head["axes"].push_back({{"key", axis.key}, {"values", axis.values}});
        }
        for (const SweepPoint& point : points) {
            const Json ms = {{"median", 1.5}, {"p95", 2}, {"min", 1}, {"max", 2}, {"sd", 0.5}};
            entries.push_back(
                {{"values", sweepValues(axes, point)},
                 {"refusal", nullptr},
                 {"clock", "gpu timer"},
                 {"views", {{"requested", point.settings.views.vpls}, {"alive", 3}}},
                 {"ms", {{"maps", ms}, {"gather", ms}, {"indirect", ms}, {"frame", ms}}},
                 {"speedup", nullptr},
                 {"pairs", {{"processed", 2500000}}},
                 {"stages", {{"gather cull", ms}}},
                 {"memory", {{"maps, left", 77}}},
                 {"errors",
                  {{"exact", {{"relmse", 0.2512345}, {"psnr", nullptr}}}, {"pathtraced", nullptr}}},
                 {"settings", toJson(point.settings)}});
        }
    }
};

// Of one line of CSV, quotes undone.
std::vector<std::string> fieldsOf(const std::string& line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
            fields.back() += line[i++];
        } else if (line[i] == '"') {
            quoted = !quoted;
        } else if (line[i] == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += line[i];
        }
    }
    return fields;
}

std::vector<std::vector<std::string>> csvOf(const Json& head, const SweepEntries& entries) {
    std::istringstream stream(sweepCsv(head, entries));
    std::vector<std::vector<std::string>> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(fieldsOf(line));
    return lines;
}

std::string at(const std::vector<std::vector<std::string>>& csv, std::size_t row,
               const std::string& column) {
    const auto it = std::find(csv[0].begin(), csv[0].end(), column);
    return it == csv[0].end() ? "no column" : csv.at(row).at(std::size_t(it - csv[0].begin()));
}

TEST(SweepOutput, CsvHasTheJsonsMembers) {
    FakeSweep s;
    s.entries[3] = {{"values", sweepValues(s.axes, s.points[3])},
                    {"refusal", "too large, by far"},
                    {"settings", toJson(s.points[3].settings)}};
    const auto csv = csvOf(s.head, s.entries);
    ASSERT_EQ(csv.size(), 5u);
    for (const auto& line : csv) EXPECT_EQ(line.size(), csv[0].size());
    EXPECT_EQ(csv[0][0], "vpls");
    EXPECT_EQ(csv[0][1], "method");
    EXPECT_EQ(at(csv, 1, "vpls"), "1024");
    EXPECT_EQ(at(csv, 2, "method"), "none");
    EXPECT_EQ(at(csv, 1, "refusal"), "n/a");
    EXPECT_EQ(at(csv, 4, "refusal"), "too large, by far");
    EXPECT_EQ(at(csv, 4, "ms.maps.median"), "n/a");
    EXPECT_EQ(at(csv, 1, "ms.maps.median"), "1.5");
    EXPECT_EQ(at(csv, 1, "stages.gather cull.sd"), "0.5");
    EXPECT_EQ(at(csv, 1, "stages.fuse.median"), "n/a");
    EXPECT_EQ(at(csv, 1, "pairs.processed"), "2500000");
    EXPECT_EQ(at(csv, 1, "memory.maps, left"), "77");
    EXPECT_EQ(at(csv, 1, "errors.exact.relmse"), "0.2512345");
    EXPECT_EQ(at(csv, 1, "errors.exact.psnr"), "n/a");         // without bound
    EXPECT_EQ(at(csv, 1, "errors.pathtraced.relmse"), "n/a");  // without a reference
    EXPECT_EQ(at(csv, 1, "settings.resolution"), "1280x720");
    EXPECT_EQ(at(csv, 1, "settings.camera-up"), "0,1,0");
    EXPECT_EQ(at(csv, 4, "settings.vpls"), "4096");
    EXPECT_EQ(at(csv, 4, "gl.renderer"), "r, \"x\"");
    EXPECT_EQ(at(csv, 4, "scene.hash"), "00");
    EXPECT_EQ(at(csv, 1, "clock"), "gpu timer");
}

TEST(SweepOutput, KeepsWhatIsThere) {
    FakeSweep s;
    EXPECT_FALSE(sweepJson(s.head, s.entries).at("partial").get<bool>());
    SweepEntries allButOne = s.entries;
    allButOne[3] = nullptr;
    EXPECT_TRUE(sweepJson(s.head, allButOne).at("partial").get<bool>());
    s.entries[1] = nullptr;
    s.entries[2] = nullptr;
    const Json json = sweepJson(s.head, s.entries);
    EXPECT_TRUE(json.at("partial").get<bool>());
    EXPECT_EQ(json.at("points").size(), 2u);
    EXPECT_EQ(json.at("clock"), "gpu timer");
    EXPECT_EQ(csvOf(s.head, s.entries).size(), 3u);
    const SweepEntries none(4);
    EXPECT_TRUE(sweepJson(s.head, none).at("clock").is_null());
    EXPECT_EQ(csvOf(s.head, none).size(), 1u);
    EXPECT_FALSE(sweepTable(s.head, none).empty());
}

TEST(SweepOutput, TableShowsRefusalsAsRows) {
    FakeSweep s;
    s.entries[3] = {{"values", sweepValues(s.axes, s.points[3])}, {"refusal", "needs 3 MiB"}};
    const std::string table = sweepTable(s.head, s.entries);
    EXPECT_NE(table.find("\n4K    none       needs 3 MiB\n"), std::string::npos) << table;
    EXPECT_NE(table.find("clock: gpu timer"), std::string::npos) << table;
    // maps, p95, gather, frame, speedup, millions of pairs.
    std::istringstream row(table.substr(table.find("\n1K    megaviews") + 1));
    std::vector<std::string> words;
    for (std::string word; words.size() < 8 && row >> word;) words.push_back(word);
    EXPECT_EQ(words, (std::vector<std::string>{"1K", "megaviews", "1.50", "2.00", "1.50", "1.50",
                                               "n/a", "2.50"}))
        << table;
    EXPECT_NE(table.find("relmse"), std::string::npos) << table;
    EXPECT_EQ(table.find("pathtraced"), std::string::npos) << table;
}

class SweepResume : public testing::Test {
  protected:
    test::TempFolder folder;
    FakeSweep s;
    std::string name = folder.file("r");
    std::size_t others = 0;
    SweepEntries resume(const Json& head, const std::string& references = {}) {
        ResumedPoints resumed = resumedPoints(name, head, s.points, s.axes, references);
        others = resumed.others;
        return resumed.entries;
    }
    std::string refusal(const Json& head, ExitCode code) {
        try {
            resume(head);
        } catch (const Error& error) {
            EXPECT_EQ(error.code, code);
            return error.what();
        }
        return "";
    }
};

TEST_F(SweepResume, TakesPointsOfTheSameSettings) {
    EXPECT_EQ(resume(s.head), SweepEntries(4));  // no file yet
    SweepEntries some = s.entries;
    some[1] = nullptr;
    some[2]["refusal"] = "no memory that day";  // is tried again
    writeSweep(name, s.head, some);
    EXPECT_TRUE(std::filesystem::exists(name + ".csv"));
    SweepEntries expected = s.entries;
    expected[1] = expected[2] = nullptr;
    EXPECT_EQ(resume(s.head), expected);
    EXPECT_EQ(others, 0u);

    // A reference that was made since, and references that nobody asked for then.
    some = s.entries;
    some[0]["missingReferences"] = {"exact-1.npy"};
    Json head = s.head;
    head["references"] = true;
    writeSweep(name, head, some);
    EXPECT_FALSE(resume(head, folder.file(""))[0].is_null());
    std::ofstream(folder.file("exact-1.npy")) << "an array";
    EXPECT_TRUE(resume(head, folder.file(""))[0].is_null());
    EXPECT_FALSE(resume(head, folder.file(""))[1].is_null());
    EXPECT_FALSE(resume(head)[0].is_null());
    head["references"] = false;
    writeSweep(name, head, s.entries);
    EXPECT_EQ(resume(head, folder.file("")), SweepEntries(4));
    writeSweep(name, s.head, s.entries);

    // Another grid that shares points: its own axes name them.
    s.axes = {sweepAxisFromText("seed=0,1", ""), sweepAxisFromText("method=none", ""),
              sweepAxisFromText("vpls=4K", "")};
    s.points = sweepPoints({}, s.axes);
    const SweepEntries other = resume(s.head);
    ASSERT_EQ(other.size(), 2u);
    EXPECT_EQ(others, 3u);
    EXPECT_TRUE(other[1].is_null());
    ASSERT_FALSE(other[0].is_null());
    EXPECT_EQ(other[0].at("values"), Json({{"seed", 0}, {"method", "none"}, {"vpls", 4096}}));
    EXPECT_EQ(other[0].at("ms"), s.entries[3].at("ms"));

    Settings base;
    base.gather.samples = 3;
    s.points = sweepPoints(base, s.axes);
    EXPECT_EQ(resume(s.head), SweepEntries(2));
}

TEST_F(SweepResume, OfASearchTakesWhatWasFound) {
    // The value that was found is no part of what was asked for; everything else is.
    s.head["search"] = {{"goal", "time"}, {"vary", {{"key", "gather-samples"}}}};
    for (Json& entry : s.entries) entry["settings"]["gather-samples"] = 7;
    writeSweep(name, s.head, s.entries);
    EXPECT_EQ(resume(s.head), s.entries);
    s.entries[2]["settings"]["view-res"] = 8;
    writeSweep(name, s.head, s.entries);
    s.entries[2] = nullptr;
    EXPECT_EQ(resume(s.head), s.entries);
}

TEST_F(SweepResume, RefusesOtherMeasurements) {
    writeSweep(name, s.head, s.entries);
    for (const auto& [pointer, message] : std::vector<std::pair<std::string, std::string>>{
             {"/scene/hash", "another scene"},
             {"/program/commit", "another version"},
             {"/gl/renderer", "another machine"},
             {"/host/cpu", "another machine"},
             {"/frames/measured", "other numbers of frames"},
             {"/search", "another aim"}}) {
        Json head = s.head;
        head[Json::json_pointer(pointer)] = "other";
        EXPECT_NE(refusal(head, ExitCode::usage).find(message), std::string::npos) << pointer;
    }
    std::ofstream(name + ".json") << "{\"kind\": \"megaviews sw";
    EXPECT_NE(refusal(s.head, ExitCode::input).find("not valid JSON"), std::string::npos);
    std::ofstream(name + ".json") << "[]";
    EXPECT_NE(refusal(s.head, ExitCode::input).find("is no sweep's"), std::string::npos);
}

}  // namespace
}  // namespace mv
