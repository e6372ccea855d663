# SPDX-License-Identifier: BSD-3-Clause
"""The copper Taylor bar at 227 m/s by Tenon and by CalculiX on the same meshes, one core each: run time and error.
    taylor_bar.py BUILD [CSV = taylor_bar.csv] [--repeats 3] [--most-seconds 60]
A quarter of the section, bilateral frictionless wall, 80 us."""
import argparse
import sys

from meshes import quarter_cylinder
from runs import CalculiX, Table, Tenon, folder

RADIUS, LENGTH = 3.2e-3, 32.4e-3
# The finest of independent axisymmetric solutions (10 x 100 quadrilaterals, B-bar); one mesh coarser they are 21.483, 7.164 mm.
REFERENCE_LENGTH, REFERENCE_RADIUS = 21.445, 7.198
MESHES = [(2, 1, 20), (4, 2, 40), (6, 3, 50), (8, 4, 60), (12, 6, 100)]  # core, shell, axial

SCENE = """
title: Taylor bar, copper, 227 m/s
end_time: 80 us
meshes:
  bar: {{type: file, file: mesh.msh}}
materials:
  copper:
    density: 8930 kg/m^3
    elastic: {{youngs_modulus: 117 GPa, poissons_ratio: 0.35}}
    plasticity: {{type: linear_hardening, yield_stress: 400 MPa, hardening_modulus: 100 MPa}}
components:
  mechanics:
    type: explicit_mechanics
    mesh: bar
    material: copper
    hourglass: {{form: {hourglass}}}
    initial_velocity: [0, 0, -227 m/s]
    symmetry_planes:
      - {{node_sets: x_min, normal: [1, 0, 0]}}
      - {{node_sets: y_min, normal: [0, 1, 0]}}
    rigid_walls:
      - {{point: [0, 0, 0], normal: [0, 0, 1], node_sets: bottom, bilateral: true}}
output:
  frames: {{every: 1 s}}
  history:
    every: 80 us
    points:
      free_end: {{field: displacement, point: [0, 0, 32.4 mm]}}
      foot_edge: {{field: displacement, point: [3.2 mm, 0, 0]}}
"""

# Linear hardening as a line from 0 to a plastic strain of 4.
CARDS = """*MATERIAL, NAME=COPPER
*ELASTIC
117E9, 0.35
*DENSITY
8930
*PLASTIC
400E6, 0.
800E6, 4.
*SOLID SECTION, ELSET=BODY, MATERIAL=COPPER
*BOUNDARY
X_MIN, 1, 1
Y_MIN, 2, 2
BOTTOM, 3, 3
*INITIAL CONDITIONS, TYPE=VELOCITY
ALL, 3, -227.
*STEP, NLGEOM, INC=10000000
*DYNAMIC{parameters}
{first}, 80E-6
*NODE PRINT, NSET=FREE_END, FREQUENCY=1000000
U
*NODE PRINT, NSET=FOOT_EDGE, FREQUENCY=1000000
U
*EL PRINT, ELSET=BODY, FREQUENCY=1000000
PEEQ
*END STEP
"""
# Name, element, parameters of *DYNAMIC, first increment (s).
RIVALS = [("C3D8I implicit", "C3D8I", ", ALPHA=-0.3", "2.5E-7"), ("C3D8R implicit", "C3D8R", ", ALPHA=-0.3", "2.5E-7"),
          ("C3D8R explicit", "C3D8R", ", EXPLICIT", "1E-8"), ("C3D8 explicit", "C3D8", ", EXPLICIT", "1E-8")]

# An independent one-point hexahedral code on meshes of its own: elements, steps, length, foot radius, plastic strain. Its
# time is not known; what stands there is elements x steps at the rate of OpenRadioss for such elements with
# rank-independent sums, 1.40 million element-steps per processor second, measured on another machine (EPYC, Zen 3).
INDEPENDENT = [(1080, 7000, 21.4961, 7.1154, 3.047), (2880, 13065, 21.4658, 7.1587, 3.169)]
OPENRADIOSS_RATE = 1.40e6


def of_tenon(tenon, mesh, where, hourglass, repeats):
    mesh.write_gmsh(f"{where}/mesh.msh")
    seconds, summary, row = tenon.run(where, SCENE.format(hourglass=hourglass), repeats)
    return seconds, summary["steps"], row["free_end_z"], row["foot_edge_x"], row["max_eqps"]


def of_calculix(mesh, where, element, parameters, first, repeats):
    deck = mesh.calculix(element) + CARDS.format(parameters=parameters, first=first)
    seconds, tables = CalculiX().run(where, deck, repeats)
    find = lambda words: next(rows for title, rows in tables.items() if words in title)
    strain = max(row[2] for row in find("plastic strain"))
    return seconds, "", find("FREE_END")[0][3], find("FOOT_EDGE")[0][1], strain


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("csv", nargs="?", default="taylor_bar.csv")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--most-seconds", type=float, default=60, help="no finer mesh than that which exceeded this or failed")
    parser.add_argument("--only", default="", help="codes whose name contains this")
    options = parser.parse_args()
    tenon = Tenon(options.build)
    table = Table(options.csv, ["code", "elements", "steps", "seconds", "L_mm", "R_mm", "eqps", "L_error", "R_error"])
    codes = {"Tenon": ["viscous"], "Tenon (physical hourglass)": ["physical"]}
    codes |= {f"CalculiX {name}": settings for name, *settings in RIVALS}

    def row(code, elements, steps, seconds, length, radius, strain):
        if options.only in code:
            table.row(code=code, elements=elements, steps=steps, seconds=seconds, L_mm=length, R_mm=radius, eqps=strain,
                      L_error=abs(length / REFERENCE_LENGTH - 1), R_error=abs(radius / REFERENCE_RADIUS - 1))

    for name, settings in codes.items():
        for core, shell, axial in MESHES if options.only in name else []:
            mesh, where = quarter_cylinder(RADIUS, LENGTH, core, shell, axial), folder()
            try:
                if name.startswith("Tenon"):
                    result = of_tenon(tenon, mesh, where, *settings, options.repeats)
                else:
                    result = of_calculix(mesh, where, *settings, 1)
            except RuntimeError as error:
                print(f"{name}, {len(mesh.elements)} elements: {error}", file=sys.stderr)
                break
            seconds, steps, shortening, growth, strain = result
            row(name, len(mesh.elements), steps, seconds, 1e3 * (LENGTH + shortening), 1e3 * (RADIUS + growth), strain)
            if seconds > options.most_seconds:
                break
    for elements, steps, length, radius, strain in INDEPENDENT:
        row("independent hex8 at OpenRadioss's rate", elements, steps, elements * steps / OPENRADIOSS_RATE, length, radius, strain)


if __name__ == "__main__":
    main()
