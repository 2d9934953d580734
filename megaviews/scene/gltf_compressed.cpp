#include "megaviews/scene/gltf_compressed.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include "megaviews/scene/gltf_check.h"
#include "megaviews/scene/gltf_draco.h"
#include "megaviews/scene/gltf_fields.h"
#include "megaviews/scene/gltf_meshopt.h"

namespace mv {

namespace {

using Json = nlohmann::json;

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

std::uint64_t numberAt(const Json& object, const char* key) {
    return object.value(key, std::uint64_t{0});
}

const Json* findExtension(const Json& object, const char* name) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end()) return nullptr;
    const auto extension = extensions->find(name);
    return extension == extensions->end() ? nullptr : &*extension;
}

// Components of a SCALAR or vector; nothing for a matrix.
std::optional<std::size_t> componentsOf(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (!type.starts_with("VEC")) return std::nullopt;
    return static_cast<std::size_t>(type.back() - '0');
}

class Unpacker {
  public:
    Unpacker(Json& json, GltfFile& file, GltfReport& report, const Progress& progress)
        : json_(json), file_(file), report_(report), progress_(progress) {
        for (const auto& buffer : file.buffers) packedBytes_ += buffer.size();
    }

    void run() {
        unpackViews();
        collectPrimitives();
        unpackPrimitives();
    }

  private:
    // A buffer view that meshoptimizer unpacks.
    struct View {
        std::size_t index = 0;
        std::string place;
        MeshoptView view;
        std::span<const std::uint8_t> packed;
        std::vector<std::uint8_t> bytes;
        std::string error;
    };
    // A buffer view that is a Draco stream, with all that primitives want of it.
    struct Stream {
        std::string place;  // of the first primitive that names it
        std::span<const std::uint8_t> packed;
        DracoRequest request;
        std::vector<std::size_t> accessors;       // one for each attribute of the request
        std::vector<std::size_t> indexAccessors;  // that its triangles go to
        std::uint64_t statedTriangles = 0;        // 0: the document does not say
        DracoMesh mesh;
    };

    // Throws where all that is unpacked passes the limits.
    void allow(const std::string& place, std::uint64_t bytes) {
        unpackedBytes_ += bytes;  // no overflow: each is below 2^40, and the first beyond ends it
        if (unpackedBytes_ <= mostBytes()) return;
        report_.fail(place, "with it the packed data of the file expand to " +
                                std::to_string(unpackedBytes_ >> 20) + " MiB, from buffers of " +
                                std::to_string(packedBytes_) + " bytes: more than is supported");
    }
    std::uint64_t mostBytes() const {
        return std::min(kMostUnpacked, kUnpackedForFree + kUnpackedPerByte * packedBytes_);
    }

    std::span<const std::uint8_t> bytesOf(std::size_t buffer, std::uint64_t offset,
                                          std::uint64_t length) const {
        return std::span<const std::uint8_t>(file_.buffers[buffer]).subspan(offset, length);
    }

    std::size_t addBuffer(std::vector<std::uint8_t> bytes) {
        file_.buffers.push_back(std::move(bytes));
        return file_.buffers.size() - 1;
    }

    template <typename Jobs, typename Run>
    void inParallel(Jobs& jobs, const Run& run) {
        if (jobs.empty()) return;
        std::atomic<std::size_t> done{0};
        tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
            run(jobs[i]);
            const std::size_t count = ++done;
            if (count % (jobs.size() / 20 + 1) == 0) {
                report(progress_, "unpack meshes",
                       static_cast<float>(count) / static_cast<float>(jobs.size()));
            }
        });
    }

    void unpackViews();
    void collectPrimitives();
    void collectPrimitive(Json& primitive, const std::string& place);
    void unpackPrimitives();
    Json& accessorAt(const Json& index) { return json_["accessors"][index.get<std::size_t>()]; }
    bool claim(Json& index, std::size_t stream, std::int64_t attribute);

    Json& json_;
    GltfFile& file_;
    GltfReport& report_;
    const Progress& progress_;
    std::uint64_t packedBytes_ = 0, unpackedBytes_ = 0;
    std::vector<Stream> streams_;
    std::map<std::size_t, std::size_t> streamOfView_;
    // For an accessor of the document, a stream and an attribute of it, or -1 for its indices: the
    // accessor that is filled with that. It is the document's own for the first that claims it.
    std::map<std::tuple<std::size_t, std::size_t, std::int64_t>, std::size_t> filled_;
    std::set<std::size_t> claimed_;
};

void Unpacker::unpackViews() {
    std::vector<View> views;
    Json& all = json_["bufferViews"];
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Json* extension = findExtension(all[i], kMeshopt);
        if (!extension) continue;
        View view;
        view.index = i;
        view.place = element("bufferViews", i) + ".extensions." + kMeshopt;
        view.view = {(*extension)["mode"], extension->value("filter", "NONE"),
                     numberAt(*extension, "count"), numberAt(*extension, "byteStride")};
        const std::uint64_t length = numberAt(*extension, "byteLength");
        const std::string error = meshoptViewError(view.view, length);
        if (!error.empty()) report_.fail(view.place, error);
        const std::uint64_t bytes = view.view.count * view.view.byteStride;
        if (bytes != numberAt(all[i], "byteLength")) {
            report_.fail(view.place, "its elements take " + std::to_string(bytes) + " bytes, " +
                                         element("bufferViews", i) + " has " +
                                         std::to_string(numberAt(all[i], "byteLength")));
        }
        allow(view.place, bytes);
        view.packed = bytesOf((*extension)["buffer"].get<std::size_t>(),
                              numberAt(*extension, "byteOffset"), length);
        views.push_back(std::move(view));
    }
    inParallel(views, [](View& view) {
        view.bytes.resize(view.view.count * view.view.byteStride);
        view.error = decodeMeshopt(view.view, view.packed, view.bytes);
    });
    for (View& view : views) {
        if (!view.error.empty()) report_.fail(view.place, view.error);
        all[view.index]["buffer"] = addBuffer(std::move(view.bytes));
        all[view.index]["byteOffset"] = 0;
    }
    for (Json& view : all) view.erase("extensions");
}

void Unpacker::collectPrimitives() {
    for (std::size_t m = 0; m < json_["meshes"].size(); ++m) {
        Json& primitives = json_["meshes"][m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            collectPrimitive(primitives[p], element(element("meshes", m) + ".primitives", p));
            if (findExtension(primitives[p], kDraco)) primitives[p]["extensions"].erase(kDraco);
        }
    }
}

void Unpacker::collectPrimitive(Json& primitive, const std::string& place) {
    constexpr int kTriangles = 4, kStrip = 5;
    const Json* extension = findExtension(primitive, kDraco);
    const int mode = primitive.value("mode", kTriangles);
    Json& attributes = primitive["attributes"];
    if (!extension || mode < kTriangles || !attributes.contains("POSITION")) return;  // not drawn
    const std::string inside = place + ".extensions." + kDraco;
    if (mode > kStrip) report_.fail(inside, "the extension has no triangle fans");
    if (!primitive.contains("indices")) {
        report_.fail(place + ".indices", "it is missing, which " + std::string(kDraco) + " needs");
    }
    // A file may hold the same unpacked, for programs that do not know the extension.
    const Json& packed = (*extension)["attributes"];
    bool unpacked = accessorAt(primitive["indices"]).contains("bufferView");
    for (const auto& entry : packed.items()) {
        if (!attributes.contains(entry.key())) continue;
        unpacked = unpacked && accessorAt(attributes[entry.key()]).contains("bufferView");
    }
    if (unpacked) return;

    const auto view = (*extension)["bufferView"].get<std::size_t>();
    const auto [known, isNew] = streamOfView_.try_emplace(view, streams_.size());
    if (isNew) {
        const Json& in = json_["bufferViews"][view];
        Stream& stream = streams_.emplace_back();
        stream.place = inside;
        stream.packed = bytesOf(in["buffer"].get<std::size_t>(), numberAt(in, "byteOffset"),
                                numberAt(in, "byteLength"));
        stream.request.vertices = numberAt(accessorAt(attributes["POSITION"]), "count");
        const std::uint64_t indices = numberAt(accessorAt(primitive["indices"]), "count");
        stream.request.mostTriangles = mode == kStrip ? indices : indices / 3;
        stream.statedTriangles = mode == kStrip ? 0 : indices / 3;
        allow(inside, 3 * sizeof(std::uint32_t) * stream.request.mostTriangles);
    }
    Stream& stream = streams_[known->second];
    if (numberAt(accessorAt(attributes["POSITION"]), "count") != stream.request.vertices) {
        report_.fail(inside, "other primitives that name " + element("bufferViews", view) +
                                 " have " + std::to_string(stream.request.vertices) + " vertices");
    }
    primitive["mode"] = kTriangles;  // whatever it was: a stream holds separate triangles
    if (claim(primitive["indices"], known->second, -1)) {
        stream.indexAccessors.push_back(primitive["indices"].get<std::size_t>());
    }
    for (const auto& entry : packed.items()) {
        const auto attribute = attributes.find(entry.key());
        if (attribute == attributes.end()) continue;
        Json& accessor = accessorAt(*attribute);
        const std::string type = accessor["type"];
        const auto components = componentsOf(type);
        if (!attributeTypes(entry.key()) || !components) {
            // Never read: it need not stand for zeros either.
            if (!accessor.contains("bufferView")) accessor["count"] = 1;
            continue;
        }
        if (numberAt(accessor, "count") != stream.request.vertices) {
            report_.fail(place + ".attributes." + printable(entry.key()),
                         "it has " + std::to_string(numberAt(accessor, "count")) +
                             " elements, POSITION has " + std::to_string(stream.request.vertices));
        }
        const auto componentType = accessor["componentType"].get<int>();
        const auto id = entry.value().get<std::uint32_t>();
        if (!claim(*attribute, known->second, id)) continue;
        allow(inside, stream.request.vertices * accessorElementBytes(componentType, type));
        stream.accessors.push_back(attribute->get<std::size_t>());
        stream.request.attributes.push_back({id, componentType, *components});
    }
}

// `index` names the accessor that is filled from that source afterwards: the same as before or, if
// another source has claimed it, a copy. Returns whether it is the first to name it.
bool Unpacker::claim(Json& index, std::size_t stream, std::int64_t attribute) {
    const auto accessor = index.get<std::size_t>();
    const auto [known, isNew] = filled_.try_emplace({accessor, stream, attribute}, accessor);
    if (isNew && !claimed_.insert(accessor).second) {
        known->second = json_["accessors"].size();
        json_["accessors"].push_back(Json(json_["accessors"][accessor]));
    }
    index = known->second;
    return isNew;
}

void Unpacker::unpackPrimitives() {
    for (Stream& stream : streams_) stream.request.mostBytes = mostBytes();
    inParallel(streams_,
               [](Stream& stream) { stream.mesh = decodeDraco(stream.packed, stream.request); });
    for (std::size_t s = 0; s < streams_.size(); ++s) {
        Stream& stream = streams_[s];
        if (!stream.mesh.error.empty()) report_.fail(stream.place, stream.mesh.error);
        // One buffer for the stream, a buffer view for each accessor that it fills.
        std::vector<std::uint8_t> bytes;
        const auto append = [&](std::span<const std::uint8_t> part) {
            json_["bufferViews"].push_back({{"buffer", file_.buffers.size()},
                                            {"byteOffset", bytes.size()},
                                            {"byteLength", part.size()}});
            bytes.insert(bytes.end(), part.begin(), part.end());
            bytes.resize((bytes.size() + 3) / 4 * 4);
            return json_["bufferViews"].size() - 1;
        };
        const auto& indices = stream.mesh.indices;
        const std::size_t indexView =
            append({reinterpret_cast<const std::uint8_t*>(indices.data()), 4 * indices.size()});
        for (const std::size_t accessor : stream.indexAccessors) {
            constexpr int kUnsignedInt = 5125;
            json_["accessors"][accessor] = {{"bufferView", indexView},
                                            {"componentType", kUnsignedInt},
                                            {"type", "SCALAR"},
                                            {"count", indices.size()}};
        }
        if (indices.size() / 3 < stream.statedTriangles) {
            report_.warn(stream.place, "its stream holds " + std::to_string(indices.size() / 3) +
                                           " triangles, its accessors announce " +
                                           std::to_string(stream.statedTriangles));
        }
        // Khronos' exporter for Blender has written such (v0.9).
        if (stream.mesh.vertices > stream.request.vertices) {
            report_.warn(stream.place, "its stream holds " + std::to_string(stream.mesh.vertices) +
                                           " vertices, its accessors announce " +
                                           std::to_string(stream.request.vertices));
        }
        for (std::size_t i = 0; i < stream.accessors.size(); ++i) {
            Json& out = json_["accessors"][stream.accessors[i]];
            out["bufferView"] = append(stream.mesh.attributes[i]);
            out.erase("byteOffset");
            out["count"] = stream.mesh.vertices;
            if (const float step = stream.mesh.steps[i]; step > 0) {
                out["extras"] = {{"megaviews", {{"positionStep", step}}}};
            }
            stream.mesh.attributes[i] = {};
        }
        stream.mesh.indices = {};
        addBuffer(std::move(bytes));
    }
}

}  // namespace

void unpackCompressed(Json& json, GltfFile& file, GltfReport& report, const Progress& progress) {
    Unpacker(json, file, report, progress).run();
}

}  // namespace mv
