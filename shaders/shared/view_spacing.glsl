// How far a view's light is spread: a virtual point light stands for the patch of surface between
// it and its neighbours, so nearer than about that patch's radius it must not grow brighter. The
// distance below which the gather clamps it follows from the nearest views that face alike, and
// from their flux: where all shine alike, pi r^2 is the view's share of their patch. With one
// distance for all views the dense ones lose light in corners and the sparse ones leave blobs.
#ifndef MV_VIEW_SPACING_GLSL
#define MV_VIEW_SPACING_GLSL
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/language.glsl"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

// Neighbours are looked for among so many views before and after, in the order of the Morton curve:
// approximate, a neighbour across a cell's border may be missed, and the patch be taken too large.
MV_CONST uint kSpacingWindow = 16u;
// Times the patch's radius: nearer to one, views beside an edge leave blobs on the other wall.
MV_CONST float kClampSpread = 2.0f;
MV_CONST float kMaxClampDistance = 0.1f;  // root-cube units
// Lights without surface, such as particles, and views without neighbours take this.
MV_CONST float kPointClampDistance = 0.01f;

// The nearest so far: squared distances, rising, and their power. Of four, chance puts some close
// together among thousands of views, and such a one shines as a patch of sun would.
MV_CONST int kNearest = 8;
struct NearestViews {
    float distances2[kNearest];
    float powers[kNearest];
};

MV_FN NearestViews noNearestViews() {
    NearestViews n;
    for (int i = 0; i < kNearest; ++i) {
        n.distances2[i] = kInfinity;
        n.powers[i] = 0.0f;
    }
    return n;
}

MV_FN bool hasNearest(NearestViews n) { return n.distances2[0] < kInfinity; }

MV_FN NearestViews withView(NearestViews n, float distance2, float power) {
    if (!(distance2 < n.distances2[kNearest - 1])) return n;
    for (int i = 0; i < kNearest; ++i) {
        bool nearer = distance2 < n.distances2[i];
        float d = n.distances2[i];
        float p = n.powers[i];
        n.distances2[i] = nearer ? distance2 : d;
        n.powers[i] = nearer ? power : p;
        distance2 = nearer ? d : distance2;
        power = nearer ? p : power;
    }
    return n;
}

MV_FN float viewPower(View view) { return gatherPower(viewFlux(view)); }

MV_FN NearestViews withNeighbour(NearestViews n, View view, View other) {
    MV_PRECISE float x = view.positionX - other.positionX;
    MV_PRECISE float y = view.positionY - other.positionY;
    MV_PRECISE float z = view.positionZ - other.positionZ;
    float distance2 = dot3(vec3(x, y, z), vec3(x, y, z));
    return dot3(viewNormal(view), viewNormal(other)) > 0.5f
               ? withView(n, distance2, viewPower(other))
               : n;
}

// How far apart views lie is told by pairs of them, each half of the Morton curve apart.
MV_CONST uint kSpreadPairs = 32u;
MV_CONST float kEdgeOfSpread = 4.0f;  // edges of a cube that they fill, per median distance
MV_FN uint spreadView(uint i, uint viewCount) { return i * viewCount / (2u * kSpreadPairs); }
MV_FN float spreadDistance2(vec3 a, vec3 b) {
    MV_PRECISE float x = a.x - b.x;
    MV_PRECISE float y = a.y - b.y;
    MV_PRECISE float z = a.z - b.z;
    return dot3(vec3(x, y, z), vec3(x, y, z));
}

// A few neighbours say too little of a density where they happen to lie together: the patch of such
// a view would shine a thousand times too bright. No distance is less than a tenth of what it would
// be if all views shared the six faces of the root cube, or of the smaller cube that most of them
// fill: a room is a speck of wide ground. median2: of spreadDistance2().
MV_FN float leastClampDistanceOn(float edge, uint views) {
    return min(0.1f * edge * sqrt(6.0f / (kPi * float(max(views, 1u)))), kMaxClampDistance);
}
MV_FN float leastClampDistance(float median2, uint viewCount) {
    float edge = viewCount < 2u * kSpreadPairs ? 1.0f : min(kEdgeOfSpread * sqrt(median2), 1.0f);
    return leastClampDistanceOn(edge, viewCount);
}

// Where one cell of the Morton grid holds more views than are looked at, as in a room that is a
// speck of its world, those looked at are any of them and as many times farther apart (squared),
// and the cell is the cube that they fill.
struct Crowd {
    float lookedShare;  // of the cell's views; 1: it holds no more
    float least;        // leastClampDistance() there
};
MV_FN Crowd crowdOf(uint looked, uint inCell, float least) {
    Crowd crowd;
    crowd.lookedShare = inCell > looked ? float(looked) / float(inCell) : 1.0f;
    float ofCell = leastClampDistanceOn(2.0f * cellHalf(kMortonLevels), inCell);
    crowd.least = inCell > looked ? min(least, ofCell) : least;
    return crowd;
}

// Root-cube units, below which a view of such power lights no brighter, by at least one neighbour.
MV_FN float clampDistanceAmong(NearestViews n, float own, Crowd crowd) {
    // The circle through the farthest of them holds the others whole and that one by half. Where
    // fewer are found it is taken for as many times larger: two that stand alone on a moulding say
    // how far apart they are, and not how much of it they stand for.
    float found = 1.0f;
    float reach2 = n.distances2[0];
    float within = 0.0f;
    float last = n.powers[0];
    for (int i = 1; i < kNearest; ++i) {
        if (!(n.distances2[i] < kInfinity)) continue;
        reach2 = n.distances2[i];
        found += 1.0f;
        within += last;
        last = n.powers[i];
    }
    float others = within + 0.5f * last;
    reach2 *= float(kNearest) / found;
    MV_PRECISE float c2 = reach2 * crowd.lookedShare * (own / max(own + others, 1e-30f));
    MV_PRECISE float c = sqrt(c2);
    return clamp(kClampSpread * c, crowd.least, kMaxClampDistance);
}

MV_FN float clampDistanceOf(View view, NearestViews n, Crowd crowd) {
    if (hasNearest(n)) return clampDistanceAmong(n, viewPower(view), crowd);
    return view.flags == kViewOmnidirectional ? kPointClampDistance : kMaxClampDistance;
}

MV_END_NAMESPACE
#endif
