#include "megaviews/io/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>

#include "megaviews/core/error.h"
#include "megaviews/io/output_file.h"

namespace mv {

namespace {

static_assert(std::endian::native == std::endian::little,
              "files are written as they lie in memory");

// ---------------------------------------------------------------- the header, as parsed

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Format { ascii, littleEndian, bigEndian };

constexpr std::size_t sizeOf(Type t) {
    constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(t)];
}

std::optional<Type> typeNamed(std::string_view name) {
    constexpr std::array<std::array<std::string_view, 2>, 8> kNames = {{{"char", "int8"},
                                                                        {"uchar", "uint8"},
                                                                        {"short", "int16"},
                                                                        {"ushort", "uint16"},
                                                                        {"int", "int32"},
                                                                        {"uint", "uint32"},
                                                                        {"float", "float32"},
                                                                        {"double", "float64"}}};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<Type>(i);
    }
    return std::nullopt;
}

// What of a view a property holds.
enum Field { x, y, z, nx, ny, nz, red, green, blue, fieldCount };
constexpr std::array<std::string_view, fieldCount> kFieldNames = {"x",  "y",   "z",     "nx",  "ny",
                                                                  "nz", "red", "green", "blue"};

struct Property {
    Type type = Type::f32;
    std::optional<Type> listCount;  // a list: type of its length
    int field = -1;                 // Field, or -1: skipped
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
    // Bytes (binary) or characters (ASCII) that one entry takes at least.
    std::uint64_t leastBytes(Format format) const {
        std::uint64_t bytes = 0;
        for (const Property& p : properties) {
            bytes += format == Format::ascii ? 2 : sizeOf(p.listCount.value_or(p.type));
        }
        return bytes;
    }
};

// ---------------------------------------------------------------- reading

class Reader {
  public:
    Reader(const std::string& name, std::string text) : name_(name), text_(std::move(text)) {}

    ViewSet read(const RootCube& root, std::vector<std::string>* warnings) {
        readHeader();
        ViewSet set;
        for (const Element& element : elements_) {
            checkSize(element);
            if (element.name == "vertex") {
                checkVertex(element);
                set = readVertices(element, root, warnings);
                return set;  // whatever follows is no view
            }
            skip(element);
        }
        fail("has no vertex element, so no views");
    }

  private:
    [[noreturn]] void fail(const std::string& why) const {
        throw Error(ExitCode::input, name_ + ": " + why);
    }
    [[noreturn]] void failAtLine(const std::string& why) const {
        fail("line " + std::to_string(line_) + ": " + why);
    }
    std::uint64_t left() const { return text_.size() - at_; }

    // The next line without its end; the file must have one.
    std::string_view nextLine(const char* expected) {
        if (left() == 0) fail(std::string("ends where ") + expected + " is expected");
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        std::string_view line(text_.data() + at_, end - at_);
        if (line.ends_with('\r')) line.remove_suffix(1);
        at_ = std::min(end + 1, text_.size());
        ++line_;
        return line;
    }

    static std::vector<std::string_view> words(std::string_view line) {
        std::vector<std::string_view> result;
        constexpr std::string_view kBlank = " \t\v\f\r";
        for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
            const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
            result.push_back(line.substr(at, end - at));
            at = line.find_first_not_of(kBlank, end);
        }
        return result;
    }
    // Text of the file as it may be shown in a message: short, and without control characters.
    static std::string shown(std::string_view text) {
        std::string result(text.substr(0, 40));
        for (char& c : result) {
            if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
        }
        return "'" + result + (text.size() > 40 ? "...'" : "'");
    }

    void readHeader() {
        if (!std::string_view(text_).starts_with("ply") || nextLine("its first line") != "ply") {
            fail("is not a PLY file: it does not begin with a line 'ply'");
        }
        bool hasFormat = false;
        for (;;) {
            const std::string_view line = nextLine("the rest of its header");
            const std::vector<std::string_view> w = words(line);
            if (w.empty() || w[0] == "comment" || w[0] == "obj_info") continue;
            if (w[0] == "end_header") break;
            if (w[0] == "format") {
                readFormat(w);
                hasFormat = true;
            } else if (w[0] == "element") {
                readElement(w);
            } else if (w[0] == "property") {
                readProperty(w);
            } else {
                failAtLine("unknown header keyword " + shown(w[0]));
            }
        }
        if (!hasFormat) fail("has no format line in its header");
    }

    void readFormat(const std::vector<std::string_view>& w) {
        if (w.size() != 3 || w[2] != "1.0") failAtLine("expected 'format <kind> 1.0'");
        if (w[1] == "ascii") {
            format_ = Format::ascii;
        } else if (w[1] == "binary_little_endian") {
            format_ = Format::littleEndian;
        } else if (w[1] == "binary_big_endian") {
            format_ = Format::bigEndian;
        } else {
            failAtLine("unknown format " + shown(w[1]));
        }
    }

    void readElement(const std::vector<std::string_view>& w) {
        Element element;
        if (w.size() != 3) failAtLine("expected 'element <name> <count>'");
        const auto [end, status] =
            std::from_chars(w[2].data(), w[2].data() + w[2].size(), element.count);
        if (status != std::errc{} || end != w[2].data() + w[2].size()) {
            failAtLine("the count of element " + shown(w[1]) + " is " + shown(w[2]));
        }
        element.name = w[1];
        for (const Element& other : elements_) {
            if (other.name == element.name) failAtLine("a second element " + shown(w[1]));
        }
        elements_.push_back(std::move(element));
    }

    void readProperty(const std::vector<std::string_view>& w) {
        if (elements_.empty()) failAtLine("a property before any element");
        const bool isList = w.size() == 5 && w[1] == "list";
        if (w.size() != 3 && !isList) failAtLine("expected 'property <type> <name>'");
        Element& element = elements_.back();
        Property property;
        const std::optional<Type> type = typeNamed(w[isList ? 3 : 1]);
        if (!type) failAtLine("unknown type " + shown(w[isList ? 3 : 1]));
        property.type = *type;
        if (isList) {
            property.listCount = typeNamed(w[2]);
            if (!property.listCount) failAtLine("unknown type " + shown(w[2]));
            if (*property.listCount == Type::f32 || *property.listCount == Type::f64) {
                failAtLine("the length of a list must be an integer");
            }
        }
        const auto field = std::find(kFieldNames.begin(), kFieldNames.end(), w.back());
        if (element.name == "vertex" && field != kFieldNames.end()) {
            property.field = static_cast<int>(field - kFieldNames.begin());
            if (isList) failAtLine("property " + shown(w.back()) + " is a list");
            for (const Property& other : element.properties) {
                if (other.field == property.field) {
                    failAtLine("a second property " + shown(w.back()));
                }
            }
        }
        element.properties.push_back(property);
    }

    // The count of an element against what is left of the file.
    void checkSize(const Element& element) const {
        const std::uint64_t least = element.leastBytes(format_);
        // The last ASCII number needs no blank after it.
        const std::uint64_t have = left() + (format_ == Format::ascii ? 1 : 0);
        if (least != 0 && element.count > have / least) {
            fail("its header says " + std::to_string(element.count) + " of element " +
                 shown(element.name) + ", but only " + std::to_string(left()) + " bytes are left");
        }
    }

    void checkVertex(const Element& element) const {
        if (element.count > kMaxViewsInFile) {
            fail("holds " + std::to_string(element.count) + " views; at most " +
                 std::to_string(kMaxViewsInFile) + " are accepted");
        }
        std::array<bool, fieldCount> has{};
        for (const Property& p : element.properties) {
            if (p.field >= 0) has[static_cast<std::size_t>(p.field)] = true;
        }
        const bool anyNormal = has[nx] || has[ny] || has[nz];
        for (std::size_t i = 0; i < fieldCount; ++i) {
            const bool needed = i < nx || i >= red || anyNormal;
            if (needed && !has[i]) {
                fail("its vertices have no property '" + std::string(kFieldNames[i]) +
                     "'; views need x y z red green blue, and VPLs nx ny nz");
            }
        }
    }

    // ------------------------------------------------------------ numbers

    double binaryNumber(Type type) {
        const std::size_t bytes = sizeOf(type);
        if (left() < bytes) fail(place_ + ": the file ends");
        std::array<char, 8> raw{};
        std::memcpy(raw.data(), text_.data() + at_, bytes);
        at_ += bytes;
        if (format_ == Format::bigEndian) {
            std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(bytes));
        }
        const auto as = [&]<typename T>(T value) {
            std::memcpy(&value, raw.data(), sizeof(T));
            return static_cast<double>(value);
        };
        switch (type) {
            case Type::i8:
                return as(std::int8_t{});
            case Type::u8:
                return as(std::uint8_t{});
            case Type::i16:
                return as(std::int16_t{});
            case Type::u16:
                return as(std::uint16_t{});
            case Type::i32:
                return as(std::int32_t{});
            case Type::u32:
                return as(std::uint32_t{});
            case Type::f32:
                return as(float{});
            case Type::f64:
                return as(double{});
        }
        return 0;
    }

    double asciiNumber(std::string_view word) const {
        std::string_view digits = word;
        if (digits.starts_with('+')) digits.remove_prefix(1);
        double value = 0;
        const auto [end, status] =
            std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (status != std::errc{} || end != digits.data() + digits.size()) {
            failAtLine(place_ + ": " + shown(word) + " is not a number");
        }
        return value;
    }

    // The values of one entry, fields alone; others are passed over.
    void readEntry(const Element& element, std::array<double, fieldCount>& values) {
        if (format_ != Format::ascii) {
            for (const Property& p : element.properties) {
                if (p.listCount) {
                    const double length = binaryNumber(*p.listCount);
                    const double bytes = length * static_cast<double>(sizeOf(p.type));
                    if (length < 0 || bytes > static_cast<double>(left())) {
                        fail(place_ + ": a list longer than the file");
                    }
                    at_ += static_cast<std::size_t>(bytes);
                } else {
                    const double value = binaryNumber(p.type);
                    if (p.field >= 0) values[static_cast<std::size_t>(p.field)] = value;
                }
            }
            return;
        }
        std::string_view line;
        do {
            line = nextLine(place_.c_str());
        } while (words(line).empty());
        const std::vector<std::string_view> w = words(line);
        std::size_t at = 0;
        const auto next = [&]() {
            if (at == w.size()) failAtLine(place_ + ": too few numbers");
            return asciiNumber(w[at++]);
        };
        for (const Property& p : element.properties) {
            if (p.listCount) {
                const double length = next();
                if (!(length >= 0 && length <= static_cast<double>(w.size() - at))) {
                    failAtLine(place_ + ": a list longer than its line");
                }
                at += static_cast<std::size_t>(length);
            } else {
                const double value = next();
                if (p.field >= 0) values[static_cast<std::size_t>(p.field)] = value;
            }
        }
        if (at != w.size()) failAtLine(place_ + ": too many numbers");
    }

    void skip(const Element& element) {
        if (element.properties.empty()) return;
        std::array<double, fieldCount> ignored{};
        for (std::uint64_t i = 0; i < element.count; ++i) {
            place_ = element.name + " " + std::to_string(i);
            readEntry(element, ignored);
        }
    }

    // ------------------------------------------------------------ views

    ViewSet readVertices(const Element& element, const RootCube& root,
                         std::vector<std::string>* warnings) {
        std::array<double, fieldCount> scale;
        scale.fill(1.0);
        for (const Property& p : element.properties) {
            if (p.field < red) continue;
            auto& s = scale[static_cast<std::size_t>(p.field)];
            if (p.type == Type::u8) s = 1.0 / 255;
            if (p.type == Type::u16) s = 1.0 / 65535;
        }
        ViewSet set;
        set.views.reserve(element.count);
        std::uint64_t clamped = 0;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            place_ = "vertex " + std::to_string(i);
            std::array<double, fieldCount> values{};
            readEntry(element, values);
            for (std::size_t k = 0; k < fieldCount; ++k) {
                values[k] *= scale[k];
                if (!std::isfinite(values[k])) {
                    fail(place_ + ": " + std::string(kFieldNames[k]) + " is not finite");
                }
            }
            View view = makeView(values, root, clamped);
            view.slot = static_cast<std::uint32_t>(i);
            set.views.push_back(view);
        }
        if (clamped != 0 && warnings) {
            warnings->push_back(name_ + ": " + std::to_string(clamped) +
                                " views lie just outside the scene's root cube and were moved "
                                "onto it");
        }
        return set;
    }

    View makeView(const std::array<double, fieldCount>& v, const RootCube& root,
                  std::uint64_t& clamped) const {
        constexpr double kTolerance = 1e-3;              // root-cube units
        constexpr double kLast = 1.0 - 1.0 / (1 << 24);  // largest float below 1
        const glm::dvec3 position = (glm::dvec3(v[x], v[y], v[z]) - root.origin) / root.edge;
        const glm::dvec3 inside = glm::clamp(position, 0.0, kLast);
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(position[axis] - inside[axis]) <= kTolerance) continue;
            const double low = root.origin[axis], high = low + root.edge;
            fail(place_ + " lies outside the scene's root cube: " +
                 std::string(kFieldNames[static_cast<std::size_t>(axis)]) + " = " +
                 std::to_string(v[static_cast<std::size_t>(axis)]) + " is not within " +
                 std::to_string(low) + " .. " + std::to_string(high) +
                 "; do the views belong to another scene?");
        }
        clamped += position != inside;

        View view{};
        view.positionX = static_cast<float>(inside.x);
        view.positionY = static_cast<float>(inside.y);
        view.positionZ = static_cast<float>(inside.z);
        const double length = std::hypot(v[nx], v[ny], v[nz]);
        view.flags = kViewOmnidirectional;
        if (length > 0) {
            view.flags = kViewHemisphere;
            view.bounce = 1;
            view.normalX = static_cast<float>(v[nx] / length);
            view.normalY = static_cast<float>(v[ny] / length);
            view.normalZ = static_cast<float>(v[nz] / length);
        }
        std::array<float, 3> flux{};
        for (std::size_t k = 0; k < 3; ++k) {
            flux[k] = static_cast<float>(v[red + k]);
            if (!(flux[k] >= 0) || !std::isfinite(flux[k])) {
                fail(place_ + ": " + std::string(kFieldNames[red + k]) + " = " +
                     std::to_string(v[red + k]) + " is not a flux");
            }
        }
        view.fluxR = flux[0];
        view.fluxG = flux[1];
        view.fluxB = flux[2];
        return view;
    }

    const std::string& name_;
    std::string text_;
    std::size_t at_ = 0;
    std::uint64_t line_ = 0;
    Format format_ = Format::ascii;
    std::vector<Element> elements_;
    std::string place_;  // "vertex 17": where reading stands
};

std::string readWhole(const std::filesystem::path& file) {
    const auto bad = [&](const std::string& why) {
        return Error(ExitCode::input, file.string() + ": " + why);
    };
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) throw bad("there is no such file");
    if (!std::filesystem::is_regular_file(status)) throw bad("is not a regular file");
    const std::uint64_t bytes = std::filesystem::file_size(file, error);
    if (error) throw bad("cannot be read: " + error.message());
    if (bytes > (8ull << 30)) throw bad("is larger than 8 GiB");
    std::ifstream in(file, std::ios::binary);
    std::string text(bytes, '\0');
    in.read(text.data(), static_cast<std::streamsize>(bytes));
    if (!in) throw bad("cannot be read");
    return text;
}

}  // namespace

ViewSet loadViews(const std::filesystem::path& file, const RootCube& root,
                  std::vector<std::string>* warnings) {
    return parseViews(readWhole(file), file.string(), root, warnings);
}

ViewSet parseViews(std::string bytes, const std::string& name, const RootCube& root,
                   std::vector<std::string>* warnings) {
    return Reader(name, std::move(bytes)).read(root, warnings);
}

void saveViews(const std::filesystem::path& file, const ViewSet& views, const RootCube& root) {
    const bool normals = std::any_of(views.views.begin(), views.views.end(),
                                     [](const View& v) { return v.flags == kViewHemisphere; });
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    header += "comment MegaViews views: positions in world units, flux in linear RGB watts\n";
    header += "comment no normal or a zero one: omnidirectional\n";
    header += "element vertex " + std::to_string(views.alive()) + "\n";
    header += "property double x\nproperty double y\nproperty double z\n";
    if (normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
    header += "property float red\nproperty float green\nproperty float blue\nend_header\n";

    OutputFile out(file);
    out.write(header);
    for (const View& v : views.views) {
        if (v.flags == kViewDead) continue;
        const glm::dvec3 p = root.worldFromRoot({v.positionX, v.positionY, v.positionZ});
        const std::array<double, 3> position = {p.x, p.y, p.z};
        const std::array<float, 3> normal = {v.normalX, v.normalY, v.normalZ};
        const std::array<float, 3> flux = {v.fluxR, v.fluxG, v.fluxB};
        out.writeBytes(position.data(), sizeof position);
        if (normals) out.writeBytes(normal.data(), sizeof normal);
        out.writeBytes(flux.data(), sizeof flux);
    }
    out.commit();
}

}  // namespace mv
