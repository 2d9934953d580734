#include "megaviews/hierarchy/scene_hierarchy_cache.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>
#include <vector>

#include "megaviews/settings/statistics.h"

namespace mv {
namespace {

namespace fs = std::filesystem;

// Raise whenever build() gives another result or the file another layout.
constexpr std::uint32_t kVersion = 2;
constexpr char kMagic[8] = {'m', 'v', 'o', 'c', 't', 'r', 'e', 'e'};
constexpr const char* kExtension = ".octree";
constexpr const char* kAside = ".octree.part";

// Bytes to 128 bits: four lanes of multiply and rotate, as fast as memory. Not cryptographic; it
// tells scenes apart and finds broken files.
class Hash {
  public:
    void add(const void* data, std::size_t bytes) {
        const auto* p = static_cast<const unsigned char*>(data);
        std::uint64_t words[4];
        std::size_t left = bytes;
        for (; left >= sizeof words; left -= sizeof words, p += sizeof words) {
            std::memcpy(words, p, sizeof words);
            mix(words);
        }
        std::memset(words, 0, sizeof words);
        if (left) std::memcpy(words, p, left);
        mix(words);
        const std::uint64_t length[4] = {bytes, 0, 0, 0};
        mix(length);
    }
    template <typename T>
    void add(std::span<const T> values) {
        add(values.data(), values.size_bytes());
    }
    CacheKey key() const {
        std::uint64_t high = 0, low = 1;
        for (const std::uint64_t lane : lanes_) {
            high = scramble(high ^ lane);
            low = scramble(low + std::rotl(lane, 32));
        }
        return {high, low};
    }

  private:
    void mix(const std::uint64_t (&words)[4]) {
        for (std::size_t i = 0; i < 4; ++i)
            lanes_[i] = std::rotl((lanes_[i] ^ words[i]) * 0x9E3779B97F4A7C15u, 29);
    }
    static std::uint64_t scramble(std::uint64_t x) {
        x = (x ^ (x >> 32)) * 0xD6E8FEB86659FD93u;
        x = (x ^ (x >> 32)) * 0xD6E8FEB86659FD93u;
        return x ^ (x >> 32);
    }
    std::uint64_t lanes_[4] = {0x243F6A8885A308D3u, 0x13198A2E03707344u, 0xA4093822299F31D0u,
                               0x082EFA98EC4E6C89u};
};

struct Header {
    char magic[8];
    std::uint32_t version, levels;
    std::uint64_t keyHigh, keyLow;
    std::uint64_t nodes;
    std::uint64_t checksumHigh, checksumLow;  // of everything else
};
static_assert(sizeof(Header) == 56);

CacheKey checksum(Header header, const SceneHierarchy& h) {
    header.checksumHigh = header.checksumLow = 0;
    Hash hash;
    hash.add(&header, sizeof header);
    hash.add(std::span(h.levelBegin));
    hash.add(std::span(h.nodes));
    hash.add(std::span(h.mortonKeys));
    hash.add(std::span(h.attributes));
    return hash.key();
}

// In the file: header, levelBegin, nodes, mortonKeys, attributes.
std::uint64_t fileBytes(std::uint64_t levels, std::uint64_t nodes) {
    return sizeof(Header) + (levels + 1) * 4 +
           nodes * (sizeof(SceneNode) + 4 + sizeof(SceneNodeAttributes));
}

template <typename T>
void readArray(std::ifstream& in, std::vector<T>& out, std::uint64_t count) {
    out.resize(count);
    in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(count * sizeof(T)));
}
template <typename T>
void writeArray(std::ofstream& out, const std::vector<T>& values) {
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(T)));
}

std::string reasonOf(int error) { return std::generic_category().message(error); }

}  // namespace

std::string CacheKey::hex() const { return fmt::format("{:016x}{:016x}", high, low); }

CacheKey cacheKey(const Scene& scene, const TriangleBvh& bvh, int levels) {
    Hash hash;
    const std::uint32_t settings[2] = {kVersion, static_cast<std::uint32_t>(levels)};
    hash.add(settings, sizeof settings);
    hash.add(std::span(scene.positions));
    hash.add(std::span(scene.normals));
    hash.add(std::span(scene.colors));
    hash.add(std::span(scene.uvs));
    hash.add(std::span(scene.emissiveUvs));
    hash.add(std::span(scene.triangles));
    hash.add(std::span(scene.triangleMaterials));
    hash.add(std::span(bvh.materials));
    hash.add(std::span(bvh.textures.textures));
    hash.add(std::span(bvh.textures.texels));
    return hash.key();
}

fs::path cacheFile(const fs::path& directory, const CacheKey& key) {
    return directory / (key.hex() + kExtension);
}

void storeHierarchy(const SceneHierarchy& h, const CacheKey& key, const fs::path& file) {
    Header header{};
    std::memcpy(header.magic, kMagic, sizeof kMagic);
    header.version = kVersion;
    header.levels = static_cast<std::uint32_t>(h.levels);
    header.keyHigh = key.high;
    header.keyLow = key.low;
    header.nodes = h.nodes.size();
    const CacheKey sum = checksum(header, h);
    header.checksumHigh = sum.high;
    header.checksumLow = sum.low;

    fs::create_directories(file.parent_path());
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    const fs::path aside =
        file.parent_path() / fmt::format("{}.{}.{}{}", key.hex(), ::getpid(), now, kAside);
    try {
        errno = 0;
        std::ofstream out(aside, std::ios::binary);
        out.write(reinterpret_cast<const char*>(&header), sizeof header);
        writeArray(out, h.levelBegin);
        writeArray(out, h.nodes);
        writeArray(out, h.mortonKeys);
        writeArray(out, h.attributes);
        out.close();
        if (!out)
            throw std::runtime_error(aside.string() + " cannot be written: " + reasonOf(errno));
        fs::rename(aside, file);
    } catch (...) {
        std::error_code ignored;
        fs::remove(aside, ignored);
        throw;
    }
}

std::optional<SceneHierarchy> loadHierarchy(const CacheKey& key, const fs::path& file) {
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        if (errno == ENOENT || errno == ENOTDIR) return std::nullopt;
        throw std::runtime_error("cannot be read: " + reasonOf(errno));
    }
    Header header{};
    in.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!in || std::memcmp(header.magic, kMagic, sizeof kMagic) != 0 || header.version != kVersion)
        throw std::runtime_error("is no octree of this version");
    if (CacheKey{header.keyHigh, header.keyLow} != key)
        throw std::runtime_error("holds another scene than its name says");
    // The size is checked before anything is allocated.
    if (header.levels > static_cast<std::uint32_t>(kMaxLevels) || header.nodes >> 28 > 0 ||
        fileBytes(header.levels, header.nodes) != fs::file_size(file))
        throw std::runtime_error("is cut off or damaged");
    SceneHierarchy h;
    h.levels = static_cast<int>(header.levels);
    readArray(in, h.levelBegin, header.levels + 1);
    readArray(in, h.nodes, header.nodes);
    readArray(in, h.mortonKeys, header.nodes);
    readArray(in, h.attributes, header.nodes);
    if (!in || checksum(header, h) != CacheKey{header.checksumHigh, header.checksumLow})
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
    for (const fs::directory_entry& e : fs::directory_iterator(directory)) {
        const std::string name = e.path().filename().string();
        std::error_code gone;  // another process may be trimming too
        const bool whole = name.ends_with(kExtension);
        if ((!whole && !name.ends_with(kAside)) || !e.is_regular_file(gone)) continue;
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

SceneHierarchy buildOrLoad(const Scene& scene, const TriangleBvh& bvh, int levels,
                           const fs::path& directory, const Progress& progress) {
    if (directory.empty() || scene.empty())
        return SceneHierarchy::build(scene, bvh, levels, progress);
    report(progress, "read octree", 0);
    const CacheKey key = cacheKey(scene, bvh, levels);
    const fs::path file = cacheFile(directory, key);
    try {
        if (std::optional<SceneHierarchy> cached = loadHierarchy(key, file)) {
            std::error_code ignored;  // used now: the last to be removed
            fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
            report(progress, "read octree", 1);
            return *std::move(cached);
        }
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

}  // namespace mv
