#pragma once
// A scene as everything downstream sees it: one triangle soup in root-cube units, materials,
// images, and the nodes that lights and cameras hang on. First stage of the data's way
// (file -> Scene). Geometry is flattened: instances are expanded, skins and morphs stand in the
// pose of one time, and can be posed anew (rigged_scene.h). A scene without vertex colours,
// textures or moving geometry leaves the corresponding members empty, and nobody downstream pays
// for them.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "shaders/shared/types.glsl"

namespace mv {

// World (the file's units, y up) <-> root cube ([0,1]^3, all computation): uniform scale and
// translation, applied in double so that a scene far from its origin keeps its precision.
struct RootCube {
    glm::dvec3 origin{0};  // world position of root-cube (0,0,0)
    double edge = 1;       // world length of the root cube's edge, > 0
    glm::vec3 rootFromWorld(glm::dvec3 p) const { return glm::vec3((p - origin) / edge); }
    glm::dvec3 worldFromRoot(glm::vec3 p) const { return origin + glm::dvec3(p) * edge; }
    // The cube around a world box, the box centred in it, with a margin of 1/64 of the edge on
    // every side. An empty or flat box gives a cube of positive edge all the same.
    static RootCube around(glm::dvec3 min, glm::dvec3 max);
};

enum class Wrap : std::uint32_t { repeat = 0, clamp = 1, mirror = 2 };

struct Image {
    std::string name;
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // 4 * width * height, top row first, sRGB colour, linear alpha
};

struct Texture {
    int image = -1;  // index into Scene::images
    Wrap wrapS = Wrap::repeat, wrapT = Wrap::repeat;
    bool nearest = false;
};

// Share that is reflected of light at normal incidence [Fresnel].
inline double reflectanceOfIndex(double index) {
    const double part = (index - 1) / (index + 1);
    return part * part;
}

// Matt and two-sided, below a gloss where it has one [glTF 2.0, appendix B].
struct Material {
    std::string name;
    glm::vec4 baseColor{1};    // linear factor; alpha used by mask and blending only
    int baseTexture = -1;      // index into Scene::textures, looked up at Vertex uv
    glm::vec3 emission{0};     // W/(m^2 sr), factor * strength
    int emissiveTexture = -1;  // looked up at the emissive uv
    float alphaCutoff = 0;     // below it nothing is there; 0 = opaque. Of what blends, for rays
    bool blends = false;       // alpha is how much of it the eye sees before what is behind
    bool doubleSided = false;
    bool unlit = false;  // an emitter of its base colour that reflects nothing
    // Gloss: a layer of microfacets over what is not metal, and all of what is.
    float specular = 0;                 // share that the layer reflects at normal incidence, by its
                                        // index of refraction; 0: none, all matt
    glm::vec3 specularColor{1};         // times that, at most 1
    float specularFactor = 1;           // times all that the layer reflects, 0 .. 1
    float metallic = 0;                 // 0 .. 1
    float roughness = 1;                // 0 .. 1: the square root of the GGX distribution's alpha
    int metallicRoughnessTexture = -1;  // its blue and green times those; looked up at Vertex uv
    int normalTexture = -1;             // tangent space; looked up at Vertex uv
    float normalScale = 1;
    // A clear coat over all of it, smooth where normalTexture is not: its strength, 0 .. 1, and
    // roughness.
    float coat = 0, coatRoughness = 0;
    int coatTexture = -1;        // its red times the strength; looked up at Vertex uv
    int coatNormalTexture = -1;  // of the coat alone; as normalTexture
    float coatNormalScale = 1;
    // Glass: the share of what is neither reflected nor metal's that passes, in its colour.
    float transmission = 0;
    // What fills it: how thick, in world units (0: thin), what share is lost, 1 / world unit, and
    // its index of refraction.
    float thickness = 0;
    glm::vec3 absorption{0};
    float index = 1.5f;
    // Of light that passes, what it leaves [Beer and Lambert].
    glm::vec3 attenuation() const { return glm::exp(-absorption * thickness); }
    // Index of refraction inside a filled transmissive material; 0 if it is thin or lets nothing
    // through.
    float filledIndex() const {
        return thickness > 0 && transmission > 0 && index > 1 && !unlit ? index : 0;
    }
    // How far roughness spreads what passes, beside how far it spreads reflections: not at all
    // where light does not bend, as far for the index of glass [glTF Sample Viewer,
    // applyIorToRoughness].
    float passingSpread() const { return glm::clamp(2 * index - 2, 0.0f, 1.0f); }
    // What is behind it is seen, too.
    bool isClear() const { return blends || (transmission > 0 && !unlit); }
    // It lets most light through.
    bool isGlass() const { return !unlit && transmission > 0.5f; }
    // Below this alpha rays of light, views and the octree pass it.
    float rayCutoff() const { return isGlass() ? 2.0f : alphaCutoff; }
    // It keeps some of the light of rays that pass it. Not what blends by its texture, such as
    // leaves: there is little between all and nothing.
    bool tints() const { return isGlass() || (blends && baseColor.a < alphaCutoff); }
    bool emits() const { return emission != glm::vec3(0) || unlit; }
    // Of light at normal incidence the share that the layer reflects, by colour.
    glm::vec3 layer() const { return specularFactor * glm::min(specular * specularColor, 1.0f); }
    bool isGlossy() const {
        return !unlit && (layer() != glm::vec3(0) || metallic > 0 || coat > 0);
    }
};

// A node that a light or a camera hangs on; a tree by `parent` (parents stand before children).
struct Node {
    int parent = -1;
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
    std::optional<glm::dmat4> matrix;  // instead of translation, rotation, scale
};

enum class Interpolation { step, linear, cubicSpline };
enum class AnimatedProperty { translation, rotation, scale };

struct AnimationChannel {
    int node = 0;
    AnimatedProperty property = AnimatedProperty::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times;       // s, ascending
    std::vector<glm::dvec4> values;  // xyz(w); cubicSpline: in-tangent, value, out-tangent a key
};
struct Animation {
    std::string name;
    double duration = 0;  // s; evaluation loops over it
    std::vector<AnimationChannel> channels;
    bool together = false;  // made by us: the others at once, the shorter resting at their ends
};

enum class LightType { point, spot, directional };
struct Light {
    std::string name;
    LightType type = LightType::point;
    glm::vec3 intensity{1};  // W/sr (point, spot) or W/m^2 (directional): colour * factor
    double innerConeRad = 0, outerConeRad = 0.7853981633974483;
    int node = 0;            // shines along the node's -z
    bool isDefault = false;  // placed by us because the file has none
};

// Names such a light in `extras.megaviews` of a KHR_lights_punctual entry of files that are saved.
inline constexpr const char* kPlacedLight = "placed";

struct Camera {
    std::string name;
    int node = 0;                           // looks along the node's -z, y up
    double yfovRad = 0.9;                   // perspective
    std::optional<double> orthoHalfHeight;  // world units, orthographic
    bool isDefault = false;                 // placed by us
};

// A light or camera posed at one time, in world units.
struct PosedLight {
    Light light;
    glm::dvec3 position;
    glm::dvec3 direction;  // unit
};
struct PosedCamera {
    Camera camera;
    glm::dvec3 position, forward, up;  // unit, orthogonal
};

struct MovingGeometry;  // rigged_scene.h

struct Scene {
    std::string name;  // what the user typed: path or builtin:...
    std::string hash;  // of the file and all it refers to, or of the builtin's name and version
    std::vector<std::string> files;  // that it refers to and that were read
    // Hashes all that the geometry was made from: file, files it refers to, scene number, pose.
    // Keys the octree cache. Empty: hash says it all.
    std::string contentHash;
    RootCube root;

    // Geometry, root-cube units. Normals are unit shading normals. Optional arrays are empty or
    // as long as `positions`.
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> colors;       // linear, optional
    std::vector<glm::vec2> uvs;          // optional; of all textures but emissive ones, transformed
    std::vector<glm::vec2> emissiveUvs;  // optional
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> triangleMaterials;
    // Of the coarsest grid on which a file's packed positions lie (KHR_draco_mesh_compression,
    // KHR_mesh_quantization), root-cube units; 0: none are packed.
    float positionStep = 0;

    // Geometry that the animation moves: the last vertices and triangles. Null: none.
    std::shared_ptr<const MovingGeometry> moving;
    double poseS = 0;              // the time it stands at, inside the animation
    std::uint64_t poseNumber = 0;  // rises with every other pose

    std::vector<Material> materials;  // never empty: 0 may be the default material
    std::vector<Texture> textures;
    std::vector<Image> images;

    std::vector<Node> nodes;
    std::vector<Animation> animations;
    std::vector<Light> lights;
    std::vector<Camera> cameras;  // never empty once placeDefaults (framing.h) has seen it
    // One sentence each, also logged: what is wrong with the file, and what was added that it
    // lacks.
    std::vector<std::string> warnings, notes;
    std::vector<std::string> fileScenes;  // names of all scenes of a file that has several
    std::vector<std::string> variants;    // names of the file's material variants
    // Names of what the file uses: extensions that are read, and extensions and features that are
    // not.
    std::vector<std::string> extensions, ignored;

    bool empty() const { return triangles.empty(); }
    int defaultAnimation() const;  // all together where there is such, else the first, or -1
    // Poses at a time; animation < 0: none. Loops over the animation's duration.
    std::vector<PosedLight> lightsAt(double timeS, int animation) const;
    std::vector<PosedCamera> camerasAt(double timeS, int animation) const;
    bool animated() const;  // any light or camera moves
    // Materials::full and lambert differ: a material reflects with gloss or tints what passes it.
    bool needsFull() const;
    // What a texture shows. Null: the index is negative, or it shows no texel.
    const Image* imageOf(int texture) const;
};

}  // namespace mv
