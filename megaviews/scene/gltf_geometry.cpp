#include "megaviews/scene/gltf_geometry.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

#include "megaviews/scene/gltf_posed.h"
#include "megaviews/scene/pose.h"

namespace mv {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargestCoordinate = 1e30;

struct Box {
    glm::dvec3 min{kInfinity}, max{-kInfinity};
    void add(glm::dvec3 p) { min = glm::min(min, p), max = glm::max(max, p); }
    void add(const Box& b) { min = glm::min(min, b.min), max = glm::max(max, b.max); }
};

bool usable(glm::dvec3 p) {  // false for NaN
    return std::abs(p.x) < kLargestCoordinate && std::abs(p.y) < kLargestCoordinate &&
           std::abs(p.z) < kLargestCoordinate;
}

bool zero(glm::dvec3 v) { return v == glm::dvec3(0); }

// What one draw adds to the scene.
struct Piece {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> colors;
    std::vector<glm::vec2> uvs, emissiveUvs;
    std::vector<glm::uvec3> triangles;
    std::size_t notFinite = 0, flat = 0, badNormals = 0;
};

// Face normals replace vertex normals that are zero or not finite.
void repairNormals(PosedVertices& posed, const std::vector<glm::uvec3>& triangles, Piece& piece) {
    std::vector<bool> bad(posed.normals.size());
    for (std::size_t i = 0; i < bad.size(); ++i) {
        const double length = glm::length(posed.normals[i]);
        bad[i] = !(length > 0) || !std::isfinite(length);
        posed.normals[i] = bad[i] ? glm::dvec3(0) : posed.normals[i] / length;
        if (bad[i]) ++piece.badNormals;
    }
    if (piece.badNormals == 0) return;
    for (const glm::uvec3& t : triangles) {
        if (!bad[t.x] && !bad[t.y] && !bad[t.z]) continue;
        const glm::dvec3 p = posed.positions[t.x];
        const glm::dvec3 area = glm::cross(posed.positions[t.y] - p, posed.positions[t.z] - p);
        for (int k = 0; k < 3; ++k) {
            if (bad[t[k]]) posed.normals[t[k]] += area;
        }
    }
    for (std::size_t i = 0; i < bad.size(); ++i) {
        if (!bad[i]) continue;
        const double length = glm::length(posed.normals[i]);
        posed.normals[i] = length > 0 ? posed.normals[i] / length : glm::dvec3(0, 1, 0);
    }
}

template <typename T>
std::vector<T> pick(const std::vector<T>& from, const std::vector<std::uint32_t>& which) {
    std::vector<T> result;
    if (from.empty()) return result;
    result.reserve(which.size());
    for (const std::uint32_t i : which) result.push_back(from[i]);
    return result;
}

Piece makePiece(const Draw& draw, const RootCube& root, const GltfReport& report) {
    const Primitive& primitive = *draw.primitive;
    PosedVertices posed = pose(draw, true, report);
    Piece piece;
    std::vector<glm::vec3> positions(posed.positions.size());
    std::vector<bool> finite(posed.positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        finite[i] = usable(posed.positions[i]);
        positions[i] = finite[i] ? root.rootFromWorld(posed.positions[i]) : glm::vec3(0);
    }

    // Triangles that can be drawn, turned where the pose mirrors them.
    std::vector<glm::uvec3> triangles;
    triangles.reserve(primitive.triangles.size());
    for (glm::uvec3 t : primitive.triangles) {
        if (!finite[t.x] || !finite[t.y] || !finite[t.z]) {
            ++piece.notFinite;
            continue;
        }
        const glm::dvec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
        if (zero(glm::cross(b - a, c - a))) {
            ++piece.flat;
            continue;
        }
        if (posed.turnsOver(t)) std::swap(t.y, t.z);
        triangles.push_back(t);
    }

    // Vertices in use; a vertex of flat-shaded triangles is one triangle's alone.
    std::vector<std::uint32_t> vertices;
    if (primitive.normals.empty()) {
        vertices.reserve(3 * triangles.size());
        for (glm::uvec3& t : triangles) {
            const glm::dvec3 p = posed.positions[t.x];
            glm::dvec3 area = glm::cross(posed.positions[t.y] - p, posed.positions[t.z] - p);
            const double largest = std::max({std::abs(area.x), std::abs(area.y), std::abs(area.z)});
            if (!(largest > 0)) {  // lost to underflow, though not so in root-cube units
                const glm::dvec3 q = positions[t.x];
                area = glm::cross(glm::dvec3(positions[t.y]) - q, glm::dvec3(positions[t.z]) - q);
            } else {
                area /= largest;
            }
            const glm::vec3 normal(glm::normalize(area));
            for (int k = 0; k < 3; ++k) {
                vertices.push_back(t[k]);
                piece.normals.push_back(normal);
                t[k] = static_cast<std::uint32_t>(vertices.size() - 1);
            }
        }
    } else {
        repairNormals(posed, triangles, piece);
        vertices = dropUnusedVertices(triangles, positions.size());
        piece.normals.reserve(vertices.size());
        for (const std::uint32_t i : vertices) piece.normals.emplace_back(posed.normals[i]);
    }
    piece.positions = pick(positions, vertices);
    piece.colors = pick(primitive.colors, vertices);
    piece.uvs = pick(primitive.uvs, vertices);
    piece.emissiveUvs = pick(primitive.emissiveUvs, vertices);
    piece.triangles = std::move(triangles);
    return piece;
}

Box worldBox(const Draw& draw, const GltfReport& report) {
    const PosedVertices posed = pose(draw, false, report);
    Box box;
    for (const glm::uvec3& t : draw.primitive->triangles) {
        const glm::dvec3 &a = posed.positions[t.x], &b = posed.positions[t.y],
                         &c = posed.positions[t.z];
        if (!usable(a) || !usable(b) || !usable(c)) continue;
        box.add(a), box.add(b), box.add(c);
    }
    return box;
}

// Whether a cube leaves a box half of the margin that one around it would, and is not much larger.
bool fits(const RootCube& cube, const Box& box, const RootCube& around) {
    constexpr float kMargin = 1.0f / 128;
    const glm::vec3 low = cube.rootFromWorld(box.min), high = cube.rootFromWorld(box.max);
    for (int k = 0; k < 3; ++k) {
        if (!(low[k] >= kMargin && high[k] <= 1 - kMargin)) return false;  // also NaN, an empty box
    }
    return cube.edge <= 2 * around.edge;
}

// All draws of a scene with what they share.
class Drawing {
  public:
    Drawing(const tinygltf::Model& model, const Rig& rig, PoseTime time, GltfReport& report)
        : model_(model), rig_(rig), time_(time), report_(report), reader_(model, report) {
        const bool animated = time.animation >= 0;
        world_ = worldMatrices(
            rig.nodes,
            animated ? &rig.animations[static_cast<std::size_t>(time.animation)] : nullptr,
            time.timeS);
    }

    // Which primitives are drawn where; nothing is read yet but instances and skins.
    void collect();
    // Reads the primitives that are drawn.
    void readPrimitives(std::span<const MaterialUvs> uvs, const Progress& progress);
    std::span<const Draw> draws() const { return draws_; }
    std::span<const Primitive> primitives() const { return primitives_; }

  private:
    std::vector<glm::dmat4> instances(std::size_t node) const;
    const std::vector<glm::dmat4>* joints(int skin);

    const tinygltf::Model& model_;
    const Rig& rig_;
    PoseTime time_;
    GltfReport& report_;
    AccessorReader reader_;
    std::vector<glm::dmat4> world_;
    std::vector<Primitive> primitives_;
    std::vector<std::pair<int, int>> primitiveOf_;          // parallel: mesh, number in it
    std::vector<std::vector<std::size_t>> meshPrimitives_;  // a mesh's entries in primitives_
    std::vector<std::size_t> drawPrimitive_;                // parallel to draws_
    std::vector<Draw> draws_;
    std::vector<std::unique_ptr<std::vector<glm::dmat4>>> joints_;  // a skin each
    std::vector<std::unique_ptr<std::vector<double>>> weights_;
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

const std::vector<glm::dmat4>* Drawing::joints(int skin) {
    const auto s = static_cast<std::size_t>(skin);
    joints_.resize(model_.skins.size());
    if (joints_[s]) return joints_[s].get();
    const tinygltf::Skin& in = model_.skins[s];
    std::vector<glm::dmat4> inverseBind(in.joints.size(), glm::dmat4(1));
    if (in.inverseBindMatrices >= 0) inverseBind = reader_.matrices(in.inverseBindMatrices);
    joints_[s] = std::make_unique<std::vector<glm::dmat4>>();
    for (std::size_t j = 0; j < in.joints.size(); ++j) {
        const int node = rig_.rigNode[static_cast<std::size_t>(in.joints[j])];
        joints_[s]->push_back(world_[static_cast<std::size_t>(node)] * inverseBind[j]);
    }
    return joints_[s].get();
}

void Drawing::collect() {
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

        const std::vector<glm::dmat4>* skin = in.skin >= 0 ? joints(in.skin) : nullptr;
        std::size_t targets = 0;
        for (const auto& primitive : meshPrimitives)
            targets = std::max(targets, primitive.targets.size());
        const std::vector<double>* weights = nullptr;
        if (targets > 0) {
            weights_.push_back(std::make_unique<std::vector<double>>(
                morphWeights(model_, rig_, node, time_.animation, time_.timeS, targets)));
            weights = weights_.back().get();
        }
        const double determinant = glm::determinant(glm::dmat3(world_[node]));
        if (!skin && (determinant == 0 || !std::isfinite(determinant))) {
            report_.warn(nodePlace(model_, rig_.fileNode[node]),
                         "its transform cannot be inverted: it flattens what it draws");
        }
        for (const glm::dmat4& instance : instances(node)) {
            for (const std::size_t p : meshPrimitives_[mesh]) {
                const PrimitiveSize size = primitiveSize(
                    model_, meshPrimitives[static_cast<std::size_t>(primitiveOf_[p].second)]);
                triangles += size.triangles;
                if (triangles > kMostTriangles || draws_.size() >= kMostDraws) {
                    report_.fail("", "the scene expands to more than is supported: " +
                                         std::to_string(kMostTriangles >> 20) +
                                         " Mi triangles in " + std::to_string(kMostDraws >> 20) +
                                         " Mi instances");
                }
                draws_.push_back({nullptr, world_[node] * instance, skin, weights});
                drawPrimitive_.push_back(p);
            }
        }
    }
    if (skippedModes > 0) {
        report_.warn("meshes", std::to_string(skippedModes) +
                                   " primitives are points or lines, which are not drawn");
    }
    if (withoutPositions > 0) {
        report_.warn("meshes", std::to_string(withoutPositions) +
                                   " primitives have no POSITION and are not drawn");
    }
}

void Drawing::readPrimitives(std::span<const MaterialUvs> uvs, const Progress& progress) {
    mv::report(progress, "read meshes", 0);
    primitives_.resize(primitiveOf_.size());
    tbb::parallel_for(std::size_t{0}, primitives_.size(), [&](std::size_t i) {
        const auto [mesh, number] = primitiveOf_[i];
        const tinygltf::Mesh& in = model_.meshes[static_cast<std::size_t>(mesh)];
        const std::string place = "meshes[" + std::to_string(mesh) + "].primitives[" +
                                  std::to_string(number) + "]" +
                                  (in.name.empty() ? "" : " (" + quote(in.name) + ")");
        primitives_[i] = readPrimitive(model_, in.primitives[static_cast<std::size_t>(number)],
                                       place, uvs, report_);
    });
    for (std::size_t i = 0; i < draws_.size(); ++i) {
        draws_[i].primitive = &primitives_[drawPrimitive_[i]];
    }
}

// Appends the pieces in order; an optional array exists if any piece has it.
void join(std::span<const Piece> pieces, std::span<const Draw> draws, Scene& scene) {
    std::vector<std::size_t> firstVertex{0}, firstTriangle{0};
    bool colors = false, uvs = false, emissiveUvs = false;
    for (const Piece& piece : pieces) {
        firstVertex.push_back(firstVertex.back() + piece.positions.size());
        firstTriangle.push_back(firstTriangle.back() + piece.triangles.size());
        colors = colors || !piece.colors.empty();
        uvs = uvs || !piece.uvs.empty();
        emissiveUvs = emissiveUvs || !piece.emissiveUvs.empty();
    }
    const std::size_t vertices = firstVertex.back(), triangles = firstTriangle.back();
    scene.positions.resize(vertices);
    scene.normals.resize(vertices);
    if (colors) scene.colors.assign(vertices, glm::vec4(1));
    if (uvs) scene.uvs.assign(vertices, glm::vec2(0));
    if (emissiveUvs) scene.emissiveUvs.assign(vertices, glm::vec2(0));
    scene.triangles.resize(triangles);
    scene.triangleMaterials.resize(triangles);
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
        const Piece& piece = pieces[i];
        const auto at = static_cast<std::ptrdiff_t>(firstVertex[i]);
        std::copy(piece.positions.begin(), piece.positions.end(), scene.positions.begin() + at);
        std::copy(piece.normals.begin(), piece.normals.end(), scene.normals.begin() + at);
        std::copy(piece.colors.begin(), piece.colors.end(),
                  scene.colors.begin() + (colors ? at : 0));
        std::copy(piece.uvs.begin(), piece.uvs.end(), scene.uvs.begin() + (uvs ? at : 0));
        std::copy(piece.emissiveUvs.begin(), piece.emissiveUvs.end(),
                  scene.emissiveUvs.begin() + (emissiveUvs ? at : 0));
        for (std::size_t t = 0; t < piece.triangles.size(); ++t) {
            scene.triangles[firstTriangle[i] + t] =
                piece.triangles[t] + static_cast<std::uint32_t>(firstVertex[i]);
            scene.triangleMaterials[firstTriangle[i] + t] = draws[i].primitive->material;
        }
    });
}

}  // namespace

bool geometryMoves(const tinygltf::Model& model, const Rig& rig, int animation) {
    if (animation < 0) return false;
    const auto a = static_cast<std::size_t>(animation);
    if (!rig.weightChannels[a].empty()) return true;
    // Nodes that meshes hang on, directly or as a skin's joints, and the ancestors of both.
    std::vector<bool> carries(rig.nodes.size(), false);
    const auto markUpwards = [&](int node) {
        for (; node >= 0 && !carries[static_cast<std::size_t>(node)];
             node = rig.nodes[static_cast<std::size_t>(node)].parent) {
            carries[static_cast<std::size_t>(node)] = true;
        }
    };
    for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
        const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(rig.fileNode[i])];
        if (!rig.inScene[i] || node.mesh < 0) continue;
        markUpwards(static_cast<int>(i));
        if (node.skin < 0) continue;
        for (const int joint : model.skins[static_cast<std::size_t>(node.skin)].joints) {
            markUpwards(rig.rigNode[static_cast<std::size_t>(joint)]);
        }
    }
    const auto& channels = rig.animations[a].channels;
    return std::any_of(channels.begin(), channels.end(), [&](const AnimationChannel& channel) {
        return carries[static_cast<std::size_t>(channel.node)] && channel.times.size() > 1;
    });
}

void addGeometry(const tinygltf::Model& model, const Rig& rig, PoseTime time,
                 std::span<const MaterialUvs> uvs, const std::optional<RootCube>& stated,
                 Scene& scene, GltfReport& report, const Progress& progress) {
    Drawing drawing(model, rig, time, report);
    drawing.collect();
    drawing.readPrimitives(uvs, progress);
    const std::span<const Draw> draws = drawing.draws();

    mv::report(progress, "place geometry", 0);
    const Box box = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, draws.size()), Box{},
        [&](const tbb::blocked_range<std::size_t>& range, Box sum) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                sum.add(worldBox(draws[i], report));
            return sum;
        },
        [](Box a, const Box& b) { return a.add(b), a; });
    scene.root = RootCube::around(box.min, box.max);
    if (stated && fits(*stated, box, scene.root)) scene.root = *stated;

    std::vector<Piece> pieces(draws.size());
    std::atomic<std::size_t> done{0};
    tbb::parallel_for(std::size_t{0}, draws.size(), [&](std::size_t i) {
        pieces[i] = makePiece(draws[i], scene.root, report);
        const std::size_t count = ++done;
        if (count % (draws.size() / 10 + 1) == 0) {
            mv::report(progress, "place geometry",
                       static_cast<float>(count) / static_cast<float>(draws.size()));
        }
    });
    join(pieces, draws, scene);

    // The default material stands last; who does not need it should not see it.
    const auto last = static_cast<std::uint32_t>(scene.materials.size() - 1);
    const bool used = std::find(scene.triangleMaterials.begin(), scene.triangleMaterials.end(),
                                last) != scene.triangleMaterials.end();
    if (!used && last > 0) scene.materials.pop_back();

    // What was left out, in one sentence a reason.
    std::size_t notFinite = 0, flat = 0, badNormals = 0, leftOver = 0;
    for (const Piece& piece : pieces) {
        notFinite += piece.notFinite;
        flat += piece.flat;
        badNormals += piece.badNormals;
    }
    std::string leftOverPlace;
    for (const Draw& draw : draws) flat += draw.primitive->repeatedIndices;
    for (const Primitive& primitive : drawing.primitives()) {
        if (primitive.leftOverIndices > 0 && leftOver == 0) leftOverPlace = primitive.place;
        leftOver += primitive.leftOverIndices;
    }
    if (leftOver > 0) {
        report.warn(leftOverPlace, std::to_string(leftOver) + " indices at the end of " +
                                       "primitives make no whole triangle and are ignored");
    }
    if (notFinite > 0) {
        report.warn("meshes",
                    std::to_string(notFinite) +
                        " triangles have positions that are NaN, infinite or beyond 1e30; "
                        "they are dropped");
    }
    if (flat > 0) {
        report.warn("meshes", std::to_string(flat) + " triangles have no area; they are dropped");
    }
    if (badNormals > 0) {
        report.warn("meshes",
                    std::to_string(badNormals) +
                        " vertex normals are zero or not finite; face normals replace them");
    }
    if (!draws.empty() && scene.triangles.empty()) {
        report.warn("", "nothing can be drawn: the file has no triangle with an area");
    }
}

}  // namespace mv
