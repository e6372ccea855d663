# SPDX-License-Identifier: BSD-3-Clause
"""Whether mechanics and conduction on one scene, without a transfer, cost the sum of the two alone.
    sum_of_parts.py BUILD [--turns 7] [--command PREFIX]
Each turn runs the three scenes one after the other, long and short; the difference of a scene's two times (processor
seconds, user, of the whole process) is what its steps cost, without set-up and output. Printed: both over the sum, turn
by turn, and the median. On one rank."""
import argparse
import os
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "rivals"))
from runs import environment  # noqa: E402

HEAD = """
title: {title}
end_time: {end} us
meshes:
  solid: {{type: box, high: [1, 1, 1], elements: [32, 32, 32]}}
  warm: {{type: box, high: [1, 1, 1], elements: [48, 48, 48], element: tet4}}
materials:
  steel:
    density: 7850
    elastic: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3}}
    plasticity: {{type: linear_hardening, yield_stress: 400 MPa, hardening_modulus: 1 GPa}}
    thermal: {{conductivity: 40 W/(m K), specific_heat: 500 J/(kg K), reference_temperature: 20 degC}}
output: {{frames: {{every: 1 s}}, history: {{every: 1 s}}, log: {{every: 1 s}}}}
components:
"""
MECHANICS = """
  mechanics:
    type: explicit_mechanics
    mesh: solid
    material: steel
    initial_velocities: [{gradient: [-2000, 300, 0, 0, 500, 0, 0, 0, 700]}]
    time_step: {fixed: 0.5 us}
"""
# A little more than ten steps of mechanics, so that rounding does not add one.
CONDUCTION = """
  conduction:
    type: heat_conduction
    mesh: warm
    material: steel
    stepper: crank_nicolson
    time_step: {fixed: 5.000001 us}
    initial_temperatures: [{temperature: 300 K, gradient: [100, 50, 20]}]
"""
SCENES = {"mechanics": MECHANICS, "conduction": CONDUCTION, "both": MECHANICS + CONDUCTION}
SHORT, LONG = 10, 210  # us


def user_seconds(prefix, program, folder, name, end):
    path = os.path.join(folder, f"{name}{end}.yaml")
    with open(path, "w") as file:
        file.write(HEAD.format(title=name, end=end) + SCENES[name])
    process = subprocess.Popen(prefix + [program, "run", path, "-o", path + ".out"], stdout=subprocess.DEVNULL, env=environment())
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise RuntimeError(f"{path} failed")
    return usage.ru_utime


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("--turns", type=int, default=7)
    parser.add_argument("--command", default="", help="words before the program, such as: taskset -c 0")
    options = parser.parse_args()
    program, folder = os.path.join(os.path.abspath(options.build), "tenon"), tempfile.mkdtemp(prefix="sum-of-parts-")
    ratios = []
    for _ in range(options.turns):
        cost = {name: 0.0 for name in SCENES}
        for end, sign in ((LONG, 1), (SHORT, -1)):
            for name in SCENES:
                cost[name] += sign * user_seconds(options.command.split(), program, folder, name, end)
        ratios.append(cost["both"] / (cost["mechanics"] + cost["conduction"]))
        print(f"mechanics {cost['mechanics']:.2f} s, conduction {cost['conduction']:.2f} s, both {cost['both']:.2f} s: "
              f"{ratios[-1]:.4f}", flush=True)
    print(f"median {statistics.median(ratios):.4f} of the sum")


if __name__ == "__main__":
    main()
