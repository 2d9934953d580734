#include "app/viewer/start_page.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>

#include "app/viewer/scene_pictures.h"
#include "megaviews/scene/load_scene.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb_image.h>

namespace mv {
namespace {

namespace fs = std::filesystem;

constexpr int kDepth = 3;  // of folders below the first
constexpr std::size_t kMostFound = 8;
constexpr int kMostOfAFolder = 3;

std::span<const unsigned char> pictureOf(const std::string& scene) {
    if (scene == "builtin:atrium") return pictureOfAtrium();
    if (scene == "builtin:cathedral") return pictureOfCathedral();
    if (scene == "builtin:cornell") return pictureOfCornell();
    if (scene == "builtin:door") return pictureOfDoor();
    if (scene == "builtin:hairball") return pictureOfHairball();
    return {};
}

gl::Texture textureOf(std::span<const unsigned char> jpeg) {
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(jpeg.data(), static_cast<int>(jpeg.size()), &width, &height,
                              &channels, 4),
        stbi_image_free);
    if (!pixels) throw std::logic_error("a picture of the start page is no JPEG");
    gl::Texture texture("picture of a scene", GL_TEXTURE_2D, GL_RGBA8, width, height);
    const std::size_t bytes =
        4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    texture.writeBytes(4, {pixels.get(), pixels.get() + bytes});
    texture.parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    texture.parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return texture;
}

}  // namespace

StartPage::StartPage() {
    std::error_code gone;
    found_ = scenesNear(fs::current_path(gone).string(), kMostFound);
    for (const std::string& scene : builtinNames()) {
        ui::StartTile tile{scene, {}};
        if (const auto jpeg = pictureOf(scene); !jpeg.empty()) {
            const gl::Texture& texture = textures_.emplace_back(textureOf(jpeg));
            tile.picture = {reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture.id())),
                            texture.width(), texture.height(), false};
        }
        tiles_.push_back(std::move(tile));
    }
}

std::vector<std::string> scenesNear(const std::string& folder, std::size_t mostFound,
                                    std::size_t mostEntries) {
    std::vector<std::string> found;
    std::error_code error;
    fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied,
                                        error);
    std::size_t seen = 0;
    for (; !error && it != fs::recursive_directory_iterator() && seen < mostEntries;
         it.increment(error), ++seen) {
        const std::string name = it->path().filename().string();
        std::error_code unreadable;
        if (it->is_directory(unreadable)) {
            if (it.depth() >= kDepth || name.starts_with('.')) it.disable_recursion_pending();
            continue;
        }
        const std::string extension = it->path().extension().string();
        if (extension == ".glb" || extension == ".gltf") found.push_back(it->path().string());
    }
    std::sort(found.begin(), found.end());
    std::map<fs::path, int> ofFolder;
    std::erase_if(found, [&](const std::string& file) {
        return ++ofFolder[fs::path(file).parent_path()] > kMostOfAFolder;
    });
    found.resize(std::min(found.size(), mostFound));
    return found;
}

}  // namespace mv
