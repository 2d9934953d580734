#include "renderer/passes/scene_geometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "megaviews/scene/rigged_scene.h"
#include "shaders/shared/morton.glsl"

namespace mv {
namespace {

float distanceSquared(const GeometryChunk& chunk, glm::vec3 eye) {
    const glm::vec3 away = eye - 0.5f * (chunk.min + chunk.max);
    return glm::dot(away, away);
}

void append(MaterialDraw& draw, const GeometryChunk& chunk) {
    draw.counts.push_back(static_cast<GLsizei>(3 * chunk.triangles));
    draw.offsets.push_back(reinterpret_cast<const void*>(std::uintptr_t{chunk.firstTriangle} * 3 *
                                                         sizeof(std::uint32_t)));
}

void include(const Scene& scene, glm::uvec3 triangle, GeometryChunk& chunk) {
    for (int corner = 0; corner < 3; ++corner) {
        chunk.min = glm::min(chunk.min, scene.positions[triangle[corner]]);
        chunk.max = glm::max(chunk.max, scene.positions[triangle[corner]]);
    }
}

}  // namespace

Frustum::Frustum(const glm::mat4& clipFromWorld) {
    const glm::mat4 rows = glm::transpose(clipFromWorld);
    planes_ = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
               rows[3] - rows[1], rows[2],           rows[3] - rows[2]};
}

bool Frustum::touches(glm::vec3 min, glm::vec3 max) const {
    for (const glm::vec4& plane : planes_) {
        const glm::vec3 normal(plane);
        const glm::vec3 furthest(normal.x > 0 ? max.x : min.x, normal.y > 0 ? max.y : min.y,
                                 normal.z > 0 ? max.z : min.z);
        // Rounding of the three products: a few ulp of their magnitudes.
        const float slack =
            1e-6f * (glm::dot(glm::abs(normal), glm::abs(furthest)) + std::abs(plane.w));
        if (glm::dot(normal, furthest) + plane.w < -slack) return false;
    }
    return true;
}

SceneGeometry::SceneGeometry(const Scene& scene) {
    // Sort the triangles by material, then along the Morton curve; what moves comes last.
    const std::size_t count = scene.triangles.size();
    const std::size_t standing = scene.moving ? scene.moving->triangle : count;
    std::vector<std::uint32_t> keys(count), order(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::uvec3 t = scene.triangles[i];
        keys[i] = mortonKeyOf((scene.positions[t.x] + scene.positions[t.y] + scene.positions[t.z]) /
                              3.0f);
    }
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const bool movesA = a >= standing, movesB = b >= standing;
        return std::tie(movesA, scene.triangleMaterials[a], keys[a], a) <
               std::tie(movesB, scene.triangleMaterials[b], keys[b], b);
    });

    // Cut the sorted list into chunks.
    const std::size_t perChunk = std::clamp<std::size_t>(count / 512, 128, 4096);
    std::vector<glm::uvec3> triangles(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::uvec3 t = scene.triangles[order[i]];
        triangles[i] = t;
        const std::uint32_t material = scene.triangleMaterials[order[i]];
        if (i == standing) firstMovingChunk_ = chunks_.size();
        if (chunks_.empty() || chunks_.back().material != material || i == standing ||
            chunks_.back().triangles == perChunk) {
            GeometryChunk chunk;
            chunk.material = material;
            chunk.firstTriangle = static_cast<std::uint32_t>(i);
            chunks_.push_back(chunk);
        }
        ++chunks_.back().triangles;
        include(scene, t, chunks_.back());
    }
    movingOrder_.assign(order.begin() + static_cast<std::ptrdiff_t>(standing), order.end());

    // Upload. Attributes that the scene lacks stay disabled and read their constant value.
    positions_ = gl::Buffer::of("scene positions", scene.positions);
    normals_ = gl::Buffer::of("scene normals", scene.normals);
    indices_ = gl::Buffer::of("scene triangles", triangles);
    vertices_ = gl::VertexArray("scene");
    vertices_.floats(kPositionAttribute, positions_, 3, sizeof(glm::vec3));
    vertices_.floats(kNormalAttribute, normals_, 3, sizeof(glm::vec3));
    vertices_.indices(indices_);
    if (scene.moving) {
        positionsBefore_ = gl::Buffer::of("scene positions before", scene.positions);
        vertices_.floats(kPositionBeforeAttribute, positionsBefore_, 3, sizeof(glm::vec3));
        const std::span moving = std::span(scene.positions).subspan(scene.moving->vertex);
        movingPositions_.assign(moving.begin(), moving.end());
    }
    if (!scene.colors.empty()) {
        colors_ = gl::Buffer::of("scene vertex colours", scene.colors);
        vertices_.floats(kColorAttribute, colors_, 4, sizeof(glm::vec4));
    }
    if (!scene.uvs.empty()) {
        uvs_ = gl::Buffer::of("scene texture coordinates", scene.uvs);
        vertices_.floats(kUvAttribute, uvs_, 2, sizeof(glm::vec2));
    }
    if (!scene.emissiveUvs.empty()) {
        emissiveUvs_ = gl::Buffer::of("scene emissive texture coordinates", scene.emissiveUvs);
        vertices_.floats(kEmissiveUvAttribute, emissiveUvs_, 2, sizeof(glm::vec2));
    }
}

void SceneGeometry::setPose(const Scene& scene) {
    const std::uint32_t first = scene.moving->vertex;
    const std::span moving = std::span(scene.positions).subspan(first);
    largestStep_ = 0;
    for (std::size_t i = 0; i < moving.size(); ++i) {
        const glm::vec3 step = glm::abs(moving[i] - movingPositions_[i]);
        largestStep_ = std::max({largestStep_, step.x, step.y, step.z});
    }
    positionsBefore_.write(first, std::span<const glm::vec3>(movingPositions_));
    positions_.write(first, moving);
    movingPositions_.assign(moving.begin(), moving.end());
    normals_.write(first, std::span(scene.normals).subspan(first));
    std::vector<glm::uvec3> triangles;
    triangles.reserve(movingOrder_.size());
    for (const std::uint32_t t : movingOrder_) triangles.push_back(scene.triangles[t]);
    indices_.write(scene.moving->triangle, std::span<const glm::uvec3>(triangles));
    std::size_t next = 0;
    for (std::size_t i = firstMovingChunk_; i < chunks_.size(); ++i) {
        GeometryChunk& chunk = chunks_[i];
        chunk.min = glm::vec3(kInfinity);
        chunk.max = glm::vec3(-kInfinity);
        for (std::uint32_t t = 0; t < chunk.triangles; ++t) {
            include(scene, triangles[next++], chunk);
        }
    }
}

std::vector<MaterialDraw> SceneGeometry::visible(const Frustum& frustum, glm::vec3 eye) const {
    std::vector<std::pair<float, std::uint32_t>> nearest;  // distance^2, chunk
    for (std::uint32_t i = 0; i < chunks_.size(); ++i) {
        if (frustum.touches(chunks_[i].min, chunks_[i].max)) {
            nearest.emplace_back(distanceSquared(chunks_[i], eye), i);
        }
    }
    std::sort(nearest.begin(), nearest.end());
    // Shells around the eye, each 1.4 times as wide as the one inside it.
    std::vector<MaterialDraw> draws;
    std::unordered_map<std::uint32_t, std::size_t> drawOfMaterial;
    int shell = 0;
    for (const auto& [distance, index] : nearest) {
        const int chunkShell = std::ilogb(std::max(distance, 1e-6f));
        if (chunkShell != shell) drawOfMaterial.clear();
        shell = chunkShell;
        const GeometryChunk& chunk = chunks_[index];
        const auto [known, isNew] = drawOfMaterial.try_emplace(chunk.material, draws.size());
        if (isNew) draws.push_back({chunk.material, {}, {}});
        append(draws[known->second], chunk);
    }
    return draws;
}

void SceneGeometry::draw(const MaterialDraw& draw) const {
    glMultiDrawElements(GL_TRIANGLES, draw.counts.data(), GL_UNSIGNED_INT, draw.offsets.data(),
                        static_cast<GLsizei>(draw.counts.size()));
}

std::uint64_t SceneGeometry::bytes() const {
    return positions_.bytes() + positionsBefore_.bytes() + normals_.bytes() + colors_.bytes() +
           uvs_.bytes() + emissiveUvs_.bytes() + indices_.bytes();
}

}  // namespace mv
