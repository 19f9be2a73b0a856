#!/usr/bin/env python3
"""Plays an exported world in MuJoCo: a file with a job comes in, the joints' course goes out as JSON.

The job: {"model": path, "step_s": s, "at_s": [...], "speed": {joint: speed at the start},
          "controls": [[...]]            where the motors are led, one row a time, or
          "force": {"body": name, "site": name, "rows": [[fx, fz], ...]}}
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


def play(job):
    model = mujoco.MjModel.from_xml_string(Path(job["model"]).read_text(encoding="utf-8"))
    model.opt.timestep = job["step_s"]
    data = mujoco.MjData(model)
    for name, value in job.get("speed", {}).items():
        data.qvel[model.joint(name).dofadr[0]] = value
    if "controls" in job:
        lead(model, data, job["controls"][0])
    mujoco.mj_forward(model, data)
    names = [model.joint(i).name for i in range(model.njnt)]
    rows = []
    for index, at_s in enumerate(job["at_s"]):
        while data.time < at_s - 0.5 * job["step_s"]:
            if "controls" in job:
                data.ctrl[:] = job["controls"][index]
            elif "force" in job:
                push(model, data, job["force"], index)
            mujoco.mj_step(model, data)
        rows.append(data.qpos.tolist())
    return {"mujoco": mujoco.__version__, "joints": names, "rows": rows}


def lead(model, data, control):
    """Fingers start where they are led at first."""
    for motor, place in enumerate(control):
        data.qpos[model.jnt_qposadr[model.actuator_trnid[motor, 0]]] = place


def push(model, data, force, index):
    """A force in the plane at a site, whatever else acts there."""
    fx, fz = force["rows"][index]
    data.qfrc_applied[:] = 0.0
    mujoco.mj_applyFT(model, data, numpy.array([fx, 0.0, fz]), numpy.zeros(3),
                      data.site(force["site"]).xpos, model.body(force["body"]).id, data.qfrc_applied)


if __name__ == "__main__":
    print(json.dumps(play(json.loads(Path(sys.argv[1]).read_text(encoding="utf-8")))))
