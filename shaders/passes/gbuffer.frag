// A visible point of the scene: where it is, how it faces, what it reflects and emits.
#include "shaders/shared/bindings.glsl"
uniform vec4 baseColor;  // alpha used by the mask only
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
#ifdef MV_BASE_TEXTURE
in vec2 uvAt;
layout(binding = kUnitBaseTexture) uniform sampler2D baseTexture;
#endif
#ifdef MV_EMISSIVE_TEXTURE
in vec2 emissiveUvAt;
layout(binding = kUnitEmissiveTexture) uniform sampler2D emissiveTexture;
#endif

layout(location = 0) out vec4 outPosition;
layout(location = 1) out vec4 outNormalDepth;
layout(location = 2) out vec4 outAlbedo;
layout(location = 3) out vec4 outEmission;
layout(location = 4) out vec4 outPlane;

void main() {
    vec4 base = baseColor;
#ifdef MV_COLORS
    base *= colorAt;
#endif
#ifdef MV_BASE_TEXTURE
    base *= texture(baseTexture, uvAt);
#endif
#ifdef MV_MASK
    if (base.a < alphaCutoff) discard;
#endif
    vec3 emitted = emission;
#ifdef MV_EMISSIVE_TEXTURE
    emitted *= texture(emissiveTexture, emissiveUvAt).rgb;
#endif
#ifdef MV_UNLIT
    emitted += base.rgb;
    base.rgb = vec3(0.0);
#endif

    // The triangle's own plane decides on which side the camera is; a smooth normal may point away
    // from the camera at a silhouette and is kept all the same.
    vec3 fromEye = positionAt - eye;
    vec3 plane = cross(dFdx(positionAt), dFdy(positionAt));
    vec3 ray = mix(forward, fromEye, eyeShare);
    vec3 n = normalAt * inversesqrt(max(dot(normalAt, normalAt), 1e-30));
    if (dot(plane, n) * sign(dot(plane, ray)) > 0.0) n = -n;

    outPosition = vec4(positionAt, 1.0);
    outNormalDepth = vec4(n, dot(fromEye, forward));
    outAlbedo = vec4(base.rgb, 1.0);
    outEmission = vec4(emitted, 1.0);
    // The triangle's normal faces the camera.
    plane *= dot(plane, ray) > 0.0 ? -1.0 : 1.0;
    float area = length(plane);
    outPlane = vec4(area > 0.0 ? plane / area : n, 1.0);
}
