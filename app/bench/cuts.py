#!/usr/bin/env python3
"""Measures what cuts that ManyLoDs keeps from frame to frame save on the GPU, and what they cost.

    app/bench/cuts.py FOLDER|FILE|builtin:NAME ... [--out measured-cuts] [--programs build]
                      [--frame-rates 0,120,30,10,2] [--trees octree,binary] [--vpls 1K]
                      [--frames 8] [--repeats 3] [--resolution 16x9] [-- FLAGS of the viewer]

Renders a few frames of every scene's animation by MegaViews and by ManyLoDs with each kind of cut,
so many frames a second; 0 a second stands still. Views are traced, so that they keep their slots.
All kinds are run in turn, --repeats times: times are the median of the ratios to basic cuts of the
same turn (docs/benchmark.md). Writes OUT/cuts.md and OUT/cuts.json, and keeps what is measured: run
it again to go on after an interruption. Needs OpenImageIO's Python module.
"""

import json
import math
import pathlib
import statistics
import sys

import OpenImageIO as oiio

from scene_runs import (Failure, asked, beside, kept, measure_scenes, milliseconds, parse,
                        parser_of, run, run_script)

# Each with its flags; the second is what ratios are to.
KINDS = {"MegaViews": ["--method", "megaviews"],
         "basic": ["--method", "manylods", "--cut", "basic"],
         "incremental": ["--method", "manylods", "--cut", "incremental"],
         "lazy": ["--method", "manylods", "--cut", "lazy"]}
BASIC = "basic"
TREES = ("octree", "binary")
COUNTS = ("nodes", "kept", "split", "merged", "coarse", "iterations")


def counts_of(base, frames):
    """Means over the frames after the first, of pairs and, where cuts are kept, of their nodes."""
    sums = {}
    for frame in range(1, frames + 1):
        file = str(base.with_name(f"{base.name}.{frame:04}.exr"))
        picture = oiio.ImageBuf(file)
        text = picture.spec().get_string_attribute("megaviews.methods")
        if picture.has_error or not text:
            raise Failure(3, f"'{file}' cannot be read: {picture.geterror()}")
        method = json.loads(text)[0]
        cuts = method.get("cuts", {})
        found = {"pairs": method["pairs"]["processed"], **{key: cuts.get(key) for key in COUNTS}}
        for key, value in found.items():
            sums.setdefault(key, []).append(value)
    return {key: None if None in values else statistics.mean(values)
            for key, values in sums.items()}


def measure(args, name, scene, rate, tree, kind, turn):
    """One run; a frame that is not measured comes first, so that cuts are kept from the first."""
    base = args.out / f"{name}-{rate:g}-{tree}-{kind}"
    motion = ["--frame-rate", f"{rate:g}"] if rate > 0 else ["--animation", "none"]
    settings = ["--vpls", args.vpls, "--frames", str(args.frames + 1), "--warmup", "1", *motion,
                "--scene-tree", tree, *KINDS[kind]]

    def render():
        stats = beside(base, "stats.json")
        run([str(args.programs / "megaviews"), "--headless", scene, "--no-config", "--quiet",
             "--environment", "none", "--placement", "traced", "--scene-depth", "9",
             "--view-depth", "9", "--gather-samples", "1", "--filter", "off",
             "--resolution", args.resolution, *args.flags, *settings,
             "--stats", str(stats), "-o", f"{base}.exr"])
        return {"scene": name, "rate": rate, "tree": tree, "kind": kind,
                **counts_of(base, args.frames),
                "mapsMs": milliseconds(json.loads(stats.read_text()))[1]}

    return kept(args.out / f"{base.name}-{turn}.json",
                asked(args, scene, turn, args.resolution, *settings, *args.flags), render)


def rows_of(args, name, scene, rate):
    """A row a tree and kind. Times are ratios within a turn, in which all kinds follow another."""
    turns = []
    for turn in range(args.repeats):
        turns.append({(tree, kind): measure(args, name, scene, rate, tree, kind, turn)
                      for tree in args.trees for kind in KINDS})
    rows = []
    for key, row in turns[0].items():
        basic, shared = ((key[0], BASIC), (key[0], "MegaViews"))
        def ratio(to):
            return statistics.median(turn[key]["mapsMs"] / turn[to]["mapsMs"] for turn in turns)
        rows.append({**row, "mapsMs": statistics.median(turn[key]["mapsMs"] for turn in turns),
                     "pairsToBasic": row["pairs"] / turns[0][basic]["pairs"],
                     "msToBasic": ratio(basic), "msToMegaViews": ratio(shared)})
    return rows


def share(row, key):
    return "–" if row[key] is None else f"{100 * row[key] / row['nodes']:.2f}"


def table(args, rows):
    text = [f"{args.vpls} views, traced, 9 levels, {args.frames} frames after the first"
            f"{', ' + ' '.join(args.flags) if args.flags else ''}. Pairs that are tested a frame, "
            "beside those of basic cuts through the same tree; of the cuts' nodes the shares that "
            "are kept without a test, split, merged, and too coarse; rounds of tests; milliseconds "
            "of the maps (medians), and beside those of basic cuts and of MegaViews in the same "
            f"turn, the median of {args.repeats}.", "",
            "| scene | frames a second | tree | cut | pairs, M | : basic | kept % | split % "
            "| merged % | coarse % | rounds | ms | : basic | : MegaViews |",
            "|---|--:|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for r in rows:
        rounds = "–" if r["iterations"] is None else f"{r['iterations']:.0f}"
        shares = " | ".join(share(r, key) for key in ("kept", "split", "merged", "coarse"))
        text.append(f"| {r['scene']} | {r['rate']:g} | {r['tree']} | {r['kind']} "
                    f"| {r['pairs'] / 1e6:.3f} | {r['pairsToBasic']:.2f} | {shares} | {rounds} "
                    f"| {r['mapsMs']:.0f} | {r['msToBasic']:.2f} | {r['msToMegaViews']:.2f} |")
    return "\n".join(text) + "\n"


def rates_of(text):
    try:
        values = [float(value) for value in text.split(",")]
    except ValueError as error:
        raise Failure(2, f"--frame-rates is no list of numbers: '{text}'") from error
    for value in values:
        if not (value >= 0 and math.isfinite(value)):
            raise Failure(2, f"--frame-rates has {value:g}, which is no number of frames a second")
    return values


def arguments():
    parser = parser_of(__doc__, out=pathlib.Path("measured-cuts"), resolution="16x9")
    parser.add_argument("--frame-rates", default="0,120,30,10,2")
    parser.add_argument("--trees", default=",".join(TREES))
    parser.add_argument("--vpls", default="1K")
    parser.add_argument("--frames", type=int, default=8)
    parser.add_argument("--repeats", type=int, default=3)
    args = parse(parser, sys.argv[1:])
    args.rates = rates_of(args.frame_rates)
    args.trees = args.trees.split(",")
    for tree in args.trees:
        if tree not in TREES:
            raise Failure(2, f"--trees has no '{tree}'; there are {', '.join(TREES)}")
    for option in ("frames", "repeats"):
        if getattr(args, option) < 1:
            raise Failure(2, f"--{option} is {getattr(args, option)}, and has to be at least 1")
    return args


def main():
    args = arguments()

    def rows(name, scene):
        for rate in args.rates:
            yield from rows_of(args, name, scene, rate)

    return measure_scenes(args, "cuts", rows, lambda rows: table(args, rows))


if __name__ == "__main__":
    run_script(main)
