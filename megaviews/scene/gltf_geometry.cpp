#include "megaviews/scene/gltf_geometry.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "megaviews/scene/pose.h"
#include "megaviews/scene/rigged_scene.h"

namespace mv {

namespace {

// All draws of a scene with what they share.
class Drawing {
  public:
    Drawing(const tinygltf::Model& model, Rig rig, const GeometryRequest& request,
            GltfReport& report)
        : model_(model), without_(request.without), report_(report), reader_(model, report) {
        out_.rig = std::move(rig);
        const PoseTime time = request.time;
        const bool animated = time.animation >= 0;
        world_ = worldMatrices(
            rig_.nodes,
            animated ? &rig_.animations[static_cast<std::size_t>(time.animation)] : nullptr,
            time.timeS);
    }

    // Which primitives are drawn where; nothing is read yet but instances and skins.
    void collect();
    // Reads the primitives that are drawn.
    void readPrimitives(std::span<const MaterialUvs> uvs, const Progress& progress);
    // What was left out of them, in one sentence a reason.
    void warnOfPrimitives() const;
    // Thicknesses from units of the mesh to those of the world: by the first node that draws it.
    void scaleThickness(std::vector<Material>& materials) const;
    RiggedScene take() { return std::move(out_); }

  private:
    std::vector<glm::dmat4> instances(std::size_t node) const;
    void readSkins();
    void checkJoints(const RiggedDraw& draw) const;

    bool isLeftOut(const tinygltf::Primitive& primitive) const {
        return std::any_of(without_.begin(), without_.end(), [&](std::uint32_t material) {
            return primitive.material == static_cast<int>(material);
        });
    }

    const tinygltf::Model& model_;
    std::span<const std::uint32_t> without_;
    GltfReport& report_;
    AccessorReader reader_;
    RiggedScene out_;
    const Rig& rig_ = out_.rig;
    std::vector<glm::dmat4> world_;                         // of the rig's nodes
    std::vector<std::pair<int, int>> primitiveOf_;          // parallel to primitives: mesh, number
    std::vector<std::vector<std::size_t>> meshPrimitives_;  // a mesh's entries in primitives
};

// EXT_mesh_gpu_instancing; the identity alone without it.
std::vector<glm::dmat4> Drawing::instances(std::size_t node) const {
    const tinygltf::Node& in = model_.nodes[static_cast<std::size_t>(rig_.fileNode[node])];
    const auto extension = in.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == in.extensions.end() || !extension->second.Has("attributes")) {
        return {glm::dmat4(1)};
    }
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    std::vector<glm::dvec4> translations, rotations, scales;
    const auto read = [&](const char* name, std::vector<glm::dvec4>& to) {
        if (!attributes.Has(name)) return;
        const int accessor = attributes.Get(name).GetNumberAsInt();
        if (reader_.count(accessor) > kMostDraws) {
            report_.fail(nodePlace(model_, rig_.fileNode[node]),
                         std::to_string(reader_.count(accessor)) + " instances are too many");
        }
        to = reader_.vectors(accessor, glm::dvec4(0));
    };
    read("TRANSLATION", translations);
    read("ROTATION", rotations);
    read("SCALE", scales);
    const std::size_t count = std::max({translations.size(), rotations.size(), scales.size()});
    std::vector<glm::dmat4> result;
    for (std::size_t i = 0; i < count; ++i) {
        Node instance;
        if (!translations.empty()) instance.translation = glm::dvec3(translations[i]);
        if (!rotations.empty()) {
            const glm::dvec4 q = rotations[i];
            instance.rotation = glm::dquat(q.w, q.x, q.y, q.z);
        }
        if (!scales.empty()) instance.scale = glm::dvec3(scales[i]);
        result.push_back(localMatrix(instance));
    }
    return result;
}

void Drawing::readSkins() {
    std::vector<bool> used(model_.skins.size(), false);
    for (std::size_t node = 0; node < rig_.nodes.size(); ++node) {
        const tinygltf::Node& in = model_.nodes[static_cast<std::size_t>(rig_.fileNode[node])];
        if (rig_.inScene[node] && in.mesh >= 0 && in.skin >= 0) {
            used[static_cast<std::size_t>(in.skin)] = true;
        }
    }
    out_.skins.resize(model_.skins.size());
    for (std::size_t s = 0; s < used.size(); ++s) {
        if (!used[s]) continue;
        const tinygltf::Skin& in = model_.skins[s];
        Skin& skin = out_.skins[s];
        skin.inverseBind.assign(in.joints.size(), glm::dmat4(1));
        if (in.inverseBindMatrices >= 0) {
            skin.inverseBind = reader_.matrices(in.inverseBindMatrices);
        }
        for (const int joint : in.joints) {
            skin.joints.push_back(rig_.rigNode[static_cast<std::size_t>(joint)]);
        }
    }
}

void Drawing::collect() {
    readSkins();
    std::size_t skippedModes = 0, withoutPositions = 0;
    std::uint64_t triangles = 0, elementsKept = 0, elementsRead = 0, bytes = 0;
    for (const tinygltf::Buffer& buffer : model_.buffers) bytes += buffer.data.size();
    meshPrimitives_.resize(model_.meshes.size());
    std::vector<bool> seen(model_.meshes.size(), false);
    for (std::size_t node = 0; node < rig_.nodes.size(); ++node) {
        const tinygltf::Node& in = model_.nodes[static_cast<std::size_t>(rig_.fileNode[node])];
        if (!rig_.inScene[node] || in.mesh < 0) continue;
        const auto mesh = static_cast<std::size_t>(in.mesh);
        const auto& meshPrimitives = model_.meshes[mesh].primitives;
        if (!seen[mesh]) {
            seen[mesh] = true;
            for (std::size_t p = 0; p < meshPrimitives.size(); ++p) {
                if (isLeftOut(meshPrimitives[p])) continue;
                if (drawsTriangles(meshPrimitives[p])) {
                    const PrimitiveSize size = primitiveSize(model_, meshPrimitives[p]);
                    elementsKept += size.elementsKept;
                    elementsRead += size.elementsRead;
                    meshPrimitives_[mesh].push_back(primitiveOf_.size());
                    primitiveOf_.emplace_back(in.mesh, static_cast<int>(p));
                } else if (meshPrimitives[p].mode < TINYGLTF_MODE_TRIANGLES) {
                    ++skippedModes;
                } else {
                    ++withoutPositions;
                }
            }
        }
        if (elementsKept > kElementsForFree + kElementsPerByte * bytes ||
            elementsRead > kMostElementsRead) {
            report_.fail("meshes", "their attributes expand to " + std::to_string(elementsRead) +
                                       " elements, from buffers of " + std::to_string(bytes) +
                                       " bytes: more than is supported");
        }
        if (meshPrimitives_[mesh].empty()) continue;

        std::size_t targets = 0;
        for (const auto& primitive : meshPrimitives)
            targets = std::max(targets, primitive.targets.size());
        std::vector<double> weights;
        if (targets > 0) weights = restWeights(model_, rig_, node, targets);
        const double determinant = glm::determinant(glm::dmat3(world_[node]));
        if (in.skin < 0 && (determinant == 0 || !std::isfinite(determinant))) {
            report_.warn(nodePlace(model_, rig_.fileNode[node]),
                         "its transform cannot be inverted: it flattens what it draws");
        }
        for (const glm::dmat4& instance : instances(node)) {
            for (const std::size_t p : meshPrimitives_[mesh]) {
                const PrimitiveSize size = primitiveSize(
                    model_, meshPrimitives[static_cast<std::size_t>(primitiveOf_[p].second)]);
                triangles += size.triangles;
                if (triangles > kMostTriangles || out_.draws.size() >= kMostDraws) {
                    report_.fail("", "the scene expands to more than is supported: " +
                                         std::to_string(kMostTriangles >> 20) +
                                         " Mi triangles in " + std::to_string(kMostDraws >> 20) +
                                         " Mi instances");
                }
                out_.draws.push_back({p, node, instance, in.skin, weights});
            }
        }
    }
    if (skippedModes > 0) {
        report_.warn("meshes", std::to_string(skippedModes) +
                                   " primitives are points or lines, which are not drawn");
    }
    if (withoutPositions > 0) {
        report_.warn("meshes", std::to_string(withoutPositions) +
                                   " primitives have no positions and are not drawn");
    }
}

void Drawing::readPrimitives(std::span<const MaterialUvs> uvs, const Progress& progress) {
    mv::report(progress, "read meshes", 0);
    out_.primitives.resize(primitiveOf_.size());
    tbb::parallel_for(std::size_t{0}, out_.primitives.size(), [&](std::size_t i) {
        const auto [mesh, number] = primitiveOf_[i];
        const tinygltf::Mesh& in = model_.meshes[static_cast<std::size_t>(mesh)];
        const std::string place = "meshes[" + std::to_string(mesh) + "].primitives[" +
                                  std::to_string(number) + "]" +
                                  (in.name.empty() ? "" : " (" + quote(in.name) + ")");
        out_.primitives[i] = readPrimitive(model_, in.primitives[static_cast<std::size_t>(number)],
                                           place, uvs, report_);
    });
    for (const RiggedDraw& draw : out_.draws) checkJoints(draw);
}

// A skin without joints has none to hang on either.
void Drawing::checkJoints(const RiggedDraw& draw) const {
    if (draw.skin < 0) return;
    const Primitive& primitive = out_.primitives[draw.primitive];
    const std::size_t joints = out_.skins[static_cast<std::size_t>(draw.skin)].joints.size();
    for (const Primitive::Influences& set : primitive.influences) {
        for (std::size_t vertex = 0; vertex < set.weights.size(); ++vertex) {
            for (int k = 0; k < 4; ++k) {
                if (!(set.weights[vertex][k] > 0) || set.joints[vertex][k] < joints) continue;
                report_.fail(primitive.place, "vertex " + std::to_string(vertex) +
                                                  " hangs on joint " +
                                                  std::to_string(set.joints[vertex][k]) +
                                                  ", but the skin has " + std::to_string(joints));
            }
        }
    }
}

void Drawing::warnOfPrimitives() const {
    std::size_t leftOver = 0;
    std::string leftOverPlace;
    for (const Primitive& primitive : out_.primitives) {
        if (primitive.leftOverIndices > 0 && leftOver == 0) leftOverPlace = primitive.place;
        leftOver += primitive.leftOverIndices;
    }
    if (leftOver > 0) {
        report_.warn(leftOverPlace, std::to_string(leftOver) + " indices at the end of " +
                                        "primitives make no whole triangle and are ignored");
    }
}

void Drawing::scaleThickness(std::vector<Material>& materials) const {
    std::vector<bool> done(materials.size(), false);
    for (const RiggedDraw& draw : out_.draws) {
        const std::uint32_t material = out_.primitives[draw.primitive].material;
        if (done[material] || draw.skin >= 0) continue;
        const glm::dmat4 toWorld = world_[draw.node] * draw.instance;
        const double volume = std::abs(glm::determinant(glm::dmat3(toWorld)));
        float& thickness = materials[material].thickness;
        if (std::isfinite(volume)) {
            thickness = std::min(thickness * static_cast<float>(std::cbrt(volume)), 1e30f);
        }
        done[material] = true;
    }
}

}  // namespace

void addGeometry(const tinygltf::Model& model, Rig rig, const GeometryRequest& request,
                 std::span<const MaterialUvs> uvs, Scene& scene, GltfReport& report,
                 const Progress& progress) {
    Drawing drawing(model, std::move(rig), request, report);
    drawing.collect();
    drawing.readPrimitives(uvs, progress);
    drawing.warnOfPrimitives();
    drawing.scaleThickness(scene.materials);
    RiggedScene rigged = drawing.take();
    const bool draws = !rigged.draws.empty();
    std::size_t repeated = 0;
    for (const RiggedDraw& draw : rigged.draws) {
        repeated += rigged.primitives[draw.primitive].repeatedIndices;
    }
    const LeftOut leftOut = assembleGeometry(std::move(rigged), request.time, request.durationS,
                                             request.stated, scene, progress);

    // The default material stands last; who does not need it should not see it.
    const auto last = static_cast<std::uint32_t>(scene.materials.size() - 1);
    const bool used = std::find(scene.triangleMaterials.begin(), scene.triangleMaterials.end(),
                                last) != scene.triangleMaterials.end();
    if (!used && last > 0) scene.materials.pop_back();

    // What was left out, in one sentence a reason.
    if (leftOut.notFinite > 0) {
        report.warn("meshes",
                    std::to_string(leftOut.notFinite) +
                        " triangles have positions that are NaN, infinite or beyond 1e30; "
                        "they are dropped");
    }
    if (leftOut.flat + repeated > 0) {
        report.warn("meshes", std::to_string(leftOut.flat + repeated) +
                                  " triangles have no area; they are dropped");
    }
    if (leftOut.badNormals > 0) {
        report.warn("meshes",
                    std::to_string(leftOut.badNormals) +
                        " vertex normals are zero or not finite; face normals replace them");
    }
    if (draws && scene.triangles.empty()) {
        report.warn("", "nothing can be drawn: the file has no triangle with an area");
    }
}

}  // namespace mv
