#!/usr/bin/env python3
"""Makes the models of this folder: what the Khronos collection shows of materials, in small.

Each file has a camera and no light, so a sky and a sun are placed. Run in this folder.
"""
import json
import math
import struct
import zlib


class Shapes:
    """Meshes in one binary file that all models share."""

    def __init__(self):
        self.bytes = b""
        self.views, self.accessors, self.meshes = [], [], {}

    def array(self, rows, code, component, target):
        flat = [x for row in rows for x in row]
        data = struct.pack(f"<{len(flat)}{code}", *flat)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        if target:
            self.views[-1]["target"] = target
        self.bytes += data + b"\0" * (-len(data) % 4)
        width = len(rows[0])
        accessor = {"bufferView": len(self.views) - 1, "componentType": component,
                    "count": len(rows), "type": ["SCALAR", "", "VEC3", "VEC4"][width - 1]
                    if width != 2 else "VEC2"}
        if width == 3:
            accessor["min"] = [min(r[i] for r in rows) for i in range(3)]
            accessor["max"] = [max(r[i] for r in rows) for i in range(3)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def mesh(self, name, positions, normals, uvs, indices):
        self.meshes[name] = {
            "attributes": {"POSITION": self.array(positions, "f", 5126, 34962),
                           "NORMAL": self.array(normals, "f", 5126, 34962),
                           "TEXCOORD_0": self.array(uvs, "f", 5126, 34962)},
            "indices": self.array([[i] for i in indices], "H", 5123, 34963)}

    def grid(self, name, across, down, at):
        """at(u, v) -> position, normal, uv; counter-clockwise where u goes right and v up."""
        points = [at(i / across, j / down) for j in range(down + 1) for i in range(across + 1)]
        triangles = []
        for j in range(down):
            for i in range(across):
                a = j * (across + 1) + i
                b = a + across + 1
                triangles += [[a, a + 1, b + 1], [a, b + 1, b]]
        corners = [tuple(round(x, 6) for x in p[0]) for p in points]
        indices = [i for t in triangles if len({corners[k] for k in t}) == 3 for i in t]
        self.mesh(name, *([p[k] for p in points] for k in range(3)), indices)


def on_sphere(u, v):
    phi, theta = 2 * math.pi * u, math.pi * (1 - v)
    n = [math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi)]
    return [0.45 * x for x in n], n, [u, 1 - v]


def on_floor(u, v):
    return [20 * (u - 0.5), 0, 20 * (0.5 - v)], [0, 1, 0], [20 * u, 20 * (1 - v)]


def dome(x, y):
    """Height and slope of a dome in the middle of a unit square, level at its top and its rim."""
    r, radius, height = math.hypot(x, y), 0.4, 0.2
    if r >= radius:
        return 0, 0, 0
    slope = -height / 2 * math.pi / radius * math.sin(math.pi * r / radius) / max(r, 1e-9)
    return height / 2 * (1 + math.cos(math.pi * r / radius)), slope * x, slope * y


def normal_of(x, y):
    _, dx, dy = dome(x, y)
    length = math.sqrt(dx * dx + dy * dy + 1)
    return [-dx / length, -dy / length, 1 / length]


def on_dome(u, v):
    x, y = u - 0.5, v - 0.5
    return [0.9 * x, 0.9 * y, 0.9 * dome(x, y)[0]], normal_of(x, y), [u, 1 - v]


def flat(turn):
    """A unit square towards +z whose texture coordinates are turned."""
    return lambda u, v: ([0.9 * (u - 0.5), 0.9 * (v - 0.5), 0], [0, 0, 1], turn(u, 1 - v))


def png(name, size, pixel):
    rows = b"".join(b"\0" + bytes(c for x in range(size) for c in pixel(x, y)) for y in range(size))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    with open(name, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0))
                  + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def coded(normal):
    return [round(255 * (0.5 + 0.5 * c)) for c in normal]


shapes = Shapes()
shapes.grid("sphere", 40, 20, on_sphere)
shapes.grid("floor", 1, 1, on_floor)
shapes.grid("dome", 40, 40, on_dome)
shapes.grid("flat", 1, 1, flat(lambda u, v: [u, v]))
shapes.grid("flat, mirrored", 1, 1, flat(lambda u, v: [1 - u, v]))
shapes.grid("flat, turned", 1, 1, flat(lambda u, v: [v, 1 - u]))
shapes.array([[x, y, 0] for y in range(4) for x in range(-3, 4)], "f", 5126, None)
GRID = len(shapes.accessors) - 1
shapes.array([[0, math.sin(t), 0, math.cos(t)] for t in (0.02 * i for i in range(28))], "f", 5126, None)
shapes.array([[1 - 0.025 * i] * 3 for i in range(28)], "f", 5126, None)
TIMES = shapes.array([[float(t)] for t in range(5)], "f", 5126, None)
shapes.accessors[TIMES].update({"min": [0.0], "max": [4.0]})
TURNS = shapes.array([[0, 0, math.sin(math.pi * t / 4), math.cos(math.pi * t / 4)] for t in range(5)],
                     "f", 5126, None)
SLIDES = shapes.array([[t % 2, 0, 0] for t in range(5)], "f", 5126, None)
with open("shapes.bin", "wb") as binary:
    binary.write(shapes.bytes)

# The dome's normals as a map, for squares whose texture lies as the file's, mirrored, and turned.
SIZE = 128
SQUARES = {"dome.png": lambda n: n, "dome-mirrored.png": lambda n: [-n[0], n[1], n[2]],
           "dome-turned.png": lambda n: [-n[1], n[0], n[2]]}
AT = {"dome.png": lambda s, t: (s, t), "dome-mirrored.png": lambda s, t: (1 - s, t),
      "dome-turned.png": lambda s, t: (1 - t, s)}
for file, in_texture in SQUARES.items():
    def pixel(x, y, file=file, in_texture=in_texture):
        u, v = AT[file]((x + 0.5) / SIZE, (y + 0.5) / SIZE)  # of the square, v downwards
        return coded(in_texture(normal_of(u - 0.5, 0.5 - v)))
    png(file, SIZE, pixel)
png("checks.png", 64, lambda x, y: [200, 200, 205] if (x // 32 + y // 32) % 2 else [60, 62, 66])


class Model:
    def __init__(self, about, columns, rows, floor=True):
        self.gltf = {"asset": {"version": "2.0", "generator": "assets/materials/make.py",
                               "copyright": "CC0 1.0: the MegaViews authors", "extras": {"about": about}},
                     "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                     "materials": [], "buffers": [{"uri": "shapes.bin", "byteLength": len(shapes.bytes)}],
                     "bufferViews": shapes.views, "accessors": shapes.accessors}
        self.extensions = set()
        height = (rows - 1) / 2
        distance = 1.45 * max(columns / 1.5, rows) + 0.7
        self.gltf["cameras"] = [{"type": "perspective",
                                 "perspective": {"yfov": 0.7, "znear": 0.1, "aspectRatio": 1.5}}]
        self.node({"camera": 0, "translation": [0, height + math.tan(0.12) * distance, distance],
                   "rotation": [-math.sin(0.06), 0, 0, math.cos(0.06)]})
        if floor:
            self.texture("checks.png")
            self.put("floor", self.material({"baseColorTexture": {"index": 0}, "metallicFactor": 0,
                                             "roughnessFactor": 0.9}), [0, -0.5, 0])
            self.gltf["meshes"][-1]["primitives"][0]["attributes"] = dict(
                shapes.meshes["floor"]["attributes"])

    def node(self, node):
        self.gltf["nodes"].append(node)
        self.gltf["scenes"][0]["nodes"].append(len(self.gltf["nodes"]) - 1)

    def texture(self, file):
        self.gltf.setdefault("images", []).append({"uri": file})
        self.gltf.setdefault("textures", []).append({"source": len(self.gltf["images"]) - 1})
        return len(self.gltf["textures"]) - 1

    def material(self, metallic_roughness, extensions=None, **more):
        material = {"pbrMetallicRoughness": metallic_roughness, **more}
        if extensions:
            material["extensions"] = extensions
            self.extensions |= set(extensions)
        self.gltf["materials"].append(material)
        return len(self.gltf["materials"]) - 1

    def put(self, shape, material, at, extensions=None, of_mesh=None):
        self.gltf["meshes"].append({"primitives": [{**shapes.meshes[shape], "material": material}]})
        if of_mesh:
            self.gltf["meshes"][-1]["primitives"][0]["extensions"] = of_mesh
        node = {"mesh": len(self.gltf["meshes"]) - 1, "translation": at}
        if extensions:
            node["extensions"] = extensions
        self.node(node)

    def row(self, y, materials):
        for i, material in enumerate(materials):
            self.put("sphere", material, [i - (len(materials) - 1) / 2, y, 0])

    def write(self, name, required=()):
        if self.extensions:
            self.gltf["extensionsUsed"] = sorted(self.extensions)
        if required:
            self.gltf["extensionsRequired"] = list(required)
        with open(name + ".gltf", "w") as out:
            json.dump(self.gltf, out, indent=1)
            out.write("\n")


def surface(colour, metallic=0, roughness=0.5):
    return {"baseColorFactor": [*colour, 1], "metallicFactor": metallic, "roughnessFactor": roughness}


GOLD, RED, BLACK, WHITE = [1, 0.77, 0.34], [0.6, 0.05, 0.03], [0.02, 0.02, 0.02], [1, 1, 1]

m = Model("Roughness 0 to 1 from left to right; metallic 0, 0.5, 1 from the bottom up.", 5, 3)
for row, metallic in enumerate((0, 0.5, 1)):
    m.row(row, [m.material(surface(GOLD, metallic, r)) for r in (0, 0.25, 0.5, 0.75, 1)])
m.write("metal-rough")

m = Model("Domes, and squares that seem to be: texture as it is, mirrored, turned by 90 degrees.", 3, 2, False)
matt = m.material(surface([0.5, 0.5, 0.55], 0, 0.4))
for i, (shape, file) in enumerate((("flat", "dome.png"), ("flat, mirrored", "dome-mirrored.png"),
                                   ("flat, turned", "dome-turned.png"))):
    m.put("dome", matt, [i - 1, 1, 0])
    mapped = m.material(surface([0.5, 0.5, 0.55], 0, 0.4), normalTexture={"index": m.texture(file)})
    m.put(shape, mapped, [i - 1, 0, 0])
m.write("normal-map")

m = Model("A rough red ball below a coat of 0, 0.25, 0.5, 1; the coat smooth below and rough above.", 4, 2)
for row, rough in enumerate((0, 0.4)):
    m.row(row, [m.material(surface(RED, 0, 0.8), {"KHR_materials_clearcoat": {
        "clearcoatFactor": c, "clearcoatRoughnessFactor": rough}}) for c in (0, 0.25, 0.5, 1)])
m.write("clear-coat")

m = Model("Index of refraction 1, 1.33, 1.5, 1.8, 2.4: black balls below, balls of glass above.", 5, 2)
INDICES = (1, 1.33, 1.5, 1.8, 2.4)
m.row(0, [m.material(surface(BLACK, 0, 0), {"KHR_materials_ior": {"ior": n}}) for n in INDICES])
m.row(1, [m.material(surface(WHITE, 0, 0), {
    "KHR_materials_ior": {"ior": n}, "KHR_materials_transmission": {"transmissionFactor": 1},
    "KHR_materials_volume": {"thicknessFactor": 0.9}}) for n in INDICES])
m.write("index-of-refraction")

m = Model("Black balls with a specular factor of 0, 0.25, 0.5, 1 below; above, of colour white, red, "
          "green, blue.", 4, 2)
m.row(0, [m.material(surface(BLACK, 0, 0.1), {"KHR_materials_specular": {"specularFactor": s}})
          for s in (0, 0.25, 0.5, 1)])
m.row(1, [m.material(surface(BLACK, 0, 0.1), {
    "KHR_materials_specular": {"specularColorFactor": c}, "KHR_materials_ior": {"ior": 1.8}})
    for c in ([1, 1, 1], [1, 0.05, 0.05], [0.05, 1, 0.05], [0.05, 0.05, 1])])
m.write("specular")

m = Model("A ball that is matt, of gold, or lacquered: three variants.", 1, 1)
matt, gold = m.material(surface([0.1, 0.3, 0.6], 0, 0.9)), m.material(surface(GOLD, 1, 0.2))
lacquered = m.material(surface(RED, 0, 0.8), {"KHR_materials_clearcoat": {"clearcoatFactor": 1}})
m.put("sphere", matt, [0, 0, 0], of_mesh={"KHR_materials_variants": {"mappings": [
    {"material": matt, "variants": [0]}, {"material": gold, "variants": [1]},
    {"material": lacquered, "variants": [2]}]}})
m.extensions.add("KHR_materials_variants")
m.gltf["extensions"] = {"KHR_materials_variants": {
    "variants": [{"name": name} for name in ("matt", "gold", "lacquered")]}}
m.write("variants")

m = Model("Twenty-eight domes of one node, each turned further and smaller than the one before.", 7, 4)
m.put("dome", m.material(surface([0.2, 0.5, 0.3], 0, 0.3)), [0, 0, 0], extensions={
    "EXT_mesh_gpu_instancing": {"attributes": {
        "TRANSLATION": GRID, "ROTATION": GRID + 1, "SCALE": GRID + 2}}})
m.extensions.add("EXT_mesh_gpu_instancing")
m.write("instancing", ["EXT_mesh_gpu_instancing"])

m = Model("A checked square that turns once in four seconds, and glows: no noise but that of its edges.",
          1, 1, False)
glows = m.material({"baseColorTexture": {"index": m.texture("checks.png")}, "metallicFactor": 0},
                   {"KHR_materials_unlit": {}})
m.put("flat", glows, [0, 0, 0])
m.gltf["animations"] = [{"name": "turn", "samplers": [{"input": TIMES, "output": TURNS}],
                         "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}]
m.write("turning")

m = Model("A matt dome that slides to the right and back, twice in four seconds.", 3, 2, False)
m.put("dome", m.material(surface([0.5, 0.5, 0.55], 0, 1)), [0, 0, 0])
m.gltf["animations"] = [{"name": "slide", "samplers": [{"input": TIMES, "output": SLIDES}],
                         "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}]
m.write("sliding")
