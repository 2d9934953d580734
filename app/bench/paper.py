#!/usr/bin/env python3
"""Repeats the experiments of the paper on MegaViews [Kol19].

    app/bench/paper.py FOLDER|FILE|builtin:NAME ... [--out measured-paper] [--programs build]
                       [--figures 10,11,12,13,14,16,17,rules] [--views 64K] [--error-views 2K]
                       [--seeds 0,1,2] [--resolution 160x90] [-- FLAGS of the programs]

Published rules and pair queue, 11 levels, maps of 16 x 16 (the preset paper-megaviews). Counts are of
living views: as many slots are asked for as leave so many alive. Every scene and figure is a sweep,
OUT/SCENE-FIGURE.json, which plot.py draws; OUT/paper.md has the tables. What is measured is kept: run
it again to go on after an interruption. The figures, by the paper's numbers:

    10      time of the maps against the number of views; memory and stages of the largest
    11      random views, anywhere and facing anywhere, against those on lit surfaces
    12      time of the maps against their resolution
    13      levels of both octrees: time, error
    14      resolution of the maps: error (figures 14 and 15)
    16      gather culling: error
    17      glowing particles
    rules   from the published rules to the corrected ones, a step at a time: pairs, time, error

Needs Python alone. Exit codes are the programs': that of what went wrong last, after everything else
was measured.
"""

import json
import math
import pathlib
import statistics
import sys

from scene_runs import (Failure, asked, kept, parse, parser_of, run, run_script, scenes_of,
                        write_whole)

FIRST_VIEWS = 1024
RESOLUTIONS = (16, 32, 64)
LEVELS = (8, 9, 10, 11)
# Corrections of the published rules, and what they are called in the table.
RULES = ("centroid", "boxes", "lone-views", "bound", "radius", "surfaces", "footprint")
CORRECTIONS = ("drawn at centroids", "tight boxes", "leaves of one view at any level",
               "a size that bounds every view's", "the larger radius is split",
               "surface elements", "shadow test by the texel's footprint")
# Each a step from the one before; what a step does not name stays as it was.
STEPS = (("published", []), ("lists instead of a queue", ["--traversal", "lists"]),
         *((name, ["--rules", ",".join(RULES[:i + 1])]) for i, name in enumerate(CORRECTIONS)),
         ("near leaves fill their texels", ["--hole-fill", "on"]),
         ("2 texels", ["--rules", "corrected"]),
         ("undecided samples by rays", ["--undecided", "rays"]))


def number(text):
    """4096 of 4K."""
    units = {"K": 1024, "M": 1024 * 1024}
    try:
        return int(text[:-1]) * units[text[-1]] if text[-1:] in units else int(text)
    except ValueError as error:
        raise Failure(2, f"'{text}' is no count of views, such as 64K") from error


class Scene:
    """Sweeps of one scene; each is made once."""

    def __init__(self, args, name, place):
        self.args, self.name, self.place = args, name, place

    def file(self, figure):
        return self.args.out / f"{self.name}-{figure}.json"

    def sweep(self, figure, flags, axes):
        """The points of a grid, those that were refused left out."""
        command = [str(self.args.programs / "megaviews-bench"), "sweep", self.place, "--no-config",
                   "--preset", "paper-megaviews", "--environment", "none", "--resolution",
                   self.args.resolution, *flags, *self.args.flags]
        for key, values in axes.items():
            command += ["--sweep", f"{key}={','.join(map(str, values))}"]
        file = self.file(figure)
        command += ["--frames", "1", "--warmup", "1", "--out", str(file.with_suffix(""))]
        try:
            run([*command, "--resume"], also=(6,))
        except Failure as failure:
            if "without --resume it is made anew" not in str(failure):
                raise
            run(command, also=(6,))  # it was another program's
        return [p for p in json.loads(file.read_text())["points"] if p["refusal"] is None]

    def alive(self, distribution):
        """Share of the slots that leave a view."""
        def measure():
            point = self.sweep(f"alive-{distribution}", ["--gather-samples", "1"],
                               {"distribution": [distribution], "vpls": [4096],
                                "method": ["megaviews"]})[0]
            return point["views"]["alive"] / point["views"]["requested"]
        return kept(self.file(f"alive-{distribution}-share"),
                    asked(self.args, self.place, *self.args.flags), measure)

    def slots(self, distribution, living):
        share = self.alive(distribution)
        if share == 0:
            raise Failure(4, f"'{self.place}': no view of '{distribution}' lives")
        return round(living / share)

    def methods(self, figure, distribution, living, flags=(), axes=None):
        """Both methods with so many living views, gathered as little as can be."""
        return self.sweep(figure, ["--gather-samples", "1", "--filter", "off", *flags],
                          {"distribution": [distribution],
                           "vpls": [self.slots(distribution, n) for n in living],
                           **(axes or {"seed": self.args.seeds}),
                           "method": ["megaviews", "manylods"]})

    def errors(self, figure, flags, axes):
        """One picture a point, of few views, against all of them with exact rays."""
        common = ["--bounces", "1", "--vpls", str(self.slots("single", self.args.error_views)),
                  "--filter", "off", *flags]
        references = ["--references", str(self.args.out / "references")]
        run([str(self.args.programs / "megaviews"), "--headless", self.place, "--no-config",
             "--quiet", "--preset", "paper-megaviews", "--environment", "none", "--resolution",
             self.args.resolution, *common, *self.args.flags, "--method", "exact", *references,
             "-o", str(self.args.out / f"{self.name}-exact.png")])
        return self.sweep(figure, [*common, *references], axes)


# ---- numbers

def maps_ms(point):
    return point["ms"]["maps"]["median"]


def mean_and_interval(values, digits):
    """Mean, and half a 95 % interval of it by Student's t; of one value alone, the value."""
    mean = statistics.mean(values)
    if len(values) < 2:
        return f"{mean:.{digits}f}"
    t = {2: 12.71, 3: 4.30, 4: 3.18, 5: 2.78, 6: 2.57, 7: 2.45}.get(
        len(values), 1.96 + 2.8 / (len(values) - 1))
    half = t * statistics.stdev(values) / math.sqrt(len(values))
    return f"{mean:.{digits}f} ± {half:.{digits}f}"


def exponent(counts, times):
    """Of time ~ count^exponent, by least squares over the logarithms."""
    return statistics.linear_regression([math.log(n) for n in counts],
                                        [math.log(t) for t in times]).slope


def pairs_of_methods(points, *keys):
    """For each value of the keys, in order: MegaViews' points and ManyLoDs'."""
    groups = {}
    for point in points:
        key = tuple(point["values"][k] for k in keys)
        groups.setdefault(key, {}).setdefault(point["settings"]["method"], []).append(point)
    return {key: (g["megaviews"], g["manylods"]) for key, g in groups.items()
            if len(g.get("megaviews", [])) == len(g.get("manylods", [])) > 0}


def rows_of(points, key, label):
    """A row a value of the key, its columns TIMES after the label."""
    rows = []
    for (value,), (mega, many) in pairs_of_methods(points, key).items():
        seconds = [[maps_ms(p) / 1000 for p in side] for side in (mega, many)]
        pairs = [statistics.mean(p["pairs"]["processed"] for p in side) / 1e6
                 for side in (mega, many)]
        ratio = mean_and_interval([b / a for a, b in zip(*seconds)], 2)
        rows.append([label(value, mega), *(f"{statistics.mean(s):.2f}" for s in seconds),
                     f"**{ratio}**", f"{pairs[0]:.2f} / {pairs[1]:.2f}",
                     f"{statistics.mean(p['viewsPerRenderedNode'] for p in mega):.1f}"])
    return rows


def living(_, mega):
    return f"{statistics.mean(p['views']['alive'] for p in mega):,.0f}"


def table(head, rows):
    if not rows:
        return "Nothing could be measured.\n"
    lines = ["| " + " | ".join(head) + " |",
             "|" + "|".join(["---"] + ["--:"] * (len(head) - 1)) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


TIMES = ["MegaViews, s", "ManyLoDs, s", "ratio", "M pairs", "views a drawn node"]


def exponents(points):
    """One sentence on how the times of both methods grow, where that can be seen."""
    groups = pairs_of_methods(points, "vpls")
    if len(groups) < 2:
        return ""
    said = []
    for i, name in enumerate(("MegaViews", "ManyLoDs")):
        counts = [g[i][0]["views"]["alive"] for g in groups.values()]
        times = exponent(counts, [statistics.mean(map(maps_ms, g[i])) for g in groups.values()])
        work = exponent(counts, [statistics.mean(p["pairs"]["processed"] for p in g[i])
                                 for g in groups.values()])
        said.append(f"{name} {times:.2f} (pairs {work:.2f})")
    return "\nExponents of time: " + ", ".join(said) + ".\n"


def parts(points):
    """Stages and memory of the largest of a sweep, of both methods."""
    largest = max(p["values"]["vpls"] for p in points)
    rows = []
    for method in ("megaviews", "manylods"):
        point = next(p for p in points
                     if p["values"]["vpls"] == largest and p["settings"]["method"] == method)
        ms = {name: value["median"] for name, value in point["stages"].items()}
        mib = {name: value / 2**20 for name, value in point["memory"].items()}
        views = sum(ms.get(name, 0) for name in ("trace views", "sort views", "view hierarchy"))
        maps = mib.get("working maps", 0) + mib.get("final maps", 0)
        rows.append([method, f"{views:.0f}", f"{ms.get('traverse', 0):.0f}", f"{ms.get('fuse', 0):.0f}",
                     f"{mib.get('pair queue', 0):.0f}", f"{maps:.0f}",
                     f"{mib['scene octree'] + mib['view octree']:.0f}"])
    return table(["largest", "views, ms", "traverse, ms", "fuse, ms", "queue, MiB", "maps, MiB",
                  "octrees, MiB"], rows)


# ---- figures

def figure_10(scene):
    text = ""
    counts = [FIRST_VIEWS]
    while 4 * counts[-1] <= scene.args.views:
        counts.append(4 * counts[-1])
    for distribution, title in (("single", "single bounce"), ("bounces", "4 bounces")):
        points = scene.methods(f"10-{distribution}", distribution, counts)
        text += f"\n{title}:\n\n" + table(["living views", *TIMES], rows_of(points, "vpls", living))
        text += exponents(points)
        if distribution == "single" and points:
            text += "\n" + parts(points)
    return text


def figure_11(scene):
    most = [scene.args.views]
    points = scene.methods("11", "random", most)
    mega = [statistics.mean(maps_ms(p) for p in side if p["settings"]["method"] == "megaviews")
            for side in (points, scene.methods("11-single", "single", most))]
    return (table(["living views", *TIMES], rows_of(points, "vpls", living)) +
            f"\nRandom views take {mega[0] / mega[1]:.1f} times as long as single bounces.\n")


def figure_12(scene):
    count = min(scene.args.views, 4096)
    points = scene.methods("12", "single", [count], ["--hole-fill", "on"],
                           {"view-res": RESOLUTIONS})
    return table(["texels", *TIMES], rows_of(points, "view-res", lambda value, _: f"{value}²"))


def error_cells(point):
    errors = point["errors"]["exact"] or {}
    return [f"{errors.get(metric, math.nan):.{digits}f}"
            for metric, digits in (("psnr", 1), ("ssim", 3), ("relmse", 3))]


def forced(point):
    pairs = point["pairs"]
    return f"{100 * pairs['forced'] / max(pairs['rendered'], 1):.1f}"


def figure_13(scene):
    rows = []
    for levels in LEVELS:
        depths = ["--scene-depth", str(levels), "--view-depth", str(levels)]
        time = scene.methods(f"13-{levels}", "bounces", [scene.args.views], depths,
                             {"seed": scene.args.seeds[:1]})
        error = scene.errors(f"13-{levels}-error", [*depths, "--gather-samples", "0"],
                             {"method": ["megaviews"]})
        for mega, many in pairs_of_methods(time, "vpls").values():
            rows.append([str(levels), f"{maps_ms(mega[0]) / 1000:.2f}", f"{maps_ms(many[0]) / 1000:.2f}",
                         forced(mega[0]), forced(many[0]), *error_cells(error[0])])
    return table(["levels", "MegaViews, s", "ManyLoDs, s", "larger than a texel, %", "ManyLoDs, %",
                  "PSNR dB", "SSIM", "relMSE"], rows)


def figure_14(scene):
    points = scene.errors("14", ["--hole-fill", "on", "--gather-samples", "0"],
                          {"view-res": RESOLUTIONS, "method": ["megaviews", "manylods"]})
    return table(["texels, method", "maps, s", "PSNR dB", "SSIM", "relMSE"],
                 [[f"{p['settings']['view-res']}², {p['settings']['method']}",
                   f"{maps_ms(p) / 1000:.2f}", *error_cells(p)] for p in points])


def figure_16(scene):
    points = scene.errors("16", ["--gather-samples", "64"],
                          {"cull-level": [0, 6], "gather-candidates": [1, 32],
                           "method": ["megaviews"]})
    return table(["views sampled", "gather, s", "PSNR dB", "SSIM", "relMSE"],
                 [[("culled at level 6" if p["values"]["cull-level"] else "all") +
                   (", by importance" if p["values"]["gather-candidates"] > 1 else ""),
                   f"{p['ms']['gather']['median'] / 1000:.2f}", *error_cells(p)] for p in points])


def figure_17(scene):
    counts = [min(4096, scene.args.views), scene.args.views]
    points = scene.methods("17", "particles", sorted(set(counts)))
    return table(["particles", *TIMES], rows_of(points, "vpls", living))


def figure_rules(scene):
    rows, flags = [], []
    count = min(scene.args.views, 16384)
    for i, (name, step) in enumerate(STEPS):
        flags = [*flags, *step]
        error = scene.errors(f"rules-{i}-error", [*flags, "--gather-samples", "0"],
                             {"method": ["megaviews"]})
        time = scene.methods(f"rules-{i}", "bounces", [count], flags,
                             {"seed": scene.args.seeds[:1]})
        rows += [[name, *cells, *error_cells(error[0])]
                 for cells in (row[1:] for row in rows_of(time, "vpls", living))]
    return table(["step", *TIMES, "PSNR dB", "SSIM", "relMSE"], rows)


FIGURES = {
    "10": ("Time against views [fig. 10]", figure_10),
    "11": ("Random views [fig. 11]", figure_11),
    "12": ("Resolution of the maps: time [fig. 12]", figure_12),
    "13": ("Levels of the octrees [fig. 13]", figure_13),
    "14": ("Resolution of the maps: error [fig. 14, 15]", figure_14),
    "16": ("Gather culling [fig. 16]", figure_16),
    "17": ("Particles [fig. 17]", figure_17),
    "rules": ("From published to corrected", figure_rules)}


def arguments():
    parser = parser_of(__doc__, out=pathlib.Path("measured-paper"), resolution="160x90")
    parser.add_argument("--figures", default=",".join(FIGURES))
    parser.add_argument("--views", default="64K", help="the most of a figure")
    parser.add_argument("--error-views", default="2K", help="of pictures that are compared")
    parser.add_argument("--seeds", default="0,1,2")
    args = parse(parser, sys.argv[1:])
    args.views, args.error_views = number(args.views), number(args.error_views)
    args.seeds = [number(seed) for seed in args.seeds.split(",")]
    args.figures = args.figures.split(",")
    for figure in args.figures:
        if figure not in FIGURES:
            raise Failure(2, f"--figures has no '{figure}'; there are {', '.join(FIGURES)}")
    return args


def main():
    args = arguments()
    code, text = 0, ""
    for name, place in scenes_of(args.scenes):
        scene = Scene(args, name, place)
        for figure in args.figures:
            title, measure = FIGURES[figure]
            try:
                body = measure(scene)
            except Failure as failure:
                print(f"paper.py: {failure}", file=sys.stderr)
                code, body = failure.code, f"{failure}\n"
            text += f"## {name}: {title}\n\n{body}\n"
            print(f"## {name}: {title}\n\n{body}", flush=True)
            write_whole(args.out / "paper.md", text)
    return code


if __name__ == "__main__":
    run_script(main)
