#pragma once
// Reads the accessors of a checked glTF model into vectors: any component type, normalised or not,
// interleaved, sparse, or standing for zeros. Serves the first stage, file -> Scene.

#include <tiny_gltf.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "megaviews/scene/gltf_report.h"

namespace mv {

class AccessorReader {
  public:
    AccessorReader(const tinygltf::Model& model, const GltfReport& report)
        : model_(&model), report_(&report) {}

    std::size_t count(int accessor) const { return get(accessor).count; }
    // Components the accessor lacks are taken from `missing`. With `normalize` integers are always
    // normalised, as colours and weights must be; otherwise as the accessor says.
    std::vector<glm::dvec4> vectors(int accessor, glm::dvec4 missing, bool normalize = false) const;
    std::vector<glm::dvec3> vectors3(int accessor, bool normalize = false) const;
    std::vector<glm::dvec2> vectors2(int accessor, bool normalize = false) const;
    std::vector<double> scalars(int accessor, bool normalize = false) const;
    std::vector<std::uint32_t> indices(int accessor) const;
    std::vector<glm::uvec4> indices4(int accessor) const;
    std::vector<glm::dmat4> matrices(int accessor) const;

  private:
    const tinygltf::Accessor& get(int accessor) const {
        return model_->accessors[static_cast<std::size_t>(accessor)];
    }
    template <typename T>
    void read(int accessor, std::size_t width, bool normalize, T* out, std::size_t stride) const;

    const tinygltf::Model* model_;
    const GltfReport* report_;
};

}  // namespace mv
