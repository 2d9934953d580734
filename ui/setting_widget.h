#pragma once
// One row for one row of the settings table: kind, range and choices come from the table, the
// tooltip gives meaning, unit, range, default and paper section, a right click offers the default.

#include "megaviews/settings/settings_table.h"
#include "ui/context.h"

namespace mv::ui {

// Label and field over the whole width. True if the value changed. The field is registered under
// the setting's key, the entry of its menu under "reset:KEY".
bool settingRow(Context& c, const SettingInfo& setting);
// `shortLabel` stands in where the table's label is too wide for its column.
bool settingRow(Context& c, std::string_view key, std::string_view shortLabel = {});
// The field alone, `width` wide.
bool settingField(Context& c, const SettingInfo& setting, float width);
bool settingField(Context& c, std::string_view key, float width);
// A label in the column of settingRow, for rows that no setting stands behind.
void rowLabel(Context& c, std::string_view label, bool changed = false);
float rowFieldWidth();

// All settings of a group get their defaults.
void resetGroup(Context& c, SettingGroup group);
// The menu of a right click on the last item: the default, the group's defaults, the setting as an
// option. True if a value changed.
bool settingMenu(Context& c, const SettingInfo& setting);
std::string settingTooltip(const Context& c, const SettingInfo& setting);

}  // namespace mv::ui
