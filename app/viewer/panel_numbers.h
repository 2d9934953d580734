#pragma once
// The numbers of the panels beside those of the frame, as saved and copied: errors, and whatever
// the open instrument shows.

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "ui/model.h"

namespace mv {

// Picture errors, then those of maps; null for a value that is not there or not finite.
nlohmann::ordered_json errorNumbers(const ui::ErrorsData& errors);
// What an open views, pixel or steps panel shows: {"name": ..., ...}; else null. Units as in
// ui/model.h.
nlohmann::ordered_json panelNumbers(const ui::Model& model);
// "place,value" lines, a place being a JSON pointer; texts in quotes.
std::string toCsv(const nlohmann::ordered_json& json);

}  // namespace mv
