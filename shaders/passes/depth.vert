// A vertex of the scene for a shadow map.
layout(location = 0) in vec3 position;
#ifdef MV_COLORS
layout(location = 2) in vec4 color;
out float alphaAt;
#endif
#ifdef MV_BASE_TEXTURE
layout(location = 3) in vec2 uv;
out vec2 uvAt;
#endif
uniform mat4 clipFromWorld;

void main() {
    gl_Position = clipFromWorld * vec4(position, 1.0);
#ifdef MV_COLORS
    alphaAt = color.a;
#endif
#ifdef MV_BASE_TEXTURE
    uvAt = uv;
#endif
}
