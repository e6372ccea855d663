// SPDX-License-Identifier: BSD-3-Clause
// A tube of shells about z. Made by make-mesh.
r = 0.025; h = 0.08; around = 16; up = 32;  // m, m, elements along a quarter and along the axis
Point(1) = {0, 0, 0};
For q In {0:3}
  Point(2 + q) = {r * Cos(q * Pi / 2), r * Sin(q * Pi / 2), 0};
EndFor
For q In {0:3}
  Circle(1 + q) = {2 + q, 1, 2 + (q + 1) % 4};
EndFor
Transfinite Curve{1:4} = around + 1;
Extrude {0, 0, h} { Curve{1:4}; Layers{up}; Recombine; }
Physical Curve("bottom") = {1:4};
Physical Surface("tube") = Surface{:};
