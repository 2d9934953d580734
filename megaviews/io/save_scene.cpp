#include "megaviews/io/save_scene.h"

#include <tbb/parallel_for.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <span>
#include <streambuf>

#include "megaviews/core/error.h"
#include "megaviews/core/output_file.h"
#include "megaviews/io/png.h"
#include "shaders/shared/microfacet.glsl"

namespace mv {

namespace {

using tinygltf::Value;

std::vector<double> numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
Value colorValue(const glm::dvec3& v) {
    return Value(Value::Array{Value(v.x), Value(v.y), Value(v.z)});
}

// A colour of any brightness as a factor within [0, 1] and how often that is to be taken.
struct Scaled {
    glm::dvec3 factor{0};
    double strength = 1;
};
Scaled scaled(const glm::dvec3& colour) {
    const double largest = std::max({colour.r, colour.g, colour.b});
    return largest > 0 ? Scaled{colour / largest, largest} : Scaled{};
}

// A unit vector of floats that is `normal` again once it is normalised in double and rounded, as
// the loader does with all normals: rounding alone would change the last bit of some. Hardly any
// needs more than a few lengths, all within 1e-4 of 1; failing that, the normal itself.
glm::vec3 normalToStore(const glm::vec3& normal) {
    constexpr int kLengths = 256;
    for (int i = 0; i < kLengths; ++i) {
        const double length = 1 + (i % 2 ? i : -i) * 0x1p-22;
        const glm::vec3 stored(glm::dvec3(normal) * length);
        if (glm::vec3(glm::normalize(glm::dvec3(stored))) == normal) return stored;
    }
    return normal;
}

// Whether any texture is looked up at Vertex uv.
bool usesUvs(const Material& m) {
    return std::max({m.baseTexture, m.metallicRoughnessTexture, m.normalTexture, m.coatTexture,
                     m.coatNormalTexture}) >= 0;
}

// Puts a model together, data behind it.
class ModelBuilder {
  public:
    explicit ModelBuilder(const SceneToSave& saved) : saved_(saved), scene_(saved.scene) {}

    tinygltf::Model build() {
        model_.asset.version = "2.0";
        model_.asset.generator = "MegaViews";
        model_.scenes.emplace_back();
        model_.defaultScene = 0;
        addImages();
        for (const Material& material : scene_.materials) addMaterial(material);
        addGeometry();
        for (const PosedCamera& camera : saved_.cameras) addCamera(camera);
        for (const PosedLight& light : saved_.lights) addLight(light);
        if (!data_.empty()) model_.buffers.emplace_back().data = std::move(data_);
        return std::move(model_);
    }

  private:
    template <typename Entry, typename T>
    static int append(std::vector<Entry>& entries, T&& entry) {
        entries.push_back(std::forward<T>(entry));
        return static_cast<int>(entries.size() - 1);
    }
    void use(const std::string& extension) {
        auto& used = model_.extensionsUsed;
        if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
    }
    void extend(tinygltf::Material& out, const std::string& extension, Value::Object value) {
        out.extensions[extension] = Value(std::move(value));
        use(extension);
    }

    int addView(std::span<const std::uint8_t> bytes, int target = 0) {
        data_.resize((data_.size() + 3) / 4 * 4);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data_.size();
        view.byteLength = bytes.size();
        view.target = target;
        data_.insert(data_.end(), bytes.begin(), bytes.end());
        return append(model_.bufferViews, std::move(view));
    }

    template <typename T>
    int addAccessor(const std::vector<T>& values, int componentType, int type, int target) {
        tinygltf::Accessor accessor;
        accessor.bufferView =
            addView(std::span(reinterpret_cast<const std::uint8_t*>(values.data()),
                              values.size() * sizeof(T)),
                    target);
        accessor.componentType = componentType;
        accessor.type = type;
        accessor.count = values.size();
        return append(model_.accessors, std::move(accessor));
    }
    template <typename T>
    int addAttribute(const std::vector<T>& values) {
        return addAccessor(values, TINYGLTF_COMPONENT_TYPE_FLOAT, T::length(),
                           TINYGLTF_TARGET_ARRAY_BUFFER);
    }

    int addNode(tinygltf::Node node) {
        const int index = append(model_.nodes, std::move(node));
        model_.scenes[0].nodes.push_back(index);
        return index;
    }

    void addImages();
    void addMaterial(const Material& material);
    void addSpecular(const Material& in, tinygltf::Material& out);
    void addTransmission(const Material& in, tinygltf::Material& out);
    void addCoat(const Material& in, tinygltf::Material& out);
    void addEmission(const Material& in, tinygltf::Material& out);
    void addGeometry();
    void addRun(std::size_t first, std::size_t end, tinygltf::Mesh& mesh);
    void addCamera(const PosedCamera& posed);
    void addLight(const PosedLight& posed);

    const SceneToSave& saved_;
    const Scene& scene_;
    tinygltf::Model model_;
    std::vector<std::uint8_t> data_;
};

void ModelBuilder::addImages() {
    std::vector<std::vector<std::uint8_t>> files(scene_.images.size());
    tbb::parallel_for(std::size_t{0}, files.size(),
                      [&](std::size_t i) { files[i] = encodePng(scene_.images[i]); });
    for (std::size_t i = 0; i < files.size(); ++i) {
        tinygltf::Image& image = model_.images.emplace_back();
        image.name = scene_.images[i].name;
        image.mimeType = "image/png";
        image.bufferView = addView(files[i]);
    }
    const auto wrap = [](Wrap mode) {
        return mode == Wrap::clamp    ? TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE
               : mode == Wrap::mirror ? TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT
                                      : TINYGLTF_TEXTURE_WRAP_REPEAT;
    };
    for (const Texture& in : scene_.textures) {
        tinygltf::Sampler& sampler = model_.samplers.emplace_back();
        sampler.wrapS = wrap(in.wrapS);
        sampler.wrapT = wrap(in.wrapT);
        sampler.magFilter =
            in.nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
        tinygltf::Texture& texture = model_.textures.emplace_back();
        texture.sampler = static_cast<int>(model_.samplers.size() - 1);
        texture.source = in.image;
    }
}

void ModelBuilder::addMaterial(const Material& in) {
    tinygltf::Material out;
    out.name = in.name;
    out.doubleSided = in.doubleSided;
    if (in.blends) {
        out.alphaMode = "BLEND";
    } else if (in.alphaCutoff > 0) {
        out.alphaMode = "MASK";
        out.alphaCutoff = static_cast<double>(in.alphaCutoff);
    }
    const glm::dvec4 base(in.baseColor);
    out.pbrMetallicRoughness.baseColorFactor = {base.r, base.g, base.b, base.a};
    out.pbrMetallicRoughness.metallicFactor = static_cast<double>(in.metallic);
    out.pbrMetallicRoughness.roughnessFactor = static_cast<double>(in.roughness);
    out.pbrMetallicRoughness.baseColorTexture.index = in.baseTexture;
    out.pbrMetallicRoughness.metallicRoughnessTexture.index = in.metallicRoughnessTexture;
    out.normalTexture.index = in.normalTexture;
    out.normalTexture.scale = static_cast<double>(in.normalScale);
    addSpecular(in, out);
    addTransmission(in, out);
    addCoat(in, out);
    addEmission(in, out);
    if (in.unlit) extend(out, "KHR_materials_unlit", {});
    model_.materials.push_back(std::move(out));
}

void ModelBuilder::addSpecular(const Material& in, tinygltf::Material& out) {
    Value::Object specular;
    const double factor = double{in.specularFactor};
    if (in.filledIndex() > 0) {
        extend(out, "KHR_materials_ior", {{"ior", Value(double{in.index})}});
    } else if (!in.unlit && in.specular != kSpecularOfGlass) {
        // The index of refraction that reflects so much; 0 stands for one without end.
        const double part = std::sqrt(static_cast<double>(in.specular));
        const double same = part < 1 ? (1 + part) / (1 - part) : 0;
        extend(out, "KHR_materials_ior", {{"ior", Value(same)}});
    }
    if (!in.unlit && factor < 1) specular["specularFactor"] = Value(factor);
    if (!in.unlit && in.specularColor != glm::vec3(1)) {
        specular["specularColorFactor"] = colorValue(in.specularColor);
    }
    if (!specular.empty()) extend(out, "KHR_materials_specular", std::move(specular));
}

void ModelBuilder::addTransmission(const Material& in, tinygltf::Material& out) {
    if (in.thickness > 0) {
        // The node scales it by the root's edge.
        const double thick = double{in.thickness};
        extend(out, "KHR_materials_volume",
               {{"thicknessFactor", Value(thick / scene_.root.edge)},
                {"attenuationDistance", Value(thick)},
                {"attenuationColor", colorValue(in.attenuation())}});
    }
    if (in.transmission > 0) {
        extend(out, "KHR_materials_transmission",
               {{"transmissionFactor", Value(static_cast<double>(in.transmission))}});
    }
}

void ModelBuilder::addCoat(const Material& in, tinygltf::Material& out) {
    if (!(in.coat > 0) || in.unlit) return;
    Value::Object coat{{"clearcoatFactor", Value(static_cast<double>(in.coat))},
                       {"clearcoatRoughnessFactor", Value(static_cast<double>(in.coatRoughness))}};
    if (in.coatTexture >= 0) {
        coat["clearcoatTexture"] = Value(Value::Object{{"index", Value(in.coatTexture)}});
    }
    if (in.coatNormalTexture >= 0) {
        coat["clearcoatNormalTexture"] =
            Value(Value::Object{{"index", Value(in.coatNormalTexture)},
                                {"scale", Value(static_cast<double>(in.coatNormalScale))}});
    }
    extend(out, "KHR_materials_clearcoat", std::move(coat));
}

void ModelBuilder::addEmission(const Material& in, tinygltf::Material& out) {
    const Scaled emission = scaled(glm::dvec3(in.emission) * saved_.lightScale);
    if (emission.factor == glm::dvec3(0)) return;
    // Up to 1 the factor says it all.
    const bool strong = emission.strength > 1;
    out.emissiveFactor = numbers(emission.factor * (strong ? 1 : emission.strength));
    if (strong) {
        extend(out, "KHR_materials_emissive_strength",
               {{"emissiveStrength", Value(emission.strength)}});
    }
    out.emissiveTexture.index = in.emissiveTexture;
    out.emissiveTexture.texCoord = usesUvs(in) ? 1 : 0;
}

// Positions stay in root-cube units, which the node takes to the world: in floats of world units a
// scene far from its origin would lose bits.
void ModelBuilder::addGeometry() {
    const RootCube& root = scene_.root;
    Value::Object stated = {
        {"rootCube", Value(Value::Array{Value(root.origin.x), Value(root.origin.y),
                                        Value(root.origin.z), Value(root.edge)})}};
    if (scene_.positionStep > 0) stated["positionStep"] = Value(double{scene_.positionStep});
    model_.asset.extras = Value(Value::Object{{"megaviews", Value(std::move(stated))}});
    if (scene_.triangles.empty()) return;
    tinygltf::Mesh mesh;
    const auto& materials = scene_.triangleMaterials;
    for (std::size_t first = 0; first < materials.size();) {
        std::size_t end = first + 1;
        while (end < materials.size() && materials[end] == materials[first]) ++end;
        addRun(first, end, mesh);
        first = end;
    }
    tinygltf::Node node;
    node.mesh = append(model_.meshes, std::move(mesh));
    node.translation = numbers(root.origin);
    node.scale = numbers(glm::dvec3(root.edge));
    addNode(std::move(node));
}

// Triangles [first, end), which have one material, and the vertices that they use.
void ModelBuilder::addRun(std::size_t first, std::size_t end, tinygltf::Mesh& mesh) {
    std::vector<std::uint32_t> vertices, indices;
    for (std::size_t t = first; t < end; ++t) {
        for (int k = 0; k < 3; ++k) vertices.push_back(scene_.triangles[t][k]);
    }
    indices = vertices;
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (std::uint32_t& index : indices) {
        const auto at = std::lower_bound(vertices.begin(), vertices.end(), index);
        index = static_cast<std::uint32_t>(at - vertices.begin());
    }
    const auto pick = [&](const auto& from) {
        std::remove_cvref_t<decltype(from)> picked;
        picked.reserve(vertices.size());
        for (const std::uint32_t vertex : vertices) picked.push_back(from[vertex]);
        return picked;
    };

    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = static_cast<int>(scene_.triangleMaterials[first]);
    primitive.indices = addAccessor(indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                    TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);

    const std::vector<glm::vec3> positions = pick(scene_.positions);
    glm::vec3 low = positions.front(), high = low;
    for (const glm::vec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);
    primitive.attributes["POSITION"] = addAttribute(positions);
    model_.accessors.back().minValues = numbers(low);
    model_.accessors.back().maxValues = numbers(high);

    std::vector<glm::vec3> normals = pick(scene_.normals);
    for (glm::vec3& normal : normals) normal = normalToStore(normal);
    primitive.attributes["NORMAL"] = addAttribute(normals);
    if (!scene_.colors.empty()) primitive.attributes["COLOR_0"] = addAttribute(pick(scene_.colors));
    const auto& material = model_.materials[static_cast<std::size_t>(primitive.material)];
    if (usesUvs(scene_.materials[scene_.triangleMaterials[first]])) {
        primitive.attributes["TEXCOORD_0"] = addAttribute(pick(scene_.uvs));
    }
    if (const tinygltf::TextureInfo& emissive = material.emissiveTexture; emissive.index >= 0) {
        primitive.attributes["TEXCOORD_" + std::to_string(emissive.texCoord)] =
            addAttribute(pick(scene_.emissiveUvs));
    }
    mesh.primitives.push_back(std::move(primitive));
}

// A node that looks along `forward`; a matrix, as an axis then is what was given.
tinygltf::Node nodeAt(const glm::dvec3& position, const glm::dvec3& forward, const glm::dvec3& up) {
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    tinygltf::Node node;
    for (const auto& [axis, last] :
         {std::pair(right, 0.0), {up, 0.0}, {-forward, 0.0}, {position, 1.0}}) {
        node.matrix.insert(node.matrix.end(), {axis.x, axis.y, axis.z, last});
    }
    return node;
}

void ModelBuilder::addCamera(const PosedCamera& posed) {
    // Nothing of the scene may be cut away, wherever the camera stands.
    const RootCube& root = scene_.root;
    const double distance = glm::length(posed.position - root.worldFromRoot(glm::vec3(0.5f)));
    const double nearest = 1e-4 * root.edge, farthest = distance + 2 * root.edge;
    tinygltf::Camera camera;
    camera.name = posed.camera.name;
    if (posed.camera.orthoHalfHeight) {
        camera.type = "orthographic";
        camera.orthographic.ymag = *posed.camera.orthoHalfHeight;
        camera.orthographic.xmag = *posed.camera.orthoHalfHeight * saved_.aspect;
        camera.orthographic.znear = nearest;
        camera.orthographic.zfar = farthest;
    } else {
        camera.type = "perspective";
        camera.perspective.yfov = posed.camera.yfovRad;
        camera.perspective.aspectRatio = saved_.aspect;
        camera.perspective.znear = nearest;
        camera.perspective.zfar = farthest;
    }
    tinygltf::Node node = nodeAt(posed.position, posed.forward, posed.up);
    node.name = camera.name;
    node.camera = append(model_.cameras, std::move(camera));
    addNode(std::move(node));
}

void ModelBuilder::addLight(const PosedLight& posed) {
    const Light& in = posed.light;
    const Scaled intensity = scaled(glm::dvec3(in.intensity) * saved_.lightScale);
    if (intensity.factor == glm::dvec3(0)) return;
    tinygltf::Light light;
    light.name = in.name;
    light.type = in.type == LightType::directional ? "directional"
                 : in.type == LightType::spot      ? "spot"
                                                   : "point";
    light.color = numbers(intensity.factor);
    light.intensity = intensity.strength;
    if (in.type == LightType::spot) {
        // The standard wants the inner cone to be the smaller, if by a hair.
        light.spot.outerConeAngle = in.outerConeRad;
        light.spot.innerConeAngle = std::min(in.innerConeRad, in.outerConeRad * (1 - 1e-9));
    }
    if (in.isDefault) {
        const Value placed(Value::Object{{kPlacedLight, Value(true)}});
        light.extras = Value(Value::Object{{"megaviews", placed}});
    }
    const glm::dvec3& forward = posed.direction;
    const glm::dvec3 any = std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    tinygltf::Node node =
        nodeAt(posed.position, forward, glm::normalize(any - forward * glm::dot(any, forward)));
    node.name = light.name;
    const int index = append(model_.lights, std::move(light));
    node.extensions["KHR_lights_punctual"] = Value(Value::Object{{"light", Value(index)}});
    addNode(std::move(node));
}

// What tinygltf writes into.
class FileStream : public std::streambuf {
  public:
    explicit FileStream(OutputFile& file) : file_(file) {}

  protected:
    std::streamsize xsputn(const char* data, std::streamsize bytes) override {
        file_.writeBytes(data, static_cast<std::uint64_t>(bytes));
        return bytes;
    }
    int_type overflow(int_type c) override {
        const char byte = traits_type::to_char_type(c);
        if (!traits_type::eq_int_type(c, traits_type::eof())) file_.writeBytes(&byte, 1);
        return traits_type::not_eof(c);
    }

  private:
    OutputFile& file_;
};

}  // namespace

void saveScene(const std::filesystem::path& file, const SceneToSave& saved) {
    OutputFile out(file);
    tinygltf::Model model = ModelBuilder(saved).build();
    // The JSON stays far below: each primitive takes some hundred bytes of it.
    constexpr std::uint64_t kMostJson = std::uint64_t{1} << 30;
    const std::uint64_t bytes = model.buffers.empty() ? 0 : model.buffers[0].data.size();
    if (bytes + kMostJson > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ExitCode::output, "'" + file.string() + "' cannot be written: the scene's " +
                                          std::to_string(bytes >> 20) +
                                          " MiB are more than a GLB file can hold");
    }
    FileStream buffer(out);
    std::ostream stream(&buffer);
    stream.exceptions(std::ios::badbit);  // lets an Error of the file through
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
    out.commit();
}

}  // namespace mv
