#!/usr/bin/env python3
"""Times a tick of our world beside the same scenes in MuJoCo and writes one table; see benches/README.md.

    python3 benches/peers.py [--quick] [--out FILE]

Our side is the example `tick_cost`; it also says what the scenes are, so that both sides share every size, mass, friction
and finger path. MuJoCo is stepped in C by `mujoco.rollout` on the calling thread.
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import time
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = ROOT / (os.environ.get("CARGO_TARGET_DIR") or "target")
ELLIPTIC = 'cone="elliptic" impratio="10"'
NOSLIP = f'{ELLIPTIC} noslip_iterations="5"'

# Our scene, MuJoCo's model of it, MuJoCo's options, what it is called in the table.
ROWS = [
    ("pinch", "blocks", "", "pinch"),
    ("pinch", "blocks", ELLIPTIC, "pinch, elliptic"),
    ("pinch", "blocks", NOSLIP, "pinch, elliptic + noslip"),
    ("pinch-fine", "blocks", "", "pinch at 0.1 ms"),
    ("lift", "blocks", "", "lift and put down"),
    ("lift", "blocks", ELLIPTIC, "lift, elliptic"),
    ("lift", "blocks", NOSLIP, "lift, elliptic + noslip"),
    ("crank", "spring", "", "crank, finger is a spring"),
    ("crank", "pads", "", "crank, two pads touch"),
    ("crank-turn", "spring", "", "turning, finger is a spring"),
    ("crank-turn", "pads", "", "turning, two pads touch"),
    ("towers", "blocks", "", "30 stacked blocks"),
    ("towers", "blocks", ELLIPTIC, "30 stacked blocks, elliptic"),
]


def import_scenes():
    """The MuJoCo side, from this Python or one of its own; says so and ends when MuJoCo cannot be had."""
    sys.dont_write_bytecode = True
    try:
        import mujoco_scenes

        return mujoco_scenes
    except (ImportError, OSError) as why:
        if os.environ.get("PEERS_ENVIRONMENT"):
            skip(f"MuJoCo is installed but does not load ({why})")
    folder = TARGET / "peers-venv"
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    print("Installing MuJoCo into an environment of its own under the build folder ...", flush=True)
    try:
        if not python.exists():
            venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "mujoco"], check=True)
    except (OSError, subprocess.CalledProcessError) as why:
        skip(f"MuJoCo could not be installed ({type(why).__name__})")
    command = [python, Path(__file__).resolve(), *sys.argv[1:]]
    again = subprocess.run(command, env={**os.environ, "PEERS_ENVIRONMENT": "1"})
    raise SystemExit(again.returncode)


def skip(why):
    print(f"skipped: {why}. Install the package `mujoco` for this Python and run the script again.")
    raise SystemExit(0)


def build_ours():
    """Path of the release example."""
    command = ["cargo", "build", "--release", "--quiet", "-p", "haptics", "--example", "tick_cost"]
    try:
        command += ["--message-format=json"]
        out = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    except (OSError, subprocess.CalledProcessError) as why:
        raise SystemExit(f"Our side could not be built ({type(why).__name__}): see cargo's messages above.") from why
    found = [m.get("executable") for m in map(json.loads, out.stdout.splitlines())
             if m.get("reason") == "compiler-artifact" and m["target"]["name"] == "tick_cost"]
    return found[-1]


def ours(program, *arguments):
    return json.loads(subprocess.run([program, *arguments], check=True, stdout=subprocess.PIPE, text=True).stdout)


def interleave(program, scenes, rounds, batches):
    """Every round times our program, then every MuJoCo model."""
    peers = [mujoco_scenes.Peer(scenes[scene], kind, options) for scene, kind, options, _ in ROWS]
    seen = []
    for number in range(rounds):
        mine = {s["name"]: s for s in ours(program, "--json", "--batches", str(batches["ours"]))["scenes"]}
        theirs = [peer.costs_ns(batches["towers" if peer.scene["name"] == "towers" else "peer"]) for peer in peers]
        seen.append((mine, theirs))
        print(f"round {number + 1} of {rounds} done", flush=True)
    rows = []
    for index, ((scene, kind, options, label), peer) in enumerate(zip(ROWS, peers)):
        our_best = [mine[scene]["best_ns"] for mine, _ in seen]
        peer_best = [theirs[index][0] for _, theirs in seen]
        ratios = [p / o for p, o in zip(peer_best, our_best)]
        rows.append({
            "label": label, "scene": scene, "timed": peer.scene["timed"], "dt_s": peer.scene["dt_s"],
            "mujoco_model": kind, "mujoco_options": options or "default",
            "ours_best_ns": statistics.median(our_best),
            "ours_median_ns": statistics.median(mine[scene]["median_ns"] for mine, _ in seen),
            "mujoco_best_ns": statistics.median(peer_best),
            "mujoco_median_ns": statistics.median(statistics.median(theirs[index]) for _, theirs in seen),
            "ratio": {"median": statistics.median(ratios), "least": min(ratios), "most": max(ratios)},
            "ratio_of_medians": statistics.median(
                statistics.median(theirs[index]) / mine[scene]["median_ns"] for mine, theirs in seen),
            "ours": {"parts_per_tick": seen[-1][0][scene]["parts_per_tick"], **seen[-1][0][scene]["outcome"]},
            "mujoco": peer.outcome(),
        })
    return rows


def print_table(rows, grips):
    print(f"\n{'scene':<29}{'ours µs':>9}{'median':>8}{'MuJoCo µs':>11}{'median':>8}{'ratio':>8}{'range':>13}   "
          "contacts")
    for row in rows:
        ratio = row["ratio"]
        print(f"{row['label']:<29}{row['ours_best_ns'] / 1e3:>9.3f}{row['ours_median_ns'] / 1e3:>8.3f}"
              f"{row['mujoco_best_ns'] / 1e3:>11.2f}{row['mujoco_median_ns'] / 1e3:>8.2f}{ratio['median']:>7.1f}×"
              f"{ratio['least']:>7.1f}–{ratio['most']:<5.1f}   {span(row['ours'])} | {span(row['mujoco'])}")
    print("\nWhat happened (ours | MuJoCo): so that the same work is compared")
    for row in rows:
        mine, theirs = row["ours"], row["mujoco"]
        if "crank_turned_rad" in theirs:
            told = f"turned {mine['crank_turned_rad']:.2f} | {theirs['crank_turned_rad']:.2f} rad"
        else:
            told = (f"highest rise {mine['highest_rise_m'] * 1e3:.2f} | {theirs['highest_rise_m'] * 1e3:.2f} mm,"
                    f" MuJoCo ends within {theirs['largest_height_change_m'] * 1e3:.2f} mm of its start")
        print(f"  {row['label']:<29}{told}; {mine['parts_per_tick']} parts a tick | {theirs['degrees_of_freedom']} degrees"
              f" of freedom, {theirs['mean_solver_iterations']:.1f} solver iterations")
    print("\nGrip of 0.2 kg, friction 0.9, 2.4 N: how far it sinks after the first second")
    for grip in grips:
        sunk = "dropped" if grip.get("dropped") else f"{grip['creep_m'] * 1e3:.6f} mm"
        print(f"  {grip['who']:<30} dt {grip['dt_s'] * 1e3:g} ms, {grip['seconds']:g} s: {sunk}"
              f" (pinch at the end {grip['pinch_n']:.2f} N)")


def span(outcome):
    contacts = outcome["contacts"]
    least, most = contacts["least"], contacts["most"]
    return f"{least}–{most}" if least != most else f"{most}"


def all_grips(program, scene, our_seconds):
    grips = [{"who": "ours", **grip} for grip in ours(program, "--json", "--grip-seconds", str(our_seconds))["grip"]]
    settings = {"default": "", "elliptic, impratio 10": ELLIPTIC, "the same + noslip": NOSLIP}
    for who, options in settings.items():
        grips += [{"who": f"MuJoCo, {who}", **mujoco_scenes.creep(scene, options, dt_s, 10.0)} for dt_s in (1e-3, 1e-4)]
    return grips


def processor():
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or "unknown"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="about 20 s after the build: fewer rounds, shorter grip")
    parser.add_argument("--out", type=Path, default=TARGET / "peers.json", help="the JSON (default: build folder)")
    wish = parser.parse_args()
    program = build_ours()
    scenes = {scene["name"]: scene for scene in ours(program, "--describe")["scenes"]}
    rounds = 3 if wish.quick else 9
    batches = {"ours": 20, "peer": 4 if wish.quick else 8, "towers": 2 if wish.quick else 8}
    rows = interleave(program, scenes, rounds, batches)
    grips = all_grips(program, scenes["grip"], 60 if wish.quick else 600)
    print_table(rows, grips)
    report = {"date": time.strftime("%Y-%m-%d"), "quick": wish.quick, "mujoco": mujoco_scenes.mujoco.__version__,
              "python": platform.python_version(), "system": platform.system(), "processor": processor(),
              "cores": os.cpu_count(), "rounds": rounds, "batches": batches, "rows": rows, "grip": grips}
    wish.out.parent.mkdir(parents=True, exist_ok=True)
    wish.out.write_text(json.dumps(report, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(f"\nMuJoCo {mujoco_scenes.mujoco.__version__}, {report['processor']}; the JSON is in {wish.out.name}.")


if __name__ == "__main__":
    mujoco_scenes = import_scenes()
    main()
