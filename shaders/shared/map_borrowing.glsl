// Which of many views have maps of their own, and whose map another one takes: that of a view
// nearby that faces as it does, and so sees about the same. What maps say is believed only as far
// as rays bear it out, so any choice is right in the mean; a better one leaves less noise.
#ifndef MV_MAP_BORROWING_GLSL
#define MV_MAP_BORROWING_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// Fewer than kMaxBorrowingViews along the curve fall into as many runs as there are maps, as even
// as 1 / 2^11 of a view allows, and the middle view of a run has its map.
MV_CONST uint kRunShift = 11u;
MV_CONST uint kMaxBorrowingViews = 1u << 21u;
MV_FN uint mapsOfViews(uint views, uint most) { return min(views, most); }
MV_FN uint runLength(uint views, uint maps) { return maps > 0u ? (views << kRunShift) / maps : 0u; }
MV_FN uint viewWithMap(uint run, uint length) { return (run * length + length / 2u) >> kRunShift; }
MV_FN uint runOfView(uint view, uint length, uint maps) {
    return min(((view << kRunShift) + (1u << (kRunShift - 1u))) / length, maps - 1u);
}

// A view looks for a map in so many runs before and after its own: neighbours along the curve may
// lie apart, face elsewhere, or stand on the other side of a wall.
MV_CONST uint kMapRuns = 4u;

// How little a view's map serves another, by the way between them in root-cube units: less is
// better. Normals are zero where views see everything.
MV_CONST float kFacesAlike = 0.7f;
// The root cube's squared diagonal: of any two maps that which faces alike serves better.
MV_CONST float kFacesAwayPenalty = 3.0f;
MV_FN float mapDistance(vec3 way, vec3 normal, vec3 normalOfMap) {
    bool alike = dot3(normal, normal) == 0.0f || dot3(normal, normalOfMap) >= kFacesAlike;
    return dot3(way, way) + (alike ? 0.0f : kFacesAwayPenalty);
}

MV_END_NAMESPACE
#endif
