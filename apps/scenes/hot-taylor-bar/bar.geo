// SPDX-License-Identifier: BSD-3-Clause
// The copper bar of the main job: a full round cylinder about z, impact face at z = 0, in metres. Both meshes are made
// from this file; `make-meshes` runs Gmsh with hexahedra = 1 and 0.
//
//   hexahedra = 1: a butterfly of 36 + 4 x 18 quadrangles (27 per quarter), drawn out in 50 layers: 5400 hex8
//   hexahedra = 0: the same cylinder without inner lines, filled with unstructured tetrahedra of edge `edge`
//
// Physical groups, of the same names in both: volume "bar"; surfaces "foot" (z = 0), "top" (z = length), "side".
DefineConstant[
  hexahedra = {1, Choices{0, 1}, Name "Hexahedra"}
  layers = {50, Name "Layers along the bar"}
  core_elements = {6, Name "Elements across the core"}
  shell_elements = {3, Name "Elements from core to surface"}
  edge = {0.000465, Name "Edge of a tetrahedron"}
];
radius = 0.0032;   // m
length = 0.0324;   // m

// The circle, in four arcs from corner to corner on the diagonals.
s = radius * Sqrt(0.5);
Point(1) = {0, 0, 0, edge};
Point(2) = { s, -s, 0, edge};
Point(3) = { s,  s, 0, edge};
Point(4) = {-s,  s, 0, edge};
Point(5) = {-s, -s, 0, edge};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 2};

If (hexahedra)
  // The core: a square whose sides bulge, so that the three quadrangles at its corners have angles near 120 degrees.
  // Corners at (c, c), middle of a side at (b, 0); the arc through them has its centre at (-m, 0).
  c = 0.42 * radius;
  b = 0.48 * radius;
  m = (2 * c * c - b * b) / (2 * (b - c));
  Point(12) = { c, -c, 0};
  Point(13) = { c,  c, 0};
  Point(14) = {-c,  c, 0};
  Point(15) = {-c, -c, 0};
  Point(16) = {-m, 0, 0};
  Point(17) = {0, -m, 0};
  Point(18) = { m, 0, 0};
  Point(19) = {0,  m, 0};
  Circle(11) = {12, 16, 13};
  Circle(12) = {13, 17, 14};
  Circle(13) = {14, 18, 15};
  Circle(14) = {15, 19, 12};
  Line(21) = {12, 2};
  Line(22) = {13, 3};
  Line(23) = {14, 4};
  Line(24) = {15, 5};
  Curve Loop(1) = {11, 12, 13, 14};
  Curve Loop(2) = {21, 1, -22, -11};
  Curve Loop(3) = {22, 2, -23, -12};
  Curve Loop(4) = {23, 3, -24, -13};
  Curve Loop(5) = {24, 4, -21, -14};
  Plane Surface(1) = {1};
  Plane Surface(2) = {2};
  Plane Surface(3) = {3};
  Plane Surface(4) = {4};
  Plane Surface(5) = {5};
  Transfinite Curve {1:4, 11:14} = core_elements + 1;
  Transfinite Curve {21:24} = shell_elements + 1;
  Transfinite Surface {1:5};
  Recombine Surface {1:5};
  bottom[] = {1, 2, 3, 4, 5};
Else
  Curve Loop(1) = {1, 2, 3, 4};
  Plane Surface(1) = {1};
  bottom[] = {1};
EndIf

volumes[] = {};
tops[] = {};
sides[] = {};
For i In {0 : #bottom[] - 1}
  If (hexahedra)
    made[] = Extrude {0, 0, length} { Surface{bottom[i]}; Layers{layers}; Recombine; };
  Else
    made[] = Extrude {0, 0, length} { Surface{bottom[i]}; };
  EndIf
  tops[] += made[0];
  volumes[] += made[1];
  If (!hexahedra)
    sides[] += {made[2], made[3], made[4], made[5]};
  ElseIf (i > 0)
    sides[] += made[3];   // the second curve of each outer loop lies on the circle
  EndIf
EndFor

Physical Volume("bar", 1) = volumes[];
Physical Surface("foot", 1) = bottom[];
Physical Surface("top", 2) = tops[];
Physical Surface("side", 3) = sides[];

Mesh.ElementOrder = 1;
Mesh.MshFileVersion = 4.1;
Mesh.Algorithm = 6;       // frontal Delaunay on surfaces
Mesh.Algorithm3D = 1;     // Delaunay
Mesh.Optimize = 1;
Mesh.OptimizeThreshold = 0.5;
Mesh.SaveAll = 0;
