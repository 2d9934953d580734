// loadGltf: the glTF loader's steps in their order. First stage, file -> Scene.
#include <spdlog/fmt/ranges.h>
#include <spdlog/spdlog.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cctype>
#include <new>

#include "megaviews/core/error.h"
#include "megaviews/scene/gltf_check.h"
#include "megaviews/scene/gltf_geometry.h"
#include "megaviews/scene/gltf_glossiness.h"
#include "megaviews/scene/gltf_materials.h"
#include "megaviews/scene/gltf_nodes.h"
#include "megaviews/scene/gltf_variants.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/pose.h"

namespace mv {

namespace {

// tinygltf asks for its buffers here: buffer i of the checked copy has the uri "i".
using Buffers = std::vector<std::vector<std::uint8_t>>;

bool giveBuffer(std::vector<unsigned char>* out, std::string*, const std::string& path,
                void* data) {
    const std::size_t digits = path.find_last_not_of("0123456789") + 1;  // npos + 1 = 0
    auto& buffers = *static_cast<Buffers*>(data);
    *out = std::move(buffers[std::stoul(path.substr(digits))]);
    return true;
}

tinygltf::Model parseModel(const nlohmann::json& checked, Buffers& buffers,
                           const GltfReport& report) {
    tinygltf::TinyGLTF parser;
    tinygltf::FsCallbacks files{};
    files.FileExists = [](const std::string&, void*) { return true; };
    files.ExpandFilePath = [](const std::string& path, void*) { return path; };
    files.ReadWholeFile = giveBuffer;
    files.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                              void*) { return false; };
    files.user_data = &buffers;
    parser.SetFsCallbacks(files);
    const std::string text = checked.dump();
    tinygltf::Model model;
    std::string error, warning;
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.c_str(),
                                    static_cast<unsigned int>(text.size()), "")) {
        report.fail("", "it cannot be read as glTF: " + printable(error));
    }
    return model;
}

// The root cube that --save-scene leaves in a file (save_scene.h).
std::optional<RootCube> statedRootCube(const nlohmann::json& json) {
    const nlohmann::json::json_pointer place("/asset/extras/megaviews/rootCube");
    if (!json.contains(place)) return std::nullopt;
    const nlohmann::json& in = json[place];
    if (!in.is_array() || in.size() != 4) return std::nullopt;
    for (const nlohmann::json& number : in) {
        if (!number.is_number()) return std::nullopt;
    }
    RootCube cube;
    cube.origin = {in[0].get<double>(), in[1].get<double>(), in[2].get<double>()};
    cube.edge = in[3].get<double>();
    return cube.edge > 0 ? std::optional(cube) : std::nullopt;
}

// So with Scene::positionStep.
float statedPositionStep(const nlohmann::json& json) {
    const nlohmann::json::json_pointer place("/asset/extras/megaviews/positionStep");
    if (!json.contains(place) || !json[place].is_number()) return 0;
    return static_cast<float>(std::clamp(json[place].get<double>(), 0.0, 1.0));
}

void load(const LoadOptions& options, GltfReport& report, Scene& scene) {
    mv::report(options.progress, "read file", 0);
    GltfFile file = readGltfFile(report.file(), report);
    scene.hash = file.hash;

    mv::report(options.progress, "check file", 0);
    CheckedGltf checked = checkGltf(file, report, options.progress);
    scene.variants = variantNames(checked.json);
    const int variant = findVariant(scene, options.variant);
    if (variant >= 0) applyVariant(checked.json, static_cast<std::size_t>(variant));
    translateGlossiness(checked.json);
    const tinygltf::Model model = parseModel(checked.json, file.buffers, report);
    scene.extensions.assign(checked.extensions.begin(), checked.extensions.end());
    scene.ignored.assign(checked.ignored.begin(), checked.ignored.end());
    if (!scene.ignored.empty() && options.without.empty()) {
        spdlog::info("{}: not used: {}", report.file(), fmt::join(scene.ignored, ", "));
    }

    mv::report(options.progress, "decode images", 0);
    const std::vector<MaterialUvs> uvs =
        loadMaterials(model, file, scene, report, options.progress);
    for (std::size_t i = 0; model.scenes.size() > 1 && i < model.scenes.size(); ++i) {
        const std::string& name = model.scenes[i].name;
        scene.fileScenes.push_back(name.empty() ? "scene " + std::to_string(i) : printable(name));
    }
    Rig rig = buildRig(model, options.sceneIndex, report);
    addLightsAndCameras(model, rig, scene);
    const int animation = findAnimation(scene, options.animation);
    const double duration =
        animation >= 0 ? scene.animations[static_cast<std::size_t>(animation)].duration : 0;
    const PoseTime time = {animation, loopTime(options.timeS, duration)};
    // With everything that was read; of a file that stands alone it is the file's own.
    if (!file.files.empty()) scene.hash = file.content.hex();
    scene.files = std::move(file.files);
    file.content.add(std::to_string(options.sceneIndex));
    if (variant >= 0) file.content.add("variant " + std::to_string(variant));
    scene.contentHash = file.content.hex();
    addGeometry(model, std::move(rig), {time, duration, options.without, statedRootCube(file.json)},
                uvs, scene, report, options.progress);
    scene.positionStep = std::max(scene.positionStep, statedPositionStep(file.json));
}

}  // namespace

Scene loadGltf(const std::string& path, const LoadOptions& options) {
    GltfReport report(path, options.without.empty());
    Scene scene;
    scene.name = path;
    try {
        load(options, report, scene);
    } catch (const Error&) {
        throw;
    } catch (const Cancelled&) {
        throw;
    } catch (const std::bad_alloc&) {
        report.fail("", "there is not enough memory to load it");
    } catch (const std::exception& e) {
        report.fail("", "it cannot be read: " + printable(e.what()));
    }
    scene.warnings = std::move(report.warnings);
    return scene;
}

}  // namespace mv
