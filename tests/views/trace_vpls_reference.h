#pragma once
// The VPL tracer's twin for tests: the same distribution of paths, by other means. Embree's rays,
// double precision, a Mersenne twister, lights chosen with equal probability, spots sampled
// uniformly in their cone, emissive triangles by area alone. Sums of flux times anything agree in
// the mean with traceVpls; single VPLs do not.

#include "megaviews/references/embree_scene.h"
#include "megaviews/views/view_set.h"

namespace mv {

// Slots lie as in traceVpls (shaders/shared/vpl.glsl).
ViewSet traceVplsReference(const EmbreeScene& embree, double timeS, int animation,
                           double lightScale, const VplOptions& options);

}  // namespace mv
