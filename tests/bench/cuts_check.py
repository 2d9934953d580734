"""app/bench/cuts.py, run as a user would: what its table says of cuts that are kept.

Arguments: cuts.py, the folder of programs. Exit code 77 is a skip: no OpenGL, or no such module.
"""
import json

from script_run import finished, out, refused, run, skip

try:
    import OpenImageIO
except ImportError as missing:
    skip(missing)

line = ["builtin:door", "--vpls", "64", "--frames", "2", "--repeats", "1", "--frame-rates", "0,5"]
flags = ["--", "--scene-depth", "6"]
finished(run(*line, *flags))

rows = json.loads((out / "cuts.json").read_text())
assert len(rows) == 2 * 2 * 4, len(rows)
by = {(r["rate"], r["tree"], r["kind"]): r for r in rows}
for rate in (0, 5):
    for tree in ("octree", "binary"):
        mega, basic, incremental, lazy = (by[rate, tree, kind] for kind in
                                          ("MegaViews", "basic", "incremental", "lazy"))
        # Neither MegaViews nor basic cuts keep any; what is kept is not tested.
        assert mega["nodes"] is None and basic["nodes"] is None
        assert basic["pairsToBasic"] == basic["msToBasic"] == mega["msToMegaViews"] == 1
        assert 0 < incremental["pairs"] < basic["pairs"], (rate, tree)
        assert 0 < lazy["pairs"] <= incremental["pairs"]
        assert incremental["coarse"] == 0 and incremental["kept"] <= incremental["nodes"]
        # Where all stands still nothing splits and next to nothing is tested; else lazy cuts have nodes that are too coarse.
        assert (incremental["split"] > 0) == (rate > 0) == (lazy["coarse"] > 0), (rate, tree)
        if rate == 0:
            assert incremental["kept"] > 0.99 * incremental["nodes"], incremental
assert by[5, "octree", "basic"]["pairs"] < by[5, "binary", "basic"]["pairs"]
text = (out / "cuts.md").read_text()
for r in rows:
    assert f"| door | {r['rate']:g} | {r['tree']} | {r['kind']} | {r['pairs'] / 1e6:.3f} |" in text

# What is measured is not measured again; what was asked for differently is.
written = {file: file.stat().st_mtime_ns for file in out.glob("*.stats.json")}
assert len(written) == 16, sorted(written)
assert run(*line, *flags).returncode == 0
assert written == {file: file.stat().st_mtime_ns for file in out.glob("*.stats.json")}
assert run(*line[:-1], "5", "--trees", "octree", *flags, "--seed", "1").returncode == 0
assert all((file.stat().st_mtime_ns != time) == file.name.startswith("door-5-octree")
           for file, time in written.items())

refused(3, "there is no such file", "absent.glb", "--repeats", "1")
refused(2, "--no-such-flag", *line, "--", "--no-such-flag")
refused(2, "there are octree, binary", "builtin:door", "--trees", "oak")
refused(2, "is no list of numbers", "builtin:door", "--frame-rates", "few")
for rate in ("-1", "nan", "inf"):
    refused(2, "no number of frames", "builtin:door", f"--frame-rates=2,{rate}")
refused(2, "at least 1", "builtin:door", "--repeats", "0")
print("as it should be")
