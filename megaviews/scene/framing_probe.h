#pragma once
// What rays find out about a scene before a camera or a light is placed in it (framing.h): where
// there is room to stand, whether that is indoors, and which surfaces a viewer sees. Root-cube
// units throughout.

#include <cstdint>
#include <functional>
#include <vector>

#include "megaviews/scene/triangle_bvh.h"

namespace mv::framing {

inline constexpr float kOff = 1e-4f;  // that points lie off their surface

// n directions spread evenly over the sphere.
std::vector<glm::vec3> sphereDirections(int n);

// A place where a person could stand, or a lamp hang: free space above a floor.
struct FreePoint {
    glm::vec3 position{0};
    float floor = 0;      // height of the surface below
    float ceiling = 0;    // height of the surface above, or the scene's top
    float clearance = 0;  // distance to the nearest surface
    float roominess = 0;  // mean distance to surfaces, all around
    float enclosure = 0;  // share of level directions that end at a surface
    float sky = 0;        // share of upward directions that end nowhere
    float inside = 0;     // share of hits on the back of a surface: high within solids
};
FreePoint probe(const TriangleBvh& bvh, glm::vec3 position);
bool isEnclosed(const FreePoint& point);  // by walls, and not in a solid
bool isRoofed(const FreePoint& point);
bool isInRoom(const FreePoint& point);  // both

double areaOf(const Scene& scene, std::uint32_t triangle);  // root-cube units^2

// A point just off a surface, its normal towards the viewer who found it.
struct SurfacePoint {
    glm::vec3 position{0}, normal{0};
    std::uint32_t triangle = 0;  // index into Scene::triangles
};

struct Box {
    glm::vec3 low{kInfinity}, high{-kInfinity};
    void add(glm::vec3 p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    bool contains(glm::vec3 p) const {
        return glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThanEqual(p, high));
    }
    float diagonal() const { return length3(high - low); }
};

struct Surroundings {
    // Bounds of the geometry, without strays: what lies far from nearly all of the surface, where a
    // picture of everything would show all else in less than a quarter of its size.
    glm::vec3 low{0}, high{0};
    float eyeHeight = 0;              // of a person; a share of the height if units look odd
    std::vector<FreePoint> standing;  // at eye height over floors; enclosed, not in solids
    float enclosedShare = 0;          // of all columns tried, those with such a place
    float openness = 0;               // share of directions from the fronts of surfaces that escape
    bool fitsPeople = false;          // as high as a room or a building, if units are metres
    bool hasRooms() const { return enclosedShare > 0.1f; }
    bool interior = false;
    bool litWithin = false;  // what the file lights is indoors
};
Surroundings survey(const TriangleBvh& bvh);

// Is part of the scene a room, closed but for windows and doors, whatever the rest of it is like?
// Then `surroundings` keeps the places in it.
bool hasRoomWithWindows(const TriangleBvh& bvh, Surroundings& surroundings);

// Points spread evenly by area over the fronts of all surfaces, or by area times a weight of each
// triangle.
std::vector<SurfacePoint> surfaceSamples(
    const TriangleBvh& bvh, int count,
    const std::function<double(std::uint32_t triangle)>& weightOf = {});

// Where rays from the points hit, `directions` from each.
std::vector<SurfacePoint> visibleSurfaces(const TriangleBvh& bvh,
                                          const std::vector<glm::vec3>& points, int directions);

// What a viewer has before him, through a 16:9 window of about 55 degrees.
struct Viewer {
    glm::vec3 position{0}, forward{0, 0, -1}, up{0, 1, 0};  // root-cube units
};
std::vector<SurfacePoint> surfacesInView(const TriangleBvh& bvh, const Viewer& viewer);

// Nothing between two points, ends excepted.
bool clear(const TriangleBvh& bvh, glm::vec3 a, glm::vec3 b);

}  // namespace mv::framing
