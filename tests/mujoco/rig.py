"""Two fingers in MuJoCo, sensors, and logs in Touchstone's format. Shares nothing with Touchstone but the format.

x to the right, z up; logs have that as x and y.
"""

import csv
import json
from pathlib import Path

import mujoco
import numpy

RATE_HZ = 1000
STEP_S = 2.5e-4
GRAVITY = 9.81
ARM_N_M, ARM_KG = 4000.0, 0.05
# Foam on the fingertip: a small body on springs, normal and along the surface.
PAD_N_M, PAD_SHEAR_N_M, PAD_N_S_M, PAD_KG = 2500.0, 1500.0, 1.5, 0.002
# What closing the fingers by a length gives as a grip: both arms and both pads give.
GRIP_N_M = 0.5 / (1.0 / ARM_N_M + 1.0 / PAD_N_M)
RADIUS_M = 0.004
HAND = {"link_m": 0.08, "base1_m": [-0.04, 0.0], "base2_m": [0.04, 0.0]}


def finger(name, friction, start):
    """A flat pad on foam on a finger that motors lead; the finger's joints are where the pad's surface is while nothing presses."""
    side = -1.0 if name == "left" else 1.0
    damping = 1.4 * (ARM_N_M * ARM_KG) ** 0.5
    axes = (("x", "1 0 0", start[0]), ("z", "0 0 1", start[1]))
    joints = "".join(f'<joint name="{name}{a}" type="slide" axis="{v}" ref="{at}" damping="{damping}"/>' for a, v, at in axes)
    foam = "".join(f'<joint name="{name}-foam-{a}" type="slide" axis="{v}" stiffness="{k}" damping="{PAD_N_S_M}"/>'
                   for a, v, k in (("x", "1 0 0", PAD_N_M), ("z", "0 0 1", PAD_SHEAR_N_M)))
    geom = (f'<geom name="{name}" type="box" size="{RADIUS_M} 0.008 0.004" pos="{side * RADIUS_M} 0 0" mass="{PAD_KG}"'
            f' friction="{friction}" priority="1" contype="2" conaffinity="1" solref="0.002 1"/>')
    inertial = f'<inertial pos="0 0 0" mass="{ARM_KG}" diaginertia="1e-5 1e-5 1e-5"/>'
    body = (f'<body name="{name}" gravcomp="1" pos="{start[0]} 0 {start[1]}">{joints}{inertial}'
            f'<body name="{name}-pad" gravcomp="1">{foam}{geom}</body></body>')
    motors = "".join(f'<position joint="{name}{a}" kp="{ARM_N_M}"/>' for a in "xz")
    return body, motors


def model(things, fingers, more="", noslip=5):
    bodies = "".join(body for body, _ in fingers)
    motors = "".join(motors for _, motors in fingers)
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler angle="radian"/><option timestep="{STEP_S}" gravity="0 0 {-GRAVITY}" cone="elliptic"'
        f' impratio="20" noslip_iterations="{noslip}"/><worldbody>{things}{bodies}</worldbody>'
        f'<actuator>{motors}</actuator>{more}</mujoco>')


def smooth(u):
    """From 0 to 1 without a jerk."""
    u = numpy.clip(u, 0.0, 1.0)
    return u ** 3 * (10.0 - 15.0 * u + 6.0 * u * u)


def course(points):
    """Waypoints (t, values...) joined smoothly, as a function of time."""
    points = numpy.array(points, dtype=float)

    def at(t):
        i = int(numpy.clip(numpy.searchsorted(points[:, 0], t) - 1, 0, len(points) - 2))
        (t0, *a), (t1, *b) = points[i], points[i + 1]
        return numpy.array(a) + smooth((t - t0) / (t1 - t0)) * (numpy.array(b) - numpy.array(a))

    return at, points[-1, 0]


def pressed_by(m, d, name):
    """Force in the plane that a finger exerts on whatever it touches, N."""
    total, mine = numpy.zeros(3), m.geom(name).id
    wrench = numpy.zeros(6)
    for i in range(d.ncon):
        contact = d.contact[i]
        if mine not in (contact.geom1, contact.geom2):
            continue
        mujoco.mj_contactForce(m, d, i, wrench)
        # In the contact's frame, from its first geom to its second.
        force = contact.frame.reshape(3, 3).T @ wrench[:3]
        total += force if contact.geom1 == mine else -force
    return total[0], total[2]


def felt_by(m, d, name):
    """Force in the plane that a finger exerts through its foam, N: what a sensor between the arm and the foam reads."""
    joints = [m.joint(f"{name}-foam-{axis}") for axis in "xz"]
    return [-m.jnt_stiffness[j.id] * d.qpos[j.qposadr[0]] - PAD_N_S_M * d.qvel[j.dofadr[0]] for j in joints]


class Sensors:
    """White noise on what is recorded, and the resolution of a usual converter."""

    def __init__(self, seed, position_m=5e-6, force_n=0.01, velocity_m_s=1e-3):
        self.rng = numpy.random.default_rng(seed)
        self.sizes = {"m": position_m, "N": force_n, "s": velocity_m_s}

    def see(self, rows, columns):
        rows = numpy.array(rows)
        for k, name in enumerate(columns[1:], start=1):
            rows[:, k] += self.rng.normal(0.0, self.sizes[name.rsplit("_", 1)[-1]], len(rows))
        return rows


def pinched(m, path, end_s, sensors, each=lambda m, d, t: None, force=pressed_by):
    """Leads both fingers along `path(t)` = (middle x, middle z, distance) and records them."""
    d = mujoco.MjData(m)
    columns = ["t_s", "x1_m", "y1_m", "x2_m", "y2_m", "vx1_m_s", "vy1_m_s", "vx2_m_s", "vy2_m_s",
               "fx1_N", "fy1_N", "fx2_N", "fy2_N"]
    joints = [m.joint(name).qposadr[0] for name in ("leftx", "leftz", "rightx", "rightz")]
    speeds = [m.joint(name).dofadr[0] for name in ("leftx", "leftz", "rightx", "rightz")]
    every, rows = round(1.0 / (RATE_HZ * STEP_S)), []
    for tick in range(round(end_s / STEP_S)):
        x, z, apart = path(d.time)
        d.ctrl[:] = [x - 0.5 * apart, z, x + 0.5 * apart, z]
        each(m, d, d.time)
        mujoco.mj_step(m, d)
        if tick % every == every - 1:
            # What a step leaves: places after it, forces of it.
            rows.append([d.time, *d.qpos[joints], *d.qvel[speeds], *force(m, d, "left"), *force(m, d, "right")])
    return columns, sensors.see(rows, columns), d


def write(folder, name, columns, rows, sidecar):
    """A log and its sidecar."""
    with open(Path(folder) / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow(columns)
        for row in rows:
            out.writerow([f"{row[0]:.6f}", *(f"{value:.7g}" for value in row[1:])])
    (Path(folder) / f"{name}.meta.json").write_text(json.dumps(sidecar), encoding="utf-8")
