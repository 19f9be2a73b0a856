#!/usr/bin/env python3
"""Logs of cranks with at most one hidden effect each, made in MuJoCo: hidden_in_cranks.py LOGS TRUTH SEED COUNT

LOGS gets COUNT logs `crank-N.csv` with their sidecars, in an order drawn from the seed: of twelve, one has each effect and two have none.
TRUTH gets one file with the hidden effects; only the assertion opens it.
"""

import json
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

WIDTH_M = 0.010
EFFECTS = ["coulomb-friction", "stribeck", "return-spring", "position-ripple", "local-resistance", "friction-change", "eccentric-mass",
           "force-drift", "force-bias", "time-delay"]


class Crank:
    """A handle with its own bearing on an arm with a damper, and the effect that is hidden in it."""

    def __init__(self, rng, effect):
        self.effect, self.size_n = effect, rng.uniform(0.05, 0.15)
        self.mass, self.radius = rng.uniform(0.02, 0.05), rng.uniform(0.018, 0.024)
        self.viscous = rng.uniform(0.8, 1.5)
        self.center = (rng.uniform(-0.003, 0.003), -0.1 + rng.uniform(-0.003, 0.003))
        self.phase, self.waves = rng.uniform(0.0, 2.0 * numpy.pi), int(rng.integers(3, 8))
        self.changes_s, self.end_s, self.closed_s, self.opens_s = None, None, 1.15, None

    def things(self):
        hinge = f'type="hinge" axis="0 -1 0" damping="{self.viscous * self.radius**2}"'
        if self.effect in ("coulomb-friction", "stribeck"):
            hinge += f' frictionloss="{self.size_n * self.radius}"'
        elif self.effect == "friction-change":
            hinge += f' frictionloss="{0.02 * self.radius}"'
        elif self.effect == "return-spring":
            # The stated force at half a turn from its rest.
            hinge += f' stiffness="{self.size_n * self.radius / numpy.pi}" springref="{self.phase / 10.0}"'
        extra = '<inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>'
        if self.effect == "eccentric-mass":
            side = 1.0 if self.phase < numpy.pi else -1.0
            mass = self.size_n / rig.GRAVITY
            extra = f'<inertial pos="{side * self.radius} 0 0" mass="{mass}" diaginertia="1e-9 1e-9 1e-9"/>'
        return (f'<body name="arm" pos="{self.center[0]} 0 {self.center[1]}"><joint name="arm" {hinge}/>{extra}'
                f'<body name="handle" pos="0 0 {-self.radius}"><joint type="hinge" axis="0 -1 0"/>'
                f'<inertial pos="0 0 0" mass="{self.mass}" diaginertia="1e-7 1e-7 1e-7"/>'
                f'<geom name="handle" type="box" size="{WIDTH_M / 2} 0.008 0.006" contype="1" conaffinity="3"'
                ' solref="0.004 1"/></body></body>')

    def each(self, m, d, t):
        """The grasp, and the torques that no joint of MuJoCo has, before every step."""
        joint = m.joint("arm")
        self.hold(m, d, t)
        angle, rate = d.qpos[joint.qposadr[0]], d.qvel[joint.dofadr[0]]
        slow = numpy.tanh(rate / 0.02)
        force_n = 0.0
        if self.effect == "stribeck":
            # More friction while it moves slowly, in the form of a fraction, not of an exponential.
            force_n = -1.5 * self.size_n * slow / (1.0 + (rate * self.radius / 0.012) ** 2)
        elif self.effect == "position-ripple":
            force_n = self.size_n * numpy.sin(self.waves * angle + self.phase)
        elif self.effect == "local-resistance":
            off = (angle - self.phase + numpy.pi) % (2.0 * numpy.pi) - numpy.pi
            force_n = -2.0 * self.size_n * slow * max(0.0, 1.0 - (off / 0.5) ** 2)
        elif self.effect == "friction-change" and t > self.changes_s:
            m.dof_frictionloss[joint.dofadr[0]] = (0.02 + self.size_n) * self.radius
        d.qfrc_applied[joint.dofadr[0]] = force_n * self.radius

    def hold(self, m, d, t):
        """A brake holds the arm while no hand does. Closed pads are joined to the handle: MuJoCo's contacts alone would creep."""
        m.dof_damping[m.joint("arm").dofadr[0]] = self.viscous * self.radius**2 if self.closed_s < t < self.opens_s else 1.0
        for k, name in enumerate(("left", "right")):
            if t > self.closed_s and not d.eq_active[k] and t < self.opens_s:
                pad, handle = m.geom(name).bodyid[0], m.body("handle").id
                at = 0.5 * (d.geom(name).xpos + d.body("handle").xpos)
                for part, body in enumerate((pad, handle)):
                    m.eq_data[k, 3 * part:3 * part + 3] = d.xmat[body].reshape(3, 3).T @ (at - d.xpos[body])
            d.eq_active[k] = self.closed_s < t < self.opens_s

    def measured(self, columns, rows, rng):
        """The errors of the sensors."""
        rows = numpy.array(rows)
        axis = "xy"[int(rng.integers(2))]
        if self.effect == "force-bias":
            rows[:, columns.index("fx1_N")] += self.size_n
        elif self.effect == "force-drift":
            # A sensor that warms up drifts faster at first.
            warm = 1.0 - numpy.exp(-1.5 * rows[:, 0] / self.end_s)
            rows[:, columns.index(f"f{axis}2_N")] += 2.0 * self.size_n * warm
        elif self.effect == "time-delay":
            late_s = 0.08 * self.size_n + 0.006
            for k, name in enumerate(columns):
                if name.startswith("f"):
                    rows[:, k] = numpy.interp(rows[:, 0] - late_s, rows[:, 0], rows[:, k])
        return rows

    def strokes(self, rng):
        """An operator's strokes: back and forth, of different widths and speeds, with pauses."""
        points, at, side = [(0.0, 0.0), (1.5, 0.0)], 0.0, 1.0
        while points[-1][0] < 17.0:
            width = rng.uniform(0.35, 1.3)
            goal = side * rng.uniform(0.2, 0.9) if rng.random() < 0.7 else at + side * width
            last = points[-1][0] + rng.uniform(1.1, 2.6) * max(0.5, abs(goal - at)) ** 0.5
            points.append((last, goal))
            if rng.random() < 0.6:
                points.append((last + rng.uniform(0.15, 0.5), goal))
            at, side = goal, -side
        end = points[-1][0]
        return [*points, (end + 1.5, at)]


def log(rng, effect):
    crank = Crank(rng, effect)
    turned, end_s = rig.course(crank.strokes(rng))
    crank.end_s, crank.changes_s, crank.opens_s = end_s, rng.uniform(0.35, 0.65) * end_s, end_s - 1.05
    squeeze = rng.uniform(2.0, 3.5) / rig.GRIP_N_M
    firm = WIDTH_M - squeeze
    closing, _ = rig.course([(0.0, 0.02), (0.6, 0.02), (1.1, firm), (end_s - 1.0, firm), (end_s - 0.5, 0.02), (end_s, 0.02)])
    trembles = [(rng.uniform(0.4, 2.5), rng.uniform(0.0, 2.0 * numpy.pi), rng.uniform(0.5, 2.0) * 1e-5) for _ in range(5)]

    def path(t):
        angle = -0.5 * numpy.pi + 2.0 * numpy.pi * turned(t)[0]
        dx, dz = ([size * numpy.sin(2.0 * numpy.pi * hz * t + phase + k) for hz, phase, size in trembles] for k in (0.0, 1.6))
        return (crank.center[0] + crank.radius * numpy.cos(angle) + sum(dx),
                crank.center[1] + crank.radius * numpy.sin(angle) + sum(dz), closing(t)[0])

    holds = "".join(f'<connect name="{name}" body1="{name}-pad" body2="handle" anchor="0 0 0" active="false"'
                    ' solref="0.002 1" solimp="0.99 0.99 0.001"/>' for name in ("left", "right"))
    m = rig.model(crank.things(), [rig.finger("left", 1.5, _start(path, -1.0)), rig.finger("right", 1.5, _start(path, 1.0))],
                  f"<equality>{holds}</equality>", noslip=0)
    columns, rows, _ = rig.pinched(m, path, end_s, rig.Sensors(rng.integers(2**31)), crank.each, rig.felt_by)
    return columns, crank.measured(columns, rows, rng), {"effect": effect, "size_n": crank.size_n, "changes_s": crank.changes_s}


def _start(path, side):
    x, z, apart = path(0.0)
    return x + side * 0.5 * apart, z


def main():
    logs, truth_folder, seed, count = sys.argv[1:]
    rng = numpy.random.default_rng(int(seed))
    twelve = [*EFFECTS, "none", "none"]
    effects = [effect for _ in range(-(-int(count) // len(twelve))) for effect in rng.permutation(twelve)][:int(count)]
    sidecar = {"task": "crank", "gravity_m_s2": rig.GRAVITY, "up": "y", "hand": rig.HAND}
    truth = {}
    for number, effect in enumerate(effects):
        name = f"crank-{number}"
        columns, rows, truth[name] = log(numpy.random.default_rng([int(seed), number]), str(effect))
        rig.write(logs, name, columns, rows, sidecar)
    (Path(truth_folder) / "truth.json").write_text(json.dumps(truth), encoding="utf-8")


if __name__ == "__main__":
    main()
