#pragma once
// What a sweep writes: NAME.json with everything (docs/benchmark.md), NAME.csv with one line a
// point, whose columns are the JSON's members, and the table on standard output. The files are
// written anew after every point, so that a sweep that is ended keeps what it has; --resume takes
// the points from them that the grid asks for again.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/bench/sweep.h"

namespace mv {

inline constexpr int kSweepSchema = 1;

// Everything but the points. Needs a current context.
nlohmann::ordered_json sweepHead(const SweepRequest& request, const SceneAssets& assets,
                                 const std::string& command);

// `points` by index; null for those that are not measured yet, which are left out.
using SweepEntries = std::vector<nlohmann::ordered_json>;
nlohmann::ordered_json sweepJson(nlohmann::ordered_json head, const SweepEntries& points);
// "n/a" for what was not measured.
std::string sweepCsv(const nlohmann::ordered_json& head, const SweepEntries& points);
std::string sweepTable(const nlohmann::ordered_json& head, const SweepEntries& points);

// Both files, NAME.json and NAME.csv.
void writeSweep(const std::string& name, const nlohmann::ordered_json& head,
                const SweepEntries& points);

struct ResumedPoints {
    SweepEntries entries;    // null: to be measured
    std::size_t others = 0;  // measured, and not of the sweep: they would be lost
};
// The points of an earlier NAME.json, where their settings are the same; the others are null.
// Without such a file none is. A point that lacks errors against what `references` (a folder, or
// empty) holds by now is null, too. Throws Error(ExitCode::input) if it is not a sweep's, and
// Error(ExitCode::usage) if it was measured on another scene, machine or program, or otherwise.
ResumedPoints resumedPoints(const std::string& name, const nlohmann::ordered_json& head,
                            const std::vector<SweepPoint>& points,
                            const std::vector<SweepAxis>& axes,
                            const std::filesystem::path& references);

}  // namespace mv
