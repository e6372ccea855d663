# SPDX-License-Identifier: BSD-3-Clause
"""A cantilever of shells bent through large rotations by Tenon (dynamic relaxation) and by CalculiX (implicit statics).
    cantilever.py BUILD [CSV = cantilever.csv] [--repeats 3] [--most-seconds 60]
Length 10, width 1, thickness 0.1, E = 1.2e6, nu = 0, dead load P = 4 at the tip, so that P L^2 / (E I) = 4 ([Sze04] 3.1).
The reference is the elastica, which does not stretch: its difference from a beam that does is of the order of
(t/L)^2 = 1e-4, so smaller errors mean nothing."""
import argparse
import sys

from meshes import strip
from runs import CalculiX, Table, Tenon, folder

LENGTH, WIDTH, THICKNESS, LOAD = 10.0, 1.0, 0.1, 4.0
REFERENCE_U, REFERENCE_W = 3.289412422, 6.699641813
ALONG = [4, 8, 16, 32, 64]

SCENE = """
title: Cantilever of shells
end_time: 500 s
meshes:
  strip: {{type: file, file: mesh.msh}}
materials:
  rubbery: {{density: 1 kg/m^3, elastic: {{youngs_modulus: 1.2e6 Pa, poissons_ratio: 0}}}}
components:
  mechanics:
    type: explicit_mechanics
    mesh: strip
    material: rubbery
    shell: {{thickness: {thickness} m}}
    bulk_viscosity: {{linear: 0, quadratic: 0}}
    fixed: [{{node_sets: root}}]
    nodal_forces: [{{node_sets: tip, z: {load} N, shared: true}}]
    dynamic_relaxation: {{tolerance: 1e-4}}
output:
  frames: {{every: 1e9 s}}
  log: {{every: 1e9 s}}
  history:
    every: 1e9 s
    points: {{tip: {{field: displacement, point: [{length} m, 0, 0]}}}}
"""

CARDS = """*MATERIAL, NAME=RUBBERY
*ELASTIC
1.2E6, 0.
*SHELL SECTION, ELSET=BODY, MATERIAL=RUBBERY
{thickness}
*BOUNDARY
ROOT, 1, 6
*STEP, NLGEOM, INC=10000
*STATIC
0.1, 1.
*CLOAD
{loads}
*NODE PRINT, NSET=TIP, FREQUENCY=100000
U
*END STEP
"""
RIVALS = ["S4", "S4R", "S8", "S8R"]


def of_tenon(tenon, mesh, where, repeats):
    mesh.write_gmsh(f"{where}/mesh.msh")
    scene = SCENE.format(thickness=THICKNESS, length=LENGTH, load=LOAD)
    seconds, summary, row = tenon.run(where, scene, repeats)
    return seconds, summary["steps"], -row["tip_x"], row["tip_z"]


def of_calculix(mesh, where, element, repeats):
    tip = mesh.sets["tip"]
    shares = [LOAD / 2] * 2 if len(tip) == 2 else [LOAD / 6, LOAD / 6, 4 * LOAD / 6]  # two corners, the middle
    loads = "\n".join(f"{n + 1}, 3, {share!r}" for n, share in zip(tip, shares))
    deck = mesh.calculix(element) + CARDS.format(thickness=THICKNESS, loads=loads)
    seconds, tables = CalculiX().run(where, deck, repeats)
    rows = next(rows for title, rows in tables.items() if "TIP" in title)
    mean = lambda column: sum(row[column] for row in rows[:2]) / 2
    return seconds, "", -mean(1), mean(3)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("csv", nargs="?", default="cantilever.csv")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--most-seconds", type=float, default=60, help="no finer mesh than that which exceeded this")
    options = parser.parse_args()
    tenon = Tenon(options.build)
    table = Table(options.csv, ["code", "elements", "steps", "seconds", "U", "W", "U_error", "W_error"])
    for rival in [None] + RIVALS:
        for along in ALONG:
            mesh, where = strip(LENGTH, WIDTH, along, rival in ("S8", "S8R")), folder()
            try:
                result = (of_calculix(mesh, where, rival, options.repeats) if rival
                          else of_tenon(tenon, mesh, where, options.repeats))
            except RuntimeError as error:
                print(error, file=sys.stderr)
                continue
            seconds, steps, u, w = result
            table.row(code=f"CalculiX {rival}" if rival else "Tenon", elements=along, steps=steps, seconds=seconds, U=u, W=w,
                      U_error=abs(u / REFERENCE_U - 1), W_error=abs(w / REFERENCE_W - 1))
            if seconds > options.most_seconds:
                break


if __name__ == "__main__":
    main()
