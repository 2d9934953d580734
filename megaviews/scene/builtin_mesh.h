#pragma once
// A kit for scenes made by code (load_scene.h, makeBuiltin): triangles with shared vertices and
// unit normals, lights and cameras on nodes, closed animation loops. Serves the first stage
// (name -> Scene). Everything is computed in double with + - * / sqrt and the sines below, in
// program order, so that every machine makes the same bytes.

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "megaviews/scene/rigged_scene.h"
#include "megaviews/scene/scene.h"

namespace mv::builtin {

using Vec = glm::dvec3;

// Sine and cosine of an angle in turns (1 = full circle), the same bits everywhere: the C
// library's differ from version to version in the last place.
double sinTurns(double turns);
double cosTurns(double turns);

Vec unit(Vec v, Vec fallback = {0, 1, 0});
glm::vec3 srgb(int r, int g, int b);  // linear colour of an sRGB triple 0..255

// Uniform numbers by a counter that is hashed; the seed names the stream.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double uniform(double low = 0, double high = 1);
    Vec direction();

  private:
    std::uint64_t state_;
};

// Where a part stands: origin and right-handed orthonormal axes.
struct Frame {
    Vec origin{0};
    Vec x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    Vec point(Vec p) const { return origin + x * p.x + y * p.y + z * p.z; }
    Vec vector(Vec v) const { return x * v.x + y * v.y + z * v.z; }
    // Turned about y by a number of quarter turns: x goes to -z after one.
    static Frame at(Vec origin, int quarterTurns = 0);
};

// Collects geometry in world units; finish() brings it to the root cube. Material, tint (vertex
// colour) and frame are state that following geometry takes on.
class MeshBuilder {
  public:
    explicit MeshBuilder(Scene& scene) : scene_(scene) {}

    std::uint32_t addMaterial(const std::string& name, glm::vec3 color, bool doubleSided = false,
                              glm::vec3 emission = glm::vec3(0));
    void use(std::uint32_t material) { material_ = material, tint_ = glm::vec3(1); }
    void tint(glm::vec3 linear) { tint_ = linear; }
    void frame(const Frame& f) { frame_ = f; }
    // What follows hangs on this node of the scene, in its coordinates; -1: it stands.
    void hangOn(int node) { node_ = node; }
    const Frame& currentFrame() const { return frame_; }

    std::uint32_t vertex(Vec p, Vec n);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);  // no-op without area
    // A flat quadrilateral or triangle seen counter-clockwise from its front.
    void quad(Vec a, Vec b, Vec c, Vec d);
    void flat(Vec a, Vec b, Vec c);

    // Faces of a box, outwards: bits -x 1, +x 2, -y 4, +y 8, -z 16, +z 32.
    static constexpr unsigned kAllFaces = 63;
    void box(Vec min, Vec max, unsigned faces = kAllFaces);
    // A box whose top face is inset: bevelled tiles and plinths; no bottom.
    void tile(Vec min, Vec max, double bevel);

    // The surface point(i, j), 0 <= i <= nu, 0 <= j <= nv, smooth; its front is du x dv. A closed
    // direction joins the last row to the first. Normals are sums of face normals by area.
    using Point = std::function<Vec(int i, int j)>;
    void surface(int nu, int nv, bool closedU, bool closedV, const Point& point);

    // A profile (radius, height) turned about y, outside to the right of its direction of travel
    // upwards; a point given twice makes a crease. `radius(r, y, turns)` may shape the section.
    using Section = std::function<double(double r, double y, double turns)>;
    void lathe(const std::vector<glm::dvec2>& profile, int segments,
               const Section& section = nullptr);

    // A closed section, counter-clockwise in offsets along `side` and along side x tangent, swept
    // along a path in the plane normal to `side`; sharp section corners, smooth along the path.
    // Ends are left open.
    void sweep(const std::vector<Vec>& path, Vec side, const std::vector<glm::dvec2>& section);
    // The same with what stands for side x tangent at each point of the path.
    void sweep(const std::vector<Vec>& path, const std::vector<Vec>& outs, Vec side,
               const std::vector<glm::dvec2>& section);

    // World -> root cube, and the optional arrays checked. Where something hangs on a node, last of
    // all: it is posed by the scene's first animation, at time 0.
    void finish();

  private:
    RiggedScene takeRigged();  // what was collected, leaving the scene's arrays empty

    Scene& scene_;
    std::vector<Vec> world_;
    std::vector<std::uint32_t> slots_;  // scratch of surface()
    std::vector<Vec> sums_;
    std::vector<int> nodes_;  // parallel to the scene's triangles, once one hangs
    std::uint32_t material_ = 0;
    int node_ = -1;
    glm::vec3 tint_{1};
    Frame frame_;
};

// A node looking from `from` at `to`, along its -z.
int addNode(Scene& scene, Vec from, Vec to);
void addCamera(Scene& scene, const std::string& name, Vec from, Vec to, double yfovDeg);

// A node that follows path(turns) = {position, target} once around in `durationS`, its -z at the
// target. At time 0 it is at path(0). All that moves in a scene shares its first animation.
using Path = std::function<std::pair<Vec, Vec>(double turns)>;
int addMovingNode(Scene& scene, double durationS, const Path& path);
// A light on a node of its own.
void addMovingLight(Scene& scene, Light light, double durationS, const Path& path);

}  // namespace mv::builtin
