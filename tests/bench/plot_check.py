"""What app/bench/plot.py draws, read from the figures instead of from pictures. Argument: plot.py."""
import argparse
import importlib.util
import math
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

spec = importlib.util.spec_from_file_location("plot", sys.argv[1])
plot = importlib.util.module_from_spec(spec)
sys.dont_write_bytecode = True
spec.loader.exec_module(plot)


def near(a, b):
    assert math.isclose(a, b, rel_tol=1e-9), (a, b)


def point(method, views, ms, relmse=None, **more):
    stages = {"traverse": {"median": 3 * ms}, "gather": {"median": ms}}
    return dict({"values": {"vpls": views, "method": method}, "settings": {"method": method},
                 "scene": "s", "views": {"requested": views},
                 "ms": {"maps": {"median": ms}, "indirect": {"median": 2 * ms}},
                 "stages": stages,
                 "errors": {"exact": {"relmse": relmse, "psnr": relmse and 1 / relmse},
                            "pathtraced": {"relmse": relmse and 9 * relmse}}}, **more)


def drawn(kind, points, **more):
    """Axes of the one figure of a kind."""
    options = dict(time="maps", x="views", against="exact", metric="relmse")
    options.update(more)
    pictures = plot.Pictures(plt, argparse.Namespace(**options), points, ["command"], [])
    figures = []
    pictures.finish = lambda name, figure: figures.append(figure)
    if kind == "time":
        reason = pictures.against_x("time", "t", "ms", points,
                                    lambda p: plot.at(p, "ms/maps/median"), fitted=True)
    else:
        reason = getattr(pictures, kind)(points)
    assert not reason, reason
    return figures[0].axes[0]


exponent, factor = plot.fit([1024, 4096, 16384], [3 * n ** 0.7 for n in (1024, 4096, 16384)])
near(exponent, 0.7)
near(factor, 3)
assert plot.fit([8, 8], [1, 2]) is None

assert plot.pareto([(3, 1), (1, 5), (2, 6), (2, 4), (4, 2)]) == [(1, 5), (2, 4), (3, 1)]
assert [plot.count(n) for n in (1000, 1024, 65536, 1 << 20, 1536)] == ["1000", "1K", "64K", "1M",
                                                                     "1536"]
memory = {"queue": 1 << 20, "maps": 2 << 20, "sceneHierarchy": 4 << 20, "viewHierarchy": 8 << 20}
near(plot.memory_mib({"settings": {"method": "raster"}, "memoryBytes": memory}), 15)
assert plot.memory_mib({"settings": {"method": "none"}, "memoryBytes": memory}) == 0

# What is extrapolated begins where the measurement ends, on the fitted line.
ax = drawn("time", [point("megaviews", n, 2 * n ** 0.5) for n in (1024, 4096, 16384)] +
           [point("raster", n, 0.25 * n) for n in (256, 1024)])
dotted = [line for line in ax.lines if line.get_linestyle() == ":" and len(line.get_xdata())]
assert len(dotted) == 1
assert list(dotted[0].get_xdata()) == [1024, 4096, 16384]
near(dotted[0].get_ydata()[-1], 0.25 * 16384)

# Of a key that was swept beside views and methods one value is drawn: the first, or that asked for.
points = [point("megaviews", n, ms) for n in (64, 128) for ms in (1, 2)]
for i, p in enumerate(points):
    p["values"]["view-res"] = (8, 16)[i % 2]
for where, ms in (({}, 1), ({"view-res": "16"}, 2)):
    line = drawn("time", plot.chosen(points, where)).lines[0]
    assert list(line.get_ydata()) == [ms, ms], line.get_ydata()

# Who is not beaten, for errors of which less and for those of which more is better.
points = [point("megaviews", 64, 1, 0.5), point("megaviews", 64, 2, 0.25),
          point("manylods", 64, 3, 0.4), point("manylods", 64, 4, 0.125)]
for more, errors in (({}, [0.5, 0.25, 0.125]), ({"metric": "psnr"}, [2, 4, 8]),
                     ({"against": "pathtraced"}, [4.5, 2.25, 1.125])):
    front = [line for line in drawn("error", points, **more).lines
             if line.get_label() == "Pareto front"][0]
    assert list(front.get_xdata()) == [2, 4, 8]
    assert list(front.get_ydata()) == errors, front.get_ydata()

# Stages as shares: three quarters, a quarter, nothing else.
heights = [bar.get_height() for bar in drawn("stages", [point("megaviews", 64, 5)]).patches]
assert heights == [75, 25, 0], heights
print("as it should be")
