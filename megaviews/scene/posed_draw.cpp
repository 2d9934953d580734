#include "megaviews/scene/posed_draw.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mv {

namespace {

constexpr double kLargestCoordinate = 1e30;

bool usable(glm::dvec3 p) {  // false for NaN
    return std::abs(p.x) < kLargestCoordinate && std::abs(p.y) < kLargestCoordinate &&
           std::abs(p.z) < kLargestCoordinate;
}

bool zero(glm::dvec3 v) { return v == glm::dvec3(0); }

// Base plus weighted displacements.
std::vector<glm::dvec3> morphed(const std::vector<glm::dvec3>& base, const Draw& draw,
                                std::vector<glm::dvec3> Primitive::MorphTarget::*displacements) {
    std::vector<glm::dvec3> result = base;
    const auto& targets = draw.primitive->targets;
    for (std::size_t t = 0; t < std::min(targets.size(), draw.morphWeights.size()); ++t) {
        const double weight = draw.morphWeights[t];
        const std::vector<glm::dvec3>& moved = targets[t].*displacements;
        if (weight == 0 || moved.empty()) continue;
        for (std::size_t i = 0; i < result.size(); ++i) result[i] += weight * moved[i];
    }
    return result;
}

// The weighted mean of a vertex's joint matrices.
glm::dmat4 blended(const Draw& draw, std::size_t vertex) {
    glm::dmat4 matrix(0);
    double sum = 0;
    for (const Primitive::Influences& set : draw.primitive->influences) {
        for (int k = 0; k < 4; ++k) {
            const double weight = set.weights[vertex][k];
            if (!(weight > 0)) continue;  // also NaN
            const std::uint32_t joint = set.joints[vertex][k];
            matrix += weight * draw.joints->at(joint);
            sum += weight;
        }
    }
    if (!(sum > 0) || !std::isfinite(sum)) return (*draw.joints)[0];
    return matrix * (1 / sum);
}

// Face normals replace vertex normals that are zero or not finite.
void repairNormals(PosedVertices& posed, const std::vector<glm::uvec3>& triangles,
                   ScenePiece& piece) {
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

}  // namespace

glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

PosedVertices pose(const Draw& draw, bool withNormals) {
    const Primitive& primitive = *draw.primitive;
    PosedVertices out;
    const bool morphs = !draw.morphWeights.empty() && !primitive.targets.empty();
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
            const glm::dmat4 m = blended(draw, i);
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

std::vector<std::uint32_t> dropUnusedVertices(std::vector<glm::uvec3>& triangles,
                                              std::size_t vertices) {
    constexpr std::uint32_t kUnused = UINT32_MAX;
    std::vector<std::uint32_t> newIndex(vertices, kUnused), kept;
    for (const glm::uvec3& t : triangles) newIndex[t.x] = newIndex[t.y] = newIndex[t.z] = 0;
    for (std::uint32_t i = 0; i < vertices; ++i) {
        if (newIndex[i] == kUnused) continue;
        newIndex[i] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(i);
    }
    for (glm::uvec3& t : triangles) t = {newIndex[t.x], newIndex[t.y], newIndex[t.z]};
    return kept;
}

WorldBox worldBox(const Draw& draw) {
    const PosedVertices posed = pose(draw, false);
    WorldBox box;
    for (const glm::uvec3& t : draw.primitive->triangles) {
        const glm::dvec3 &a = posed.positions[t.x], &b = posed.positions[t.y],
                         &c = posed.positions[t.z];
        if (!usable(a) || !usable(b) || !usable(c)) continue;
        box.add(a), box.add(b), box.add(c);
    }
    return box;
}

double worldArea(const Draw& draw) {
    const PosedVertices posed = pose(draw, false);
    double sum = 0;
    for (const glm::uvec3& t : draw.primitive->triangles) {
        const glm::dvec3 &a = posed.positions[t.x], &b = posed.positions[t.y],
                         &c = posed.positions[t.z];
        if (usable(a) && usable(b) && usable(c)) sum += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return sum;
}

ScenePiece makePiece(const Draw& draw, const RootCube& root, bool moves) {
    const Primitive& primitive = *draw.primitive;
    PosedVertices posed = pose(draw, true);
    ScenePiece piece;
    std::vector<glm::vec3> positions(posed.positions.size());
    std::vector<bool> finite(posed.positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        finite[i] = usable(posed.positions[i]);
        positions[i] = finite[i] ? root.rootFromWorld(posed.positions[i]) : glm::vec3(0);
        if (moves) positions[i] = glm::clamp(positions[i], 0.0f, 1.0f);
    }

    // Triangles that can be drawn, turned where the pose mirrors them. Those that move stay, since
    // the next pose may need them: what has no place is drawn together to what has.
    std::vector<glm::uvec3> triangles;
    triangles.reserve(primitive.triangles.size());
    for (glm::uvec3 t : primitive.triangles) {
        if (!finite[t.x] || !finite[t.y] || !finite[t.z]) {
            ++piece.notFinite;
            if (!moves) continue;
            const glm::vec3 place = positions[finite[t.x] ? t.x : finite[t.y] ? t.y : t.z];
            for (int k = 0; k < 3; ++k) {
                if (!finite[t[k]]) positions[t[k]] = place;
            }
        }
        const glm::dvec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
        if (!moves && zero(glm::cross(b - a, c - a))) {
            ++piece.flat;
            continue;
        }
        triangles.push_back(t);
    }

    // Vertices in use; a vertex of flat-shaded triangles is one triangle's alone.
    std::vector<std::uint32_t> vertices;
    if (primitive.normals.empty()) {
        vertices.reserve(3 * triangles.size());
        for (glm::uvec3& t : triangles) {
            const glm::uvec3 corners = t;  // in the file's order: that of vertices in every pose
            const bool over = posed.turnsOver(t);
            if (over) std::swap(t.y, t.z);
            const glm::dvec3 p = posed.positions[t.x];
            glm::dvec3 area = glm::cross(posed.positions[t.y] - p, posed.positions[t.z] - p);
            const double largest = std::max({std::abs(area.x), std::abs(area.y), std::abs(area.z)});
            if (!(largest > 0)) {  // lost to underflow, though not so in root-cube units
                const glm::dvec3 q = positions[t.x];
                area = glm::cross(glm::dvec3(positions[t.y]) - q, glm::dvec3(positions[t.z]) - q);
            } else {
                area /= largest;
            }
            const double length = glm::length(area);
            const glm::vec3 normal(length > 0 ? area / length : glm::dvec3(0, 1, 0));
            for (int k = 0; k < 3; ++k) {
                t[k] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(corners[k]);
                piece.normals.push_back(normal);
            }
            if (over) std::swap(t.y, t.z);
        }
    } else {
        for (glm::uvec3& t : triangles) {
            if (posed.turnsOver(t)) std::swap(t.y, t.z);
        }
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

}  // namespace mv
