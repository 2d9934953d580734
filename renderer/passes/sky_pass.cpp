#include "renderer/passes/sky_pass.h"

#include <algorithm>

#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

constexpr std::uint32_t kRaysAtOnce = 4, kLookupsAtOnce = 16;
constexpr int kSliceRows = 32;

}  // namespace

void GpuSky::set(const std::shared_ptr<const Sky>& sky) {
    if (sky_ == sky) return;
    sky_ = nullptr;
    if (!sky) {
        texels_ = {};
        return;
    }
    texels_.ensure("sky", sky->texels.size());
    texels_.write(0, sky->texels);
    sky_ = sky;
}

void GpuSky::bindTexels() const {
    if (sky_) texels_.bindTexels(kUnitSky);
}

void GpuSky::bind(gl::Program& program) const {
    bindTexels();
    program.set("skyRows", sky_->rows);
}

gl::Program& SkyPass::prepare(const SkyRays& rays, const GBuffer& gbuffer, bool alone,
                              const gl::Texture& irradiance) {
    const BvhTables& triangles = *rays.triangles;
    const bool shares = !alone && rays.seenShares;
    const auto gloss = static_cast<std::size_t>(gbuffer.glossKind());
    const auto passing = static_cast<std::size_t>(triangles.passing());
    const std::size_t where = alone ? 1 : shares ? 2 : 0;
    gl::Program& p = programs_[rays.maps ? 1 : 0][where][passing][gloss];
    if (!p) {
        gl::Defines defines = triangles.rayDefines();
        if (alone) defines.emplace_back("MV_ALONE", "1");
        if (shares) defines.emplace_back("MV_SEEN_SHARES", "1");
        if (rays.maps) defines.emplace_back("MV_SKY_MAPS", "1");
        gbuffer.addGlossDefines(defines);
        p = gl::Program("sky light", {"passes/sky_light.comp"}, defines);
    }
    triangles.bind(p, gbuffer.isFull());
    if (rays.maps) {
        rays.maps->bind(p);
    } else {
        rays.sky->bind(p);
        p.set("tableShare", rays.sky->sky()->tableShare);
    }
    if (shares) rays.seenShares->bind(kUnitReflectionWeight);
    if (gloss > 0) gbuffer.bindGloss(p);
    if (gloss > 0 || shares) {
        p.set("scale", (gbuffer.width + irradiance.width() - 1) / irradiance.width());
    }
    irradiance.bindImage(kImageIrradiance, GL_READ_WRITE, GL_RGBA32F);
    p.set("size", glm::ivec2(irradiance.width(), irradiance.height()));
    p.set("samples", static_cast<std::uint32_t>(std::max(rays.samples, 1)));
    p.set("seed", rays.seed);
    p.set("accumulationIndex", rays.accumulationIndex);
    return p;
}

void SkyPass::trace(gl::Program& p, const SkyRays& rays, const gl::Texture& irradiance,
                    const AlonePixels* pixels, gl::Profiler& profiler) {
    const auto samples = static_cast<std::uint32_t>(std::max(rays.samples, 1));
    const int width = irradiance.width(), height = irradiance.height();
    const int rowsAtOnce = profiler.watched() ? kSliceRows : height;
    const std::uint32_t atOnce = rays.maps ? kLookupsAtOnce : kRaysAtOnce;
    for (std::uint32_t first = 0; first < samples; first += atOnce) {
        const std::uint32_t last = std::min(first + atOnce, samples);
        p.set("firstSample", first);
        p.set("lastSample", last);
        if (pixels) {
            pixels->dispatch(p);
            continue;
        }
        for (int row = 0; row < height; row += rowsAtOnce) {
            const int rows = std::min(rowsAtOnce, height - row);
            p.set("firstRow", row);
            p.dispatch2D(width, rows);
            if (!profiler.watched()) continue;
            const double share = double(row + rows) / height;
            profiler.report(Stage::skyLight, (first + share * (last - first)) / samples);
        }
    }
}

void SkyPass::render(const SkyRays& rays, const GBuffer& gbuffer, const GatherLists& lists,
                     const Resting& resting, gl::Profiler& profiler,
                     const gl::Texture& irradiance) {
    gl::Program& p = prepare(rays, gbuffer, false, irradiance);
    resting.bind(p);
    lists.surfaces.bind(kUnitSurfaces);
    lists.planes.bind(kUnitPlanes);
    trace(p, rays, irradiance, nullptr, profiler);
}

void SkyPass::renderAlone(const SkyRays& rays, const GBuffer& gbuffer, const AlonePixels& pixels,
                          gl::Profiler& profiler, const gl::Texture& irradiance,
                          const gl::Texture& unfiltered) {
    gl::Program& p = prepare(rays, gbuffer, true, irradiance);
    gbuffer.position.bind(kUnitPosition);
    gbuffer.normal.bind(kUnitNormal);
    gbuffer.plane.bind(kUnitPlane);
    unfiltered.bindImage(kImageUnfiltered, GL_READ_WRITE, GL_RGBA32F);
    trace(p, rays, irradiance, &pixels, profiler);
}

}  // namespace mv
