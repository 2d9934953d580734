#include "megaviews/settings/settings_table.h"

#include <algorithm>

#include "megaviews/settings/settings_rows.h"

namespace mv {
namespace {

std::vector<SettingInfo> makeTable() {
    std::vector<SettingInfo> table;
    const auto add = [&](SettingGroup group, std::vector<SettingInfo> rows) {
        for (SettingInfo& row : rows) {
            row.group = group;
            table.push_back(std::move(row));
        }
    };
    add(SettingGroup::scene, rows::ofScene());
    add(SettingGroup::method, rows::ofMethod());
    add(SettingGroup::views, rows::ofViews());
    add(SettingGroup::gather, rows::ofGather());
    add(SettingGroup::picture, rows::ofPicture());
    add(SettingGroup::instruments, rows::ofInstruments());
    return table;
}

}  // namespace

std::string_view groupTitle(SettingGroup group) {
    switch (group) {
        case SettingGroup::scene:
            return "Scene";
        case SettingGroup::method:
            return "Method";
        case SettingGroup::views:
            return "Views";
        case SettingGroup::gather:
            return "Gather";
        case SettingGroup::instruments:
            return "Instruments";
        case SettingGroup::picture:
            return "Picture";
    }
    return "";
}

std::span<const SettingInfo> settingsTable() {
    static const std::vector<SettingInfo> table = makeTable();
    return table;
}

const SettingInfo* findSetting(std::string_view key) {
    const auto table = settingsTable();
    const auto it = std::find_if(table.begin(), table.end(),
                                 [&](const SettingInfo& s) { return s.key == key; });
    return it == table.end() ? nullptr : &*it;
}

}  // namespace mv
