# SPDX-License-Identifier: BSD-3-Clause
"""The Taylor bar of 42CrMo4 (shipped scene, adiabatic Johnson-Cook, 287 m/s) by Tenon on several meshes, one core, beside
published values.
    taylor_bar_steel.py BUILD [CSV = taylor_bar_steel.csv] [--repeats 3]"""
import argparse

from runs import REPOSITORY, Table, Tenon, folder

RADIUS, LENGTH = 3.2e-3, 32.4e-3
# The finest of three independent axisymmetric solutions (20 x 200 quadrilaterals, B-bar).
REFERENCE = {"L_mm": 26.522, "D_mm": 11.249, "T_degC": 607.9, "eqps": 1.875}
# Quoted in the examples of DynELA (impact samples); no run times are given.
PUBLISHED = {"Abaqus 3-D 4455 elements": (26.55, 11.22, 597.01, 1.84), "Abaqus axisymmetric 5 x 50": (26.56, 11.16, 590.96, 1.81)}
MESHES = [(4, 2, 40), (6, 3, 50), (8, 4, 60), (12, 6, 100)]  # core, shell, axial


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("csv", nargs="?", default="taylor_bar_steel.csv")
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    errors = [name.split("_")[0] + "_error" for name in REFERENCE]
    table = Table(options.csv, ["code", "elements", "seconds"] + list(REFERENCE) + errors)

    def row(code, values, **more):
        named = dict(zip(REFERENCE, values))
        error = {e: abs(v / REFERENCE[name] - 1) for e, (name, v) in zip(errors, named.items())}
        table.row(code=code, **named, **error, **more)

    with open(f"{REPOSITORY}/apps/scenes/taylor-bar-42crmo4/scene.yaml") as file:
        scene = file.read()
    for core, shell, axial in MESHES:
        changed = scene.replace("core: 6, shell: 3, axial: 50", f"core: {core}, shell: {shell}, axial: {axial}")
        changed = changed.replace("output:\n", "output:\n  frames: {every: 1 s}\n")
        seconds, summary, last = Tenon(options.build).run(folder(), changed, options.repeats)
        values = (1e3 * (LENGTH + last["free_end_z"]), 2e3 * (RADIUS + last["foot_edge_x"]),
                  last["max_temperature"] - 273.15, last["max_eqps"])
        row("Tenon", values, elements=summary["components"][0]["elements"], seconds=seconds)
    for code, values in PUBLISHED.items():
        row(code, values)


if __name__ == "__main__":
    main()
