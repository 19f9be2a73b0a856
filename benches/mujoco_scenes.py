"""Our scenes as MuJoCo models: x to the right, z up, joints in that plane only, angles counter-clockwise.

Used by `peers.py`, which sees to it that `mujoco` is there. Scenes come from `tick_cost --describe`.
"""

import statistics
import time

import mujoco
import numpy
from mujoco import rollout

TIP_RADIUS_M = 0.003  # spherical fingertips; their surface, not their centre, is at our tip
TIP_MASS_KG = 0.1  # about a finger's; lighter ones slip sooner in MuJoCo
TIP_DAMPING = 22.0  # N s/m, 0.7 of critical for 2500 N/m and 0.1 kg
DEPTH_M = 0.02  # blocks in MuJoCo need a third size; nothing moves along it


def finger(name, friction, pad, shape):
    """A fingertip on springs: position actuators as stiff as our pad, normal and tangential."""
    joints = "".join(f'<joint name="{name}{a}" type="slide" axis="{v}" damping="{TIP_DAMPING}"/>'
                     for a, v in (("x", "1 0 0"), ("z", "0 0 1")))
    geom = f'<geom {shape} mass="{TIP_MASS_KG}" friction="{friction}" class="finger"/>'
    body = f'<body name="{name}">{joints}{geom}</body>'
    motors = (f'<position joint="{name}x" kp="{pad["stiffness_n_m"]}"/>'
              f'<position joint="{name}z" kp="{pad["shear_stiffness_n_m"]}"/>')
    return body, motors


def mjcf(scene, options, bodies, actuators, gravity):
    return f"""<mujoco><option timestep="{scene['dt_s']}" gravity="0 0 {-gravity}" {options}/>
    <default><default class="finger"><geom contype="2" conaffinity="1"/></default>
    <default class="thing"><geom contype="1" conaffinity="3"/></default></default>
    <worldbody>{bodies}</worldbody><actuator>{actuators}</actuator></mujoco>"""


def blocks_xml(scene, options):
    """Fingers, blocks and floor. In MuJoCo the larger friction of two surfaces counts: the fingers' is the larger, and the
    blocks' own is that against each other."""
    world = scene["world"]
    floor, bodies, actuators = world.get("floor"), "", ""
    if floor:
        bodies += (f'<geom type="plane" size="1 1 0.1" pos="0 0 {floor["height_m"]}" friction="{floor["friction"]}"'
                   ' class="thing"/>')
    for block in world["blocks"]:
        x, z = block["start"]["center_m"]
        half = f'{block["width_m"] / 2} {DEPTH_M / 2} {block["height_m"] / 2}'
        bodies += (f'<body name="{block["name"]}" pos="{x} 0 {z}"><joint type="slide" axis="1 0 0"/>'
                   '<joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 -1 0"/>'
                   f'<geom type="box" size="{half}" mass="{block["mass_kg"]}" friction="{block["block_friction"]}"'
                   ' class="thing"/></body>')
    for name in ("left", "right"):
        shape = f'type="sphere" size="{TIP_RADIUS_M}"'
        body, motors = finger(name, world["blocks"][0]["finger_friction"], world["pad"], shape)
        bodies, actuators = bodies + body, actuators + motors
    return mjcf(scene, options, bodies, actuators, world["gravity_m_s2"])


def crank_xml(scene, options, pads):
    """A handle of the crank's inertia on a massless arm. Friction under load is taken at the handle's weight."""
    crank, pad = scene["world"]["crank"], scene["world"]["pad"]
    law = {effect["id"]: next(iter(effect["parameters"].values())) for effect in crank["effects"]}
    mass, radius, (x, z) = law["inertia"], crank["radius_m"], crank["center_m"]
    friction = radius * (law["coulomb-friction"] + law["load-friction"] * law["weight"])
    hinge = (f'<joint name="arm" type="hinge" axis="0 -1 0" damping="{law["viscous-friction"] * radius**2}"'
             f' frictionloss="{friction}"/>')
    handle = f'<geom type="sphere" size="{crank["handle_width_m"] / 2}" mass="{mass}" class="thing"/>'
    bodies, actuators = "", ""
    if pads:
        # The handle turns in its own bearing on the arm, so the pads hold it upright, as ours.
        held = (f'<body pos="0 0 {-radius}"><joint type="hinge" axis="0 -1 0"/>{handle}</body>'
                '<inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>')
        for name in ("left", "right"):
            shape = f'type="box" size="{TIP_RADIUS_M} 0.008 0.008"'
            body, motors = finger(name, crank["finger_friction"], pad, shape)
            bodies, actuators = bodies + body, actuators + motors
    else:
        held = f'<body pos="0 0 {-radius}">{handle}<site name="handle"/></body>'
        # Both pads in parallel, as springs from where the fingers are to the handle: no contact, one degree of freedom.
        for gear, k, b in (("1 0 0 0 0 0", "stiffness_n_m", "damping_n_s_m"),
                           ("0 0 1 0 0 0", "shear_stiffness_n_m", "shear_damping_n_s_m")):
            actuators += (f'<position site="handle" refsite="axis" gear="{gear}" kp="{2 * pad[k]}" kv="{2 * pad[b]}"/>')
        bodies += f'<site name="axis" pos="{x} 0 {z}"/>'
    bodies = f'<body pos="{x} 0 {z}">{hinge}{held}</body>' + bodies
    # Weight and inertia of a crank are separate numbers; one gravity gives both.
    return mjcf(scene, options, bodies, actuators, law["weight"] / mass)


def model_of(scene, kind, options):
    xml = blocks_xml(scene, options) if kind == "blocks" else crank_xml(scene, options, kind == "pads")
    return mujoco.MjModel.from_xml_string(xml)


def extra_squeeze(scene, kind, options):
    """How much further each finger must close than ours to press as hard, m: MuJoCo's contacts give way too, ours have
    that in the pad already. Found without gravity on what is pinched, alone in the air."""
    world, tips = scene["world"], numpy.array(scene["tips_left_right_m"])
    width = world["crank"]["handle_width_m"] if kind == "pads" else world["blocks"][0]["width_m"]
    closest = float((tips[:, 2] - tips[:, 0]).min())
    wanted_n = world["pad"]["stiffness_n_m"] * 0.5 * (width - closest)
    if kind == "pads":
        x, z = world["crank"]["center_m"][0], world["crank"]["center_m"][1] - world["crank"]["radius_m"]
    else:
        world = {**world, "floor": None, "blocks": world["blocks"][:1]}
        x, z = world["blocks"][0]["start"]["center_m"]
    if wanted_n <= 0.0:
        return 0.0  # the fingers are away
    model = model_of({**scene, "world": world}, kind, options)
    model.opt.gravity[:] = 0.0
    data, extra = mujoco.MjData(model), 0.0
    open_m = 0.5 * width + TIP_RADIUS_M
    for name, value in zip(("leftx", "leftz", "rightx", "rightz"), (x - open_m, z, x + open_m, z)):
        data.qpos[model.joint(name).qposadr[0]] = value
    for _ in range(20):
        half = 0.5 * closest + TIP_RADIUS_M - extra
        data.ctrl[:] = [x - half, z, x + half, z]
        for _ in range(round(0.2 / model.opt.timestep)):
            mujoco.mj_step(model, data)
        extra += (wanted_n - abs(float(data.actuator_force[0]))) / world["pad"]["stiffness_n_m"]
    return extra


class Peer:
    """A scene in MuJoCo, ready to be run over our fingers' path."""

    def __init__(self, scene, kind, options):
        self.scene, self.kind = scene, kind
        self.model = model_of(scene, kind, options)
        self.data = mujoco.MjData(self.model)
        tips = numpy.array(scene["tips_left_right_m"])
        if kind == "spring":
            center = scene["world"]["crank"]["center_m"]
            self.control = 0.5 * (tips[:, :2] + tips[:, 2:]) - center
        else:
            outwards = TIP_RADIUS_M * numpy.array([-1.0, 0.0, 1.0, 0.0])
            # The springs also carry the fingertips' own weight.
            weight = -self.model.opt.gravity[2] * TIP_MASS_KG / scene["world"]["pad"]["shear_stiffness_n_m"]
            self.control = tips + outwards + weight * numpy.array([0.0, 1.0, 0.0, 1.0])
            self.control[:, [0, 2]] += extra_squeeze(scene, kind, options) * numpy.array([1.0, -1.0])
            for name, value in zip(("leftx", "leftz", "rightx", "rightz"), self.control[-1]):
                self.data.qpos[self.model.joint(name).qposadr[0]] = value
        mujoco.mj_forward(self.model, self.data)
        for _ in range(scene["warm_up_periods"]):
            self.walk()
        self.size = mujoco.mj_stateSize(self.model, mujoco.mjtState.mjSTATE_FULLPHYSICS)
        self.start = numpy.zeros((1, self.size))
        mujoco.mj_getState(self.model, self.data, self.start[0], mujoco.mjtState.mjSTATE_FULLPHYSICS)
        self.warm = self.data.qacc_warmstart.copy().reshape(1, -1)
        self.states = numpy.zeros((1, len(tips), self.size))
        self.batch = numpy.ascontiguousarray(self.control.reshape(1, len(tips), -1))
        self.pool = rollout.Rollout(nthread=0)  # the calling thread

    def walk(self, each=lambda: None):
        for control in self.control:
            self.data.ctrl[:] = control
            mujoco.mj_step(self.model, self.data)
            each()

    def costs_ns(self, batches):
        """Nanoseconds of CPU a step of each batch; a batch is the whole path from the same state."""
        costs, steps = [], self.batch.shape[1]
        for _ in range(batches):
            begin = time.thread_time_ns()
            self.pool.rollout([self.model], [self.data], self.start, self.batch, initial_warmstart=self.warm,
                              state=self.states, skip_checks=True, nstep=steps)
            costs.append((time.thread_time_ns() - begin) / steps)
        return sorted(costs)

    def blocks(self):
        """Heights and angles of the blocks, in our order."""
        names = [block["name"] for block in self.scene["world"]["blocks"]]
        return [(float(self.data.body(n).xpos[2]),
                 float(self.data.qpos[self.model.jnt_qposadr[self.model.body(n).jntadr[0]] + 2])) for n in names]

    def outcome(self):
        """What happens over one path: so that nobody times a block that lies on the floor."""
        full = mujoco.mjtState.mjSTATE_FULLPHYSICS
        mujoco.mj_setState(self.model, self.data, self.start[0], full)
        self.data.qacc_warmstart[:] = self.warm[0]
        mujoco.mj_kinematics(self.model, self.data)
        begin, counts, rise, iterations = self.blocks() if self.kind == "blocks" else [], [], [0.0], []
        turned = float(self.data.qpos[0]) if self.kind != "blocks" else 0.0

        def look():
            counts.append(self.data.ncon)
            iterations.append(int(max(self.data.solver_niter[: max(1, self.data.nisland)])))
            if begin:
                rise[0] = max(rise[0], max(now[0] - then[0] for now, then in zip(self.blocks(), begin)))

        self.walk(look)
        last = self.states[0, -1].copy()
        mujoco.mj_getState(self.model, self.data, last, full)
        if abs(last - self.states[0, -1]).max() > 1e-6:
            name = self.scene["name"]
            raise SystemExit(f"{name}: the timed run ended elsewhere than the one looked at; the figures are void")
        result = {"degrees_of_freedom": self.model.nv, "highest_rise_m": rise[0],
                  "contacts": {"least": min(counts), "mean": statistics.fmean(counts), "most": max(counts)},
                  "mean_solver_iterations": statistics.fmean(iterations)}
        if begin:
            result["blocks_at_the_end_height_m_angle_rad"] = self.blocks()
            result["largest_height_change_m"] = max(abs(a[0] - b[0]) for a, b in zip(self.blocks(), begin))
        else:
            result["crank_turned_rad"] = float(self.data.qpos[0]) - turned
        return result


def creep(scene, options, dt_s, seconds):
    """How far the held block sinks from one second after the start to the end, m."""
    peer = Peer({**scene, "dt_s": dt_s}, "blocks", options)

    def height_after(seconds):
        for _ in range(round(seconds / dt_s)):
            mujoco.mj_step(peer.model, peer.data)
        return peer.blocks()[0][0]

    peer.data.ctrl[:] = peer.control[-1]
    settled = height_after(1.0)
    end = height_after(seconds - 1.0)
    return {"dt_s": dt_s, "seconds": seconds, "creep_m": settled - end, "contacts": peer.data.ncon,
            "pinch_n": abs(float(peer.data.actuator_force[0])), "dropped": settled - end > 0.1}
