#!/usr/bin/env python3
"""Opens an exported world in Drake and lets it go: a file with a job comes in, what Drake sees goes out as JSON.

The job: {"model": path, "seconds": s, "every_s": s}; angles are of the first joint that turns, counted from where the world starts.
"""

import json
import logging
import sys

try:
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder
except (ImportError, OSError) as why:
    print(f"skipped: Python has no Drake ({why})")
    raise SystemExit(0)

# What its reader has no use for (a world's own gravity and steps) it says at length.
logging.getLogger("drake").setLevel(logging.ERROR)


def play(job):
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=2e-4)
    models = Parser(plant).AddModels(job["model"])
    plant.Finalize()
    diagram = builder.Build()
    bodies = {plant.get_body(b).scoped_name().get_full(): plant.get_body(b).default_mass() for m in models for b in plant.GetBodyIndices(m)}
    joints = [plant.get_joint(j) for m in models for j in plant.GetJointIndices(m)]
    turning = next((j for j in joints if j.type_name() == "revolute"), None)
    said = {"bodies": bodies, "joints": {j.name(): j.type_name() for j in joints}, "angles": []}
    if turning is None or job["seconds"] <= 0.0:
        return said
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    for index in range(round(job["seconds"] / job["every_s"]) + 1):
        simulator.AdvanceTo(index * job["every_s"])
        said["angles"].append(turning.get_angle(context))
    return said


if __name__ == "__main__":
    print(json.dumps(play(json.load(open(sys.argv[1], encoding="utf-8")))))
