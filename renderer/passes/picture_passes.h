#pragma once
// Camera -> GBuffer -> direct light, and radiance -> picture: the raster half of the frame, shared
// by every many-view method. All positions are root-cube units.

#include "megaviews/views/frame_camera.h"
#include "renderer/passes/direct_light_pass.h"
#include "renderer/passes/gbuffer_pass.h"
#include "renderer/passes/tonemap_pass.h"
