"""app/bench/paper.py, run as a user would: its tables hold what its sweeps measured.

Arguments: paper.py, the folder of programs. Exit code 77 is a skip: no OpenGL.
"""
import json
import re

from script_run import finished, out, refused, run


def points(figure):
    return json.loads((out / f"cornell-{figure}.json").read_text())["points"]


line = ["builtin:cornell", "--resolution", "16x9", "--seeds", "0,1", "--views", "4K",
        "--error-views", "64"]
flags = ["--", "--scene-depth", "4", "--view-depth", "4"]
finished(run(*line, *flags))
text = (out / "paper.md").read_text()
assert "nan" not in text and "Nothing could be measured" not in text, text
assert text.count("## cornell: ") == 8, text

# Of so many living views, not slots, and both methods with the same.
counts = sorted({p["values"]["vpls"] for p in points("10-bounces")})
assert len(counts) == 2 and len(points("10-bounces")) == 2 * 2 * 2
for p in points("10-bounces"):
    wanted = 1024 * 4 ** counts.index(p["values"]["vpls"])
    assert abs(p["views"]["alive"] / wanted - 1) < 0.1, p["views"]
    assert p["settings"]["rules"] == "published" and p["settings"]["traversal"] == "queue"
pairs = {m: sum(p["pairs"]["processed"] for p in points("10-bounces")
                if p["settings"]["method"] == m and p["values"]["vpls"] == counts[1]) / 2e6
         for m in ("megaviews", "manylods")}
assert f"| {pairs['megaviews']:.2f} / {pairs['manylods']:.2f} |" in text, (pairs, text)
ratios = [b["ms"]["maps"]["median"] / a["ms"]["maps"]["median"]
          for a, b in zip(*([p for p in points("10-bounces") if p["settings"]["method"] == m
                             and p["values"]["vpls"] == counts[1]]
                            for m in ("megaviews", "manylods")))]
assert f"**{sum(ratios) / 2:.2f} ± " in text, ratios

# From published to corrected, a rule at a time: pairs become fewer, and the picture better.
steps = [points(f"rules-{i}-error")[0] for i in range(12)]
rules = [s["settings"]["rules"] for s in steps]
assert rules[:3] == ["published"] * 2 + ["centroid"] and rules[10:] == ["corrected"] * 2, rules
assert all(set(a.split(",")) < set(b.split(",")) for a, b in zip(rules[2:8], rules[3:9])), rules
assert steps[0]["pairs"] == steps[1]["pairs"], "a list's pairs are the queue's"
assert steps[10]["pairs"]["processed"] < steps[0]["pairs"]["processed"]
assert steps[8]["errors"]["exact"]["psnr"] > steps[0]["errors"]["exact"]["psnr"] + 3

# What is measured is not measured again.
before = points("12")
assert run(*line, "--figures", "12", *flags).returncode == 0
assert points("12") == before
assert len(re.findall("## cornell", (out / "paper.md").read_text())) == 1

refused(2, "--figures has no '9'", *line, "--figures", "9")
refused(2, "'many' is no count of views", *line, "--views", "many")
refused(3, "there is no such file", "absent.glb", "--figures", "12")
