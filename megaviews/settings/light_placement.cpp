#include "megaviews/settings/light_placement.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "megaviews/core/error.h"

namespace mv {
namespace {

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

// Far above what a scene holds, and so that floats hold what is made of it.
constexpr double kLargest = 1e12;
constexpr double kShortestDirection = 1e-12;

template <std::size_t N>
std::optional<std::array<double, N>> readNumbers(std::string_view text) {
    std::array<double, N> v{};
    for (double& component : v) {
        if (!read(takeUntil(text, ','), component) || !std::isfinite(component)) {
            return std::nullopt;
        }
    }
    return text.empty() ? std::optional(v) : std::nullopt;
}

template <std::size_t N>
std::string textOf(const std::optional<std::array<double, N>>& v) {
    std::string text;
    if (!v) return text;
    for (const double component : *v) {
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
        const auto take = [&](auto& value) {
            constexpr std::size_t n =
                std::tuple_size_v<typename std::decay_t<decltype(value)>::value_type>;
            const std::string_view field = takeUntil(part, ':');
            if (field.empty()) return true;
            value = readNumbers<n>(field);
            return value.has_value();
        };
        const bool good = take(placement.position) && take(placement.direction) &&
                          take(placement.intensity) && take(placement.cone) && part.empty();
        if (!good || placement.changesNothing()) {
            refuse(
                "is not LIGHT:X,Y,Z:DX,DY,DZ:R,G,B:INNER,OUTER with some of them empty or left "
                "out");
        }
        const auto tooLarge = [](const auto& numbers) {
            return numbers &&
                   std::ranges::any_of(*numbers, [](double v) { return std::abs(v) > kLargest; });
        };
        if (tooLarge(placement.position) || tooLarge(placement.direction) ||
            tooLarge(placement.intensity)) {
            refuse("has a number beyond 1e12");
        }
        const auto isShort = [](double v) { return std::abs(v) < kShortestDirection; };
        if (placement.direction && std::ranges::all_of(*placement.direction, isShort)) {
            refuse("has no length for a direction");
        }
        if (placement.intensity &&
            std::ranges::any_of(*placement.intensity, [](double i) { return i < 0; })) {
            refuse("has an intensity below 0");
        }
        if (const auto& cone = placement.cone;
            cone && !(0 <= (*cone)[0] && (*cone)[0] <= (*cone)[1] && (*cone)[1] <= 90)) {
            refuse("has a cone that is not 0 <= INNER <= OUTER <= 90 degrees");
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
        std::string one = std::to_string(placement.light) + ":" + textOf(placement.position) + ":" +
                          textOf(placement.direction) + ":" + textOf(placement.intensity) + ":" +
                          textOf(placement.cone);
        one.erase(one.find_last_not_of(':') + 1);
        text.append(text.empty() ? "" : " ").append(one);
    }
    return text;
}

}  // namespace mv
