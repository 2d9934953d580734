#include "renderer/passes/sharing_pass.h"

#include <string>
#include <vector>

#include "megaviews/settings/debug_legends.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/debug_view.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/tone.glsl"

namespace mv {
namespace {

gl::Program makeProgram(int view) {
    return gl::Program("sharing", {"passes/full_screen.vert", "passes/sharing.frag"},
                       {{"MV_VIEW", std::to_string(view)}});
}

}  // namespace

std::optional<std::uint32_t> sortedViewOf(const GpuViewHierarchy& views, std::int64_t slot) {
    if (slot < 0 || views.aliveCount == 0) return std::nullopt;
    const auto sorted = views.sortedViews.read(0, views.aliveCount);
    for (std::uint32_t i = 0; i < views.aliveCount; ++i) {
        if (std::int64_t{sorted[i].slot} == slot) return i;
    }
    return std::nullopt;
}

// Everything that both pictures read.
void SharingPass::bind(gl::Program& program, const SharingInput& input) {
    const std::uint32_t viewCount =
        input.present && input.scene.nodeCount > 0 ? input.views.aliveCount : 0;
    input.gbuffer.position.bind(kUnitPosition);
    input.gbuffer.normal.bind(kUnitNormal);
    input.gbuffer.albedo.bind(kUnitAlbedo);
    if (viewCount > 0) {
        input.scene.nodes.bindTexels(kUnitSceneNodes);
        input.views.nodes.bindTexels(kUnitViewNodes);
        input.views.leafOfView.bindTexels(kUnitLeafOfView);
    }
    program.set("viewCount", viewCount);
    program.set("rules", input.rules);
    program.set("pairRes",
                pairResolution(static_cast<float>(input.mapRes), input.rules, input.pairSize));
}

void SharingPass::sharing(const SharingInput& input, std::uint32_t seed, int grid,
                          gl::Profiler& profiler, gl::Texture& out) {
    const gl::PassScope scope(profiler, Stage::sharing);
    if (!sharing_) sharing_ = makeProgram(MV_VIEW_SHARING);
    bind(sharing_, input);
    sharing_.set("seed", seed);
    sharing_.set("grid", grid);
    const int width = input.gbuffer.width, height = input.gbuffer.height;
    out.ensure("sharing", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    if (grid == 1) {
        coarse_ = gl::Texture();
        sharing_.drawFullScreen(gl::Framebuffer("sharing", {&out}));
        return;
    }
    const int columns = (width + grid - 1) / grid, rows = (height + grid - 1) / grid;
    coarse_.ensure("sharing, coarse", GL_TEXTURE_2D, GL_RGBA32F, columns, rows);
    const gl::Framebuffer from("sharing, coarse", {&coarse_}), to("sharing", {&out});
    sharing_.drawFullScreen(from);
    // The last cells may reach over the border: blits are cut there.
    glBlitNamedFramebuffer(from.id(), to.id(), 0, 0, columns, rows, 0, 0, columns * grid,
                           rows * grid, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

double SharingPass::meanSharing(const gl::Texture& sharing) {
    const std::vector<float> texels = sharing.readFloats(2);
    double views = 0, weight = 0;
    for (std::size_t i = 0; i < texels.size(); i += 2) {
        views += double{texels[i]} * double{texels[i + 1]};
        weight += double{texels[i + 1]};
    }
    return weight > 0 ? views / weight : 0;
}

void SharingPass::shared(const SharingInput& input, const FrameCamera& camera, std::int64_t slotA,
                         std::int64_t slotB, gl::Profiler& profiler, gl::Texture& out) {
    const gl::PassScope scope(profiler, Stage::shared);
    if (!shared_) shared_ = makeProgram(MV_VIEW_SHARED);
    bind(shared_, input);
    shared_.set("viewA", sortedViewOf(input.views, slotA).value_or(kNone));
    shared_.set("viewB", sortedViewOf(input.views, slotB).value_or(kNone));
    shared_.set("eye", camera.position);
    shared_.set("towardsEye",
                camera.orthoHalfHeight > 0 ? -glm::normalize(camera.forward) : glm::vec3(0));
    shared_.set("sceneLevels", static_cast<float>(input.scene.levels));
    const auto classes = legendOf(DebugView::shared).classes;
    for (std::size_t i = 0; i < classes.size(); ++i) {
        const auto& c = classes[i].colour;
        shared_.set("classColours[" + std::to_string(i) + "]",
                    glm::vec3(linearFromSrgbChannel(c[0]), linearFromSrgbChannel(c[1]),
                              linearFromSrgbChannel(c[2])));
    }
    out.ensure("shared", GL_TEXTURE_2D, GL_RGBA32F, input.gbuffer.width, input.gbuffer.height);
    shared_.drawFullScreen(gl::Framebuffer("shared", {&out}));
}

}  // namespace mv
