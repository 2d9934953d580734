#pragma once
// Radiance of a whole picture -> the exposure that it is shown with, by its log-mean luminance.

#include <optional>

#include "megaviews/settings/settings.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gbuffer_pass.h"

namespace mv {

// EV so that the log-mean luminance of the radiance becomes 0.18; nothing for a black picture.
// Texels without a surface and emitters do not count, nor do black ones; what is darker than
// 1 % of the mean counts as that, so that a shadow does not set the exposure. Less where the
// tone map would show more than 2 % of those texels as 94 % of white or above: sun must not
// drown in the shade's exposure. Where the sky takes more than a third of the picture, its
// log-mean is at most 2.5 EV above 0.18, and surfaces of a mean albedo above 0.4 are brighter
// by that ratio, at most twice as bright: a white statue is shown lighter than grey. Synchronises.
std::optional<double> fitExposure(const gl::Texture& radiance, const GBuffer& gbuffer,
                                  ToneMap toneMap);

// Does next to no light reach what is in sight, by the exposure that was fitted to it? If there was
// nothing to fit to, because more of the picture is surfaces that would reflect light than such as
// glow: neither these nor the void nor what is black by itself say anything of light. Synchronises.
bool isDark(std::optional<double> fittedEv, const GBuffer& gbuffer);

}  // namespace mv
