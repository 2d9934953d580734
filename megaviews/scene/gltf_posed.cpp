#include "megaviews/scene/gltf_posed.h"

#include <cmath>

namespace mv {

namespace {

// Base plus weighted displacements.
std::vector<glm::dvec3> morphed(const std::vector<glm::dvec3>& base, const Draw& draw,
                                std::vector<glm::dvec3> Primitive::MorphTarget::*displacements) {
    std::vector<glm::dvec3> result = base;
    const auto& targets = draw.primitive->targets;
    for (std::size_t t = 0; t < std::min(targets.size(), draw.morphWeights->size()); ++t) {
        const double weight = (*draw.morphWeights)[t];
        const std::vector<glm::dvec3>& moved = targets[t].*displacements;
        if (weight == 0 || moved.empty()) continue;
        for (std::size_t i = 0; i < result.size(); ++i) result[i] += weight * moved[i];
    }
    return result;
}

// The weighted mean of a vertex's joint matrices.
glm::dmat4 blended(const Draw& draw, std::size_t vertex, const GltfReport& report) {
    glm::dmat4 matrix(0);
    double sum = 0;
    for (const Primitive::Influences& set : draw.primitive->influences) {
        for (int k = 0; k < 4; ++k) {
            const double weight = set.weights[vertex][k];
            if (!(weight > 0)) continue;  // also NaN
            const std::uint32_t joint = set.joints[vertex][k];
            if (joint >= draw.joints->size()) {
                report.fail(draw.primitive->place, "vertex " + std::to_string(vertex) +
                                                       " hangs on joint " + std::to_string(joint) +
                                                       ", but the skin has " +
                                                       std::to_string(draw.joints->size()));
            }
            matrix += weight * (*draw.joints)[joint];
            sum += weight;
        }
    }
    if (!(sum > 0) || !std::isfinite(sum)) return (*draw.joints)[0];
    return matrix * (1 / sum);
}

}  // namespace

glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

PosedVertices pose(const Draw& draw, bool withNormals, const GltfReport& report) {
    const Primitive& primitive = *draw.primitive;
    PosedVertices out;
    const bool morphs = draw.morphWeights && !primitive.targets.empty();
    const bool skins = draw.joints && !primitive.influences.empty();
    std::vector<glm::dvec3> morphedPositions, morphedNormals;
    if (morphs) {
        morphedPositions = morphed(primitive.positions, draw, &Primitive::MorphTarget::positions);
        morphedNormals = morphed(primitive.normals, draw, &Primitive::MorphTarget::normals);
    }
    const std::vector<glm::dvec3>& positions = morphs ? morphedPositions : primitive.positions;
    const std::vector<glm::dvec3>& normals = morphs ? morphedNormals : primitive.normals;

    out.positions.resize(positions.size());
    if (withNormals) out.normals.resize(normals.size());
    if (skins) {
        out.mirrored.resize(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const glm::dmat4 m = blended(draw, i, report);
            const glm::dmat3 linear(m);
            out.positions[i] = linear * positions[i] + glm::dvec3(m[3]);
            out.mirrored[i] = glm::determinant(linear) < 0;
            if (withNormals && !normals.empty()) {
                out.normals[i] = cofactors(linear) * normals[i] * (out.mirrored[i] ? -1.0 : 1.0);
            }
        }
        return out;
    }
    const glm::dmat3 linear(draw.worldFromModel);
    const glm::dvec3 translation(draw.worldFromModel[3]);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        out.positions[i] = linear * positions[i] + translation;
    }
    out.allMirrored = glm::determinant(linear) < 0;
    if (withNormals) {
        const glm::dmat3 turn = cofactors(linear) * (out.allMirrored ? -1.0 : 1.0);
        for (std::size_t i = 0; i < normals.size(); ++i) out.normals[i] = turn * normals[i];
    }
    return out;
}

}  // namespace mv
