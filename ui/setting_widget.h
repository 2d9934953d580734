#pragma once
// One widget for one row of the settings table: kind, range and choices come from the table, the
// tooltip gives meaning, unit, range, default and paper section, a right click resets.

#include "megaviews/settings/settings.h"
#include "megaviews/settings/settings_table.h"

namespace mv::ui {

// True if the value changed.
bool settingWidget(Settings& settings, const SettingInfo& setting);
bool settingWidget(Settings& settings, const char* key);

}  // namespace mv::ui
