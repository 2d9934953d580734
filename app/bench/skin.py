#!/usr/bin/env python3
"""Writes a scene whose cost of motion can be measured: a skinned tube that bends in a closed room.

    skin.py OUT.glb [--triangles 30000]

The tube hangs on eight joints, each turning about its parent; the room stands, with one lamp.
"""
import argparse
import json
import math
import struct

JOINTS, LENGTH, RADIUS, LOOP_S = 8, 2.0, 0.25, 4.0


class Binary:
    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def add(self, rows, code, component, kind, **more):
        while len(self.data) % 4:
            self.data += b"\0"
        packed = b"".join(struct.pack("<" + code, *row) for row in rows)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        self.data += packed
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component,
                               "type": kind, "count": len(rows), **more})
        return len(self.accessors) - 1

    def positions(self, rows):
        low, high = [min(c) for c in zip(*rows)], [max(c) for c in zip(*rows)]
        return self.add(rows, "3f", 5126, "VEC3", min=low, max=high)


def tube(b, triangles):
    around = 60
    rings = max(2, triangles // (2 * around))
    positions, normals, joints, weights, indices = [], [], [], [], []
    for i in range(rings + 1):
        height = LENGTH * i / rings
        at = min(height / LENGTH * JOINTS, JOINTS - 1e-6)
        below, share = int(at), at - int(at)
        for j in range(around):
            angle = 2 * math.pi * j / around
            x, z = math.cos(angle), math.sin(angle)
            positions.append((RADIUS * x, height, RADIUS * z))
            normals.append((x, 0.0, z))
            joints.append((below, min(below + 1, JOINTS - 1), 0, 0))
            weights.append((1 - share, share, 0.0, 0.0))
            if i < rings:
                a, c = i * around + j, i * around + (j + 1) % around
                indices += [(a,), (a + around,), (c,), (c,), (a + around,), (c + around,)]
    return {"attributes": {"POSITION": b.positions(positions),
                           "NORMAL": b.add(normals, "3f", 5126, "VEC3"),
                           "JOINTS_0": b.add(joints, "4B", 5121, "VEC4"),
                           "WEIGHTS_0": b.add(weights, "4f", 5126, "VEC4")},
            "indices": b.add(indices, "I", 5125, "SCALAR"), "material": 1}


def room(b):
    x, y, z = 3.0, 3.2, 3.0
    faces = [((-x, 0, z), (x, 0, z), (x, 0, -z), (-x, 0, -z)),
             ((-x, y, -z), (x, y, -z), (x, y, z), (-x, y, z)),
             ((-x, 0, -z), (x, 0, -z), (x, y, -z), (-x, y, -z)),
             ((x, 0, z), (-x, 0, z), (-x, y, z), (x, y, z)),
             ((-x, 0, z), (-x, 0, -z), (-x, y, -z), (-x, y, z)),
             ((x, 0, -z), (x, 0, z), (x, y, z), (x, y, -z))]
    positions = [p for f in faces for p in f]
    indices = [(4 * f + k,) for f in range(6) for k in (0, 1, 2, 0, 2, 3)]
    return {"attributes": {"POSITION": b.positions(positions)},
            "indices": b.add(indices, "I", 5125, "SCALAR"), "material": 0}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out")
    parser.add_argument("--triangles", type=int, default=30000)
    arguments = parser.parse_args()
    b = Binary()
    meshes = [{"primitives": [room(b)]}, {"primitives": [tube(b, arguments.triangles)]}]
    step = LENGTH / JOINTS
    first = 4  # room, tube, lamp, camera come before the joints
    nodes = [{"mesh": 0}, {"mesh": 1, "skin": 0},
             {"translation": [1.6, 2.8, 1.2], "extensions": {"KHR_lights_punctual": {"light": 0}}},
             {"translation": [0.0, 1.5, 2.8], "camera": 0}]
    bind, channels, samplers = [], [], []
    keys = 9
    times = b.add([(LOOP_S * k / (keys - 1),) for k in range(keys)], "f", 5126, "SCALAR",
                  min=[0.0], max=[LOOP_S])
    for j in range(JOINTS):
        node = {"translation": [0, step if j else 0.05, 0]}
        if j + 1 < JOINTS:
            node["children"] = [first + j + 1]
        nodes.append(node)
        bind.append((1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -step * j, 0, 1))
        turns = []
        for k in range(keys):
            angle = 0.22 * math.sin(2 * math.pi * (k / (keys - 1) + 0.09 * j))
            turns.append((math.sin(angle / 2), 0.0, 0.0, math.cos(angle / 2)))
        samplers.append({"input": times, "output": b.add(turns, "4f", 5126, "VEC4")})
        channels.append({"sampler": j, "target": {"node": first + j, "path": "rotation"}})
    text = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 30.0, "name": "lamp"}]}},
        "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, first]}], "nodes": nodes, "meshes": meshes,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.68, 0.64, 1],
                                                "metallicFactor": 0}},
                      {"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.25, 0.15, 1],
                                                "metallicFactor": 0}, "doubleSided": True}],
        "skins": [{"joints": list(range(first, first + JOINTS)),
                   "inverseBindMatrices": b.add(bind, "16f", 5126, "MAT4")}],
        "animations": [{"name": "bend", "channels": channels, "samplers": samplers}],
        "accessors": b.accessors, "bufferViews": b.views,
        "buffers": [{"byteLength": len(b.data)}],
    }
    packed = json.dumps(text).encode()
    packed += b" " * (-len(packed) % 4)
    data = b.data + b"\0" * (-len(b.data) % 4)
    with open(arguments.out, "wb") as out:
        out.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(packed) + len(data), len(packed),
                              0x4E4F534A) + packed)
        out.write(struct.pack("<II", len(data), 0x004E4942) + data)


if __name__ == "__main__":
    main()
