"""app/bench/flicker.py, run as a user would and on frames made up here.

Arguments: flicker.py, the folder of programs. Exit code 77 is a skip: no OpenGL, or no such module.
"""
import json
import math
import sys

from script_run import finished, here, out, refused, run, script, skip

sys.path.insert(0, str(script.parent))

try:
    import numpy
    import flicker
except ImportError as missing:
    skip(missing)


def near(a, b):
    assert math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-9), (a, b)


# Frames as exact's, and frames that are wrong by the same in every frame, do not flicker, whatever
# the light does; an error that comes and goes does, by its size over exact's mean.
exact = numpy.ones((3, 2, 4, 3)) * numpy.array([1, 2, 3]).reshape(3, 1, 1, 1)
error = numpy.zeros_like(exact)
error[1] = 0.5
near(flicker.flicker(exact, exact), 0)
near(flicker.flicker(exact + 0.25, exact), 0)
near(flicker.flicker(exact + error, exact), 0.5 / 2)
near(flicker.own_change(exact, exact), 1 / 2)
# Neither pixels without a surface nor those that are not finite change it.
for value in (0.0, math.nan):
    wide = numpy.concatenate([exact, numpy.full_like(exact, value)], axis=2)
    near(flicker.flicker(wide + numpy.concatenate([error, 0 * error], axis=2), wide), 0.5 / 2)
assert math.isnan(flicker.flicker(0 * exact, 0 * exact))

tiny = ["--resolution", "16x9", "--vpls", "32", "--frames", "3", "--frame-rate", "2"]
flags = ["--", "--scene-depth", "6"]
line = ["builtin:cornell", *tiny, "--methods", "shadow-rays,ism", *flags]
finished(run(*line))

# The light moves; exact does not flicker against itself; ratios are to shadow rays.
rows = {row["method"]: row for row in json.loads((out / "flicker.json").read_text())}
assert list(rows) == ["exact", "shadow-rays", "ism"]
assert rows["exact"]["ownChange"] > 0 and rows["exact"]["flicker"] == 0
assert rows["exact"]["relmse"] == 0 and rows["exact"]["psnr"] is None
near(rows["shadow-rays"]["toShadowRays"], 1)
near(rows["ism"]["toShadowRays"] * rows["shadow-rays"]["flicker"], rows["ism"]["flicker"])
assert rows["ism"]["mapsMs"] > 0 and rows["ism"]["mapsMiB"] > 0 and rows["ism"]["queueMiB"] == 0
assert rows["shadow-rays"]["ms"] > rows["shadow-rays"]["mapsMs"] == 0 and "ms" not in rows["exact"]
assert rows["ism"]["flicker"] > 0 and rows["ism"]["relmse"] > 0 and rows["ism"]["psnr"] > 0
table = (out / "flicker.md").read_text()
for row in rows.values():
    assert f"| cornell | {row['method']} | {100 * row['flicker']:.2f} |" in table, table

# What is measured is not rendered again; what was asked for differently is.
written = {file: file.stat().st_mtime_ns for file in out.glob("*.exr")}
assert len(written) == 9, sorted(written)
assert run(*line).returncode == 0
assert written == {file: file.stat().st_mtime_ns for file in out.glob("*.exr")}
assert run("builtin:cornell", *tiny, "--methods", "exact", *flags, "--seed", "1").returncode == 0
assert all((file.stat().st_mtime_ns != time) == ("exact" in file.name)
           for file, time in written.items())

refused(3, "there is no such file", "absent.glb", *tiny)
refused(2, "--no-such-flag", "builtin:cornell", *tiny, "--", "--no-such-flag")
refused(2, "there are megaviews", "builtin:cornell", "--methods", "magic")
refused(2, "at least 2", "builtin:cornell", "--frames", "1")
refused(2, "--frames", "builtin:cornell", "--frames", "few")
refused(2, "scenes", *tiny)
# A light that stands still; and a scene of nothing, in which the program's own light moves.
scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
         "nodes": [{"name": "empty"}]}
empty, still = (here / name for name in ("empty.gltf", "still.gltf"))
empty.write_text(json.dumps(scene))
scene["extensionsUsed"] = ["KHR_lights_punctual"]
scene["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}
scene["nodes"][0]["extensions"] = {"KHR_lights_punctual": {"light": 0}}
still.write_text(json.dumps(scene))
refused(3, "no light in it moves", str(still), *tiny)
refused(3, "is black", str(empty), *tiny)
print("as it should be")
