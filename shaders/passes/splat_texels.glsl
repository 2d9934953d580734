// The texels of a map that a point or a triangle may cover, one after another: those of the front
// face, then those of the back. Areas are first column, first row, end column, end row; the end
// column is 0 where there is none.
struct SplatTexels {
    uint face;
    uvec2 at;          // the texel at hand, there while left.z is not 0
    uvec4 left, next;  // areas of its face and of the other
};

SplatTexels firstTexel(uvec4 ofFront, uvec4 ofBack) {
    if (ofFront.z == 0u) return SplatTexels(1u, ofBack.xy, ofBack, uvec4(0u));
    return SplatTexels(0u, ofFront.xy, ofFront, ofBack);
}

void toNextTexel(inout SplatTexels t) {
    t.at.x += 1u;
    if (t.at.x == t.left.z) t.at = uvec2(t.left.x, t.at.y + 1u);
    if (t.at.y == t.left.w) t = SplatTexels(1u, t.next.xy, t.next, uvec4(0u));
}
