#!/usr/bin/env python3
"""Judges the methods on scenes that nobody tuned to: each picture against path-traced light.

    app/bench/scenes.py FOLDER|FILE|builtin:NAME ... [--out measured-scenes] [--programs build]
                        [--methods megaviews,...] [--resolution 480x270] [-- FLAGS of the viewer]

For every glTF file found and every built-in scene named, under its first camera: errors of the
indirect light alone (--view indirect), milliseconds of views, maps, gather and filter of a second
frame, and a row of pictures. Writes OUT/scenes.md, OUT/scenes.json and OUT/contact.png, and keeps what is
measured: run it again to go on after an interruption. Python alone; the contact sheet needs
matplotlib.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys

METHODS = "megaviews,manylods,rays,shadow-rays,ism,exact"
VIEWS = ("guide views", "trace views", "choose views", "sort views", "view hierarchy")
ERRORS = ("psnr", "relmse", "flip", "leaked", "occluded")


def scenes_of(places):
    for place in places:
        path = pathlib.Path(place)
        if place.startswith("builtin:"):
            yield place.split(":")[1], place
        elif path.is_dir():
            for file in sorted([*path.rglob("*.glb"), *path.rglob("*.gltf")]):
                yield file.stem, str(file)
        else:
            yield path.stem, place


def run(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        print(f"{' '.join(command)}\n{done.stderr.strip()}", file=sys.stderr)
        return None
    return done


def milliseconds(stats):
    """Of views, maps, gather with its filter, from the stages of --stats."""
    stages = dict(stats["shared"]["ms"], **stats["methods"][0]["ms"])
    ms = {name: value["median"] for name, value in stages.items()}
    views = sum(ms.get(name, 0) for name in VIEWS)
    gather = sum(ms.get(name, 0) for name in ("gather cull", "gather", "near field", "filter"))
    maps = sum(ms.get(name, 0) for name in
               ("traverse", "fill", "fuse", "rasterise", "splat points", "pull and push", "march tree"))
    return views, maps, gather


def measure(args, name, scene, method, truth):
    base = args.out / f"{name}-{method}"
    kept = base.with_suffix(".json")
    if kept.exists():
        return json.loads(kept.read_text())
    common = [str(args.programs / "megaviews"), "--headless", scene, "--no-config", "--resolution",
              args.resolution, "--references", str(args.out / "references"), *args.flags]
    stats = base.with_suffix(".stats.json")
    done = run([*common, "--method", method, "--view", "indirect", "--warmup",
                "0" if method == "exact" else "1", "--reference", str(truth), "--metrics",
                ",".join(ERRORS), "--stats", str(stats)])
    if done is None:
        return None
    row = {"scene": name, "method": method}
    for metric, value in re.findall(r"^(\S+)[: ]+([-\d.einfa+]+)", done.stdout, re.M):
        if metric in ERRORS:
            row[metric] = float(value)
    written = json.loads(stats.read_text())
    row["views"] = written["views"]["alive"]
    row["pairs"] = written["methods"][0]["pairs"]["processed"]
    row["undecided"] = written["methods"][0].get("undecidedShare", 0)
    row["viewsMs"], row["mapsMs"], row["gatherMs"] = milliseconds(written)
    run([*common, "--method", method, "-o", str(base.with_suffix(".png"))])
    kept.write_text(json.dumps(row, indent=1))
    return row


def table(rows):
    text = ["| scene | method | views | PSNR dB | relMSE | FLIP | leaked % | occluded % | undecided % "
            "| pairs | views + maps + gather ms |", "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for r in rows:
        ms = "" if r["method"] == "exact" else (
            f"{r['viewsMs']:.0f} + {r['mapsMs']:.0f} + {r['gatherMs']:.0f}")
        nan = float("nan")
        text.append(
            f"| {r['scene']} | {r['method']} | {r['views']} | {r.get('psnr', nan):.1f} "
            f"| {r.get('relmse', nan):.3f} | {r.get('flip', nan):.3f} | {r.get('leaked', nan):.1f} "
            f"| {r.get('occluded', nan):.1f} | {100 * r['undecided']:.0f} | {r['pairs']} | {ms} |")
    return "\n".join(text) + "\n"


def contact_sheet(out, names, methods):
    try:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
    except ImportError:
        print("no contact sheet: matplotlib is missing", file=sys.stderr)
        return
    columns = [*methods, "pathtraced"]
    figure, axes = pyplot.subplots(len(names), len(columns), squeeze=False,
                                   figsize=(2.6 * len(columns), 1.6 * len(names)))
    for i, name in enumerate(names):
        for j, method in enumerate(columns):
            axes[i][j].axis("off")
            picture = out / f"{name}-{method}.png"
            if picture.exists():
                axes[i][j].imshow(pyplot.imread(picture))
            axes[i][j].set_title(f"{name}, {method}", fontsize=6)
    figure.tight_layout(pad=0.3)
    figure.savefig(out / "contact.png", dpi=150)


def main():
    line = sys.argv[1:]
    flags = line[line.index("--") + 1:] if "--" in line else []
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("measured-scenes"))
    parser.add_argument("--programs", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--methods", default=METHODS)
    parser.add_argument("--resolution", default="480x270")
    args = parser.parse_args(line[:line.index("--")] if "--" in line else line)
    args.flags = flags
    args.out.mkdir(parents=True, exist_ok=True)
    rows, names, methods = [], [], args.methods.split(",")
    for name, scene in scenes_of(args.scenes):
        truth = args.out / f"{name}-pathtraced.exr"
        reference = [str(args.programs / "megaviews"), "--headless", scene, "--no-config", "--method",
                     "pathtraced", "--resolution", args.resolution, "--references",
                     str(args.out / "references"), *flags]
        if not truth.exists():
            if run([*reference, "--view", "indirect", "-o", str(truth)]) is None:
                continue
            run([*reference, "-o", str(truth.with_suffix(".png"))])
        names.append(name)
        for method in methods:
            row = measure(args, name, scene, method, truth)
            if row is not None:
                rows.append(row)
                print(json.dumps(row), flush=True)
        (args.out / "scenes.md").write_text(table(rows))
        (args.out / "scenes.json").write_text(json.dumps(rows, indent=1))
    contact_sheet(args.out, names, methods)
    return 0 if rows else 3


if __name__ == "__main__":
    sys.exit(main())
