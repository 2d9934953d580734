// The light of one more point of every pixel -> two means over its points: of radiance, and of
// 1 / (1 + 4x) of each exposed channel x. A plain mean of an edge between a room and a lamp a
// thousand times as bright is white wherever any point sees the lamp, so that the edge keeps its
// stair steps on a display. The second one undone, (1 / mean - 1) / 4, is near the light whose
// display is the mean of the points' displays: exactly so for the curve 4x / (1 + 4x), which is
// near the ACES curve; for AgX the exposure is 1.4 EV lower. Channel by channel, as these curves
// are: one weight for all three would give the rim of whatever is white the hue of its light. After
// [Karis, High Quality Temporal Supersampling, 2014].
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/tone.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitRadiance) uniform sampler2D radianceTexture;
layout(binding = kImageMean, rgba32f) uniform image2D mean;
layout(binding = kImageDisplayMean, rgba32f) uniform image2D displayMean;
uniform ivec2 size;
uniform float points;  // with this one
uniform float exposure;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= size.x || pixel.y >= size.y) return;
    vec4 one = vec4(texelFetch(radianceTexture, pixel, 0).rgb, 1.0);
    vec4 shown = vec4(compressLight(one.rgb * exposure), 1.0);
    vec4 before = vec4(0.0), shownBefore = vec4(0.0);
    if (points > 1.0) {
        before = imageLoad(mean, pixel);
        shownBefore = imageLoad(displayMean, pixel);
    }
    imageStore(mean, pixel, before + (one - before) / points);
    imageStore(displayMean, pixel, shownBefore + (shown - shownBefore) / points);
}
