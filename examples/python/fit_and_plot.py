#!/usr/bin/env python3
"""Fits a log with Touchstone, replays it through the fitted world, and plots both.

    python3 examples/python/fit_and_plot.py LOG [--out PICTURE.png] [--touchstone PROGRAM]

Everything comes over the command line's JSON (docs/schemas); nothing but matplotlib is needed.
"""

import argparse
import csv
import json
import subprocess
import tempfile
from pathlib import Path

try:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError as why:
    print(f"skipped: Python has no {why.name}")
    raise SystemExit(0)


def touchstone(program, *arguments):
    """Runs a command and returns its JSON; ends with the command's own sentence when it fails."""
    done = subprocess.run([program, *map(str, arguments), "--json"], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr.strip())
    return json.loads(done.stdout)


def columns(path):
    """A CSV file as lists of numbers by column."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0] if name != "label"}


def plot_forces(figure, predicted, names):
    """Measured beside predicted force, a channel a row."""
    axes = figure.subplots(max(1, len(names)), sharex=True, squeeze=False)[:, 0]
    for axis, name in zip(axes, names):
        axis.plot(predicted["t_s"], predicted[f"measured_{name}"], color="tab:orange", linewidth=2.2, alpha=0.6,
                  label="measured")
        axis.plot(predicted["t_s"], predicted[name], color="tab:blue", linewidth=0.7, label="predicted")
        axis.set_ylabel(name.replace("_", ", "))
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel("time, s")
    if names:
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=2, frameon=False)


def plot_errors(figure, parameters):
    """Every parameter's standard error, in percent of its value."""
    axis = figure.subplots()
    shown = [p for p in parameters if p["identified"] and p.get("std_error") and p["value"]]
    shares = [100.0 * p["std_error"] / abs(p["value"]) for p in shown]
    names = [f'{p["object"]} {p["name"]}  {p["value"]:.4g} ± {p["std_error"]:.1g}' for p in shown]
    axis.plot(shares, names, "o", color="tab:blue")
    axis.invert_yaxis()
    axis.set_xscale("log")
    axis.set_xlabel("standard error, % of the value")
    axis.grid(alpha=0.3)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("log", type=Path)
    parser.add_argument("--out", type=Path, default=Path("fit.png"))
    parser.add_argument("--touchstone", default="touchstone", help="the program, where it is not on the path")
    wish = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        world, simulated = Path(folder) / "world.json", Path(folder) / "simulated.csv"
        fit = touchstone(wish.touchstone, "fit", wish.log, "--out", world)
        replay = touchstone(wish.touchstone, "simulate", world, wish.log, "--out", simulated)
        predicted = columns(simulated)
    names = [name for name in replay["columns"] if f"measured_{name}" in predicted]
    heights = [1.6 * max(1, len(names)) + 0.6, 0.26 * len(fit["parameters"]) + 1.0]
    figure = pyplot.figure(figsize=(9, sum(heights)), layout="constrained")
    above, below = figure.subfigures(2, height_ratios=heights)
    above.suptitle(f"{wish.log.name}: {fit['task']}", x=0.02, ha="left")
    plot_forces(above, predicted, names)
    plot_errors(below, fit["parameters"])
    figure.savefig(wish.out, dpi=110)
    for name, rms in replay["residual_rms"].items():
        print(f"{name}: predicted within {rms:.4f} RMS")
    print(f"picture: {wish.out}")


if __name__ == "__main__":
    main()
