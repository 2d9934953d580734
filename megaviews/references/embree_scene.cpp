#include "megaviews/references/embree_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

#include "megaviews/core/error.h"

namespace mv {

struct EmbreeScene::Impl {
    const TriangleBvh* bvh = nullptr;
    BvhData data;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    ~Impl() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    void check(const char* what) const {
        const RTCError error = rtcGetDeviceError(device);
        if (error == RTC_ERROR_NONE) return;
        throw Error(ExitCode::impossible,
                    std::string("Embree: ") + what + ": error " + std::to_string(error));
    }
};

namespace {

// Refuses hits where the alpha mask is transparent.
void refuseMaskedOut(const RTCFilterFunctionNArguments* args) {
    const auto* data = static_cast<const BvhData*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const BvhTriangle& triangle = data->triangles[RTCHitN_primID(args->hit, args->N, i)];
        if ((triangle.material & kMaterialMask) == 0) continue;
        if (bvhMaskedOut(*data, triangle.triangle, triangle.material & ~kMaterialMask,
                         RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i))) {
            args->valid[i] = 0;
        }
    }
}

RTCRay rayOf(glm::vec3 origin, glm::vec3 direction, float tMin, float tMax) {
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.tnear = tMin;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = tMax;
    ray.mask = ~0u;
    return ray;
}

}  // namespace

EmbreeScene::EmbreeScene(const TriangleBvh& bvh) : impl_(std::make_unique<Impl>()) {
    Impl& m = *impl_;
    m.bvh = &bvh;
    m.data = bvh.data();
    m.device = rtcNewDevice(nullptr);
    if (!m.device) throw Error(ExitCode::impossible, "Embree: no device");
    m.scene = rtcNewScene(m.device);
    rtcSetSceneFlags(m.scene, RTC_SCENE_FLAG_ROBUST);

    // Primitives in the order of bvh.triangles, so that a hit's primID is its slot. A triangle
    // stands in one of its slots; those of its other pieces are points, which no ray hits.
    const std::size_t count = bvh.triangles.size();
    if (count != 0) {
        RTCGeometry geometry = rtcNewGeometry(m.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * count));
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), count));
        m.check("buffers");
        for (std::size_t i = 0; i < count; ++i) {
            const glm::uvec3 corners = bvh.scene->triangles[bvh.triangles[i].triangle];
            for (int k = 0; k < 3; ++k) {
                const std::size_t at = 3 * i + static_cast<std::size_t>(k);
                std::memcpy(vertices + 3 * at, &bvh.scene->positions[corners[k]], 12);
                indices[at] = static_cast<std::uint32_t>(bvh.isFirst(i) ? at : 3 * i);
            }
        }
        rtcSetGeometryUserData(geometry, &m.data);
        if (bvh.flags & kBvhMasks) {
            rtcSetGeometryIntersectFilterFunction(geometry, refuseMaskedOut);
            rtcSetGeometryOccludedFilterFunction(geometry, refuseMaskedOut);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(m.scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(m.scene);
    m.check("building");
}

EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;

std::optional<RayHit> EmbreeScene::intersect(glm::vec3 origin, glm::vec3 direction, float tMin,
                                             float tMax) const {
    RTCRayHit query{};
    query.ray = rayOf(origin, direction, tMin, tMax);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(impl_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const std::uint32_t slot = query.hit.primID;
    return RayHit{.t = query.ray.tfar,
                  .triangle = impl_->bvh->triangles[slot].triangle,
                  .slot = slot,
                  .u = query.hit.u,
                  .v = query.hit.v};
}

bool EmbreeScene::occluded(glm::vec3 origin, glm::vec3 direction, float tMin, float tMax) const {
    RTCRay ray = rayOf(origin, direction, tMin, tMax);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(impl_->scene, &context, &ray);
    return ray.tfar < 0;  // Embree's answer is -infinity
}

glm::vec3 EmbreeScene::passed(const BvhData& bvh, glm::vec3 origin, glm::vec3 direction, float tMin,
                              float tMax) const {
    if (occluded(origin, direction, tMin, tMax)) return glm::vec3(0);
    if ((bvh.flags & kBvhTints) == 0u) return glm::vec3(1);
    return bvhPassed(bvh, origin, direction, tMin, tMax);
}

void EmbreeScene::closestDepths(glm::vec3 origin, std::span<const glm::vec3> directions,
                                std::span<float> depths) const {
    constexpr std::size_t kLanes = 8;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (std::size_t first = 0; first < directions.size(); first += kLanes) {
        alignas(32) int valid[kLanes];
        RTCRayHit8 query{};
        for (std::size_t k = 0; k < kLanes; ++k) {
            const glm::vec3 d = directions[std::min(first + k, directions.size() - 1)];
            valid[k] = first + k < directions.size() ? -1 : 0;
            query.ray.org_x[k] = origin.x;
            query.ray.org_y[k] = origin.y;
            query.ray.org_z[k] = origin.z;
            query.ray.dir_x[k] = d.x;
            query.ray.dir_y[k] = d.y;
            query.ray.dir_z[k] = d.z;
            query.ray.tfar[k] = std::numeric_limits<float>::infinity();
            query.ray.mask[k] = ~0u;
            query.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect8(valid, impl_->scene, &context, &query);
        for (std::size_t k = 0; k < kLanes && first + k < directions.size(); ++k) {
            depths[first + k] = query.ray.tfar[k];
        }
    }
}

const TriangleBvh& EmbreeScene::bvh() const { return *impl_->bvh; }

}  // namespace mv
