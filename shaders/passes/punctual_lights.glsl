// The strongest point, spot and directional lights of the scene
// (renderer/passes/punctual_lights.h).
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"

layout(binding = kUnitLights) uniform usamplerBuffer lights;

LightRecord fetchLight(uint i) {
    uvec4 a = texelFetch(lights, int(4u * i));
    uvec4 b = texelFetch(lights, int(4u * i + 1u));
    uvec4 c = texelFetch(lights, int(4u * i + 2u));
    uvec4 d = texelFetch(lights, int(4u * i + 3u));
    vec4 place = uintBitsToFloat(a);
    vec4 axis = uintBitsToFloat(b);
    vec4 shine = uintBitsToFloat(c);
    vec4 flux = uintBitsToFloat(d);
    return LightRecord(place.x, place.y, place.z, a.w, axis.x, axis.y, axis.z, axis.w, shine.r,
                       shine.g, shine.b, shine.w, flux.r, flux.g, flux.b, flux.w);
}
