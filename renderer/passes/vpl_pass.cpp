#include "renderer/passes/vpl_pass.h"

#include <array>
#include <string>

#include "renderer/gl/context.h"
#include "renderer/gl/program.h"

namespace mv {

namespace {

// A read-only array as shaders fetch it.
struct Table {
    gl::Buffer buffer;
    gl::TextureBuffer texels;
    template <typename T>
    Table(const char* label, GLenum format, const std::vector<T>& elements)
        : buffer(gl::Buffer::of(label, elements)), texels(label, format, buffer) {}
    Table() = default;
};

constexpr GLuint kFirstVplUnit = 10;  // MV_VPL_FIRST_UNIT of trace_vpls.comp

gl::Program makeProgram(bool emitters, bool masks) {
    return gl::Program(emitters ? "place VPLs on emitters" : "trace VPLs",
                       {"passes/trace_vpls.comp"},
                       {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)},
                        {"MV_VPL_EMITTERS", emitters ? "1" : "0"},
                        {"MV_BVH_MASKS", masks ? "1" : "0"}});
}

}  // namespace

struct VplPass::Impl {
    // In the order of units that shaders/shared/bvh_data.glsl names.
    std::array<Table, 10> scene;
    std::uint32_t bvhFlags = kBvhEmpty;
    Table lights, emissive;
    std::shared_ptr<const EmissiveSurfaces> emissiveInBuffer;
    gl::Buffer setup;
    gl::Program tracePaths, placeOnEmitters;
    bool programsHaveMasks = false;

    void bind(gl::Program& program) const {
        program.use();
        for (GLuint unit = 0; unit < scene.size(); ++unit) {
            if (scene[unit].texels) scene[unit].texels.bind(unit);
        }
        lights.texels.bind(kFirstVplUnit);
        emissive.texels.bind(kFirstVplUnit + 1);
        setup.bindUniform(0);
        program.set("bvhFlags", bvhFlags);
    }
};

VplPass::VplPass() : impl_(std::make_unique<Impl>()) {}
VplPass::~VplPass() = default;

void VplPass::setScene(const Scene& scene, const TriangleBvh& bvh) {
    Impl& m = *impl_;
    m.scene = {};
    m.bvhFlags = bvh.flags;
    m.emissiveInBuffer = nullptr;
    if (!(bvh.flags & kBvhEmpty)) {
        m.scene[0] = Table("BVH nodes", GL_RGBA32UI, bvh.nodes);
        m.scene[1] = Table("BVH triangles", GL_RGBA32UI, bvh.triangles);
        m.scene[2] = Table("BVH indices", GL_RGB32UI, scene.triangles);
        m.scene[3] = Table("BVH normals", GL_RGB32F, scene.normals);
        m.scene[7] = Table("BVH materials", GL_RGBA32UI, bvh.materials);
    }
    if (bvh.flags & kBvhColors) m.scene[4] = Table("BVH colours", GL_RGBA32F, scene.colors);
    if (bvh.flags & kBvhUvs) m.scene[5] = Table("BVH uvs", GL_RG32F, scene.uvs);
    if (bvh.flags & kBvhEmissiveUvs) {
        m.scene[6] = Table("BVH emissive uvs", GL_RG32F, scene.emissiveUvs);
    }
    if (bvh.flags & (kBvhUvs | kBvhEmissiveUvs)) {
        m.scene[8] = Table("BVH textures", GL_RGBA32UI, bvh.textures.textures);
        m.scene[9] = Table("BVH texels", GL_R32UI, bvh.textures.texels);
    }
}

void VplPass::trace(const Emitters& emitters, const VplOptions& options, gl::Profiler& profiler,
                    GpuViews& out) {
    Impl& m = *impl_;
    const gl::PassScope scope(profiler, "trace views");
    const VplSetup setup = makeVplSetup(emitters, options);
    out.count = setup.count;
    out.views.ensure("views", std::uint64_t{setup.count} * sizeof(View));
    if (setup.paths == 0 && setup.surfaceSlots == 0) {
        static_assert(kViewDead == 0);
        out.views.fill(0, std::uint64_t{setup.count} * sizeof(View) / 4, 0);
        return;
    }

    const bool masks = (m.bvhFlags & kBvhMasks) != 0;
    if (!m.tracePaths || m.programsHaveMasks != masks) {
        m.tracePaths = makeProgram(false, masks);
        m.placeOnEmitters = gl::Program();
        m.programsHaveMasks = masks;
    }
    m.lights = Table("lights", GL_RGBA32UI, emitters.lights);
    if (!m.emissiveInBuffer || m.emissiveInBuffer != emitters.surfaces) {
        m.emissive = Table(
            "emissive triangles", GL_RGBA32UI,
            emitters.surfaces ? emitters.surfaces->triangles : std::vector<EmissiveTriangle>{});
        m.emissiveInBuffer = emitters.surfaces;
    }
    m.setup.ensure("VPL setup", sizeof setup);
    m.setup.write(0, std::span<const VplSetup>(&setup, 1));

    out.views.bindStorage(0);
    if (setup.surfaceSlots > 0) {
        if (!m.placeOnEmitters) m.placeOnEmitters = makeProgram(true, masks);
        m.bind(m.placeOnEmitters);
        m.placeOnEmitters.dispatchInvocations(setup.surfaceSlots);
    }
    if (setup.paths > 0) {
        m.bind(m.tracePaths);
        m.tracePaths.dispatchInvocations(setup.paths);
    }
}

std::uint64_t VplPass::bytes() const {
    std::uint64_t sum = impl_->lights.buffer.bytes() + impl_->emissive.buffer.bytes();
    for (const Table& table : impl_->scene) sum += table.buffer.bytes();
    return sum;
}

void upload(const ViewSet& views, GpuViews& out) {
    out.views.ensure("views", views.views.size() * sizeof(View));
    out.views.write<View>(0, views.views);
    out.count = static_cast<std::uint32_t>(views.views.size());
}

}  // namespace mv
