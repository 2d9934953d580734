#!/usr/bin/env python3
"""Draws what megaviews-bench sweep measured: time, sharing and memory against views, time against
error, and the stages of the frame. Reads the sweep's JSON alone; the commands that made the data
stand below every picture. Needs matplotlib (Debian: python3-matplotlib)."""

import argparse
import collections
import json
import math
import os
import sys
import textwrap

USAGE, INPUT, OUTPUT = 2, 3, 5

# Okabe and Ito's palette: told apart with every form of colour vision.
METHOD_COLORS = {
    "megaviews": "#0072B2", "manylods": "#D55E00", "raster": "#009E73", "ism": "#CC79A7",
    "vir": "#F0E442", "rays": "#E69F00", "shadow-rays": "#8B4513", "none": "#808080",
    "exact": "#000000", "pathtraced": "#56B4E9"}
COLORS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#808080", "#000000"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]
STAGES_SHOWN = 7  # the others are one
PICTURES = ["time", "sharing", "memory", "error", "stages"]
TIMES = {"maps": "time of the maps", "gather": "time of the gather",
         "indirect": "time of indirect light, maps and gather", "frame": "time of the frame"}
VIEW_KEYS = ("vpls", "particles")


def fail(code, message):
    print(f"plot.py: {message}", file=sys.stderr)
    sys.exit(code)


def load(files):
    """Points of all files, each with its file's scene, and the commands that made them."""
    points, commands, clocks = [], [], []
    for file in files:
        try:
            with open(file, encoding="utf-8") as stream:
                sweep = json.load(stream)
        except OSError as error:
            fail(INPUT, f"'{file}' cannot be read: {error.strerror}")
        except ValueError as error:
            fail(INPUT, f"'{file}' is no JSON: {error}")
        if not isinstance(sweep, dict) or sweep.get("kind") != "megaviews sweep":
            fail(INPUT, f"'{file}' was not written by megaviews-bench sweep")
        if sweep.get("schema") != 1:
            fail(INPUT, f"'{file}' has schema {sweep.get('schema')}; this script reads 1")
        try:
            commands.append(sweep["command"])
            if sweep.get("clock"):
                clocks.append(f"{sweep['gl']['renderer']}, {sweep['clock']}")
            for i, point in enumerate(sweep["points"]):
                if not isinstance(point, dict):
                    fail(INPUT, f"'{file}': points[{i}] is no object")
                if point["refusal"] is not None:
                    continue
                for key in ("values", "settings"):
                    if not isinstance(point[key], dict):
                        fail(INPUT, f"'{file}': points[{i}].{key} is no object")
                if not isinstance(point["settings"]["method"], str):
                    fail(INPUT, f"'{file}': points[{i}].settings.method is no name")
                points.append(dict(point, scene=sweep["scene"]["name"], search_of=sweep["search"]))
        except KeyError as missing:
            fail(INPUT, f"'{file}' lacks {missing}")
        except (TypeError, AttributeError):
            fail(INPUT, f"'{file}' is not as megaviews-bench sweep writes it")
    return points, commands, sorted(set(clocks))


def at(point, path, default=None):
    """A member by its path; nothing where a part is missing or null."""
    for part in path.split("/"):
        if not isinstance(point, dict) or point.get(part) is None:
            return default
        point = point[part]
    return point


def method(point):
    return point["settings"]["method"]


def views(point):
    return at(point, "views/requested", 0)


def count(n):
    """65536 as 64K, like the papers."""
    for size, suffix in ((1 << 20, "M"), (1 << 10, "K")):
        if n >= size and n % size == 0:
            return f"{n // size:.0f}{suffix}"
    return f"{n:g}"


def duration(ms):
    return f"{ms / 1000:.2g} s" if ms >= 1000 else f"{ms:.2g} ms" if ms < 99.5 else f"{ms:.0f} ms"


def value_text(key, value):
    if isinstance(value, list):
        return ("x" if len(value) == 2 else ",").join(f"{v:g}" for v in value)
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, (int, float)):
        return count(value) if key in VIEW_KEYS else f"{value:g}"
    return "auto" if value is None else str(value)


def chosen(points, wanted):
    """Those with the values that --where asks for; a sweep without such a key has all of its."""
    left = points
    for key, value in wanted.items():
        there = list(collections.OrderedDict.fromkeys(
            value_text(key, p["values"][key]) for p in points if key in p["values"]))
        if not there:
            swept = list(collections.OrderedDict.fromkeys(k for p in points for k in p["values"]))
            fail(USAGE, f"--where: '{key}' was not swept; {', '.join(swept)} were")
        if value not in there:
            fail(USAGE, f"--where {key}: '{value}' was not measured; {', '.join(there)} were")
        left = [p for p in left
                if key not in p["values"] or value_text(key, p["values"][key]) == value]
    if not left:
        fail(USAGE, "--where: no point has all of these values")
    return left


def series_name(point, scenes):
    """Method, distribution and, of several scenes, which."""
    name = [method(point)]
    if "distribution" in point["values"]:
        name.append(point["values"]["distribution"])
    if len(scenes) > 1:
        name.append(os.path.basename(point["scene"]))
    return tuple(name)


def split_series(points, x):
    """Points by method, distribution and scene; of every other key that was swept, but x, only the
    first value is taken, and named in the second result."""
    free = (VIEW_KEYS if x == "views" else (x,)) + ("method", "distribution")
    fixed = {}
    keys = list(collections.OrderedDict.fromkeys(k for p in points for k in p["values"]))
    for key in keys:
        if key in free:
            continue
        there = list(collections.OrderedDict.fromkeys(
            value_text(key, p["values"][key]) for p in points if key in p["values"]))
        fixed[key] = there[0]
    series = collections.OrderedDict()
    scenes = {p["scene"] for p in points}
    for p in points:
        if any(key in p["values"] and value_text(key, p["values"][key]) != value
               for key, value in fixed.items()):
            continue
        series.setdefault(series_name(p, scenes), []).append(p)
    return series, [f"{key} {value}" for key, value in fixed.items()]


def styles(names):
    """Colour by method; marker and lines by what else tells series apart."""
    others = list(collections.OrderedDict.fromkeys(name[1:] for name in names))
    out = {}
    for name in names:
        i = others.index(name[1:])
        color = METHOD_COLORS.get(name[0], COLORS[len(out) % len(COLORS)])
        out[name] = dict(color=color, marker=MARKERS[i % len(MARKERS)],
                         linestyle=["-", (0, (6, 1)), (0, (3, 1, 1, 1)), (0, (1, 1))][i % 4])
    return out


def fit(xs, ys):
    """Exponent and factor of y = factor * x^exponent, least squares of the logarithms."""
    logs = [(math.log(x), math.log(y)) for x, y in zip(xs, ys) if x > 0 and y > 0]
    if len({x for x, _ in logs}) < 2:
        return None
    n = len(logs)
    mx, my = sum(x for x, _ in logs) / n, sum(y for _, y in logs) / n
    exponent = sum((x - mx) * (y - my) for x, y in logs) / sum((x - mx) ** 2 for x, _ in logs)
    return exponent, math.exp(my - exponent * mx)


def pareto(pairs):
    """Of (time, error), those that no other point beats in both, by rising time."""
    front = []
    for time, error in sorted(pairs):
        if not front or error < front[-1][1]:
            front.append((time, error))
    return front


class Pictures:
    def __init__(self, plt, options, points, commands, clocks):
        self.plt, self.options, self.commands, self.clocks = plt, options, commands, clocks
        self.scenes = ", ".join(collections.OrderedDict.fromkeys(
            os.path.basename(p["scene"]) for p in points))
        self.written = []

    def start(self, title, fixed, xlabel, ylabel):
        fig, ax = self.plt.subplots(figsize=(8, 5))
        notes = f"  ({', '.join(fixed)})" if fixed else ""
        ax.set_title(textwrap.fill(f"{self.scenes}: {title}{notes}", 90), fontsize=11, loc="left")
        ax.set_xlabel(xlabel)
        ax.set_ylabel(ylabel)
        ax.grid(True, which="major", color="#dddddd", linewidth=0.8)
        ax.set_axisbelow(True)
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)
        return fig, ax

    def finish(self, name, fig):
        lines = []
        for command in self.commands:
            lines += textwrap.wrap(command, 150, subsequent_indent="    ",
                                   break_long_words=True, break_on_hyphens=False)
        lines += self.clocks
        height = 0.145 * len(lines) + 0.1  # inches
        fig.set_size_inches(8, 5 + height)
        fig.text(0.012, 0.07 / (5 + height), "\n".join(lines), fontsize=6.2, color="#555555",
                 family="monospace", va="bottom")
        fig.tight_layout(rect=(0, height / (5 + height), 1, 1))
        file = os.path.join(self.options.out, f"{name}.{self.options.format}")
        fig.savefig(file, dpi=100, metadata={"Date": None} if self.options.format == "svg"
                    else {"Software": None})
        self.plt.close(fig)
        self.written.append(file)

    def log_axis(self, axis, values):
        """Plain numbers, and enough of them where less than three decades are shown."""
        from matplotlib import ticker
        decades = math.log10(max(values) / min(values))
        axis.set_major_locator(ticker.LogLocator(
            subs=(1, 2, 5) if decades < 1.5 else (1, 3) if decades < 3 else (1,)))
        axis.set_major_formatter(ticker.FuncFormatter(lambda x, _: f"{x:g}"))
        axis.set_minor_formatter(ticker.NullFormatter())

    @staticmethod
    def legend(ax):
        """Beside the picture, where it hides nothing."""
        ax.legend(fontsize=8.5, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))

    def x_axis(self, ax, xs):
        """Counts of views as the papers write them; of another setting, the values measured."""
        if self.options.x != "views":
            ax.set_xscale("log")
            ax.set_xticks(sorted(set(xs)))
            ax.set_xticklabels([f"{x:g}" for x in sorted(set(xs))])
            ax.minorticks_off()
            return
        low, high = math.log2(min(xs)), math.log2(max(xs))
        ticks = [2.0 ** e for e in range(math.floor(low), math.ceil(high) + 1)]
        while len(ticks) > 9:
            ticks = ticks[::2]
        ax.set_xscale("log", base=2)
        ax.set_xticks(ticks)
        ax.set_xticklabels([count(t) for t in ticks])
        ax.minorticks_off()

    def x(self, point):
        """Of the setting that pictures are drawn against: --x."""
        x = views(point) if self.options.x == "views" else point["values"].get(self.options.x)
        return x if isinstance(x, (int, float)) and not isinstance(x, bool) else None

    def against_x(self, name, title, ylabel, points, value, fitted):
        unit = self.options.x
        series, fixed = split_series(points, unit)
        series = {k: sorted((self.x(p), value(p)) for p in ps if self.x(p) and value(p))
                  for k, ps in series.items()}
        series = {k: v for k, v in series.items() if v}
        if len({x for v in series.values() for x, _ in v}) < 2:
            return f"{name}: needs two {'counts of views' if unit == 'views' else f'values of {unit}'}"
        most = max(x for v in series.values() for x, _ in v)
        fig, ax = self.start(title, fixed, unit, ylabel)
        look = styles(list(series))
        extrapolated = False
        for key, pairs in series.items():
            xs, ys = zip(*pairs)
            label = ", ".join(key)
            law = fit(xs, ys) if fitted else None
            if law:
                label += f": {unit}$^{{{law[0]:.2f}}}$"
            ax.plot(xs, ys, label=label, linewidth=1.8, markersize=5, **look[key])
            if law and max(xs) < most:  # beyond what was measured: marked as such
                far = [x for x in sorted({x for v in series.values() for x, _ in v})
                       if x > max(xs)]
                ends = [max(xs)] + far
                ax.plot(ends, [law[1] * x ** law[0] for x in ends], color=look[key]["color"],
                        linestyle=":", linewidth=1.5)
                ax.plot(far, [law[1] * x ** law[0] for x in far], linestyle="none",
                        marker=look[key]["marker"], markersize=5, markerfacecolor="white",
                        markeredgecolor=look[key]["color"])
                extrapolated = True
        if extrapolated:
            ax.plot([], [], color="#555555", linestyle=":", marker="o", markersize=5,
                    markerfacecolor="white", label="extrapolated")
        ax.set_yscale("log")
        self.log_axis(ax.yaxis, ax.get_ylim())
        self.x_axis(ax, [x for v in series.values() for x, _ in v])
        self.legend(ax)
        self.finish(name, fig)
        return None

    def error(self, points):
        """Time of indirect light against error, every point measured, and who is not beaten."""
        path = f"errors/{self.options.against}/{self.options.metric}"
        there = [p for p in points
                 if at(p, path) is not None and at(p, "ms/indirect/median")]
        if not there:
            return f"error: no point has {path.replace('/', '.')} and a time"
        higher = self.options.metric in ("psnr", "ssim")
        unit = {"psnr": " in dB"}.get(self.options.metric, "")
        fig, ax = self.start("time against error", [], "indirect light: maps and gather, ms",
                             f"{self.options.metric}{unit} against {self.options.against}, "
                             + ("higher" if higher else "lower") + " is better")
        names = collections.OrderedDict()
        scenes = {p["scene"] for p in there}
        for p in there:
            names.setdefault(series_name(p, scenes), []).append(
                (at(p, "ms/indirect/median"), at(p, path)))
        look = styles(list(names))
        for name, pairs in names.items():
            xs, ys = zip(*pairs)
            style = dict(look[name], linestyle="none")
            ax.plot(xs, ys, markersize=5, label=", ".join(name), **style)
        sign = -1 if higher else 1
        # Distributions and scenes are other pictures: each has its own front.
        groups = collections.OrderedDict()
        for name, pairs in names.items():
            groups.setdefault(name[1:], []).extend(pairs)
        for i, pairs in enumerate(groups.values()):
            front = [(t, sign * e) for t, e in pareto([(t, sign * e) for t, e in pairs])]
            ax.step([t for t, _ in front], [e for _, e in front], where="post", color="#333333",
                    linewidth=1.2, zorder=1, label="Pareto front" if i == 0 else None)
        ax.set_xscale("log")
        self.log_axis(ax.xaxis, ax.get_xlim())
        if not higher and all(at(p, path) > 0 for p in there):
            ax.set_yscale("log")
            self.log_axis(ax.yaxis, ax.get_ylim())
        self.legend(ax)
        self.finish("error", fig)
        return None

    def stages(self, points):
        """Where a frame's time goes, one bar a method and count of views, or value of --x."""
        series, fixed = split_series(points, self.options.x)
        bars = [(key, p) for key, ps in series.items() for p in ps
                if at(p, "stages") and self.x(p)]
        bars = [(k, p) for k, p in bars if at(p, "ms/indirect/median") is not None]
        if not bars:
            return "stages: no point has times"
        bars.sort(key=lambda bar: (bar[0][1:], self.x(bar[1])))  # methods side by side
        if len(bars) > 24:
            xs = sorted({self.x(p) for _, p in bars})
            kept = {xs[0], xs[len(xs) // 2], xs[-1]}
            bars = [bar for bar in bars if self.x(bar[1]) in kept][:24]
        totals = collections.Counter()
        for _, p in bars:
            whole = sum(ms["median"] for ms in p["stages"].values()) or 1
            for name, ms in p["stages"].items():
                totals[name] += ms["median"] / whole
        shown = [name for name, _ in totals.most_common(STAGES_SHOWN)]
        order = [name for name in bars[0][1]["stages"] if name in shown]
        order += [name for name in shown if name not in order]
        fig, ax = self.start("stages of a frame", fixed, "", "share of the frame's stages, %")
        bottoms = [0.0] * len(bars)
        wholes = [sum(ms["median"] for ms in p["stages"].values()) or 1 for _, p in bars]
        for i, name in enumerate(order + ["all others"]):
            if name == "all others":
                heights = [100 - b for b in bottoms]
            else:
                heights = [100 * at(p, f"stages/{name}/median", 0) / w
                           for (_, p), w in zip(bars, wholes)]
            ax.bar(range(len(bars)), heights, 0.75, bottom=bottoms, label=name,
                   color=COLORS[i % len(COLORS)] if name != "all others" else "#d0d0d0",
                   edgecolor="white", linewidth=0.6)
            bottoms = [b + h for b, h in zip(bottoms, heights)]
        for i, whole in enumerate(wholes):
            ax.text(i, 101, duration(whole), ha="center", va="bottom",
                    fontsize=8 if len(bars) < 10 else 6.5 if len(bars) < 16 else 5)
        ax.set_ylim(0, 108)
        ax.set_xticks(range(len(bars)))
        text = count if self.options.x == "views" else lambda x: f"{x:g}"
        labels = ["\n".join([*key, text(self.x(p))]) for key, p in bars]
        crowded = len(bars) > 8
        ax.set_xticklabels([l.replace("\n", " ") for l in labels] if crowded else labels,
                           fontsize=8, rotation=60 if crowded else 0,
                           ha="right" if crowded else "center",
                           rotation_mode="anchor" if crowded else "default")
        ax.grid(False)
        handles, names = ax.get_legend_handles_labels()
        ax.legend(handles[::-1], names[::-1], fontsize=8, frameon=False, loc="center left",
                  bbox_to_anchor=(1.0, 0.5))
        self.finish("stages", fig)
        return None


def memory_mib(point):
    parts = at(point, "memoryBytes", {})
    total = sum(at(parts, name, 0)
                for name in ("queue", "maps", "sceneHierarchy", "viewHierarchy"))
    return total / 2 ** 20 if method(point) != "none" else 0


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="+", metavar="SWEEP.json")
    parser.add_argument("--out", default=".", metavar="DIR", help="where the pictures go [.]")
    parser.add_argument("--format", default="png", choices=["png", "svg"])
    parser.add_argument("--text", action="store_true",
                        help="SVG with letters as text, in fonts of whoever reads it")
    parser.add_argument("--pictures", metavar="NAME,NAME",
                        help=f"which to draw, all of which must be possible "
                             f"[those that are, of {','.join(PICTURES)}]")
    parser.add_argument("--time", default="maps", choices=list(TIMES),
                        help="what is drawn against views [%(default)s]")
    parser.add_argument("--x", default="views", metavar="KEY",
                        help="a swept number to draw against instead of views")
    parser.add_argument("--against", default="exact", choices=["exact", "pathtraced"],
                        help="the reference of the error [%(default)s]")
    parser.add_argument("--metric", default="relmse", help="the error [%(default)s]")
    parser.add_argument("--where", action="append", default=[], metavar="KEY=VALUE",
                        help="draw the points with this value of a swept key alone; repeatable")
    options = parser.parse_args()
    options.pictures = options.pictures.split(",") if options.pictures else []
    for name in options.pictures:
        if name not in PICTURES:
            parser.error(f"--pictures: '{name}' is not one of {', '.join(PICTURES)}")
    for text in options.where:
        if "=" not in text:
            parser.error(f"--where: '{text}' is not KEY=VALUE")
    options.where = dict(text.split("=", 1) for text in options.where)
    return options


def main():
    options = arguments()
    points, commands, clocks = load(options.files)
    if not points:
        fail(INPUT, "no point was measured in " + ", ".join(options.files))
    swept = list(collections.OrderedDict.fromkeys(k for p in points for k in p["values"]))
    if options.x != "views" and options.x not in swept:
        fail(USAGE, f"--x: '{options.x}' was not swept; {', '.join(swept)} were")
    points = chosen(points, options.where)
    metrics = sorted({name for p in points for name in at(p, f"errors/{options.against}", {})})
    if metrics and options.metric not in metrics:
        fail(USAGE, f"--metric: '{options.metric}' was not measured; {', '.join(metrics)} were")
    try:
        import matplotlib
    except ImportError:
        fail(USAGE, "matplotlib is missing; on Debian: apt-get install python3-matplotlib")
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "megaviews"  # the same bytes from the same data
    if options.text:
        matplotlib.rcParams["svg.fonttype"] = "none"
    import matplotlib.pyplot as plt
    try:
        os.makedirs(options.out, exist_ok=True)
        pictures = Pictures(plt, options, points, commands, clocks)
        drawn = {
            "time": lambda: pictures.against_x(
                "time", TIMES[options.time], "ms", points,
                lambda p: at(p, f"ms/{options.time}/median", 0), fitted=True),
            "sharing": lambda: pictures.against_x(
                "sharing", "views that share a rendered node", "views a rendered node", points,
                lambda p: at(p, "viewsPerRenderedNode", 0), fitted=False),
            "memory": lambda: pictures.against_x(
                "memory", "memory of pairs, maps and hierarchies", "MiB", points, memory_mib,
                fitted=False),
            "error": lambda: pictures.error(points),
            "stages": lambda: pictures.stages(points)}
        for name in options.pictures or PICTURES:
            reason = drawn[name]()
            if not reason:
                continue
            if options.pictures:  # asked for by its name
                fail(INPUT, f"not drawn: {reason}")
            print(f"plot.py: not drawn: {reason}", file=sys.stderr)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        fail(INPUT, f"a point is not as megaviews-bench sweep writes it: {error!r}")
    except OSError as error:
        fail(OUTPUT, f"'{error.filename}' cannot be written: {error.strerror}")
    print("\n".join(pictures.written))


if __name__ == "__main__":
    main()
