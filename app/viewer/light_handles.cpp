#include "app/viewer/light_handles.h"

#include <algorithm>

#include "app/common/scene_report.h"
#include "megaviews/settings/light_placement.h"
#include "megaviews/views/pick_view.h"

namespace mv {
namespace {

constexpr float kHandleLength = 0.08f;  // of a light's direction, root-cube units

// The handle's place and the tip of its direction, root-cube units.
std::pair<glm::vec3, glm::vec3> handlesOf(const LightView& view, const ui::LightRow& row) {
    const glm::vec3 place = row.hasPosition
                                ? view.assets.scene.root.rootFromWorld(
                                      {row.position[0], row.position[1], row.position[2]})
                                : view.camera.position + view.camera.forward * view.pivotDistance;
    const glm::dvec3 direction(row.direction[0], row.direction[1], row.direction[2]);
    return {place, place + kHandleLength * glm::vec3(direction)};
}

std::optional<std::array<float, 2>> windowPosition(const LightView& view, glm::vec3 point) {
    const auto width = static_cast<float>(view.viewport.width),
               height = static_cast<float>(view.viewport.height);
    const glm::vec4 clip = view.camera.clipFromWorld(width / height) * glm::vec4(point, 1.0f);
    if (!(clip.w > 0)) return std::nullopt;
    const float x = 0.5f + 0.5f * clip.x / clip.w, y = 0.5f - 0.5f * clip.y / clip.w;
    if (x < 0 || x > 1 || y < 0 || y > 1) return std::nullopt;
    return std::array<float, 2>{static_cast<float>(view.viewport.x) + x * width,
                                static_cast<float>(view.viewport.y) + y * height};
}

}  // namespace

std::vector<ui::LightRow> lightRows(const SceneAssets& assets, const std::string& placements,
                                    double timeS) {
    const auto placed = parseLightPlacements(placements, "lights");
    std::vector<ui::LightRow> rows;
    for (const PosedLight& posed : posedLights(assets, placements, timeS)) {
        const Light& light = posed.light;
        ui::LightRow row;
        row.name = light.name;
        row.kind = lightTypeName(light.type);
        row.hasPosition = light.type != LightType::directional;
        row.hasDirection = light.type != LightType::point;
        row.hasCone = light.type == LightType::spot;
        row.position = {posed.position.x, posed.position.y, posed.position.z};
        row.direction = {posed.direction.x, posed.direction.y, posed.direction.z};
        for (int i = 0; i < 3; ++i) {
            row.intensity[static_cast<std::size_t>(i)] = static_cast<double>(light.intensity[i]);
        }
        row.cone = {glm::degrees(light.innerConeRad), glm::degrees(light.outerConeRad)};
        row.edited = std::any_of(placed.begin(), placed.end(), [&](const LightPlacement& p) {
            return p.light == static_cast<int>(rows.size());
        });
        rows.push_back(std::move(row));
    }
    return rows;
}

void placeHandles(const LightView& view, ui::LightRow& row) {
    const auto [place, tip] = handlesOf(view, row);
    row.place = windowPosition(view, place);
    if (row.hasDirection) row.tip = windowPosition(view, tip);
}

ui::LightEdit editOf(const LightView& view, const ui::LightRow& row, const ui::LightDrag& drag) {
    const auto [place, tip] = handlesOf(view, row);
    const ui::Viewport& port = view.viewport;
    const PickRay ray =
        rayThrough(view.camera, port.width, port.height, drag.x - static_cast<float>(port.x),
                   static_cast<float>(port.y + port.height) - drag.y, 1);
    const glm::vec3 forward = view.camera.forward;
    const float depth = glm::dot((drag.tip ? tip : place) - ray.origin, forward);
    const glm::vec3 target =
        ray.origin + ray.direction * (depth / glm::dot(ray.direction, forward));
    ui::LightEdit edit;
    edit.light = drag.light;
    if (drag.tip) {
        // A tip on the light itself points nowhere: edited() leaves that out.
        const glm::dvec3 d(target - place);
        const glm::dvec3 unit = glm::length(d) > 0 ? glm::normalize(d) : glm::dvec3(0);
        edit.direction = {unit.x, unit.y, unit.z};
    } else {
        const glm::dvec3 world = view.assets.scene.root.worldFromRoot(target);
        edit.position = {world.x, world.y, world.z};
    }
    return edit;
}

std::string edited(const std::string& placements, const ui::LightEdit& edit) {
    auto placed = parseLightPlacements(placements, "lights");
    const int light = static_cast<int>(edit.light);
    auto found = std::find_if(placed.begin(), placed.end(),
                              [&](const LightPlacement& p) { return p.light == light; });
    if (edit.reset) {
        if (found != placed.end()) placed.erase(found);
        return toText(placed);
    }
    if (found == placed.end()) {
        LightPlacement fresh;
        fresh.light = light;
        found = placed.insert(placed.end(), fresh);
    }
    if (edit.position) found->position = edit.position;
    if (edit.direction && *edit.direction != std::array<double, 3>{0, 0, 0}) {
        found->direction = edit.direction;
    }
    if (edit.intensity) found->intensity = edit.intensity;
    if (edit.cone) found->cone = edit.cone;
    if (edit.on) {
        found->intensity.reset();
        if (!*edit.on) found->intensity = {0, 0, 0};
    }
    if (found->changesNothing()) placed.erase(found);
    return toText(placed);
}

}  // namespace mv
