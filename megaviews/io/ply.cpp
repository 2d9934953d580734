#include "megaviews/io/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "megaviews/core/error.h"
#include "megaviews/core/hash.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/output_file.h"
#include "megaviews/core/text.h"

namespace mv {

namespace {

static_assert(std::endian::native == std::endian::little,
              "files are written as they lie in memory");

// What of a view a property holds.
enum Field { x, y, z, nx, ny, nz, red, green, blue, fieldCount };
constexpr std::array<std::string_view, fieldCount> kFieldNames = {"x",  "y",   "z",     "nx",  "ny",
                                                                  "nz", "red", "green", "blue"};
using Values = std::array<double, fieldCount>;

struct Property {
    std::size_t bytes = 4;   // 1: uchar, 4: float, 8: double
    int field = fieldCount;  // Field; fieldCount: skipped
};

class Reader {
  public:
    Reader(const std::string& name, std::string text) : name_(name), text_(std::move(text)) {}

    ViewSet read(const RootCube& root, std::vector<std::string>* warnings) {
        readHeader();
        checkHeader();
        return readVertices(root, warnings);
    }

  private:
    [[noreturn]] void fail(const std::string& why) const {
        throw Error(ExitCode::input, name_ + ": " + why);
    }
    [[noreturn]] void failAtLine(const std::string& why) const {
        fail("line " + std::to_string(line_) + ": " + why);
    }
    std::uint64_t left() const { return text_.size() - at_; }

    // The words of the next line; the file must have one.
    std::vector<std::string_view> nextLine(const std::string& expected) {
        if (left() == 0) fail("ends where " + expected + " is expected");
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        const std::string_view line(text_.data() + at_, end - at_);
        at_ = std::min(end + 1, text_.size());
        ++line_;
        std::vector<std::string_view> words;
        constexpr std::string_view kBlank = " \t\v\f\r";
        for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
            const std::size_t wordEnd = std::min(line.find_first_of(kBlank, at), line.size());
            words.push_back(line.substr(at, wordEnd - at));
            at = line.find_first_not_of(kBlank, wordEnd);
        }
        return words;
    }
    // Text of the file as it may be shown in a message: short, and without control characters.
    static std::string shown(std::string_view text) { return "'" + printable(text, 40) + "'"; }

    template <typename Number>
    bool parse(std::string_view word, Number& value) const {
        const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
        return status == std::errc{} && end == word.data() + word.size();
    }

    void readHeader() {
        using Words = std::vector<std::string_view>;
        if (!text_.starts_with("ply") || nextLine("its first line") != Words{"ply"}) {
            fail("is not a PLY file: it does not begin with a line 'ply'");
        }
        int elements = 0;
        bool hasFormat = false;
        for (;;) {
            const Words w = nextLine("the rest of its header");
            if (w.empty() || w[0] == "comment" || w[0] == "obj_info") continue;
            if (w[0] == "end_header") break;
            if (w[0] == "format") {
                if (w.size() != 3 || w[2] != "1.0") failAtLine("expected 'format <kind> 1.0'");
                ascii_ = w[1] == "ascii";
                if (!ascii_ && w[1] != "binary_little_endian") {
                    failAtLine("unknown format " + shown(w[1]) +
                               "; ascii and binary_little_endian are read");
                }
                hasFormat = true;
            } else if (w[0] == "element") {
                if (w.size() != 3) failAtLine("expected 'element <name> <count>'");
                if (++elements > 1) continue;  // whatever follows is no view
                if (w[1] != "vertex") failAtLine("the first element must be vertex");
                if (!parse(w[2], count_)) failAtLine("the count of vertices is " + shown(w[2]));
            } else if (w[0] == "property") {
                if (elements == 0) failAtLine("a property before any element");
                if (elements == 1) readProperty(w);
            } else {
                failAtLine("unknown header keyword " + shown(w[0]));
            }
        }
        if (!hasFormat) fail("has no format line in its header");
        if (elements == 0) fail("has no vertex element, so no views");
    }

    void readProperty(const std::vector<std::string_view>& w) {
        if (w.size() != 3) failAtLine("expected 'property <type> <name>'");
        Property property;
        const std::string_view type = w[1];
        property.bytes = type == "uchar" || type == "uint8"      ? 1
                         : type == "float" || type == "float32"  ? 4
                         : type == "double" || type == "float64" ? 8
                                                                 : 0;
        if (property.bytes == 0) {
            failAtLine("unknown type " + shown(type) + "; float, double and uchar are read");
        }
        const auto field = std::find(kFieldNames.begin(), kFieldNames.end(), w[2]);
        property.field = static_cast<int>(field - kFieldNames.begin());
        if (property.field < fieldCount && has(property.field)) {
            failAtLine("a second property " + shown(w[2]));
        }
        properties_.push_back(property);
    }

    bool has(int field) const {
        return std::any_of(properties_.begin(), properties_.end(),
                           [&](const Property& p) { return p.field == field; });
    }

    // All properties that views need, and a count that the rest of the file bears out.
    void checkHeader() const {
        const bool anyNormal = has(nx) || has(ny) || has(nz);
        for (int i = 0; i < fieldCount; ++i) {
            if ((i < nx || i >= red || anyNormal) && !has(i)) {
                fail("its vertices have no property '" +
                     std::string(kFieldNames[static_cast<std::size_t>(i)]) +
                     "'; views need x y z red green blue, and VPLs nx ny nz");
            }
        }
        if (count_ > kMaxViewsInFile) {
            fail("holds " + std::to_string(count_) + " views; at most " +
                 std::to_string(kMaxViewsInFile) + " are accepted");
        }
        // A digit and a blank; the last number needs no blank after it.
        std::uint64_t least = ascii_ ? 2 * properties_.size() : 0;
        for (const Property& p : properties_) least += ascii_ ? 0 : p.bytes;
        if (count_ * least > left() + (ascii_ ? 1 : 0)) {
            fail("its header says " + std::to_string(count_) + " vertices, but only " +
                 std::to_string(left()) + " bytes are left");
        }
    }

    // ------------------------------------------------------------ numbers

    template <typename T>
    double binaryNumber() {
        T value;
        std::memcpy(&value, text_.data() + at_, sizeof value);  // checkHeader: it is there
        at_ += sizeof value;
        return static_cast<double>(value);
    }

    Values readVertex() {
        Values values{};
        std::array<double, fieldCount + 1> all{};  // the last: skipped
        std::vector<std::string_view> words;
        while (ascii_ && words.empty()) words = nextLine(place_);
        if (ascii_ && words.size() != properties_.size()) {
            failAtLine(place_ + ": " + std::to_string(words.size()) + " numbers, but " +
                       std::to_string(properties_.size()) + " properties");
        }
        for (std::size_t i = 0; i < properties_.size(); ++i) {
            const Property& p = properties_[i];
            double& value = all[static_cast<std::size_t>(p.field)];
            if (ascii_) {
                std::string_view digits = words[i];
                if (digits.starts_with('+')) digits.remove_prefix(1);
                if (!parse(digits, value)) {
                    failAtLine(place_ + ": " + shown(words[i]) + " is not a number");
                }
            } else {
                value = p.bytes == 1   ? binaryNumber<std::uint8_t>()
                        : p.bytes == 4 ? binaryNumber<float>()
                                       : binaryNumber<double>();
            }
            if (p.bytes == 1 && p.field >= red) value /= 255;
        }
        std::copy_n(all.begin(), values.size(), values.begin());
        for (std::size_t k = 0; k < fieldCount; ++k) {
            if (!std::isfinite(values[k])) {
                fail(place_ + ": " + std::string(kFieldNames[k]) + " is not finite");
            }
        }
        return values;
    }

    // ------------------------------------------------------------ views

    ViewSet readVertices(const RootCube& root, std::vector<std::string>* warnings) {
        ViewSet set;
        set.views.reserve(count_);
        std::uint64_t clamped = 0;
        for (std::uint64_t i = 0; i < count_; ++i) {
            place_ = "vertex " + std::to_string(i);
            View view = makeView(readVertex(), root, clamped);
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

    View makeView(const Values& v, const RootCube& root, std::uint64_t& clamped) const {
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
    bool ascii_ = true;
    std::uint64_t count_ = 0;
    std::vector<Property> properties_;
    std::string place_;  // "vertex 17": where reading stands
};

}  // namespace

ViewSet loadViews(const std::filesystem::path& file, const RootCube& root,
                  std::vector<std::string>* warnings) {
    Resource resource = readRegularFile(file);
    if (!resource.ok()) throw Error(ExitCode::input, file.string() + ": " + resource.error);
    ViewSet views =
        parseViews({resource.bytes.begin(), resource.bytes.end()}, file.string(), root, warnings);
    views.fileHash = Hash().add(std::as_bytes(std::span(resource.bytes))).hex();
    return views;
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
        const glm::dvec3 p = root.worldFromRoot(viewPosition(v));
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
