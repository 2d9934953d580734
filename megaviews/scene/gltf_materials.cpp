#include "megaviews/scene/gltf_materials.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "megaviews/scene/gltf_glossiness.h"
#include "megaviews/scene/gltf_images.h"

namespace mv {

namespace {

const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto it = extensions.find(name);
    return it == extensions.end() ? nullptr : &it->second;
}

double numberIn(const tinygltf::Value* object, const char* key, double otherwise) {
    return object && object->Has(key) ? object->Get(key).GetNumberAsDouble() : otherwise;
}

UvSource uvSource(const tinygltf::TextureInfo& info) {
    UvSource source;
    source.set = info.texCoord;
    const tinygltf::Value* transform = findExtension(info.extensions, "KHR_texture_transform");
    if (!transform) return source;
    source.set = static_cast<int>(numberIn(transform, "texCoord", source.set));
    const auto pair = [&](const char* key, glm::dvec2 otherwise) {
        if (!transform->Has(key)) return otherwise;
        const tinygltf::Value& value = transform->Get(key);
        return glm::dvec2(value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble());
    };
    const glm::dvec2 scale = pair("scale", {1, 1});
    const double angle = numberIn(transform, "rotation", 0);
    const double c = std::cos(angle), s = std::sin(angle);
    // Scaled, then turned counter-clockwise as seen in a picture, whose v points down, then moved.
    source.matrix = glm::dmat2(glm::dvec2(c, -s) * scale.x, glm::dvec2(s, c) * scale.y);
    source.offset = pair("offset", {0, 0});
    return source;
}

constexpr const char* kClearcoat = "KHR_materials_clearcoat";
constexpr const char* kSpecular = "KHR_materials_specular";
constexpr const char* kTransmission = "KHR_materials_transmission";
constexpr const char* kVolume = "KHR_materials_volume";

glm::vec3 colorIn(const tinygltf::Value* object, const char* key) {
    if (!object || !object->Has(key)) return glm::vec3(1);
    const tinygltf::Value& color = object->Get(key);
    glm::dvec3 out;
    for (int c = 0; c < 3; ++c) out[c] = color.Get(c).GetNumberAsDouble();
    return glm::vec3(out);
}

// index -1: none.
tinygltf::TextureInfo textureIn(const tinygltf::Value* extension, const char* key) {
    tinygltf::TextureInfo out;
    if (!extension || !extension->Has(key)) return out;
    const tinygltf::Value& info = extension->Get(key);
    out.index = static_cast<int>(numberIn(&info, "index", -1));
    out.texCoord = static_cast<int>(numberIn(&info, "texCoord", 0));
    if (info.Has("extensions")) {
        const tinygltf::Value& extensions = info.Get("extensions");
        for (const std::string& name : extensions.Keys()) {
            out.extensions[name] = extensions.Get(name);
        }
    }
    return out;
}

// Of a clear coat, if there is one: of its strength, or its normals.
constexpr const char *kCoatStrength = "clearcoatTexture", *kCoatNormals = "clearcoatNormalTexture";
tinygltf::TextureInfo coatTexture(const tinygltf::Material& in, const char* key) {
    const tinygltf::Value* coat = findExtension(in.extensions, kClearcoat);
    const bool any = coat && numberIn(coat, "clearcoatFactor", 0) > 0;
    return any ? textureIn(coat, key) : tinygltf::TextureInfo();
}
float coatNormalScale(const tinygltf::Material& in) {
    const tinygltf::Value* coat = findExtension(in.extensions, kClearcoat);
    const bool any = coat && coat->Has(kCoatNormals);
    return any ? static_cast<float>(numberIn(&coat->Get(kCoatNormals), "scale", 1)) : 1;
}

// Of which the mean stands for it.
struct MeanTexture {
    const char *extension, *key;
};
constexpr MeanTexture kPasses = {kTransmission, "transmissionTexture"};            // red
constexpr MeanTexture kThickness = {kVolume, "thicknessTexture"};                  // green
constexpr MeanTexture kReflects = {kSpecular, "specularTexture"};                  // alpha
constexpr MeanTexture kReflectedColour = {kSpecular, "specularColorTexture"};      // sRGB
constexpr MeanTexture kCoatRoughness = {kClearcoat, "clearcoatRoughnessTexture"};  // green
constexpr MeanTexture kGlossy = {kGlossiness, "specularGlossinessTexture"};        // alpha
constexpr MeanTexture kMeanTextures[] = {kPasses,          kThickness,     kReflects,
                                         kReflectedColour, kCoatRoughness, kGlossy};
int textureOf(const tinygltf::Material& in, const MeanTexture& wanted) {
    return textureIn(findExtension(in.extensions, wanted.extension), wanted.key).index;
}

Wrap wrapMode(int value) {
    switch (value) {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirror;
        default:
            return Wrap::repeat;
    }
}

Material makeMaterial(const tinygltf::Material& in) {
    Material out;
    out.name = in.name;
    const std::vector<double>& color = in.pbrMetallicRoughness.baseColorFactor;
    out.baseColor = glm::vec4(glm::dvec4(color[0], color[1], color[2], color[3]));
    const double strength = numberIn(
        findExtension(in.extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
    const std::vector<double>& emissive = in.emissiveFactor;
    out.emission = glm::vec3(glm::dvec3(emissive[0], emissive[1], emissive[2]) * strength);
    out.transmission = static_cast<float>(
        numberIn(findExtension(in.extensions, kTransmission), "transmissionFactor", 0));
    const tinygltf::Value* volume = findExtension(in.extensions, kVolume);
    // Bounded, so that nothing times anything is nothing.
    out.thickness = static_cast<float>(std::min(numberIn(volume, "thicknessFactor", 0), 1e30));
    const double reach = numberIn(volume, "attenuationDistance", 0);  // where its colour is left
    if (reach > 0) {
        const glm::dvec3 left = glm::max(glm::dvec3(colorIn(volume, "attenuationColor")), 1e-6);
        out.absorption = glm::vec3(glm::min(-glm::log(left) / reach, 1e30));
    }
    if (in.alphaMode == "MASK") out.alphaCutoff = static_cast<float>(in.alphaCutoff);
    if (in.alphaMode == "BLEND") out.alphaCutoff = 0.5f;
    out.blends = in.alphaMode == "BLEND";
    out.doubleSided = in.doubleSided;
    out.unlit = findExtension(in.extensions, "KHR_materials_unlit") != nullptr;
    if (out.unlit) out.emission = glm::vec3(0);  // the standard ignores it: base colour is all
    out.metallic = static_cast<float>(in.pbrMetallicRoughness.metallicFactor);
    out.roughness = static_cast<float>(in.pbrMetallicRoughness.roughnessFactor);
    out.normalScale = static_cast<float>(in.normalTexture.scale);
    // An index of 0 stands for one without end, which nothing enters.
    const double ior = numberIn(findExtension(in.extensions, "KHR_materials_ior"), "ior", 1.5);
    out.index = static_cast<float>(std::clamp(ior, 1.0, 1e6));
    out.specular = static_cast<float>(ior > 0 ? reflectanceOfIndex(ior) : 1);
    const tinygltf::Value* specular = findExtension(in.extensions, kSpecular);
    out.specularFactor = static_cast<float>(numberIn(specular, "specularFactor", 1));
    out.specularColor = colorIn(specular, "specularColorFactor");
    if (const tinygltf::Value* coat = findExtension(in.extensions, kClearcoat)) {
        out.coat = static_cast<float>(numberIn(coat, "clearcoatFactor", 0));
        out.coatRoughness = static_cast<float>(numberIn(coat, "clearcoatRoughnessFactor", 0));
    }
    return out;
}

// A texture beside the base colour's that is looked up where that is. Where a file has other
// coordinates for it, its mean stands for it.
struct SecondTexture {
    int texture = -1;  // of the scene
    glm::vec4 mean{1};
};

// Of an image: of what it holds as numbers, and of the linear colours.
struct Means {
    glm::vec4 numbers{1};
    glm::vec3 colour{1};
};
Means meansOf(const Image& image) {
    glm::dvec4 numbers(0);
    glm::dvec3 colour(0);
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        const auto channel = static_cast<int>(i % 4);
        numbers[channel] += image.rgba[i];
        if (channel < 3) colour[channel] += static_cast<double>(linearOfByte(image.rgba[i]));
    }
    const double texels = std::max<double>(1, static_cast<double>(image.rgba.size() / 4));
    return {glm::vec4(numbers / (255.0 * texels)), glm::vec3(colour / texels)};
}

// What masks hide and what blends leave out has no colour of its own.
void fillUnseenTexels(Scene& scene) {
    std::vector<int> alphas(scene.images.size(), 256);  // below it nobody sees a texel
    const auto lower = [&](int texture, int alpha) {
        if (texture < 0) return;
        const int image = scene.textures[static_cast<std::size_t>(texture)].image;
        int& lowest = alphas[static_cast<std::size_t>(image)];
        lowest = std::min(lowest, alpha);
    };
    for (const Material& m : scene.materials) {
        const double hidden = m.blends ? 1.0 / 255 : double{m.alphaCutoff};
        const double alpha = hidden / std::max(double{m.baseColor.a}, 1e-6);
        lower(m.baseTexture, static_cast<int>(std::ceil(std::min(255 * alpha, 255.0))));
        for (const int t : {m.emissiveTexture, m.metallicRoughnessTexture, m.normalTexture,
                            m.coatTexture, m.coatNormalTexture}) {
            lower(t, 0);
        }
    }
    tbb::parallel_for(std::size_t{0}, alphas.size(), [&](std::size_t i) {
        if (alphas[i] > 0 && alphas[i] < 256) fillUnseen(scene.images[i], alphas[i]);
    });
}

// Whose light is looked up; -1: none.
int emissiveTexture(const tinygltf::Material& in) {
    const bool dark = in.emissiveFactor == std::vector<double>{0, 0, 0};
    const bool unlit = findExtension(in.extensions, "KHR_materials_unlit") != nullptr;
    return dark || unlit ? -1 : in.emissiveTexture.index;
}

class MaterialLoader {
  public:
    MaterialLoader(const tinygltf::Model& model, Scene& scene, GltfReport& report)
        : model_(model), scene_(scene), report_(report) {}

    // Which textures, hence which images, any material looks at, or takes the mean of.
    void findImages();
    void readImages(GltfFile& file, const Progress& progress);
    // The next of the file's, with what readImages() read.
    MaterialUvs add(const tinygltf::Material& in);

  private:
    void use(int texture, std::set<int>& images);
    int imageOf(int texture) const {
        return texture < 0 ? -1 : model_.textures[static_cast<std::size_t>(texture)].source;
    }
    int sceneTexture(int texture);
    // Of a texture beside the base colour's, whose place in the file is NormalTextureInfo's or
    // TextureInfo's.
    SecondTexture second(const auto& info, MaterialUvs& uv);
    // White where there is none.
    Means meansOfTexture(const tinygltf::Material& in, const MeanTexture& wanted) const {
        const auto found = means_.find(imageOf(textureOf(in, wanted)));
        return found == means_.end() ? Means() : found->second;
    }
    void takeMeans(const tinygltf::Material& in, Material& out) const;

    const tinygltf::Model& model_;
    Scene& scene_;
    GltfReport& report_;
    std::set<int> usedImages_, imagesForMeans_, sourceless_;
    std::set<int> colours_;                           // images that some material takes for colours
    std::map<int, int> sceneImages_, sceneTextures_;  // from the file's indices
    std::map<int, Means> means_;
};

void MaterialLoader::use(int texture, std::set<int>& images) {
    if (texture < 0) return;
    if (imageOf(texture) >= 0) {
        images.insert(imageOf(texture));
    } else if (sourceless_.insert(texture).second) {
        report_.warn("textures[" + std::to_string(texture) + "]",
                     "it has no image that this program can read (PNG, JPEG or WebP); drawn "
                     "without it");
    }
}

void MaterialLoader::findImages() {
    for (const tinygltf::Material& material : model_.materials) {
        for (const int texture :
             {material.pbrMetallicRoughness.baseColorTexture.index, emissiveTexture(material)}) {
            use(texture, usedImages_);
            use(texture, colours_);
        }
        for (const int texture :
             {material.pbrMetallicRoughness.metallicRoughnessTexture.index,
              material.normalTexture.index, coatTexture(material, kCoatStrength).index,
              coatTexture(material, kCoatNormals).index}) {
            use(texture, usedImages_);
        }
        for (const MeanTexture& mean : kMeanTextures) {
            use(textureOf(material, mean), imagesForMeans_);
        }
        use(textureOf(material, kReflectedColour), colours_);
    }
}

void MaterialLoader::readImages(GltfFile& file, const Progress& progress) {
    std::set<int> either = usedImages_;
    either.insert(imagesForMeans_.begin(), imagesForMeans_.end());
    std::vector<UsedImage> imageList;
    for (const int index : either) {
        imageList.push_back({index, colours_.contains(index) ? Texels::colours : Texels::numbers});
    }
    std::vector<Image> images = loadImages(file, model_, imageList, report_, progress);
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (images[i].rgba.empty()) continue;
        const int index = imageList[i].index;
        if (imagesForMeans_.contains(index)) means_[index] = meansOf(images[i]);
        if (!usedImages_.contains(index)) continue;
        sceneImages_[index] = static_cast<int>(scene_.images.size());
        scene_.images.push_back(std::move(images[i]));
    }
}

int MaterialLoader::sceneTexture(int texture) {
    const auto image = sceneImages_.find(imageOf(texture));
    if (texture < 0 || image == sceneImages_.end()) return -1;
    const auto [entry, isNew] =
        sceneTextures_.try_emplace(texture, static_cast<int>(scene_.textures.size()));
    if (!isNew) return entry->second;
    Texture out;
    out.image = image->second;
    const int sampler = model_.textures[static_cast<std::size_t>(texture)].sampler;
    if (sampler >= 0) {
        const tinygltf::Sampler& in = model_.samplers[static_cast<std::size_t>(sampler)];
        out.wrapS = wrapMode(in.wrapS);
        out.wrapT = wrapMode(in.wrapT);
        out.nearest = in.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    scene_.textures.push_back(out);
    return entry->second;
}

SecondTexture MaterialLoader::second(const auto& info, MaterialUvs& uv) {
    SecondTexture found;
    found.texture = sceneTexture(info.index);
    if (found.texture < 0) return found;
    tinygltf::TextureInfo place;
    place.texCoord = info.texCoord;
    place.extensions = info.extensions;
    const UvSource source = uvSource(place);
    if (!uv.base) uv.base = source;
    if (*uv.base == source) return found;
    report_.warn("materials[" + std::to_string(scene_.materials.size()) + "]",
                 "its textures have different coordinates; the mean of one is taken");
    const Texture& texture = scene_.textures[static_cast<std::size_t>(found.texture)];
    found.mean = meansOf(scene_.images[static_cast<std::size_t>(texture.image)]).numbers;
    found.texture = -1;
    return found;
}

void MaterialLoader::takeMeans(const tinygltf::Material& in, Material& out) const {
    out.transmission *= meansOfTexture(in, kPasses).numbers.r;
    out.thickness *= meansOfTexture(in, kThickness).numbers.g;
    out.specularFactor *= meansOfTexture(in, kReflects).numbers.a;
    out.specularColor *= meansOfTexture(in, kReflectedColour).colour;
    out.coatRoughness *= meansOfTexture(in, kCoatRoughness).numbers.g;
    if (const tinygltf::Value* gloss = findExtension(in.extensions, kGlossiness)) {
        const auto factor = static_cast<float>(numberIn(gloss, "glossinessFactor", 1));
        out.roughness = 1 - factor * meansOfTexture(in, kGlossy).numbers.a;
    }
}

MaterialUvs MaterialLoader::add(const tinygltf::Material& in) {
    Material out = makeMaterial(in);
    MaterialUvs uv;
    out.baseTexture = sceneTexture(in.pbrMetallicRoughness.baseColorTexture.index);
    if (out.baseTexture >= 0) uv.base = uvSource(in.pbrMetallicRoughness.baseColorTexture);
    const SecondTexture gloss = second(in.pbrMetallicRoughness.metallicRoughnessTexture, uv);
    out.metallicRoughnessTexture = gloss.texture;
    out.roughness *= gloss.mean.g;
    out.metallic *= gloss.mean.b;
    takeMeans(in, out);
    const SecondTexture coat = second(coatTexture(in, kCoatStrength), uv);
    out.coatTexture = coat.texture;
    out.coat *= coat.mean.r;
    out.coatNormalTexture = second(coatTexture(in, kCoatNormals), uv).texture;
    if (out.coatNormalTexture >= 0) out.coatNormalScale = coatNormalScale(in);
    out.normalTexture = second(in.normalTexture, uv).texture;
    if (out.normalTexture < 0) out.normalScale = 1;
    const int emissive = emissiveTexture(in);
    out.emissiveTexture = sceneTexture(emissive);
    if (out.emissiveTexture >= 0) {
        uv.emissive = uvSource(in.emissiveTexture);
    } else if (emissive >= 0) {
        out.emission = glm::vec3(0);  // better dark than all of it aglow
    }
    scene_.materials.push_back(std::move(out));
    return uv;
}

}  // namespace

std::vector<MaterialUvs> loadMaterials(const tinygltf::Model& model, GltfFile& file, Scene& scene,
                                       GltfReport& report, const Progress& progress) {
    MaterialLoader loader(model, scene, report);
    loader.findImages();
    loader.readImages(file, progress);
    std::vector<MaterialUvs> uvs;
    for (const tinygltf::Material& in : model.materials) uvs.push_back(loader.add(in));
    fillUnseenTexels(scene);
    Material& fallback = scene.materials.emplace_back();
    fallback.name = "default";
    uvs.emplace_back();
    return uvs;
}

}  // namespace mv
