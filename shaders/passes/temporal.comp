// A frame that moves, drawn at another point of its pixels each time, and what the frames before
// showed there -> their mean, whose edges are soft [Karis, High Quality Temporal Supersampling,
// 2014]. What was shown is looked up where the surface stood in the frame before, even if it moves
// by itself, and kept to the colours around the pixel in this frame [Salvi, An Excursion in
// Temporal Supersampling, 2016]: so nothing stays behind that is gone, and light that changes is
// followed. The mean is of a display's values, as in average_pixels.comp.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/motion.glsl"
#include "shaders/shared/tone.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitRadiance) uniform sampler2D radianceTexture;
layout(binding = kUnitPosition) uniform sampler2D positions;          // G-buffer
layout(binding = kUnitNormal) uniform sampler2D normals;              // G-buffer: w = depth
layout(binding = kUnitRememberedLight) uniform sampler2D oldDisplay;  // w: frames in it
layout(binding = kImageMean, rgba32f) uniform writeonly image2D mean;
layout(binding = kImageDisplayMean, rgba32f) uniform writeonly image2D displayMean;
uniform ivec2 size;
// Cameras of the pixels' centres, of this frame and of the one before.
uniform mat4 clipFromRoot;
uniform mat4 rootFromClip;
uniform mat4 oldClipFromRoot;
uniform bool remembers;     // there is a frame before
uniform float largestStep;  // GBuffer::largestStep
uniform float exposure;
uniform float mostFrames;

const float kSpread = 1.25;  // standard deviations around the neighbours' mean that are believed

vec3 shownAt(ivec2 pixel) {
    vec3 light = texelFetch(radianceTexture, clamp(pixel, ivec2(0), size - 1), 0).rgb;
    return compressLight(light * exposure);
}

// Where in [0, 1]^2 the frame before had what this pixel and the nearest of those around it show;
// false where it was out of sight.
bool seenBefore(ivec2 pixel, out vec2 seen) {
    vec2 centre = (vec2(pixel) + 0.5) / vec2(size);
    // Nothing nearer: a point infinitely far away, or behind the scene.
    vec4 place = rootFromClip * vec4(2.0 * centre - 1.0, 0.0, 1.0);
    vec4 way = vec4(0.0);
    float nearest = 1e30;
    for (int i = 0; i < 5; ++i) {
        ivec2 at = pixel + (i == 0 ? ivec2(0) : ivec2(i % 2 == 0 ? 1 : -1, i < 3 ? 1 : -1));
        at = clamp(at, ivec2(0), size - 1);
        vec4 surface = texelFetch(positions, at, 0);
        float depth = texelFetch(normals, at, 0).w;
        if (surface.w == 0.0 || !(depth < nearest)) continue;
        nearest = depth;
        place = vec4(surface.xyz, 1.0);
        way = vec4(stepOfMark(surface.w, largestStep), 0.0);
    }
    vec4 now = clipFromRoot * place;
    vec4 before = oldClipFromRoot * (place + way);
    seen = vec2(-1.0);
    if (!(now.w > 0.0) || !(before.w > 0.0)) return false;
    seen = centre + 0.5 * (before.xy / before.w - now.xy / now.w);
    return all(greaterThanEqual(seen, vec2(0.0))) && all(lessThanEqual(seen, vec2(1.0)));
}

// Catmull and Rom's spline through four texels, `part` beyond the second.
vec4 splineWeights(float part) {
    vec4 powers = vec4(1.0, part, part * part, part * part * part);
    return 0.5 *
           vec4(dot(powers, vec4(0.0, -1.0, 2.0, -1.0)), dot(powers, vec4(2.0, 0.0, -5.0, 3.0)),
                dot(powers, vec4(0.0, 1.0, 4.0, -3.0)), dot(powers, vec4(0.0, 0.0, -1.0, 1.0)));
}

// Not bilinear, which would blur a picture a little more with every frame.
vec4 rememberedAt(vec2 seen) {
    vec2 place = seen * vec2(size) - 0.5;
    ivec2 base = ivec2(floor(place));
    vec4 across = splineWeights(place.x - float(base.x));
    vec4 up = splineWeights(place.y - float(base.y));
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            ivec2 at = clamp(base + ivec2(x - 1, y - 1), ivec2(0), size - 1);
            sum += texelFetch(oldDisplay, at, 0) * (across[x] * up[y]);
        }
    }
    return sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= size.x || pixel.y >= size.y) return;
    vec3 radiance = texelFetch(radianceTexture, pixel, 0).rgb;
    vec3 shown = shownAt(pixel);
    float frames = 1.0;
    vec2 seen;
    if (remembers && !isBad(radiance) && seenBefore(pixel, seen)) {
        vec4 before = rememberedAt(seen);
        vec3 sum = vec3(0.0), squares = vec3(0.0);
        float count = 0.0;
        for (int i = 0; i < 9; ++i) {
            vec3 s = shownAt(pixel + ivec2(i % 3, i / 3) - 1);
            if (isBad(s)) continue;
            sum += s;
            squares += s * s;
            count += 1.0;
        }
        sum /= count;
        vec3 spread = kSpread * sqrt(max(squares / count - sum * sum, vec3(0.0)));
        if (!isBad(before.rgb) && before.w >= 0.5) {
            frames = min(before.w + 1.0, mostFrames);
            shown = mix(clamp(before.rgb, sum - spread, sum + spread), shown, 1.0 / frames);
            shown = clamp(shown, vec3(1e-6), vec3(1.0));
            radiance = expandLight(shown) / exposure;
        }
    }
    imageStore(mean, pixel, vec4(radiance, 1.0));
    imageStore(displayMean, pixel, vec4(shown, frames));
}
