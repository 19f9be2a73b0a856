#!/usr/bin/env python3
"""Times the decoding of a hidden Markov model beside hmmlearn, in turns and in one run; see benches/README.md.

    python3 benches/hmm.py [--quick] [--out FILE]

Needs numpy and hmmlearn. Nothing is asserted but that both find the same path.
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
from hmmlearn.hmm import GaussianHMM

ROOT = Path(__file__).resolve().parent.parent
TARGET = ROOT / (os.environ.get("CARGO_TARGET_DIR") or "target")
STATES, CHANNELS = 5, 12


def program():
    build = ["cargo", "build", "--release", "--quiet", "-p", "estimator", "--example", "hmm_speed"]
    subprocess.run(build, cwd=ROOT, check=True)
    return TARGET / "release/examples/hmm_speed"


def model(kind, seed):
    """A model whose states overlap, so that the path is not obvious."""
    rng = numpy.random.default_rng(seed)
    made = GaussianHMM(n_components=STATES, covariance_type="diag" if kind == "diagonal" else "full", init_params="")
    made.startprob_ = rng.dirichlet(numpy.ones(STATES))
    made.transmat_ = 0.98 * numpy.eye(STATES) + 0.02 * rng.dirichlet(numpy.ones(STATES), size=STATES)
    made.means_ = rng.normal(0.0, 1.0, (STATES, CHANNELS))
    if kind == "diagonal":
        made.covars_ = rng.uniform(0.5, 2.0, (STATES, CHANNELS))
    else:
        mixes = rng.normal(0.0, 1.0, (STATES, CHANNELS, CHANNELS))
        made.covars_ = mixes @ mixes.transpose(0, 2, 1) / CHANNELS + 0.5 * numpy.eye(CHANNELS)
    return made


def hand_over(made, kind, values, folder):
    covariances = made._covars_ if kind == "diagonal" else made.covars_
    for name, array in [
        ("start", made.startprob_), ("transition", made.transmat_), ("means", made.means_),
        ("covariances", covariances), ("values", values),
    ]:
        numpy.ascontiguousarray(array, dtype="<f8").tofile(folder / name)
    (folder / "shape").write_text(f"{STATES} {CHANNELS} {kind}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="200 000 samples, one round")
    parser.add_argument("--out", type=Path, default=TARGET / "hmm.json")
    options = parser.parse_args()
    ours = program()
    samples, rounds = (200_000, 1) if options.quick else (2_000_000, 5)
    rows = []
    print(f"{'covariance':12} {'samples':>9} {'ours M/s':>9} {'median':>7} {'hmmlearn M/s':>13} {'times':>7}  paths")
    for kind in ("full", "diagonal"):
        made = model(kind, 7)
        values, _ = made.sample(samples, random_state=8)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            hand_over(made, kind, values, folder)
            mine, medians, theirs = [], [], []
            for _ in range(rounds):
                # In turns, so that a busy minute hits both; the best of five beside the best of two.
                text = subprocess.run([ours, folder, "5"], check=True, capture_output=True, text=True).stdout
                log_probability, *seconds = (float(word) for word in text.split())
                mine.append(min(seconds))
                medians.append(statistics.median(seconds))
                best = float("inf")
                for _ in range(2):
                    start = time.perf_counter()
                    their_log_probability, path = made.decode(values)
                    best = min(best, time.perf_counter() - start)
                theirs.append(best)
            same = numpy.mean(numpy.fromfile(folder / "path", dtype=numpy.uint8) == path)
        assert same == 1.0 and abs(log_probability - their_log_probability) < 1e-9 * abs(log_probability)
        ratio = statistics.median(t / m for m, t in zip(mine, theirs))
        rate, usual, other = (samples / 1e6 / statistics.median(s) for s in (mine, medians, theirs))
        print(f"{kind:12} {samples:9} {rate:9.1f} {usual:7.1f} {other:13.2f} {ratio:7.1f}  equal", flush=True)
        rows.append({"covariance": kind, "samples": samples, "ours_s": mine, "ours_median_s": medians, "hmmlearn_s": theirs, "ratio": ratio})
    options.out.parent.mkdir(parents=True, exist_ok=True)
    facts = {"machine": platform.processor(), "cores": os.cpu_count(), "load": os.getloadavg(), "hmmlearn": version("hmmlearn"), "rows": rows}
    options.out.write_text(json.dumps(facts, indent=2))
    print(f"hmmlearn {version('hmmlearn')}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
