#!/usr/bin/env python3
"""Times the refit of a crank's ten parameters beside scipy's least_squares, in turns and in one run; see benches/README.md.

    python3 benches/refit.py [--quick] [--out FILE]

Needs numpy and scipy. Nothing is asserted but that both find the same radius and weight.
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

import numpy
from scipy.optimize import least_squares
from scipy.signal import savgol_filter

ROOT = Path(__file__).resolve().parent.parent
TARGET = ROOT / (os.environ.get("CARGO_TARGET_DIR") or "target")
WINDOW, BLUR_M_S, LEAST_M_S = 81, 2e-3, 5e-3
NAMES = "center_x_m center_y_m radius_m give_x give_y weight_N friction_mu viscous_N_s_m coulomb_N mass_kg".split()


def programs():
    for what in (["-p", "estimator", "--example", "refit_speed"], ["-p", "app"]):
        subprocess.run(["cargo", "build", "--release", "--quiet", *what], cwd=ROOT, check=True)
    return TARGET / "release/examples/refit_speed", TARGET / "release/touchstone"


class Signals:
    """What both sides prepare once: mean of the tips and net force, smoothed, with their derivatives, where the handle turns."""

    def __init__(self, log):
        with open(log) as file:
            names = file.readline().strip().split(",")
        table = numpy.genfromtxt(log, delimiter=",", skip_header=1, usecols=range(13))
        column = {name: table[:, i] for i, name in enumerate(names[:13])}
        step = (column["t_s"][-1] - column["t_s"][0]) / (len(table) - 1)

        def smooth(signal, order):
            return savgol_filter(signal, WINDOW, 3, deriv=order, delta=step, axis=0)

        def pair(name, unit, mix):
            return numpy.stack([mix(column[f"{name}{a}1_{unit}"], column[f"{name}{a}2_{unit}"]) for a in "xy"], axis=1)

        mean, total = lambda a, b: 0.5 * (a + b), lambda a, b: a + b
        position = numpy.stack([mean(column[f"{a}1_m"], column[f"{a}2_m"]) for a in "xy"], axis=1)
        velocity = pair("v", "m_s", mean)
        force = pair("f", "N", total)
        self.position, self.velocity, self.acceleration = smooth(position, 0), smooth(velocity, 0), smooth(velocity, 1)
        self.force, self.force_rate, self.force_bend = smooth(force, 0), smooth(force, 1), smooth(force, 2)
        grip = smooth(numpy.minimum(column["fx1_N"], -column["fx2_N"]), 0)
        held = (grip > 0.3) & (numpy.linalg.norm(self.velocity, axis=1) > LEAST_M_S)
        free = grip < 0.05
        self.force -= force[free].mean(axis=0) if free.any() else 0.0
        for name in ("position", "velocity", "acceleration", "force", "force_rate", "force_bend"):
            setattr(self, name, getattr(self, name)[held])

    def residuals(self, p):
        """Radius residual in 10 µm and force residual in 10 mN: both near their noise."""
        center, radius, give = p[:2], p[2], p[3:5]
        outward = self.position - self.force * give - center
        length = numpy.linalg.norm(outward, axis=1)
        outward /= length[:, None]
        along = numpy.stack([-outward[:, 1], outward[:, 0]], axis=1)
        speed = ((self.velocity - self.force_rate * give) * along).sum(axis=1)
        rise = ((self.acceleration - self.force_bend * give) * along).sum(axis=1)
        normal, tangential = (self.force * outward).sum(axis=1), (self.force * along).sum(axis=1)
        sign = numpy.tanh(speed / BLUR_M_S)
        weight, mu, viscous, coulomb, mass = p[5:]
        needed = weight * along[:, 1] + mu * abs(normal) * sign + viscous * speed + coulomb * sign + mass * rise
        return numpy.concatenate([(length - radius) / 1e-5, (tangential - needed) / 1e-2])

    def fit(self, method):
        middle = self.position.mean(axis=0)
        start = numpy.array([*middle, 0.02, 1e-4, 1e-4, 0.1, 0.05, 1.0, 0.05, 0.05])
        scale = numpy.array([0.01, 0.01, 0.01, 1e-4, 1e-4, 0.1, 0.05, 1.0, 0.05, 0.05])
        return least_squares(self.residuals, start, method=method, x_scale=scale)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="one round")
    parser.add_argument("--out", type=Path, default=TARGET / "refit.json")
    options = parser.parse_args()
    ours, touchstone = programs()
    rounds = 1 if options.quick else 5
    rows = []
    with tempfile.TemporaryDirectory() as name:
        for seconds in (10, 100):
            log = Path(name) / f"crank{seconds}.csv"
            record = ["record", "--task", "crank", "--operator", "scripted", "--seconds", str(seconds), "--out", log]
            subprocess.run([touchstone, *record], check=True, capture_output=True)
            fitted = json.loads(subprocess.run([touchstone, "fit", log, "--json"], check=True, capture_output=True).stdout)
            values = {p["name"]: p.get("value") for p in fitted["parameters"]}
            signals = Signals(log)
            first, again, theirs = [], [], {"lm": [], "trf": []}
            for _ in range(rounds):
                text = subprocess.run([ours, log, "20"], check=True, capture_output=True, text=True).stdout
                samples, once, *refits = (float(word) for word in text.split())
                first.append(once)
                again.append(statistics.median(refits))
                for method, times in theirs.items():
                    start = time.perf_counter()
                    answer = signals.fit(method)
                    times.append(time.perf_counter() - start)
            found = dict(zip(NAMES, answer.x))
            for parameter, share in (("radius_m", 0.01), ("weight_N", 0.05)):
                assert abs(values[parameter] - found[parameter]) < share * abs(values[parameter]), (parameter, values, found)
            median = statistics.median
            row = {"samples": int(samples), "first_s": median(first), "refit_s": median(again)}
            for method, times in theirs.items():
                row[f"{method}_s"] = median(times)
                row[f"{method}_ratio"] = median(t / m for t, m in zip(times, again))
            rows.append(row)
            print(
                f"{int(samples):7} samples: first {1e3 * row['first_s']:.1f} ms, refit {1e3 * row['refit_s']:.1f} ms; "
                f"scipy lm {1e3 * row['lm_s']:.0f} ms ({row['lm_ratio']:.0f} times), "
                f"trf {1e3 * row['trf_s']:.0f} ms ({row['trf_ratio']:.0f} times)",
                flush=True,
            )
    options.out.parent.mkdir(parents=True, exist_ok=True)
    facts = {"machine": platform.processor(), "cores": os.cpu_count(), "load": os.getloadavg(), "scipy": version("scipy"), "rows": rows}
    options.out.write_text(json.dumps(facts, indent=2))
    print(f"scipy {version('scipy')}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
