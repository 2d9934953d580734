#include "renderer/passes/compose_pass.h"

#include <string>

#include "shaders/shared/bindings.glsl"
#include "shaders/shared/debug_view.glsl"

namespace mv {

static_assert(static_cast<int>(DebugView::final) == MV_VIEW_FINAL);
static_assert(static_cast<int>(DebugView::direct) == MV_VIEW_DIRECT);
static_assert(static_cast<int>(DebugView::indirect) == MV_VIEW_INDIRECT);
static_assert(static_cast<int>(DebugView::unfiltered) == MV_VIEW_UNFILTERED);
static_assert(static_cast<int>(DebugView::normals) == MV_VIEW_NORMALS);
static_assert(static_cast<int>(DebugView::albedo) == MV_VIEW_ALBEDO);
static_assert(static_cast<int>(DebugView::depth) == MV_VIEW_DEPTH);
static_assert(static_cast<int>(DebugView::candidates) == MV_VIEW_CANDIDATES);
static_assert(static_cast<int>(DebugView::undecided) == MV_VIEW_UNDECIDED);
static_assert(static_cast<int>(DebugView::nan) == MV_VIEW_NAN);
static_assert(static_cast<int>(DebugView::sharing) == MV_VIEW_SHARING);
static_assert(static_cast<int>(DebugView::shared) == MV_VIEW_SHARED);

ComposePass::ComposePass() { black_.writeFloats(4, {0, 0, 0, 0}); }

gl::Program& ComposePass::programOf(DebugView view) {
    gl::Program& p = programs_[view];
    if (!p) {
        p = gl::Program("compose", {"passes/full_screen.vert", "passes/compose.frag"},
                        {{"MV_VIEW", std::to_string(static_cast<int>(view))}});
    }
    return p;
}

void ComposePass::render(const Input& input, DebugView view, gl::Profiler& profiler,
                         gl::Texture& radiance) {
    const gl::PassScope scope(profiler, Stage::compose);
    const GBuffer& g = *input.gbuffer;
    radiance.ensure("radiance", GL_TEXTURE_2D, GL_RGBA32F, g.width, g.height);
    const auto orBlack = [&](const gl::Texture* texture) -> const gl::Texture& {
        return texture && *texture ? *texture : black_;
    };
    const gl::Texture* irradiance =
        view == DebugView::unfiltered ? input.unfilteredIrradiance : input.irradiance;
    g.normal.bind(kUnitNormal);
    g.albedo.bind(kUnitAlbedo);
    g.emission.bind(kUnitEmission);
    orBlack(input.direct).bind(kUnitDirect);
    orBlack(irradiance).bind(kUnitIrradiance);
    orBlack(input.candidates).bind(kUnitCandidates);
    orBlack(input.reflected).bind(kUnitReflected);
    gl::Program& p = programOf(view);
    const bool emits = view == DebugView::final || view == DebugView::direct ||
                       view == DebugView::unfiltered || view == DebugView::nan;
    if (emits) p.set("emissionScale", input.emissionScale);
    p.drawFullScreen(gl::Framebuffer("radiance", {&radiance}));
}

}  // namespace mv
