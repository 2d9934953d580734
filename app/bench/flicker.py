#!/usr/bin/env python3
"""Measures how methods flicker while the light moves: beside the exact light of the same views.

    app/bench/flicker.py FOLDER|FILE|builtin:NAME ... [--out measured-flicker] [--programs build]
                         [--methods megaviews,...] [--resolution 160x90] [--vpls 2K]
                         [--frames 60] [--frame-rate 30] [-- FLAGS of the viewer]

Renders every scene's animation by each method and by exact, indirect light alone, and compares them
frame by frame (docs/benchmark.md). Writes OUT/flicker.md and OUT/flicker.json, and keeps what is
measured: run it again to go on after an interruption. Needs NumPy and OpenImageIO's Python module.
"""

import json
import pathlib
import sys

import numpy
import OpenImageIO as oiio

from scene_runs import (METHODS, Failure, asked, beside, kept, measure_scenes, milliseconds, parse,
                        parser_of, run, run_script)


def own_change(frames, exact):
    """Mean |difference of consecutive frames| as a share of the mean of exact; NaN if it is black.

    Frames are arrays of F x H x W x 3. A pixel that is not finite somewhere is left out; one that
    shows no surface is black in every frame, and the ratio of two means is the same without it.
    """
    good = numpy.isfinite(frames).all(axis=(0, 3)) & numpy.isfinite(exact).all(axis=(0, 3))
    light = exact[:, good].mean(dtype=float) if good.any() else 0.0
    if light == 0:
        return float("nan")
    return float(numpy.abs(numpy.diff(frames[:, good].astype(float), axis=0)).mean() / light)


def flicker(frames, exact):
    """Mean |difference between consecutive frames of (method - exact)|, as a share likewise."""
    return own_change(frames - exact, exact)


def picture_of(base, frame):
    return beside(base, f"{frame:04}.exr")


def read(base, count):
    """F x H x W x 3, and the attributes of the first frame."""
    pictures = []
    for frame in range(count):
        file = str(picture_of(base, frame))
        picture = oiio.ImageBuf(file)
        pixels = picture.get_pixels(oiio.FLOAT)
        if pixels is None or picture.has_error:
            raise Failure(3, f"'{file}' cannot be read: {picture.geterror()}")
        pictures.append(pixels[..., :3])
        if frame == 0:
            first = picture.spec()
    return numpy.stack(pictures), first


def errors(args, base, frames, exact, shown):
    """PSNR and relMSE of all frames as one picture, by the project's own definitions."""
    files = []
    for name, pictures in (("frames", frames), ("exact", exact)):
        files.append(beside(base, f"{name}.npy"))
        numpy.save(files[-1], pictures.reshape(-1, *pictures.shape[2:]).astype(numpy.float32))
    written = beside(base, "errors.json")
    tonemap = json.loads(shown.get_string_attribute("megaviews.settings"))["tonemap"]
    try:
        run([str(args.programs / "megaviews-bench"), "compare", *map(str, files), "--metrics",
             "psnr,relmse", "--exposure", shown.get_string_attribute("megaviews.exposure"),
             "--tonemap", tonemap, "--json", str(written)])
        return json.loads(written.read_text())["values"]
    finally:
        for file in (*files, written):
            file.unlink(missing_ok=True)


def cost(stats):
    """Of a frame: median milliseconds, and MiB of maps and of queues, lists or cuts."""
    memory = stats["methods"][0]["memoryBytes"]
    return {"ms": sum(milliseconds(stats)), "mapsMs": milliseconds(stats)[1],
            "mapsMiB": memory["maps"] / 2**20, "queueMiB": memory["queue"] / 2**20}


def measure(args, name, scene, method):
    """One row of the table; exact has to be measured before the others."""
    base = args.out / f"{name}-{method}"
    settings = ["--vpls", args.vpls, "--frames", str(args.frames), "--frame-rate",
                str(args.frame_rate)]

    stats = beside(base, "stats.json")

    def render():
        run([str(args.programs / "megaviews"), "--headless", scene, "--no-config", "--quiet",
             "--environment", "none",
             "--method", method, "--resolution", args.resolution, "--references",
             str(args.out / "references"), *args.flags, *settings, "--view", "indirect",
             "--stats", str(stats), "-o", str(beside(base, "exr"))])
        frames, _ = read(base, args.frames)
        exact, shown = read(args.out / f"{name}-exact", args.frames)
        change = own_change(frames, exact)
        if numpy.isnan(change):
            raise Failure(3, f"'{scene}': exact indirect light is black, nothing is a share of it")
        values = errors(args, base, frames, exact, shown)
        return {"scene": name, "method": method, "flicker": flicker(frames, exact),
                "ownChange": change, "relmse": values["relmse"], "psnr": values["psnr"],
                **(cost(json.loads(stats.read_text())) if method != "exact" else {})}

    record = beside(base, "json")
    if not picture_of(base, args.frames - 1).exists():
        record.unlink(missing_ok=True)
    return kept(record, asked(args, scene, method, args.resolution, *settings, *args.flags), render)


def with_ratios(rows):
    rays = {row["scene"]: row["flicker"] for row in rows if row["method"] == "shadow-rays"}
    for row in rows:
        share = rays.get(row["scene"])
        row["toShadowRays"] = row["flicker"] / share if share else None
    return rows


def paid(row):
    if "ms" not in row:
        return "– | –"
    return f"{row['ms']:.0f} ({row['mapsMs']:.0f}) | {row['mapsMiB']:.1f} + {row['queueMiB']:.1f}"


def table(args, rows):
    text = [f"{args.frames} frames, {args.frame_rate:g} a second, {args.resolution}, {args.vpls} "
            f"views{', ' + ' '.join(args.flags) if args.flags else ''}. Flicker: mean |difference "
            "between consecutive frames of (method − exact)|; own change: of the method's frames "
            "alone; both in % of the mean of exact, which has the same views. Errors are against "
            "exact, over all frames. Time: median of views, maps, gather and filter, the maps' part "
            "in brackets; memory: of maps, and of queues, lists or cuts.", "",
            "| scene | method | flicker % | : shadow-rays | own change % | relMSE | PSNR dB | ms "
            "| MiB |", "|---|---|--:|--:|--:|--:|--:|--:|--:|"]
    for r in rows:
        ratio = "–" if r["toShadowRays"] is None else f"{r['toShadowRays']:.2f}"
        psnr = "–" if r["psnr"] is None else f"{r['psnr']:.1f}"
        text.append(f"| {r['scene']} | {r['method']} | {100 * r['flicker']:.2f} | {ratio} "
                    f"| {100 * r['ownChange']:.2f} | {r['relmse']:.4f} | {psnr} | {paid(r)} |")
    return "\n".join(text) + "\n"


def arguments():
    parser = parser_of(__doc__, out=pathlib.Path("measured-flicker"), resolution="160x90",
                       methods=METHODS)
    parser.add_argument("--vpls", default="2K")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--frame-rate", type=float, default=30)
    args = parse(parser, sys.argv[1:])
    if args.frames < 2:
        raise Failure(2, f"--frames is {args.frames}, and flicker is between frames: at least 2")
    args.methods = ["exact", *(m for m in args.methods if m != "exact")]
    return args


def main():
    args = arguments()

    def rows(name, scene):
        animations = [str(args.programs / "megaviews"), "--list", "animations", scene]
        if not run(animations).stdout.strip():
            raise Failure(3, f"'{scene}' has no animation: no light in it moves")
        for method in args.methods:
            yield measure(args, name, scene, method)

    return measure_scenes(args, "flicker", rows, lambda rows: table(args, with_ratios(rows)))


if __name__ == "__main__":
    run_script(main)
