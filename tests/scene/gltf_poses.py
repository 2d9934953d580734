#!/usr/bin/env python3
"""Where an animated glTF file stands: numbers for gltf_poses_test.cpp, worked out from the glTF 2.0
specification without the program's loader.

    gltf_poses.py FILE TIME... [--animation N]

Prints, for each time in seconds, the box of all drawn triangles and their centre of area, in world
units (doubles; float accessors, no sparse ones, triangles only).
"""
import argparse
import base64
import json
import math
import struct
from pathlib import Path

FORMATS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
LARGEST = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class File:
    def __init__(self, path):
        data = Path(path).read_bytes()
        binary = b""
        if data[:4] == b"glTF":
            length = struct.unpack_from("<I", data, 12)[0]
            self.json = json.loads(data[20:20 + length])
            binary = data[20 + length + 8:]
        else:
            self.json = json.loads(data)
        self.buffers = []
        for buffer in self.json.get("buffers", []):
            uri = buffer.get("uri")
            if uri is None:
                self.buffers.append(binary)
            elif uri.startswith("data:"):
                self.buffers.append(base64.b64decode(uri.split(",", 1)[1]))
            else:
                self.buffers.append((Path(path).parent / uri).read_bytes())

    def accessor(self, index):
        a = self.json["accessors"][index]
        view = self.json["bufferViews"][a["bufferView"]]
        width, kind = WIDTHS[a["type"]], a["componentType"]
        code = "<" + FORMATS[kind] * width
        stride = view.get("byteStride") or struct.calcsize(code)
        at = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        data = self.buffers[view["buffer"]]
        rows = [struct.unpack_from(code, data, at + i * stride) for i in range(a["count"])]
        if a.get("normalized"):
            rows = [tuple(max(x / LARGEST[kind], -1.0) for x in row) for row in rows]
        return [row[0] for row in rows] if width == 1 else rows


# Matrices are lists of four rows.
def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def apply(m, p):
    return [m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3] for i in range(3)]


def rows_of(column_major):
    return [[column_major[4 * j + i] for j in range(4)] for i in range(4)]


IDENTITY = [[float(i == j) for j in range(4)] for i in range(4)]


def unit(q):
    length = math.sqrt(sum(x * x for x in q))
    return [x / length for x in q]


def from_trs(t, q, s):
    x, y, z, w = unit(q)
    r = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return [[r[i][j] * s[j] for j in range(3)] + [t[i]] for i in range(3)] + [[0, 0, 0, 1]]


def slerp(a, b, u):
    a, b = unit(a), unit(b)
    dot = sum(x * y for x, y in zip(a, b))
    if dot < 0:
        b, dot = [-x for x in b], -dot
    if dot > 1 - 1e-12:
        return [x + u * (y - x) for x, y in zip(a, b)]
    angle = math.acos(dot)
    f, g = math.sin((1 - u) * angle) / math.sin(angle), math.sin(u * angle) / math.sin(angle)
    return [f * x + g * y for x, y in zip(a, b)]


def sample(times, values, interpolation, path, t):
    """values: rows, one a key (three for CUBICSPLINE)."""
    cubic = interpolation == "CUBICSPLINE"
    value = (lambda k: values[3 * k + 1]) if cubic else (lambda k: values[k])
    if t <= times[0]:
        return list(value(0))
    if t >= times[-1]:
        return list(value(len(times) - 1))
    k = max(i for i in range(len(times)) if times[i] <= t)
    if interpolation == "STEP":
        return list(value(k))
    d = times[k + 1] - times[k]
    u = (t - times[k]) / d
    if cubic:
        out, into = values[3 * k + 2], values[3 * (k + 1)]
        return [(2 * u**3 - 3 * u**2 + 1) * p + d * (u**3 - 2 * u**2 + u) * m +
                (-2 * u**3 + 3 * u**2) * q + d * (u**3 - u**2) * n
                for p, m, q, n in zip(value(k), out, value(k + 1), into)]
    if path == "rotation":
        return slerp(value(k), value(k + 1), u)
    return [p + u * (q - p) for p, q in zip(value(k), value(k + 1))]


def animated(file, animation, t):
    """What the animation says of nodes: (node, path) -> value."""
    says = {}
    entry = file.json["animations"][animation]
    for channel in entry["channels"]:
        sampler = entry["samplers"][channel["sampler"]]
        node, path = channel["target"].get("node"), channel["target"]["path"]
        if node is None:
            continue
        times = file.accessor(sampler["input"])
        values = file.accessor(sampler["output"])
        interpolation = sampler.get("interpolation", "LINEAR")
        if path == "weights":  # scalars, so many a key
            keys = len(times) * (3 if interpolation == "CUBICSPLINE" else 1)
            width = len(values) // keys
            values = [values[width * k:width * (k + 1)] for k in range(keys)]
        says[node, path] = sample(times, values, interpolation, path, t)
    return says


def triangles_at(file, animation, t):
    j = file.json
    says = animated(file, animation, t)
    duration = max(max(file.accessor(s["input"])) for s in j["animations"][animation]["samplers"])
    assert 0 <= t < duration, "a time inside the animation"
    parents = {c: n for n, node in enumerate(j["nodes"]) for c in node.get("children", [])}

    def local(n):
        node = j["nodes"][n]
        if "matrix" in node:
            return rows_of(node["matrix"])
        return from_trs(says.get((n, "translation"), node.get("translation", [0, 0, 0])),
                        says.get((n, "rotation"), node.get("rotation", [0, 0, 0, 1])),
                        says.get((n, "scale"), node.get("scale", [1, 1, 1])))

    def world(n):
        m = local(n)
        while n in parents:
            n = parents[n]
            m = multiply(local(n), m)
        return m

    reached, wait = [], list(j["scenes"][j.get("scene", 0)]["nodes"])
    while wait:
        n = wait.pop()
        reached.append(n)
        wait += j["nodes"][n].get("children", [])

    for n in reached:
        node = j["nodes"][n]
        if "mesh" not in node:
            continue
        mesh = j["meshes"][node["mesh"]]
        weights = says.get((n, "weights"), node.get("weights", mesh.get("weights", [])))
        joints = None
        if "skin" in node:
            skin = j["skins"][node["skin"]]
            bind = [rows_of(m) for m in file.accessor(skin["inverseBindMatrices"])]
            joints = [multiply(world(joint), b) for joint, b in zip(skin["joints"], bind)]
        for primitive in mesh["primitives"]:
            assert primitive.get("mode", 4) == 4
            attributes = primitive["attributes"]
            points = [list(p) for p in file.accessor(attributes["POSITION"])]
            for weight, target in zip(weights, primitive.get("targets", [])):
                if "POSITION" in target:
                    for p, d in zip(points, file.accessor(target["POSITION"])):
                        for k in range(3):
                            p[k] += weight * d[k]
            if joints:
                hung = zip(points, file.accessor(attributes["JOINTS_0"]),
                           file.accessor(attributes["WEIGHTS_0"]))
                placed = []
                for p, which, how in hung:
                    moved = [apply(joints[i], p) for i in which]
                    total = sum(how)
                    placed.append([sum(w * m[k] for w, m in zip(how, moved)) / total
                                   for k in range(3)])
            else:
                m = world(n)
                placed = [apply(m, p) for p in points]
            order = (file.accessor(primitive["indices"]) if "indices" in primitive
                     else range(len(points)))
            for i in range(0, len(order) - 2, 3):
                yield [placed[order[i + k]] for k in range(3)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("file")
    parser.add_argument("times", type=float, nargs="+")
    parser.add_argument("--animation", type=int, default=0)
    arguments = parser.parse_args()
    file = File(arguments.file)
    for t in arguments.times:
        low, high = [1e300] * 3, [-1e300] * 3
        centre, total = [0.0] * 3, 0.0
        for a, b, c in triangles_at(file, arguments.animation, t):
            for p in (a, b, c):
                low = [min(x, y) for x, y in zip(low, p)]
                high = [max(x, y) for x, y in zip(high, p)]
            e, f = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
            area = math.hypot(e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2],
                              e[0] * f[1] - e[1] * f[0]) / 2
            total += area
            centre = [s + area * (x + y + z) / 3 for s, x, y, z in zip(centre, a, b, c)]
        cells = ["{%s}" % ", ".join("%.6g" % x for x in v)
                 for v in (low, high, [s / total for s in centre])]
        print("%g, %s" % (t, ", ".join(cells)))


if __name__ == "__main__":
    main()
