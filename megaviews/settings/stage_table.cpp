#include "megaviews/settings/statistics_table.h"

namespace mv {
namespace {

constexpr StageInfo kStages[] = {
    {"trace views", "Light paths shot through the scene, a virtual point light at each bounce."},
};

}  // namespace

std::span<const StageInfo> stageTable() { return kStages; }

}  // namespace mv
