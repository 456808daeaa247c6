#!/usr/bin/env python3
"""Compares a step of the smoke with one of Mantaflow, as built into Debian's Blender (apt-get install blender).

usage: tools/compare_mantaflow.py [--cells N] [--frames N] [--bench FILE]

Mantaflow gets a box of N³ cells, open but for its floor, with four jets and an ellipsoid that bobs, one substep a
frame and no adaptive domain; prostm gets four plumes and the scripted hand. Prints the time of a frame (medians), and
the largest divergence left (|∇·u| Δt, per cell) away from obstacles, jets and sides.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WARM_UP = 10  # frames
SOLVERS = ("multigrid", "3 V-cycles", "mgpcg")

# In Blender. A frame lasts 0.1·25/fps of Mantaflow's units of time; velocities are in cells per unit.
IN_BLENDER = """
import bpy, json, math, sys, time
import numpy as np
cells, frames, folder, out = int(sys.argv[-4]), int(sys.argv[-3]), sys.argv[-2], sys.argv[-1]
FPS, EDGE = 50, 3.6
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps, scene.frame_start, scene.frame_end = FPS, 1, frames

def fluid(name, kind):
    made = bpy.context.object
    made.name = name
    modifier = made.modifiers.new("fluid", "FLUID")
    modifier.fluid_type = kind
    return made, modifier

bpy.ops.mesh.primitive_cube_add(size=EDGE, location=(0, 0, EDGE / 2))
domain, modifier = fluid("domain", "DOMAIN")
box = modifier.domain_settings
box.domain_type, box.resolution_max, box.use_adaptive_domain = "GAS", cells, False
box.cache_type, box.cache_directory = "REPLAY", folder
box.use_adaptive_timesteps, box.timesteps_min, box.timesteps_max = False, 1, 1
box.alpha = box.beta = 0
for side in ("front", "back", "left", "right", "top", "bottom"):
    setattr(box, "use_collision_border_" + side, side == "bottom")

for x, y in ((-0.45, -0.45), (0.45, -0.45), (-0.45, 0.45), (0.45, 0.45)):
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(x, y, 0.1))
    jet, modifier = fluid("jet", "FLOW")
    jet.scale = (1, 1, 0.2)
    flow = modifier.flow_settings
    flow.flow_type, flow.flow_behavior = "SMOKE", "INFLOW"
    flow.use_initial_velocity, flow.velocity_coord = True, (0, 0, 6)

bpy.ops.mesh.primitive_uv_sphere_add(radius=0.4, segments=24, ring_count=16)
hand, modifier = fluid("hand", "EFFECTOR")
modifier.effector_settings.effector_type = "COLLISION"
hand.scale = (1, 1.6, 0.4)
for frame in range(1, frames + 1):
    hand.location = (0, 0, 2 + 0.2 * math.sin(2 * math.pi * frame / FPS))
    hand.keyframe_insert("location", frame=frame)

def largest_divergence():
    settings = domain.evaluated_get(bpy.context.evaluated_depsgraph_get()).modifiers["fluid"].domain_settings
    u = np.array(settings.velocity_grid[:]).reshape(cells, cells, cells, 3)  # z, y, x; at faces
    d = (u[1:-1, 1:-1, 2:, 0] - u[1:-1, 1:-1, 1:-1, 0] + u[1:-1, 2:, 1:-1, 1] - u[1:-1, 1:-1, 1:-1, 1] +
         u[2:, 1:-1, 1:-1, 2] - u[1:-1, 1:-1, 1:-1, 2])
    h = EDGE / cells
    z, y, x = np.meshgrid(*(h * (np.arange(1, cells - 1) + 0.5) - offset for offset in (0, EDGE / 2, EDGE / 2)),
                          indexing="ij")
    free = (np.abs(z - 2) > 0.6) & (z > 0.5) & (z < EDGE - 4 * h)
    free &= (np.abs(x) < EDGE / 2 - 4 * h) & (np.abs(y) < EDGE / 2 - 4 * h)
    return float(np.abs(d[free]).max()) * 0.1 * 25 / FPS

times, divergence = [], []
for frame in range(1, frames + 1):
    begin = time.perf_counter()
    scene.frame_set(frame)
    times.append(time.perf_counter() - begin)
    if frame > 10 and frame % 10 == 0:
        divergence.append(largest_divergence())
json.dump({"times": times, "divergence": divergence}, open(out, "w"))
"""


def median(values):
    return sorted(values)[len(values) // 2]


def mantaflow(cells, frames):
    """Returns the median time of a frame [ms] and the median of the largest divergence."""
    with tempfile.TemporaryDirectory() as folder:
        script, out = Path(folder) / "scene.py", Path(folder) / "out.json"
        script.write_text(IN_BLENDER)
        subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", script,
                        "--", str(cells), str(frames), folder, out], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.PIPE, env={**os.environ, "PATH": "/usr/bin:/bin"})  # where its own Python is
        result = json.loads(out.read_text())
    return 1e3 * median(result["times"][WARM_UP:]), median(result["divergence"])


def ours(bench, cells):
    """Returns the same for prostm's solvers, from its benchmark."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.json"
        subprocess.run([bench, "--json", out], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        rows = {row["name"]: row["p50"] for row in json.loads(out.read_text())}
    return [(rows[f"step {cells}^3 with a hand, {solver}"],
             rows[f"away from hands, jets and sides, {cells}^3, {solver}"]) for solver in SOLVERS]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=64, choices=(32, 64, 96, 128, 160), help="along an edge")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--bench", type=Path, default=ROOT / "build/release/fluid_bench")
    given = parser.parse_args()
    try:
        time, divergence = mantaflow(given.cells, given.frames)
        by_solver = ours(given.bench, given.cells)
    except FileNotFoundError as error:
        sys.exit(f"{error.filename} is missing: install blender, and run ./run bench fluid once")
    except subprocess.CalledProcessError as error:
        sys.exit(f"{error.cmd[0]} failed with {error.returncode}: {error.stderr.decode().strip()[-500:]}")
    print(f"{given.cells}³ cells        Mantaflow" + "".join(f"  {solver:>10}" for solver in SOLVERS))
    print(f"a step [ms]      {time:10.1f}" + "".join(f"  {ms:10.2f}" for ms, _ in by_solver))
    print(f"largest |∇·u| Δt {divergence:10.1e}" + "".join(f"  {left:10.1e}" for _, left in by_solver))
    print("faster by                  " + "".join(f"  {time / ms:9.0f}×" for ms, _ in by_solver))


if __name__ == "__main__":
    main()
