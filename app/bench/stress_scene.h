#pragma once
// What the stress cases are made of: scenes written triangle by triangle in double, which may hold
// what no loader lets through, at any scale and place, and sets of views at given points.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "app/common/scene_assets.h"
#include "megaviews/views/view_set.h"

namespace mv::stress {

// Geometry in metres, y up; finish() scales it about the origin, moves it and brings it to the root
// cube. Intensities of lights grow with the square of the scale, so that the picture stays as it
// is.
class World {
  public:
    explicit World(double scale = 1, glm::dvec3 offset = glm::dvec3(0))
        : scale_(scale), offset_(offset) {}

    // Materials that following triangles take on.
    void use(glm::vec3 color, glm::vec3 emission = glm::vec3(0), bool doubleSided = false);
    // Seen counter-clockwise from its front; one without area gets the normal (0, 1, 0).
    void triangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c);
    void triangle(const std::array<glm::dvec3, 3>& corners,
                  const std::array<glm::vec3, 3>& normals);
    void quad(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d);
    // Faces outwards, or inwards: a room.
    void box(glm::dvec3 low, glm::dvec3 high, bool inwards = false);
    // Adds every triangle so far again, `times` times, every second time with its other side up.
    void repeat(int times);

    void pointLight(glm::dvec3 position, double intensity);
    void spotLight(glm::dvec3 from, glm::dvec3 to, double intensity, double outerConeRad);
    void sun(glm::dvec3 from, glm::dvec3 to, double irradiance);
    void camera(glm::dvec3 from, glm::dvec3 to, double yfovDeg = 62);

    // Rounds corners to single precision where they stand in the world, as a file stores them.
    void roundToFloat() { rounded_ = true; }

    std::unique_ptr<SceneAssets> finish(int levels);
    bool empty() const { return corners_.empty(); }

  private:
    glm::dvec3 placed(glm::dvec3 p) const { return p * scale_ + offset_; }
    void light(Light light, glm::dvec3 from, glm::dvec3 to);

    double scale_;
    glm::dvec3 offset_;
    bool rounded_ = false;
    std::unique_ptr<SceneAssets> assets_ = std::make_unique<SceneAssets>();
    std::vector<glm::dvec3> corners_;
};

// The benign case: a room of 8 x 4 x 6 m, half divided by a wall, with a pillar from floor to
// ceiling and a chest, seen from a corner. Without a light.
World furnishedRoom(double scale = 1, glm::dvec3 offset = glm::dvec3(0));
// The same with its lamp.
World litRoom(double scale = 1, glm::dvec3 offset = glm::dvec3(0));
// A corridor of 8 x 0.5 x 0.5 m with a board across half of it: little surface, for deep octrees.
World corridor();

// Views at points of the root cube. `normal` zero: omnidirectional. Fluxes are such that about 200
// of them light a room of a few metres.
void addView(ViewSet& set, glm::vec3 position, glm::vec3 normal);
// Uniform in [0, 1)^3, and on the unit sphere; hashes of (seed, index).
glm::vec3 randomPoint(std::uint32_t seed, std::uint32_t index);
glm::vec3 randomDirection(std::uint32_t seed, std::uint32_t index);

}  // namespace mv::stress
