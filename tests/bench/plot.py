#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""plot.py REPORT.json PICTURE.svg: stacks a second over size and planes."""
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

with open(sys.argv[1]) as report:
    rows = json.load(report)
figure, (over_pixels, over_planes) = plt.subplots(1, 2, figsize=(11, 4.5), sharey=True)
for name, marker in (("method=paper and AIF", "o"), ("method=volume and AIF", "s")):
    ours = [r for r in rows if r["name"] == name]
    for planes in sorted({r["planes"] for r in ours}):
        points = sorted((r["width"] * r["height"] / 1e6, 1e3 / r["ms"]) for r in ours if r["planes"] == planes)
        if len(points) > 1:
            over_pixels.plot(*zip(*points), marker=marker, label=f"{name[7:13].strip()}, N={planes}")
    for width in sorted({r["width"] for r in ours}):
        points = sorted((r["planes"], 1e3 / r["ms"]) for r in ours if r["width"] == width)
        if len(points) > 1:
            over_planes.plot(*zip(*points), marker=marker, label=f"{name[7:13].strip()}, {width} wide")
for axes, label in ((over_pixels, "megapixels a plane"), (over_planes, "planes")):
    axes.set(xlabel=label, xscale="log", yscale="log")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=7)
over_pixels.set_ylabel("stacks a second")
figure.tight_layout()
figure.savefig(sys.argv[2])
