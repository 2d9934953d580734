// A vertex of the scene for the G-buffer.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
#ifdef MV_COLORS
layout(location = 2) in vec4 color;
out vec4 colorAt;
#endif
#ifdef MV_UVS
layout(location = 3) in vec2 uv;
out vec2 uvAt;
#endif
#ifdef MV_EMISSIVE_TEXTURE
layout(location = 4) in vec2 emissiveUv;
out vec2 emissiveUvAt;
#endif
#ifdef MV_MOVES
layout(location = 5) in vec3 positionBefore;
out vec3 stepAt;
#endif
uniform mat4 clipFromWorld;
out vec3 positionAt;
out vec3 normalAt;

void main() {
    gl_Position = clipFromWorld * vec4(position, 1.0);
    positionAt = position;
    normalAt = normal;
#ifdef MV_MOVES
    stepAt = positionBefore - position;
#endif
#ifdef MV_COLORS
    colorAt = color;
#endif
#ifdef MV_UVS
    uvAt = uv;
#endif
#ifdef MV_EMISSIVE_TEXTURE
    emissiveUvAt = emissiveUv;
#endif
}
