#include "megaviews/io/npy.h"

#include <array>
#include <bit>
#include <cassert>
#include <charconv>
#include <fstream>
#include <limits>
#include <string_view>

#include "megaviews/core/error.h"
#include "megaviews/core/input_file.h"

namespace mv {

namespace {

static_assert(std::endian::native == std::endian::little,
              "files are written as they lie in memory");

constexpr std::string_view kMagic("\x93NUMPY", 6);

template <typename T>
constexpr std::string_view kDescr = "";
template <>
constexpr std::string_view kDescr<float> = "<f4";
template <>
constexpr std::string_view kDescr<double> = "<f8";
template <>
constexpr std::string_view kDescr<std::uint32_t> = "<u4";

// The header's Python literal: {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }.
std::string shapeLiteral(const std::vector<std::uint64_t>& shape) {
    std::string text = "(";
    for (std::size_t i = 0; i < shape.size(); ++i) {
        text += (i ? ", " : "") + std::to_string(shape[i]);
    }
    return text + (shape.size() == 1 ? ",)" : ")");
}

// The text after 'key': up to the end of the header, or nothing.
std::string_view valueOf(std::string_view header, std::string_view key) {
    for (const char quote : {'\'', '"'}) {
        const std::string quoted = quote + std::string(key) + quote;
        const std::size_t at = header.find(quoted);
        if (at == std::string_view::npos) continue;
        std::string_view rest = header.substr(at + quoted.size());
        const std::size_t value = rest.find_first_not_of(" :");
        return value == std::string_view::npos ? std::string_view{} : rest.substr(value);
    }
    return {};
}

}  // namespace

template <typename T>
NpyWriter<T>::NpyWriter(const std::filesystem::path& path, const std::vector<std::uint64_t>& shape)
    : file_(path), left_(1) {
    for (const std::uint64_t n : shape) left_ *= n;
    std::string header = "{'descr': '" + std::string(kDescr<T>) +
                         "', 'fortran_order': False, 'shape': " + shapeLiteral(shape) + ", }";
    // Magic, version and length take 10 bytes; data begins at a multiple of 64.
    while ((10 + header.size() + 1) % 64 != 0) header += ' ';
    header += '\n';
    const std::array<char, 4> versionAndLength = {1, 0, static_cast<char>(header.size() & 0xFF),
                                                  static_cast<char>(header.size() >> 8)};
    file_.write(kMagic);
    file_.writeBytes(versionAndLength.data(), versionAndLength.size());
    file_.write(header);
}

template <typename T>
void NpyWriter<T>::write(std::span<const T> elements) {
    assert(elements.size() <= left_);
    left_ -= elements.size();
    file_.write(elements);
}

template <typename T>
void NpyWriter<T>::close() {
    assert(left_ == 0);
    file_.close();
}

template <typename T>
void NpyWriter<T>::commit() {
    assert(left_ == 0);
    file_.commit();
}

template <typename T>
NpyArray<T> readNpy(const std::filesystem::path& path) {
    const auto bad = [&](const std::string& why) {
        return Error(ExitCode::input, path.string() + ": " + why);
    };
    if (const std::string reason = whyUnreadable(path); !reason.empty()) throw bad(reason);
    std::error_code error;
    const std::uint64_t fileBytes = std::filesystem::file_size(path, error);
    std::ifstream in(path, std::ios::binary);
    if (error || !in) throw bad("it cannot be opened for reading");

    // Magic, version, length of the header (2 bytes in 1.0, 4 afterwards).
    std::array<unsigned char, 12> start{};
    in.read(reinterpret_cast<char*>(start.data()), 8);
    if (!in || std::string_view(reinterpret_cast<char*>(start.data()), 6) != kMagic) {
        throw bad("is not an .npy file");
    }
    if (start[6] < 1 || start[6] > 3) {
        throw bad("has .npy version " + std::to_string(start[6]) + "; 1 to 3 are read");
    }
    const int lengthBytes = start[6] == 1 ? 2 : 4;
    in.read(reinterpret_cast<char*>(start.data()) + 8, lengthBytes);
    std::uint64_t length = 0;
    for (int i = lengthBytes - 1; i >= 0; --i) {
        length = length << 8 | start[8 + static_cast<std::size_t>(i)];
    }
    const std::uint64_t headerEnd = 8 + static_cast<std::uint64_t>(lengthBytes) + length;
    if (!in || headerEnd > fileBytes) throw bad("ends inside its header");
    std::string header(length, '\0');
    in.read(header.data(), static_cast<std::streamsize>(length));

    // Type, order and shape.
    const std::string_view descr = valueOf(header, "descr");
    if (descr.size() < 5 || descr.substr(1, 3) != kDescr<T> || descr[4] != descr[0]) {
        throw bad("does not hold little-endian '" + std::string(kDescr<T>.substr(1)) + "' numbers");
    }
    if (!valueOf(header, "fortran_order").starts_with("False")) {
        throw bad("is not in C order (fortran_order: False)");
    }
    std::string_view shapeText = valueOf(header, "shape");
    const std::size_t close = shapeText.find(')');
    if (!shapeText.starts_with('(') || close == std::string_view::npos) {
        throw bad("has no shape in its header");
    }
    shapeText = shapeText.substr(1, close - 1);
    NpyArray<T> array;
    std::uint64_t count = 1;
    const std::uint64_t most = (fileBytes - headerEnd) / sizeof(T);
    while (shapeText.find_first_not_of(" ,") != std::string_view::npos) {
        shapeText.remove_prefix(shapeText.find_first_not_of(" ,"));
        std::uint64_t n = 0;
        const auto [end, status] =
            std::from_chars(shapeText.data(), shapeText.data() + shapeText.size(), n);
        if (status != std::errc{}) throw bad("has a malformed shape in its header");
        shapeText.remove_prefix(static_cast<std::size_t>(end - shapeText.data()));
        array.shape.push_back(n);
        if (n != 0 && count > std::numeric_limits<std::uint64_t>::max() / n) {
            throw bad("has an impossible shape in its header");
        }
        count *= n;
    }
    if (count != most || (fileBytes - headerEnd) % sizeof(T) != 0) {
        throw bad("holds " + std::to_string(fileBytes - headerEnd) +
                  " bytes of data where its shape "
                  "needs " +
                  std::to_string(count) + " elements of " + std::to_string(sizeof(T)));
    }
    array.elements.resize(count);
    in.read(reinterpret_cast<char*>(array.elements.data()),
            static_cast<std::streamsize>(count * sizeof(T)));
    if (!in) throw bad("cannot be read to its end");
    return array;
}

template class NpyWriter<float>;
template class NpyWriter<double>;
template class NpyWriter<std::uint32_t>;
template NpyArray<float> readNpy<float>(const std::filesystem::path&);
template NpyArray<double> readNpy<double>(const std::filesystem::path&);
template NpyArray<std::uint32_t> readNpy<std::uint32_t>(const std::filesystem::path&);

}  // namespace mv
