// A visible point of the scene: where it is, how it faces, what it reflects and emits.
#include "shaders/shared/bindings.glsl"
#ifdef MV_MOVES
#include "shaders/shared/motion.glsl"
in vec3 stepAt;  // to where it was in the frame before
uniform float largestStep;
#endif
#ifdef MV_GLOSS
#include "shaders/shared/microfacet.glsl"
#endif
uniform vec4 baseColor;  // alpha used by mask and blending only
uniform vec3 emission;   // W/(m^2 sr)
uniform float alphaCutoff;
uniform vec3 eye;
uniform vec3 forward;
uniform float eyeShare;  // 1: rays start at the eye; 0: orthographic, rays run along forward

in vec3 positionAt;
in vec3 normalAt;
#ifdef MV_COLORS
in vec4 colorAt;
#endif
#ifdef MV_UVS
in vec2 uvAt;
#endif
#ifdef MV_BASE_TEXTURE
layout(binding = kUnitBaseTexture) uniform sampler2D baseTexture;
#endif
#ifdef MV_EMISSIVE_TEXTURE
in vec2 emissiveUvAt;
layout(binding = kUnitEmissiveTexture) uniform sampler2D emissiveTexture;
#endif

#ifdef MV_GLOSS
uniform vec3 specular;  // Material's: its layer()
uniform float specularFactor;
uniform float metallic;
uniform float roughness;
#endif
#ifdef MV_COAT
uniform float coat;  // Material's
uniform float coatRoughness;
#endif
#ifdef MV_COAT_TEXTURE
layout(binding = kUnitCoatTexture) uniform sampler2D coatTexture;
#endif
#ifdef MV_COAT_NORMAL_TEXTURE
uniform float coatNormalScale;
layout(binding = kUnitCoatNormalTexture) uniform sampler2D coatNormalTexture;
#endif
#ifdef MV_CLEAR
uniform bool blends;  // Material's
uniform float transmission;
uniform float passingSpread;
uniform vec3 attenuation;
uniform float filledIndex;
#endif
#ifdef MV_METAL_TEXTURE
layout(binding = kUnitMetalTexture) uniform sampler2D metalTexture;
#endif
#ifdef MV_NORMAL_TEXTURE
uniform float normalScale;
layout(binding = kUnitNormalTexture) uniform sampler2D normalTexture;
#endif

layout(location = 0) out vec4 outPosition;
layout(location = 1) out vec4 outNormalDepth;
layout(location = 2) out vec4 outAlbedo;
layout(location = 3) out vec4 outEmission;
layout(location = 4) out vec4 outPlane;
#ifdef MV_GLOSS
layout(location = 5) out vec4 outGloss;
#endif
#ifdef MV_CLEAR
layout(location = 6) out vec4 outClear;
#endif
#ifdef MV_COAT
#ifdef MV_CLEAR
layout(location = 7) out vec4 outCoat;
#else
layout(location = 6) out vec4 outCoat;
#endif
#endif

#if defined(MV_NORMAL_TEXTURE) || defined(MV_COAT_NORMAL_TEXTURE)
// The smooth normal turned as the map says. Its axes follow the texture's coordinates across the
// pixel: where they grow to the right and down, red leans right and green up.
vec3 mappedNormal(vec3 n, sampler2D map, float scale) {
    vec2 lean = texture(map, uvAt).xy * 2.0 - 1.0;
    float up = sqrt(max(1.0 - dot(lean, lean), 0.01));
    lean *= scale;
    vec3 across = dFdx(positionAt);
    vec3 along = dFdy(positionAt);
    vec3 px = cross(along, n);
    vec3 py = cross(n, across);
    vec2 dx = dFdx(uvAt);
    vec2 dy = dFdy(uvAt);
    vec3 right = px * dx.x + py * dy.x;
    vec3 down = px * dx.y + py * dy.y;
    float size = max(dot(right, right), dot(down, down));
    if (!(size > 0.0)) return n;
    right *= inversesqrt(size);
    down *= inversesqrt(size);
    // A mirrored pixel turns both.
    float side = dot(cross(across, along), n) < 0.0 ? -1.0 : 1.0;
    vec3 m = side * (right * lean.x - down * lean.y) + n * up;
    return m * inversesqrt(max(dot(m, m), 1e-30));
}
#endif

// What is known of the point so far.
bool hidden = false;  // a mask cuts it out, or nobody sees it
vec4 base;            // its colour
float seen;           // share of it that the eye sees before what is behind it
vec3 emitted;
vec3 ray;  // from the eye, not unit
vec3 fromEye;
vec3 plane;  // of its triangle, not unit
// Normals turned to the camera: the vertices', that with a normal map, and the clear coat's.
vec3 smoothed, n, coated;
vec3 albedo;
float atGrazing = 1.0;  // share that its gloss reflects there

void readColour() {
    base = baseColor;
#ifdef MV_COLORS
    base *= colorAt;
#endif
#ifdef MV_BASE_TEXTURE
    base *= texture(baseTexture, uvAt);
#endif
#ifdef MV_MASK
    if (base.a < alphaCutoff) hidden = true;
#endif
    seen = 1.0;
#ifdef MV_CLEAR
    if (blends) seen = clamp(base.a, 0.0, 1.0);
    if (seen < 1.0 / 255.0) hidden = true;
#endif
    emitted = emission;
#ifdef MV_EMISSIVE_TEXTURE
    emitted *= texture(emissiveTexture, emissiveUvAt).rgb;
#endif
#ifdef MV_UNLIT
    emitted += base.rgb;
    base.rgb = vec3(0.0);
#endif
    albedo = base.rgb;
}

// The triangle's own plane decides on which side the camera is; a smooth normal may point away from
// the camera at a silhouette and is kept all the same, and so is one that lies in the plane, by
// design or by mistake, where rounding would decide.
const float kInPlane = 1e-3;
void readNormal() {
    fromEye = positionAt - eye;
    plane = cross(dFdx(positionAt), dFdy(positionAt));
    ray = mix(forward, fromEye, eyeShare);
    smoothed = normalAt * inversesqrt(max(dot(normalAt, normalAt), 1e-30));
    n = smoothed;
#ifdef MV_NORMAL_TEXTURE
    n = mappedNormal(smoothed, normalTexture, normalScale);
#endif
    coated = smoothed;
#ifdef MV_COAT_NORMAL_TEXTURE
    coated = mappedNormal(smoothed, coatNormalTexture, coatNormalScale);
#endif
    if (dot(plane, smoothed) * sign(dot(plane, ray)) > kInPlane * length(plane)) {
        n = -n;
        smoothed = -smoothed;
        coated = -coated;
    }
}

#ifdef MV_GLOSS
// A clear coat over all of it, with normals of its own: the share of light that gets below.
float addCoat(vec3 toEye, inout float part) {
    float under = 1.0;
#ifdef MV_COAT
    float strength = coat;
#ifdef MV_COAT_TEXTURE
    strength *= texture(coatTexture, uvAt).r;
#endif
    outCoat = vec4(coated * strength, coatRoughness);
    if (strength > 0.0) {
        under = underCoat(strength, coatRoughness, dot(coated, toEye));
        part = 1.0;
    }
    albedo *= under;
    emitted *= under;
#endif
    return under;
}

void addGloss() {
    float metal = metallic;
    float rough = roughness;
#ifdef MV_METAL_TEXTURE
    vec2 map = texture(metalTexture, uvAt).bg;
    metal *= map.x;
    rough *= map.y;
#endif
    vec3 toEye = -ray * inversesqrt(max(dot(ray, ray), 1e-30));
    float cosEye = clamp(dot(n, toEye), 0.0, 1.0);
    vec3 atNormal = mix(specular, base.rgb, metal);
    atGrazing = mix(specularFactor, 1.0, metal);
    float part = 1.0 - glossShare(rough);
    float under = addCoat(toEye, part);
    outGloss = vec4(0.0);
    vec3 broad = vec3(0.0);
    if (max(atNormal.r, max(atNormal.g, atNormal.b)) > 0.0) {
        vec3 layer = glossReflectance(specular, specularFactor, rough, cosEye);
        albedo *= (1.0 - metal) * (1.0 - max(layer.r, max(layer.g, layer.b)));
        // What no ray follows is lit as matt surfaces are (BroadGloss).
        broad = part * under * glossReflectance(atNormal, atGrazing, rough, cosEye);
        outGloss = vec4(atNormal, rough);
    }
#ifdef MV_CLEAR
    vec3 passes = albedo * transmission;
    outClear = vec4(seen * passes * attenuation + vec3(1.0 - seen),
                    transmission > 0.0 ? rough * passingSpread : 0.0);
    albedo -= passes;
#endif
    albedo += broad;
}
#endif

void main() {
    readColour();
    readNormal();
#ifdef MV_GLOSS
    addGloss();
#endif
#ifdef MV_MOVES
    outPosition = vec4(positionAt, markOfStep(stepAt, largestStep));
#else
    outPosition = vec4(positionAt, 1.0);
#endif
    outNormalDepth = vec4(n, dot(fromEye, forward));
    outAlbedo = vec4(albedo * seen, seen);
#ifdef MV_CLEAR
    outEmission = vec4(emitted * seen, filledIndex);
#else
    outEmission = vec4(emitted * seen, 0.0);
#endif
    // The triangle's normal faces the camera.
    plane *= dot(plane, ray) > 0.0 ? -1.0 : 1.0;
    float area = length(plane);
    outPlane = vec4(area > 0.0 ? plane / area : n, atGrazing);
    // Last: neighbours take their derivatives from this pixel.
    if (hidden) discard;
}
