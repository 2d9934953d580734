#include "megaviews/settings/light_placement.h"

#include <charconv>
#include <cmath>

#include "megaviews/core/error.h"

namespace mv {
namespace {

using Vector3 = std::array<double, 3>;

// Up to a separator, which is dropped with it.
std::string_view takeUntil(std::string_view& text, char separator) {
    const std::size_t end = text.find(separator);
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return part;
}

template <typename T>
bool read(std::string_view text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::optional<Vector3> readVector(std::string_view text) {
    Vector3 v{};
    for (double& component : v) {
        if (!read(takeUntil(text, ','), component) || !std::isfinite(component)) {
            return std::nullopt;
        }
    }
    return text.empty() ? std::optional(v) : std::nullopt;
}

std::string vectorText(const Vector3& v) {
    std::string text;
    for (const double component : v) {
        char buffer[64];
        const auto end = std::to_chars(buffer, buffer + sizeof buffer, component).ptr;
        text.append(text.empty() ? "" : ",").append(buffer, end);
    }
    return text;
}

}  // namespace

std::vector<LightPlacement> parseLightPlacements(std::string_view text, std::string_view where) {
    std::vector<LightPlacement> placements;
    while (!text.empty()) {
        std::string_view part = takeUntil(text, ' ');
        if (part.empty()) continue;
        const auto refuse = [&, whole = std::string(part)](const std::string& reason) {
            throw Error(ExitCode::usage, std::string(where) + ": '" + whole + "' " + reason);
        };
        LightPlacement placement;
        if (!read(takeUntil(part, ':'), placement.light) || placement.light < 0) {
            refuse("does not start with the number of a light");
        }
        const std::string_view position = takeUntil(part, ':');
        if (!position.empty()) placement.position = readVector(position);
        if (!part.empty()) placement.direction = readVector(part);
        if (placement.position.has_value() == position.empty() ||
            placement.direction.has_value() == part.empty() || (position.empty() && part.empty())) {
            refuse("is not LIGHT:X,Y,Z, LIGHT:X,Y,Z:DX,DY,DZ or LIGHT::DX,DY,DZ");
        }
        if (placement.direction && *placement.direction == Vector3{0, 0, 0}) {
            refuse("has 0,0,0 for a direction");
        }
        for (const LightPlacement& other : placements) {
            if (other.light == placement.light) refuse("places that light a second time");
        }
        placements.push_back(placement);
    }
    return placements;
}

std::string toText(const std::vector<LightPlacement>& placements) {
    std::string text;
    for (const LightPlacement& placement : placements) {
        text.append(text.empty() ? "" : " ").append(std::to_string(placement.light)).append(":");
        if (placement.position) text.append(vectorText(*placement.position));
        if (placement.direction) text.append(":").append(vectorText(*placement.direction));
    }
    return text;
}

}  // namespace mv
