"""app/bench/scenes.py, run as a user would: what it keeps, measures again, and refuses.

Arguments: scenes.py, the folder of programs. Exit code 77 is a skip: no OpenGL.
"""
import json
import subprocess
import sys

from script_run import finished, here, out, programs, refused, run, script


def times():
    return {file.name: file.stat().st_mtime_ns for file in out.glob("*.exr")} | {
        file.name: file.stat().st_mtime_ns for file in out.glob("*.stats.json")}


def rows():
    return {(r["scene"], r["method"], r["samples"]): r for r in json.loads((out / "scenes.json").read_text())}


flags = ["--", "--scene-depth", "6", "--view-depth", "5", "--vpls", "64", "--reference-samples", "8",
         "--references", str(here / "references")]
line = ["--resolution", "16x9", "--methods", "megaviews,shadow-rays", "--samples", "1"]
finished(run("builtin:cornell", *line, *flags))
first = rows()
assert set(first) == {("cornell", m, n) for m in ("megaviews", "shadow-rays") for n in (None, 1)}
for row in first.values():
    assert row["psnr"] > 0 and row["relmse"] > 0 and 0 < row["views"] <= 64, row
    assert row["mapsMs"] > 0 or row["method"] == "shadow-rays", row
table = (out / "scenes.md").read_text()
assert f"| cornell | megaviews | {first['cornell', 'megaviews', None]['views']} |" in table
assert "| nearest |" in table

# What is measured stays; other words, a damaged record or a lost picture measure again.
written = times()
assert run("builtin:cornell", *line, *flags).returncode == 0
assert times() == written and rows() == first
(out / "cornell-megaviews.json").write_text('{"asked": [')
assert run("builtin:cornell", *line, *flags).returncode == 0
assert {name for name, time in times().items() if time != written[name]} == {
    "cornell-megaviews.stats.json"}
assert run("builtin:cornell", *line, *flags, "--seed-of-nothing").returncode == 2
assert run("builtin:cornell", *line, *flags, "--bounces", "2").returncode == 0
assert all(time != written[name] for name, time in times().items())

# Two files of one name are two scenes; one that is broken costs the other nothing.
scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{}]}
for place in ("a", "b"):
    (here / "scenes" / place).mkdir(parents=True)
    (here / "scenes" / place / "same.gltf").write_text("{" if place == "a" else json.dumps(scene))
done = run("scenes", "--resolution", "16x9", "--methods", "shadow-rays", *flags)
assert done.returncode == 3 and done.stderr.count("\n") == 1, done.stderr
assert set(rows()) == {("same-2", "shadow-rays", None)}, rows()

(here / "nothing").mkdir()
refused(3, "holds no .glb", "nothing")
refused(3, "there is no such file", "absent.glb")
refused(2, "there are megaviews", "builtin:cornell", "--methods", "magic")
refused(2, "whole numbers", "builtin:cornell", "--seeds", "one")
refused(2, "whole numbers", "builtin:cornell", "--samples", "1.5")
(here / "file").write_text("")
line = [sys.executable, "-B", str(script), "--programs", str(programs), "--out", "file/below",
        "builtin:cornell"]
done = subprocess.run(line, capture_output=True, text=True, cwd=here)
assert done.returncode == 5 and done.stderr.count("\n") == 1, (done.returncode, done.stderr)
print("as it should be")
