#include "megaviews/scene/load_scene.h"

#include <charconv>
#include <optional>

#include "megaviews/core/error.h"

namespace mv {

namespace {

// The position of the entry called `wanted`, or the number that it is.
template <typename Named>
std::optional<int> findNamed(const std::vector<Named>& entries, const std::string& wanted) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (entries[i].name == wanted) return static_cast<int>(i);
    }
    std::size_t number = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [stopped, error] = std::from_chars(wanted.data(), end, number);
    if (error != std::errc() || stopped != end || number >= entries.size()) return std::nullopt;
    return static_cast<int>(number);
}

template <typename Named>
[[noreturn]] void refuse(const char* what, const std::string& wanted,
                         const std::vector<Named>& entries, const char* also) {
    std::string choices;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (i == 20) {
            choices += ", ...";
            break;
        }
        choices += (i > 0 ? ", " : "") + std::to_string(i) + " \"" + entries[i].name + '"';
    }
    if (*also) choices += (choices.empty() ? "" : ", ") + std::string(also);
    throw Error(ExitCode::usage,
                "there is no " + std::string(what) + " \"" + wanted + "\"" +
                    (choices.empty() ? ", nor any other" : "; choose from: " + choices));
}

}  // namespace

Scene loadScene(const std::string& nameOrPath, const LoadOptions& options) {
    if (!nameOrPath.starts_with("builtin:")) return loadGltf(nameOrPath, options);
    if (options.sceneIndex > 0) {
        throw Error(ExitCode::usage, "file-scene: " + std::to_string(options.sceneIndex) + "; '" +
                                         nameOrPath + "' is a single scene");
    }
    return makeBuiltin(nameOrPath, options);
}

int findAnimation(const Scene& scene, const std::string& nameOrNumber) {
    if (nameOrNumber.empty()) return scene.defaultAnimation();
    if (const auto found = findNamed(scene.animations, nameOrNumber)) return *found;
    if (nameOrNumber == "none") return -1;
    refuse("animation", nameOrNumber, scene.animations, "none");
}

int findCamera(const Scene& scene, const std::string& nameOrNumber) {
    if (nameOrNumber.empty()) return scene.cameras.empty() ? -1 : 0;
    if (const auto found = findNamed(scene.cameras, nameOrNumber)) return *found;
    refuse("camera", nameOrNumber, scene.cameras, "");
}

int findVariant(const Scene& scene, const std::string& nameOrNumber) {
    if (nameOrNumber.empty()) return -1;
    struct Variant {
        std::string name;
    };
    std::vector<Variant> variants;
    for (const std::string& name : scene.variants) variants.push_back({name});
    if (const auto found = findNamed(variants, nameOrNumber)) return *found;
    refuse("variant", nameOrNumber, variants, "");
}

}  // namespace mv
