#include "megaviews/hierarchy/scene_hierarchy_cache.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>
#include <vector>

#include "megaviews/core/error.h"
#include "megaviews/core/hash.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/output_file.h"
#include "megaviews/scene/rigged_scene.h"
#include "shaders/shared/types.glsl"

namespace mv {
namespace {

namespace fs = std::filesystem;

// Raise whenever build() gives another result or the file another layout.
constexpr std::uint32_t kVersion = 4;
constexpr char kMagic[8] = {'m', 'v', 'o', 'c', 't', 'r', 'e', 'e'};
constexpr const char* kExtension = ".octree";

struct Header {
    char magic[8];
    std::uint32_t version, levels;
    std::uint64_t nodes;
    char key[32];
    char checksum[32];  // of everything else
};
static_assert(sizeof(Header) == 88);

// With its length, so that what stands in one array cannot as well stand in the next.
void addArray(Hash& hash, const auto& values) {
    const std::uint64_t length = values.size();
    hash.add(std::span(&length, 1)).add(std::span(values));
}

std::string checksum(Header header, const SceneHierarchy& h) {
    std::memset(header.checksum, 0, sizeof header.checksum);
    Hash hash;
    hash.add(std::span(&header, 1));
    addArray(hash, h.levelBegin);
    addArray(hash, h.nodes);
    addArray(hash, h.mortonKeys);
    addArray(hash, h.areas);
    return hash.hex();
}

// In the file: header, levelBegin, nodes, mortonKeys, areas.
std::uint64_t fileBytes(std::uint64_t levels, std::uint64_t nodes) {
    return sizeof(Header) + (levels + 1) * 4 + nodes * (sizeof(SceneNode) + 4 + 4);
}

void readArray(std::ifstream& in, auto& out, std::uint64_t count) {
    out.resize(count);
    in.read(reinterpret_cast<char*>(out.data()),
            static_cast<std::streamsize>(count * sizeof(out[0])));
}
void writeArray(OutputFile& out, const auto& values) { out.write(std::span(values)); }

}  // namespace

std::string cacheKey(const Scene& scene, const TriangleBvh& bvh, int levels) {
    Hash hash;
    const std::uint32_t settings[2] = {kVersion, static_cast<std::uint32_t>(levels)};
    hash.add(std::span(settings));
    addArray(hash, scene.positions);
    addArray(hash, scene.normals);
    addArray(hash, scene.colors);
    addArray(hash, scene.uvs);
    addArray(hash, scene.emissiveUvs);
    addArray(hash, scene.triangles);
    addArray(hash, scene.triangleMaterials);
    addArray(hash, bvh.materials);
    addArray(hash, bvh.textures.textures);
    addArray(hash, bvh.textures.texels);
    if (scene.moving) hash.add(std::span(&scene.moving->triangle, 1));
    return hash.hex();
}

fs::path cacheFile(const fs::path& directory, const std::string& key) {
    return directory / (key + kExtension);
}

void storeHierarchy(const SceneHierarchy& h, const std::string& key, const fs::path& file) {
    Header header{};
    std::memcpy(header.magic, kMagic, sizeof kMagic);
    header.version = kVersion;
    header.levels = static_cast<std::uint32_t>(h.levels);
    header.nodes = h.nodes.size();
    key.copy(header.key, sizeof header.key);
    checksum(header, h).copy(header.checksum, sizeof header.checksum);

    fs::create_directories(file.parent_path());
    OutputFile out(file);
    out.writeBytes(&header, sizeof header);
    writeArray(out, h.levelBegin);
    writeArray(out, h.nodes);
    writeArray(out, h.mortonKeys);
    writeArray(out, h.areas);
    out.commit();
}

std::optional<SceneHierarchy> loadHierarchy(const std::string& key, const fs::path& file) {
    std::error_code unreadable;
    if (!fs::exists(file, unreadable) && !unreadable) return std::nullopt;
    if (const std::string reason = whyUnreadable(file); !reason.empty()) {
        throw std::runtime_error("cannot be used: " + reason);
    }
    std::ifstream in(file, std::ios::binary);
    Header header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!in || std::memcmp(header.magic, kMagic, sizeof kMagic) != 0 || header.version != kVersion)
        throw std::runtime_error("is no octree of this version");
    if (std::string_view(header.key, sizeof header.key) != key)
        throw std::runtime_error("holds another scene than its name says");
    // The size is checked before anything is allocated.
    if (header.levels > kTreeLevels || header.nodes >> 28 > 0 ||
        fileBytes(header.levels, header.nodes) != fs::file_size(file))
        throw std::runtime_error("is cut off or damaged");
    SceneHierarchy h;
    h.levels = static_cast<int>(header.levels);
    readArray(in, h.levelBegin, header.levels + 1);
    readArray(in, h.nodes, header.nodes);
    readArray(in, h.mortonKeys, header.nodes);
    readArray(in, h.areas, header.nodes);
    if (!in || checksum(header, h) != std::string_view(header.checksum, sizeof header.checksum))
        throw std::runtime_error("is cut off or damaged");
    return h;
}

void trimCache(const fs::path& directory, std::uint64_t maxBytes, const fs::path& keep) {
    struct Entry {
        fs::path path;
        fs::file_time_type used;
        std::uint64_t bytes;
    };
    std::vector<Entry> entries;
    std::uint64_t total = 0;
    std::error_code unread;  // then what is there stays
    for (fs::directory_iterator at(directory, unread), end; !unread && at != end;
         at.increment(unread)) {
        const fs::directory_entry& e = *at;
        const std::string name = e.path().filename().string();
        std::error_code gone;  // another process may be trimming too
        const bool whole = name.ends_with(kExtension);
        if ((!whole && !OutputFile::isAside(name)) || !e.is_regular_file(gone)) continue;
        const Entry entry{e.path(), e.last_write_time(gone), e.file_size(gone)};
        if (gone) continue;
        // A part that is still growing belongs to another process; after a day to none.
        const auto age = fs::file_time_type::clock::now() - entry.used;
        if (!whole && age < std::chrono::hours(24)) continue;
        total += entry.bytes;
        entries.push_back(entry);
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.used < b.used; });
    for (const Entry& e : entries) {
        if (total <= maxBytes) return;
        if (e.path == keep) continue;
        std::error_code ignored;
        fs::remove(e.path, ignored);
        total -= e.bytes;
    }
}

fs::path defaultCacheDirectory() {
    const auto absolute = [](const char* name) {
        const char* value = std::getenv(name);
        const fs::path path = value ? value : "";
        return path.is_absolute() ? path : fs::path();
    };
    if (const fs::path cache = absolute("XDG_CACHE_HOME"); !cache.empty())
        return cache / "megaviews";
    if (const fs::path home = absolute("HOME"); !home.empty()) return home / ".cache" / "megaviews";
    return {};
}

namespace {

// The octree over what stands still.
SceneHierarchy standing(const Scene& scene, const TriangleBvh& bvh, int levels,
                        const fs::path& directory, const Progress& progress) {
    if (directory.empty() || scene.empty())
        return SceneHierarchy::build(scene, bvh, levels, progress);
    report(progress, "read octree", 0);
    const std::string key = cacheKey(scene, bvh, levels);
    const fs::path file = cacheFile(directory, key);
    try {
        if (std::optional<SceneHierarchy> cached = loadHierarchy(key, file)) {
            std::error_code ignored;  // used now: the last to be removed
            fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
            report(progress, "read octree", 1);
            return *std::move(cached);
        }
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& e) {
        spdlog::warn("the cached octree {} {}; it is built anew", file.string(), e.what());
    }

    SceneHierarchy h = SceneHierarchy::build(scene, bvh, levels, progress);
    if (h.nodes.empty()) return h;
    report(progress, "store octree", 0);
    try {
        if (fileBytes(static_cast<std::uint64_t>(levels), h.nodes.size()) <= kMaxCacheBytes) {
            storeHierarchy(h, key, file);
            trimCache(directory, kMaxCacheBytes, file);
        }
    } catch (const std::exception& e) {
        spdlog::warn("the octree is not kept for the next time: {}", e.what());
    }
    report(progress, "store octree", 1);
    return h;
}

}  // namespace

SceneHierarchy buildOrLoad(const Scene& scene, const TriangleBvh& bvh, int levels,
                           const fs::path& directory, const Progress& progress) {
    SceneHierarchy h = standing(scene, bvh, levels, directory, progress);
    h.joinMoving(scene, bvh, levels);
    return h;
}

}  // namespace mv
