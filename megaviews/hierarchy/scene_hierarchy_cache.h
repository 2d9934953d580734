#pragma once
// The cache file of a SceneHierarchy and the folder that holds such files; buildOrLoad puts both
// together. Files are named after what they were built from, so they are never out of date.

#include <filesystem>
#include <optional>
#include <string>

#include "megaviews/hierarchy/scene_hierarchy.h"

namespace mv {

// Everything that build() reads, hashed to 128 bits: geometry, materials, reduced textures, depth,
// and the version of builder and file.
std::string cacheKey(const Scene& scene, const TriangleBvh& bvh, int levels);
std::filesystem::path cacheFile(const std::filesystem::path& directory, const std::string& key);

// Written aside and renamed: a file that exists is whole. Both throw std::runtime_error with the
// reason; nothing is returned where there is no such file.
void storeHierarchy(const SceneHierarchy& hierarchy, const std::string& key,
                    const std::filesystem::path& file);
std::optional<SceneHierarchy> loadHierarchy(const std::string& key,
                                            const std::filesystem::path& file);

// Removes the files used longest ago until those left hold at most maxBytes; keep is not removed.
inline constexpr std::uint64_t kMaxCacheBytes = 4ull << 30;
void trimCache(const std::filesystem::path& directory, std::uint64_t maxBytes,
               const std::filesystem::path& keep);

}  // namespace mv
