#include "renderer/passes/vpl_pass.h"

#include "renderer/gl/program.h"
#include "renderer/passes/sky_pass.h"
#include "shaders/shared/bindings.glsl"

namespace mv {

namespace {

gl::Program makeProgram(bool emitters, const BvhTables& scene) {
    return gl::Program(emitters ? "place VPLs on emitters" : "trace VPLs",
                       {"passes/trace_vpls.comp"},
                       {{"MV_VPL_EMITTERS", emitters ? "1" : "0"},
                        {"MV_BVH_MASKS", scene.masks() ? "1" : "0"},
                        {"MV_BVH_TINTS", scene.tints() ? "1" : "0"}});
}

}  // namespace

struct VplPass::Impl {
    BvhTables scene;
    gl::TexelBuffer<LightRecord> lights;
    gl::TexelBuffer<EmissiveTriangle> emissive;
    gl::TexelBuffer<float> guide;
    GpuSky sky;
    std::shared_ptr<const EmissiveSurfaces> emissiveInBuffer;
    gl::Buffer setup;
    gl::Program tracePaths, placeOnEmitters;
    int programsPassing = 0;  // BvhTables::passing()

    void bind(gl::Program& program, bool gloss) const {
        program.use();
        scene.bind(program, gloss);
        lights.bindTexels(kUnitLights);
        emissive.bindTexels(kUnitEmissive);
        guide.bindTexels(kUnitGuide);
        sky.bindTexels();
        setup.bindUniform(kUniformVplSetup);
    }
};

VplPass::VplPass() : impl_(std::make_unique<Impl>()) {}
VplPass::~VplPass() = default;

void VplPass::setScene(const Scene& scene, const TriangleBvh& bvh) {
    impl_->scene.setScene(scene, bvh);
    impl_->emissiveInBuffer = nullptr;
}
void VplPass::setPose(const Scene& scene, const TriangleBvh& bvh) {
    impl_->scene.setPose(scene, bvh);
}
const BvhTables& VplPass::tables() const { return impl_->scene; }

void VplPass::trace(const Emitters& emitters, const VplOptions& options, const ViewGuide* guide,
                    gl::Profiler& profiler, GpuViews& out) {
    Impl& m = *impl_;
    const gl::PassScope scope(profiler, Stage::traceViews);
    const VplSetup setup = makeVplSetup(emitters, options, guide);
    out.count = setup.count;
    out.views.ensure("views", setup.count);
    if (setup.paths == 0 && setup.surfaceSlots == 0) {
        static_assert(kViewDead == 0);
        out.views.fill(0, std::uint64_t{setup.count} * sizeof(View) / 4, 0);
        return;
    }

    if (!m.tracePaths || m.programsPassing != m.scene.passing()) {
        m.tracePaths = makeProgram(false, m.scene);
        m.placeOnEmitters = gl::Program();
        m.programsPassing = m.scene.passing();
    }
    m.lights = {"lights", emitters.lights};
    if (!m.emissiveInBuffer || m.emissiveInBuffer != emitters.surfaces) {
        m.emissive = {"emissive triangles", emitters.surfaces ? emitters.surfaces->triangles
                                                              : std::vector<EmissiveTriangle>{}};
        m.emissiveInBuffer = emitters.surfaces;
    }
    m.sky.set(emitters.sky);
    m.guide.ensure("emission guide", std::max(setup.guideCells, 1u));
    if (setup.guideCells > 0) m.guide.write(0, guide->cells);
    m.setup.ensure("VPL setup", sizeof setup);
    m.setup.write(0, std::span<const VplSetup>(&setup, 1));

    out.views.bindStorage(kBlockViews);
    if (setup.surfaceSlots > 0) {
        if (!m.placeOnEmitters) m.placeOnEmitters = makeProgram(true, m.scene);
        m.bind(m.placeOnEmitters, options.gloss);
        m.placeOnEmitters.dispatchInvocations(setup.surfaceSlots);
    }
    if (setup.paths > 0) {
        m.bind(m.tracePaths, options.gloss);
        m.tracePaths.dispatchInvocations(setup.paths);
    }
}

std::uint64_t VplPass::bytes() const {
    return impl_->scene.bytes() + impl_->lights.bytes() + impl_->emissive.bytes() +
           impl_->guide.bytes() + impl_->sky.bytes();
}

void upload(const ViewSet& views, GpuViews& out) {
    out.views.ensure("views", views.views.size());
    out.views.write(0, views.views);
    out.count = static_cast<std::uint32_t>(views.views.size());
}

}  // namespace mv
