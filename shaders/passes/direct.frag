// Direct light of up to eight punctual lights on the G-buffer. MV_LIGHTS is their number and
// MV_SHADE the sum over them, a call a light, so that each is compiled for its kind alone.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/direct_light.glsl"
#include "shaders/shared/light.glsl"
layout(binding = kUnitPosition) uniform sampler2D positionTexture;
layout(binding = kUnitNormal) uniform sampler2D normalTexture;
layout(binding = kUnitAlbedo) uniform sampler2D albedoTexture;
layout(binding = kUnitShadowMaps) uniform sampler2DArrayShadow
    shadowMaps;  // reversed depth: larger is nearer

layout(std140, binding = kUniformLights) uniform Lights { DirectLight lights[MV_LIGHTS]; };
uniform float edgeM;    // metres of the root cube's edge
uniform float texelUv;  // 1 / resolution of the shadow maps
out vec4 radiance;

vec3 position;
vec3 normal;

// A 3 x 3 tent of depth comparisons by four bilinear ones. uv in [-1,1].
float shadow(vec2 uv, float layer, float depth) {
    vec2 t = 0.5 * uv + 0.5;
    float h = 0.5 * texelUv;
    return 0.25 * (texture(shadowMaps, vec4(t + vec2(-h, -h), layer, depth)) +
                   texture(shadowMaps, vec4(t + vec2(h, -h), layer, depth)) +
                   texture(shadowMaps, vec4(t + vec2(-h, h), layer, depth)) +
                   texture(shadowMaps, vec4(t + vec2(h, h), layer, depth)));
}

// How far along its normal a receiver is lifted before its shadow test: over a plane the tent
// reaches 1.5 texels on both axes, along which depth grows by tan(angle) a texel, which a lift of
// 1.5 sqrt(2) sin(angle) texels clears; the constant is for smooth normals off their triangle.
vec3 lifted(float texel, float cosAngle) {
    float sinAngle = sqrt(max(1.0 - cosAngle * cosAngle, 0.0));
    return position + normal * texel * (0.75 + 2.2 * sinAngle);
}

// W/m^2 at the position without shadow: I cos / r^2. A light closer than 1e-4 of the root edge,
// or on the very surface, counts as that far away.
vec3 irradiance(vec3 intensity, float cosAngle, float distance) {
    float metres = max(distance, 1e-4) * edgeM;
    return intensity * (max(cosAngle, 0.0) / (metres * metres));
}

vec3 pointLight(int i, float falloff) {
    vec3 toLight = lights[i].position.xyz - position;
    float distance = length(toLight);
    float cosAngle = dot(normal, toLight) / max(distance, 1e-20);
    vec3 q = -toLight;
    vec3 a = abs(q);
    float texel = lights[i].intensity.w * max(a.x, max(a.y, a.z));
    q = lifted(texel, cosAngle) - lights[i].position.xyz;
    a = abs(q);
    // Face of the cube: axis, then the two axes after it in order.
    bool isX = a.x >= a.y && a.x >= a.z;
    bool isY = !isX && a.y >= a.z;
    vec3 face = isX ? q.xyz : isY ? q.yzx : q.zxy;
    float depth = max(abs(face.x), 1e-20);
    float layer = (isX ? 0.0 : isY ? 2.0 : 4.0) + (face.x < 0.0 ? 1.0 : 0.0);
    float lit = shadow(face.yz * (lights[i].cone.z / depth), lights[i].position.w + layer,
                       lights[i].cone.w / depth);
    return irradiance(lights[i].intensity.rgb, cosAngle, distance) * (lit * falloff);
}

float falloffAt(int i) {
    vec3 fromLight = position - lights[i].position.xyz;
    float cosAxis = dot(fromLight, lights[i].forward.xyz) / max(length(fromLight), 1e-20);
    return spotFalloff(cosAxis, lights[i].cone.x, lights[i].cone.y);
}

vec3 wideSpotLight(int i) { return pointLight(i, falloffAt(i)); }

vec3 spotLight(int i) {
    vec3 toLight = lights[i].position.xyz - position;
    float distance = length(toLight);
    float cosAngle = dot(normal, toLight) / max(distance, 1e-20);
    float along = -dot(toLight, lights[i].forward.xyz);
    vec3 q = lifted(lights[i].intensity.w * max(along, 0.0), cosAngle) - lights[i].position.xyz;
    float depth = max(dot(q, lights[i].forward.xyz), 1e-20);
    vec2 uv =
        vec2(dot(q, lights[i].right.xyz), dot(q, lights[i].up.xyz)) * (lights[i].cone.z / depth);
    float lit = shadow(uv, lights[i].position.w, lights[i].cone.w / depth);
    return irradiance(lights[i].intensity.rgb, cosAngle, distance) * (lit * falloffAt(i));
}

vec3 sunLight(int i) {
    float cosAngle = dot(normal, lights[i].toward.xyz);
    vec4 q = vec4(lifted(lights[i].intensity.w, cosAngle), 1.0);
    vec2 uv = vec2(dot(q, lights[i].right), dot(q, lights[i].up));
    float lit = shadow(uv, lights[i].position.w, dot(q, lights[i].forward));
    return lights[i].intensity.rgb * (max(cosAngle, 0.0) * lit);
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(positionTexture, p, 0);
    position = surface.xyz;
    normal = texelFetch(normalTexture, p, 0).xyz;
    vec3 sum = vec3(0.0);
    MV_SHADE
    vec3 albedo = texelFetch(albedoTexture, p, 0).rgb;
    radiance = vec4(surface.w == 0.0 ? vec3(0.0) : albedo * (1.0 / kPi) * sum, 1.0);
}
