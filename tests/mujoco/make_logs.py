#!/usr/bin/env python3
"""Logs of things with known parameters, made in MuJoCo: make_logs.py LOGS TRUTH [NAME...]

LOGS gets what a user would have: logs and sidecars. TRUTH gets one file with what the things are made of; only the assertion
opens it. Everything is drawn from a seed, always the same one unless `TOUCHSTONE_MUJOCO_SEED` says another: the test draws one a day, and
`docs/validation.md` has what eight others show.
"""

import json
import os
import sys
from pathlib import Path

try:
    import mujoco
    import numpy
except (ImportError, OSError) as why:
    print(f"skipped: Python has no MuJoCo ({why})")
    raise SystemExit(0)

sys.dont_write_bytecode = True
import rig  # noqa: E402

SEED = int(os.environ.get("TOUCHSTONE_MUJOCO_SEED", "20261122"))
FLOOR_M = -0.125


def box(name, x, z, width, height, mass, friction):
    joints = ('<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
              '<joint type="hinge" axis="0 -1 0"/>')
    return (f'<body name="{name}" pos="{x} 0 {z}">{joints}<geom name="{name}" type="box" contype="1" conaffinity="3"'
            f' size="{width / 2} 0.01 {height / 2}" mass="{mass}" friction="{friction}" solref="0.004 1"/></body>')


def floor(friction):
    return (f'<geom name="floor" type="plane" pos="0 0 {FLOOR_M}" size="1 1 0.1" friction="{friction}" contype="1"'
            ' conaffinity="1" solref="0.004 1"/>')


def hand(friction, start):
    apart = 0.5 * start[2]
    return [rig.finger("left", friction, (start[0] - apart, start[1])),
            rig.finger("right", friction, (start[0] + apart, start[1]))]


def two_fingered(task, **known):
    return {"task": task, "gravity_m_s2": rig.GRAVITY, "up": "y", "hand": rig.HAND, **known}


def blocks(rng):
    """Two blocks, one on the other: the upper one is carried off, then the lower one."""
    mass = rng.uniform(0.030, 0.060, 2)
    width, height = rng.uniform(0.016, 0.024, 2), rng.uniform(0.014, 0.018, 2)
    x0, x1, x2 = -0.018, 0.020, -0.022
    upper_z, lower_z = FLOOR_M + height[1] + height[0] / 2, FLOOR_M + height[1] / 2
    things = floor(0.5) + box("one", x0, upper_z, width[0], height[0], mass[0], 0.5) \
        + box("two", x0, lower_z, width[1], height[1], mass[1], 0.5)
    squeeze, up = 2.2 / rig.GRIP_N_M, 0.022
    points = [(0.0, x0, -0.08, 0.034)]

    def carry(x_from, z_from, x_to, z_to, w):
        t = points[-1][0]
        steps = [(0.6, x_from, z_from + up, 0.034), (0.6, x_from, z_from, 0.034), (0.5, x_from, z_from, w - squeeze), (0.5, x_from, z_from, w - squeeze),
                 (0.8, x_from, z_from + up, w - squeeze), (1.0, x_from, z_from + up, w - squeeze),
                 (0.9, x_to, z_to + up, w - squeeze), (0.6, x_to, z_to + up, w - squeeze),
                 (0.9, x_to, z_to - 0.0002, w - squeeze), (0.4, x_to, z_to - 0.0002, w - squeeze),
                 (0.5, x_to, z_to - 0.0002, 0.034), (0.8, x_to, z_to + up, 0.034)]
        for step in steps:
            t += step[0]
            points.append((t, *step[1:]))

    carry(x0, upper_z, x1, FLOOR_M + height[0] / 2, width[0])
    carry(x0, lower_z, x2, lower_z, width[1])
    path, end_s = rig.course(points)
    m = rig.model(things, hand(0.9, points[0][1:]))
    columns, rows, _ = rig.pinched(m, path, end_s, rig.Sensors(rng.integers(2**31)))
    truth = {}
    for k in (0, 1):
        truth[f"block-{k + 1}"] = {"weight_N": mass[k] * rig.GRAVITY, "width_m": width[k]}
    # Nothing ever stood on the upper one, so no recording of this task shows its height.
    truth["block-2"]["height_m"] = height[1]
    return columns, rows, two_fingered("block-stack"), truth


def crank(rng):
    """A handle with its own bearing on an arm with a damper and dry friction, carried round to and fro by both fingers."""
    mass, radius = rng.uniform(0.02, 0.05), rng.uniform(0.018, 0.024)
    viscous, coulomb = rng.uniform(0.8, 1.5), rng.uniform(0.03, 0.10)
    center, width = (rng.uniform(-0.003, 0.003), -0.1 + rng.uniform(-0.003, 0.003)), 0.010
    hinge = f'type="hinge" axis="0 -1 0" damping="{viscous * radius**2}" frictionloss="{coulomb * radius}"'
    things = (f'<body name="arm" pos="{center[0]} 0 {center[1]}"><joint name="arm" {hinge}/>'
              '<inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>'
              f'<body name="handle" pos="0 0 {-radius}"><joint type="hinge" axis="0 -1 0"/>'
              f'<inertial pos="0 0 0" mass="{mass}" diaginertia="1e-7 1e-7 1e-7"/>'
              f'<geom name="handle" type="box" size="{width / 2} 0.008 0.006" contype="1" conaffinity="3"'
              ' solref="0.004 1"/></body></body>')
    squeeze = 2.5 / rig.GRIP_N_M
    turns = [(0.0, 0.0), (1.5, 0.0), (4.0, 1.0), (4.4, 1.0), (7.4, -0.6), (7.8, -0.6), (9.8, 0.7), (10.1, 0.7),
             (11.6, -0.3), (13.1, 0.6), (15.6, 0.0), (16.0, 0.0), (17.2, 0.0)]
    turned, end_s = rig.course(turns)
    closing, _ = rig.course([(0.0, 0.02), (0.6, 0.02), (1.1, width - squeeze), (16.1, width - squeeze), (16.6, 0.02),
                             (end_s, 0.02)])

    def path(t):
        angle = -0.5 * numpy.pi + 2.0 * numpy.pi * turned(t)[0]
        return (center[0] + radius * numpy.cos(angle), center[1] + radius * numpy.sin(angle), closing(t)[0])

    m = rig.model(things, hand(1.5, path(0.0)))
    columns, rows, _ = rig.pinched(m, path, end_s, rig.Sensors(rng.integers(2**31)))
    truth = {"crank": {"weight_N": mass * rig.GRAVITY, "inertia_kg_m2": mass * radius**2, "viscous_N_s_m": viscous,
                       "coulomb_N": coulomb, "radius_m": radius, "center_x_m": center[0], "center_y_m": center[1]}}
    return columns, rows, two_fingered("crank"), truth


class Grip:
    """Loosens a grip until what is held slips, then closes it again, as a person would: after a reflex of 60 ms."""

    def __init__(self, points, firm, body):
        self.course, self.end_s = rig.course(points)
        self.firm, self.body = firm, body
        self.slipped_s, self.level = None, None

    def watch(self, m, d, t):
        below = 0.5 * (d.joint("leftz").qpos[0] + d.joint("rightz").qpos[0]) - d.body(self.body).xpos[2]
        _, z, apart, loosening = self.course(t)
        if loosening < 0.5:
            self.slipped_s, self.level = None, below
        elif self.slipped_s is None and below > self.level + 3e-4:
            self.slipped_s = t + 0.06

    def path(self, t):
        x, z, apart, _ = self.course(t)
        again = 0.0 if self.slipped_s is None else rig.smooth((t - self.slipped_s) / 0.04)
        return x, z, apart + again * min(0.0, self.firm - apart)


def pinch(rng):
    """A block held in the air by a grip that loosens until it slips, twice; the ratio of forces then is the friction."""
    mass, width, height = rng.uniform(0.05, 0.09), rng.uniform(0.018, 0.024), 0.018
    friction = rng.uniform(0.45, 0.75)
    z = FLOOR_M + height / 2
    things = floor(0.5) + box("one", 0.0, z, width, height, mass, 0.5)
    loose = 0.5 * mass * rig.GRAVITY / friction / rig.GRIP_N_M
    firm, open_m = width - 3.0 * loose, width + 0.012
    points = [(0.0, 0.0, -0.08, open_m, 0.0)]
    for _ in range(2):
        t, up = points[-1][0], z + 0.03
        steps = [(0.8, 0.0, z, open_m, 0.0), (0.6, 0.0, z, firm, 0.0), (0.5, 0.0, z, firm, 0.0), (0.9, 0.0, up, firm, 0.0),
                 (1.0, 0.0, up, firm, 0.0), (0.01, 0.0, up, firm, 1.0), (0.6, 0.0, up, width - 0.7 * loose, 1.0),
                 (0.2, 0.0, up, firm, 1.0), (0.8, 0.0, up, firm, 0.9), (1.2, 0.0, z + 0.006, firm, 0.9),
                 (0.6, 0.0, z + 0.006, open_m, 0.9), (0.8, 0.0, -0.08, open_m, 0.0)]
        for step in steps:
            t += step[0]
            points.append((t, *step[1:]))
    grip = Grip(points, firm, "one")
    m = rig.model(things, hand(friction, points[0][1:]))
    columns, rows, _ = rig.pinched(m, grip.path, grip.end_s, rig.Sensors(rng.integers(2**31)), grip.watch)
    return columns, rows, two_fingered("block-stack"), {"block-1": {"weight_N": mass * rig.GRAVITY, "friction": friction,
                                                                    "width_m": width}}


def slope(rng):
    """A box drawn up and down an inclined plane by a tool in its middle: x, y and force of the tool."""
    mass, friction, angle = rng.uniform(0.3, 0.8), rng.uniform(0.2, 0.4), rng.uniform(0.25, 0.5)
    along = numpy.array([numpy.cos(angle), numpy.sin(angle)])
    half, at = 0.01, numpy.array([0.05, -0.02])
    middle = at + half * numpy.array([-along[1], along[0]])
    things = (f'<geom name="slope" type="plane" size="2 2 0.1" pos="{at[0]} 0 {at[1]}" solref="0.004 1"'
              f' zaxis="{-along[1]} 0 {along[0]}" friction="{friction}" contype="1" conaffinity="1"/>'
              f'<body name="box" pos="{middle[0]} 0 {middle[1]}" axisangle="0 -1 0 {angle}"><freejoint name="box"/>'
              f'<geom name="box" type="box" size="0.03 0.02 {half}" mass="{mass}" friction="{friction}" contype="1"'
              ' conaffinity="1" solref="0.004 1"/></body>')
    m = rig.model(things, [])
    d = mujoco.MjData(m)
    course, end_s = rig.course([(0.0, 0.0), (1.0, 0.12), (2.2, -0.08), (2.8, 0.05), (3.3, -0.04), (4.5, 0.16), (6.1, 0.0)])
    stiff, damp = 4000.0, 2.0 * (4000.0 * mass) ** 0.5
    columns, rows = ["t_s", "x_m", "y_m", "fx_N", "fy_N"], []
    every, before = round(1.0 / (rig.RATE_HZ * rig.STEP_S)), None
    for tick in range(round(end_s / rig.STEP_S)):
        goal = middle + course(d.time)[0] * along
        speed = numpy.zeros(2) if before is None else (goal - before) / rig.STEP_S
        before = goal
        # The tool's own spring: along the slope only, so that it never lifts the box.
        off = (goal - d.qpos[[0, 2]]) @ along
        force = (stiff * off + damp * (speed - d.qvel[[0, 2]]) @ along) * along
        d.xfrc_applied[m.body("box").id, [0, 2]] = force
        place = d.qpos[[0, 2]].copy()
        if tick % every == 0:
            rows.append([d.time, *place, *force])
        mujoco.mj_step(m, d)
    rows = rig.Sensors(rng.integers(2**31), position_m=5e-6, force_n=0.02).see(rows, columns)
    normal = mass * rig.GRAVITY * numpy.cos(angle)
    truth = {"mechanism": {"mass_kg": mass, "coulomb_N": friction * normal, "offset_N": mass * rig.GRAVITY * numpy.sin(angle)},
             "constraint": {"direction_x": along[0], "direction_y": along[1]}}
    return columns, rows, {"task": "mechanism", "gravity_m_s2": rig.GRAVITY, "up": "y"}, truth


POSES = ["t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "trial"]
HALF_M = 0.05


def cube_on_a_table(friction, joints):
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{rig.STEP_S}" gravity="0 0 {-rig.GRAVITY}" cone="elliptic" impratio="20"/><worldbody>'
        f'<geom type="plane" size="5 5 0.1" friction="{friction} 0.005 0.0001"/><body name="cube">{joints}'
        f'<geom type="box" size="{HALF_M} {HALF_M} {HALF_M}" mass="0.37" friction="{friction} 0.005 0.0001"/></body></worldbody></mujoco>')


def watched(rng, m, d, pose, trial):
    """A throw until the cube rests, as a camera sees it: `pose(d)` is its place and its quaternion."""
    every, rows = round(1.0 / (250 * rig.STEP_S)), []
    for tick in range(round(1.6 / rig.STEP_S)):
        if tick % every == 0:
            place, quaternion = pose(d)
            place = place + rng.normal(0.0, 2e-4, 3)
            quaternion = quaternion + rng.normal(0.0, 1e-3, 4)
            rows.append([d.time, *place, *(quaternion / numpy.linalg.norm(quaternion)), trial])
        if tick * rig.STEP_S > 0.3 and numpy.linalg.norm(d.qvel) < 1e-3:
            break
        mujoco.mj_step(m, d)
    return rows


def impacts(rng):
    """Forty throws of a cube onto a table: it falls, hits, tumbles or not, and slides out."""
    friction = rng.uniform(0.15, 0.35)
    m, rows = cube_on_a_table(friction, "<freejoint/>"), []
    for trial in range(40):
        d = mujoco.MjData(m)
        d.qpos[:3] = [0.0, 0.0, rng.uniform(0.12, 0.2)]
        turn = rng.normal(0.0, 0.25, 3)
        mujoco.mju_axisAngle2Quat(d.qpos[3:7], turn / numpy.linalg.norm(turn), numpy.linalg.norm(turn))
        d.qvel[:] = [rng.uniform(0.8, 1.8), rng.uniform(-0.4, 0.4), rng.uniform(0.0, 0.8), *rng.normal(0.0, 1.5, 3)]
        rows += watched(rng, m, d, lambda d: (d.qpos[:3], d.qpos[3:7]), trial)
    sidecar = {"task": "mechanism", "gravity_m_s2": rig.GRAVITY, "up": "z"}
    return POSES, rows, sidecar, {"body": {"free_fall_m_s2": rig.GRAVITY, "length_scale": 1.0, "friction": friction}}


def thrown(rng):
    """Twenty throws of a cube within one plane: it falls, hits with an edge, slaps down and slides out."""
    friction = rng.uniform(0.15, 0.35)
    m, rows = cube_on_a_table(friction, '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
                                        '<joint type="hinge" axis="0 -1 0"/>'), []

    def pose(d):
        x, z, angle = d.qpos
        # Counter-clockwise, seen with x to the right and z up, is about -y.
        return numpy.array([x, 0.0, z]), numpy.array([numpy.cos(angle / 2), 0.0, -numpy.sin(angle / 2), 0.0])

    for trial in range(20):
        d = mujoco.MjData(m)
        d.qpos[:] = [0.0, rng.uniform(0.12, 0.2), rng.normal(0.0, 0.15)]
        d.qvel[:] = [rng.uniform(0.8, 1.8), rng.uniform(0.0, 0.8), rng.normal(0.0, 1.0)]
        rows += watched(rng, m, d, pose, trial)
    sidecar = {"task": "mechanism", "gravity_m_s2": rig.GRAVITY, "up": "z"}
    return POSES, rows, sidecar, {"body": {"free_fall_m_s2": rig.GRAVITY, "friction": friction}}


MAKERS = {"blocks": blocks, "crank": crank, "pinch": pinch, "slope": slope, "impacts": impacts, "thrown": thrown}


def main():
    logs, truth_folder, *names = sys.argv[1:]
    truth = {"mujoco": mujoco.__version__}
    for index, (name, make) in enumerate(MAKERS.items()):
        if names and name not in names:
            continue
        columns, rows, sidecar, truth[name] = make(numpy.random.default_rng(SEED + index))
        rig.write(logs, name, columns, rows, sidecar)
    (Path(truth_folder) / "truth.json").write_text(json.dumps(truth), encoding="utf-8")


if __name__ == "__main__":
    main()
