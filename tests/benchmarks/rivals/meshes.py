# SPDX-License-Identifier: BSD-3-Clause
"""Meshes that both codes read: the same nodes and elements as Gmsh file and as CalculiX deck."""
import math


class Mesh:
    """Nodes and elements count from 0 here and from 1 in files."""

    def __init__(self, gmsh_type):
        self.gmsh_type = gmsh_type  # 3: quad4, 5: hex8, 16: quad8
        self.nodes, self.elements, self.sets = [], [], {}

    def select(self, name, where):
        self.sets[name] = [n for n, x in enumerate(self.nodes) if where(*x)]

    def write_gmsh(self, path):
        """Format 2.2; a node set is a physical group of points."""
        top = 3 if self.gmsh_type == 5 else 2
        names = [(top, 1, "body")] + [(0, 2 + i, name) for i, name in enumerate(self.sets)]
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
        lines += [f'{d} {tag} "{name}"' for d, tag, name in names] + ["$EndPhysicalNames", "$Nodes", str(len(self.nodes))]
        lines += [f"{n + 1} {x!r} {y!r} {z!r}" for n, (x, y, z) in enumerate(self.nodes)] + ["$EndNodes", "$Elements"]
        elements = [(self.gmsh_type, 1, e) for e in self.elements]
        for i, nodes in enumerate(self.sets.values()):
            elements += [(15, 2 + i, [n]) for n in nodes]
        lines.append(str(len(elements)))
        for number, (kind, tag, nodes) in enumerate(elements):
            lines.append(f"{number + 1} {kind} 2 {tag} {tag} " + " ".join(str(n + 1) for n in nodes))
        with open(path, "w") as file:
            file.write("\n".join(lines + ["$EndElements", ""]))

    def calculix(self, element):
        """Cards of nodes, elements (set BODY) and node sets (names in capitals)."""
        lines = ["*NODE, NSET=ALL"] + [f"{n + 1}, {x!r}, {y!r}, {z!r}" for n, (x, y, z) in enumerate(self.nodes)]
        lines.append(f"*ELEMENT, TYPE={element}, ELSET=BODY")
        lines += [f"{i + 1}, " + ", ".join(str(n + 1) for n in e) for i, e in enumerate(self.elements)]
        for name, nodes in self.sets.items():
            lines += [f"*NSET, NSET={name.upper()}"] + [f"{n + 1}," for n in nodes]
        return "\n".join(lines) + "\n"


def quarter_cylinder(radius, length, core, shell, axial):
    """The butterfly of the scene key `type: cylinder` with `part: quarter`: core / 2 elements across the square."""
    n, bulge = core // 2, 1 / 3
    half = radius * min(max(core / (core + 2 * shell), 0.3), 0.6)
    mesh, points, quads = Mesh(5), [], []
    for j in range(n + 1):
        for i in range(n + 1):
            s, t = i / n, j / n
            points.append((half * s * (1 - bulge + bulge * math.sqrt(1 - t * t / 2)),
                           half * t * (1 - bulge + bulge * math.sqrt(1 - s * s / 2))))
    at = lambda i, j: j * (n + 1) + i
    quads += [[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)] for j in range(n) for i in range(n)]
    ring = [at(n, j) for j in range(n)] + [at(i, n) for i in range(n, -1, -1)]
    circle = [(radius * math.cos(a), radius * math.sin(a)) for a in (m * math.pi / (4 * n) for m in range(2 * n + 1))]
    circle[0], circle[-1] = (radius, 0.0), (0.0, radius)
    for steps in range(shell - 1, -1, -1):
        outer = [len(points) + m for m in range(2 * n + 1)]
        for m, inner in enumerate(ring):
            (x, y), (cx, cy) = points[inner], circle[m]
            points.append((x + (cx - x) / (steps + 1), y + (cy - y) / (steps + 1)))
        quads += [[ring[m], outer[m], outer[m + 1], ring[m + 1]] for m in range(2 * n)]
        ring = outer
    layer = len(points)
    mesh.nodes = [(x, y, length * k / axial) for k in range(axial + 1) for x, y in points]
    mesh.elements = [[k * layer + c for c in q] + [(k + 1) * layer + c for c in q] for k in range(axial) for q in quads]
    mesh.select("x_min", lambda x, y, z: x == 0)
    mesh.select("y_min", lambda x, y, z: y == 0)
    mesh.select("bottom", lambda x, y, z: z == 0)
    mesh.select("free_end", lambda x, y, z: x == 0 and y == 0 and z == length)
    mesh.select("foot_edge", lambda x, y, z: x == radius and z == 0)
    return mesh


def strip(length, width, along, quadratic=False):
    """One row of quadrilaterals in z = 0: quad4, or quad8 with the nodes at mid-sides behind the corners."""
    mesh = Mesh(16 if quadratic else 3)
    x = lambda i: length * i / along
    if not quadratic:
        mesh.nodes = [(x(i), width * j, 0.0) for i in range(along + 1) for j in range(2)]
        mesh.elements = [[2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1] for i in range(along)]
    else:  # five nodes a step: two corners, the middle of their edge, and two middles towards the next edge
        for i in range(along + 1):
            mesh.nodes += [(x(i), 0.0, 0.0), (x(i), width, 0.0), (x(i), width / 2, 0.0)]
            if i < along:
                mesh.nodes += [(x(i + 0.5), 0.0, 0.0), (x(i + 0.5), width, 0.0)]
        for i in range(along):
            a, b = 5 * i, 5 * i + 5
            mesh.elements.append([a, b, b + 1, a + 1, a + 3, b + 2, a + 4, a + 2])
    mesh.select("root", lambda x, y, z: x == 0)
    mesh.select("tip", lambda x, y, z: x == length)
    return mesh
