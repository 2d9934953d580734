#include "megaviews/scene/uri.h"

#include <algorithm>
#include <array>

#include "megaviews/scene/gltf_report.h"

namespace mv {

namespace {

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

constexpr std::array<std::int8_t, 256> makeBase64Values() {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    constexpr std::string_view kAlphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
        values[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::int8_t>(i);
    }
    return values;
}

Resource failed(std::string reason) { return {{}, std::move(reason)}; }

Resource readDataUri(const std::string& uri, std::uint64_t atLeast) {
    const std::size_t comma = uri.find(',');
    constexpr std::string_view kMark = ";base64";
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(kMark)) {
        return failed("the data URI is not base64");
    }
    auto bytes = decodeBase64(std::string_view(uri).substr(comma + 1));
    if (!bytes) return failed("the data URI cannot be decoded: it is not valid base64");
    if (bytes->size() < atLeast) {
        return failed("the data URI holds " + std::to_string(bytes->size()) +
                      " bytes, fewer than the " + std::to_string(atLeast) + " stated");
    }
    return {std::move(*bytes), {}};
}

// The file in the folder, or nothing if the URI leads elsewhere. Backslashes are part of a name or,
// as exporters on Windows write them, between folders: the former where there is such a file.
std::optional<std::filesystem::path> fileInside(const std::filesystem::path& folder,
                                                const std::string& decoded) {
    if (decoded.find('\0') != std::string::npos) return std::nullopt;
    std::string slashes = decoded;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const std::filesystem::path normal = std::filesystem::path(slashes).lexically_normal();
    if (normal.empty() || normal.is_absolute() || *normal.begin() == "..") return std::nullopt;
    const std::filesystem::path literal = std::filesystem::path(decoded).lexically_normal();
    std::error_code none;
    return folder / (std::filesystem::exists(folder / literal, none) ? literal : normal);
}

}  // namespace

std::optional<std::vector<std::uint8_t>> decodeBase64(std::string_view text) {
    static constexpr auto kValues = makeBase64Values();
    if (text.size() % 4 == 0) {
        for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
    }
    if (text.size() % 4 == 1) return std::nullopt;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t group = 0;
    int bits = 0;
    for (const char c : text) {
        const int value = kValues[static_cast<unsigned char>(c)];
        if (value < 0) return std::nullopt;
        group = (group << 6 | static_cast<std::uint32_t>(value)) & 0xffffff;
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            bytes.push_back(static_cast<std::uint8_t>(group >> bits));
        }
    }
    return bytes;
}

std::optional<std::string> percentDecode(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        if (i + 2 >= text.size()) return std::nullopt;
        const int high = hexDigit(text[i + 1]), low = hexDigit(text[i + 2]);
        if (high < 0 || low < 0) return std::nullopt;
        decoded += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return decoded;
}

Resource readUri(const std::filesystem::path& folder, const std::string& uri,
                 std::uint64_t atLeast) {
    if (uri.starts_with("data:")) return readDataUri(uri, atLeast);
    const auto decoded = percentDecode(uri);
    if (!decoded)
        return failed("the URI " + quote(uri) + " is not percent-encoded as it should be");
    // A scheme ("https:") is letters, digits, '+', '-', '.' before a colon.
    const std::size_t colon = uri.find(':');
    if (colon != std::string::npos && colon > 1 && uri.find('/') == colon + 1) {
        return failed("the URI " + quote(uri) + " is not a file beside the glTF file");
    }
    const auto inside = fileInside(folder, *decoded);
    if (!inside) {
        return failed("the URI " + quote(uri) +
                      " leads out of the glTF file's folder and is refused");
    }
    Resource result = readRegularFile(*inside, atLeast > 0 ? atLeast : UINT64_MAX);
    const std::string file = "the file " + quote(*decoded);
    if (!result.ok()) return failed(file + ": " + result.error);
    if (const std::size_t size = result.bytes.size(); size < atLeast) {
        return failed(file + " holds " + std::to_string(size) + " bytes, fewer than the " +
                      std::to_string(atLeast) + " stated");
    }
    return result;
}

}  // namespace mv
