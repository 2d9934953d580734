#!/usr/bin/env python3
"""Judges the methods on scenes that nobody tuned to: each picture against path-traced light.

    app/bench/scenes.py FOLDER|FILE|builtin:NAME ... [--out measured-scenes] [--programs build]
                        [--methods megaviews,...] [--resolution 480x270] [--cameras first|all]
                        [--seeds 0,...] [--samples 2,4,...] [-- FLAGS of the viewer]

For every glTF file found and every built-in scene named, under the preset `bench`: errors of the
indirect light alone (--view indirect), milliseconds of views, maps, gather and filter of a third
frame, and a row of pictures with their FLIP maps below. With --seeds the methods of --seed-methods are measured with each, and
means and standard deviations are given. With --samples every method but exact is also measured with
so many a pixel, and each scene gets a verdict: which method comes nearest in the time that MegaViews
take with the preset's. Writes OUT/scenes.md, OUT/scenes.json and OUT/contact.png, and keeps what is
measured: run it again to go on after an interruption. Python alone; the contact sheet needs
matplotlib. Exit codes are the viewer's: that of what went wrong last, after everything else was
measured.
"""

import json
import pathlib
import re
import statistics
import sys

from scene_runs import (METHODS, Failure, asked, beside, kept, milliseconds, parse, parser_of, run,
                        run_script, scenes_of, write_whole)

ERRORS = ("psnr", "relmse", "flip", "leaked", "occluded")


def command_of(args, scene):
    place, camera = scene
    return [str(args.programs / "megaviews"), "--headless", place, "--no-config", "--preset", "bench",
            "--resolution", args.resolution, "--references", str(args.out / "references"),
            *(["--camera", camera] if camera else []), *args.flags]


def cameras_of(args, place):
    """Names of a scene with its cameras, and what --camera takes: the first alone has none."""
    cameras = [("", "")]
    if args.cameras == "all":
        listed = run([str(args.programs / "megaviews"), place, "--list", "cameras", "--no-config"])
        cameras += [(f"-camera{k}", str(k)) for k in range(1, len(listed.stdout.splitlines()))]
    return cameras


def reference(args, name, scene):
    """The path-traced indirect light, as EXR, and the picture as PNG beside it."""
    base = args.out / f"{name}-pathtraced"
    truth = beside(base, "exr")
    command = [*command_of(args, scene), "--method", "pathtraced"]

    def trace():
        run([*command, "--view", "indirect", "-o", str(truth)])
        run([*command, "-o", str(beside(base, "png"))])
        return {}

    record = beside(base, "json")
    if not truth.exists():
        record.unlink(missing_ok=True)
    kept(record, asked(args, scene[0], *command), trace)
    return truth


def measure(args, name, scene, method, truth, seed, samples=None):
    """A row; `samples`: instead of the preset's."""
    base = args.out / (f"{name}-{method}" + (f"-seed{seed}" if seed else "") +
                       (f"-samples{samples}" if samples else ""))
    common = [*command_of(args, scene), "--method", method, "--seed", str(seed),
              *(["--gather-samples", str(samples)] if samples else [])]

    def render():
        stats = beside(base, "stats.json")
        done = run([*common, "--view", "indirect", "--warmup", "0" if method == "exact" else "2",
                    "--reference", str(truth), "--metrics", ",".join(ERRORS),
                    "--stats", str(stats)])
        row = {"scene": name, "method": method, "seed": seed, "samples": samples}
        for metric, value in re.findall(r"^(\S+)[: ]+([-\d.einfa+]+)", done.stdout, re.M):
            if metric in ERRORS:
                row[metric] = float(value)
        written = json.loads(stats.read_text())
        row["views"] = written["views"]["alive"]
        row["pairs"] = written["methods"][0]["pairs"]["processed"]
        row["undecided"] = written["methods"][0].get("undecidedShare", 0)
        row["viewsMs"], row["mapsMs"], row["gatherMs"] = milliseconds(written)
        if seed == args.first_seed and not samples:
            run([*common, "-o", str(args.out / f"{name}-{method}.png")])
            run([*command_of(args, scene), "--seed", str(seed), "--method", "pathtraced",
                 "--compare", method, "--difference", "flip",
                 "-o", str(args.out / f"{name}-{method}-flip.png")])
        return row

    return kept(beside(base, "json"), asked(args, scene[0], *common), render)


def total_ms(row):
    return row["viewsMs"] + row["mapsMs"] + row["gatherMs"]


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


def seeds_table(rows):
    """Means and standard deviations over seeds; nothing if there is one seed."""
    groups = {}
    for r in rows:
        if not r["samples"] and "relmse" in r and "psnr" in r:
            groups.setdefault((r["scene"], r["method"]), []).append(r)
    several = {k: g for k, g in groups.items() if len(g) > 1}
    if not several:
        return ""
    text = ["", "| scene | method | seeds | PSNR dB | relMSE |", "|---|---|--:|--:|--:|"]
    for (scene, method), g in several.items():
        spread = [f"{statistics.mean(v):.{n}f} ± {statistics.stdev(v):.{n}f}"
                  for v, n in (([r["psnr"] for r in g], 1), ([r["relmse"] for r in g], 3))]
        text.append(f"| {scene} | {method} | {len(g)} | {spread[0]} | {spread[1]} |")
    return "\n".join(text) + "\n"


def verdicts(rows):
    """Of each method the least relMSE in MegaViews' time; nothing if no samples were varied."""
    first = rows[0]["seed"] if rows else 0
    rows = [r for r in rows if r["seed"] == first and r["method"] != "exact" and "relmse" in r]
    if not any(r["samples"] for r in rows):
        return ""
    methods = list(dict.fromkeys(r["method"] for r in rows))
    text = ["", "| scene | ms | " + " | ".join(methods) + " | nearest |",
            "|---|--:|" + "--:|" * len(methods) + "---|"]
    for scene in dict.fromkeys(r["scene"] for r in rows):
        here = [r for r in rows if r["scene"] == scene]
        limit = next((total_ms(r) for r in here if r["method"] == "megaviews" and not r["samples"]), None)
        if limit is None:
            continue
        best = {}
        for r in here:
            if total_ms(r) <= 1.05 * limit:
                best[r["method"]] = min(best.get(r["method"], r), r, key=lambda x: x["relmse"])
        cells = [f"{best[m]['relmse']:.3f} ({best[m]['samples'] or 'preset'}, {total_ms(best[m]):.0f} ms)"
                 if m in best else "–" for m in methods]
        text.append(f"| {scene} | {limit:.0f} | " + " | ".join(cells) +
                    f" | {min(best, key=lambda m: best[m]['relmse'])} |")
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
    figure, axes = pyplot.subplots(2 * len(names), len(columns), squeeze=False,
                                   figsize=(2.6 * len(columns), 3.2 * len(names)))
    for i, name in enumerate(names):
        for j, method in enumerate(columns):
            for below, suffix in enumerate(("", "-flip")):
                panel = axes[2 * i + below][j]
                panel.axis("off")
                picture = out / f"{name}-{method}{suffix}.png"
                if picture.exists():
                    panel.imshow(pyplot.imread(picture))
                    panel.set_title(f"{name}, {method}" + (", FLIP" if below else ""), fontsize=6)
    figure.tight_layout(pad=0.3)
    figure.savefig(out / "contact.png", dpi=150)


def integers(option, text):
    """What an option lists, 1,2,4; of nothing, none."""
    try:
        return [int(number) for number in text.split(",") if number]
    except ValueError as error:
        raise Failure(2, f"{option} '{text}': whole numbers with commas between them") from error


def arguments():
    parser = parser_of(__doc__, out=pathlib.Path("measured-scenes"), resolution="480x270",
                       methods=METHODS + ",exact")
    parser.add_argument("--cameras", choices=("first", "all"), default="first")
    parser.add_argument("--seeds", default="0", help="the first is that of every method")
    parser.add_argument("--seed-methods", default="megaviews,shadow-rays")
    parser.add_argument("--samples", default="", help="to be compared at equal time")
    args = parse(parser, sys.argv[1:])
    args.first_seed, *args.seeds = integers("--seeds", args.seeds) or [0]
    args.samples = integers("--samples", args.samples)
    return args


def main():
    args = arguments()
    first = args.first_seed
    code, rows, names = 0, [], []
    runs = [(method, first, None) for method in args.methods]
    runs += [(method, seed, None) for method in args.seed_methods.split(",") for seed in args.seeds]
    runs += [(method, first, n) for method in args.methods if method != "exact"
             for n in args.samples]

    def attempt(step):
        """What the step gives; None, once it is said why, if it fails: the others are measured."""
        nonlocal code
        try:
            return step()
        except Failure as failure:
            print(f"scenes.py: {failure}", file=sys.stderr)
            code = failure.code
            return None

    for stem, place in scenes_of(args.scenes):
        for suffix, camera in attempt(lambda: cameras_of(args, place)) or []:
            name, scene = stem + suffix, (place, camera)
            truth = attempt(lambda: reference(args, name, scene))
            if truth is None:
                continue
            names.append(name)
            for method, seed, n in runs:
                row = attempt(lambda: measure(args, name, scene, method, truth, seed, n))
                if row is not None:
                    rows.append(row)
                    print(json.dumps(row), flush=True)
            shown = [r for r in rows if r["seed"] == first and not r["samples"]]
            write_whole(args.out / "scenes.md", table(shown) + seeds_table(rows) + verdicts(rows))
            write_whole(args.out / "scenes.json", json.dumps(rows, indent=1))
    if names:
        contact_sheet(args.out, names, args.methods)
    return code


if __name__ == "__main__":
    run_script(main)
