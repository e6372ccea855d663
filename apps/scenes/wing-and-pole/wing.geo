// The fuel tank of a wing between its spars, without taper: skins, two spars, and ribs at both ends and in the middle. SI.
// x along the chord (nose towards -x), y along the span, z up. Made into wing.msh by make-mesh.
chord = 0.6;   // between the spars
span = 1.2;
front = 0.16;  // heights of the spars, and in the middle
middle = 0.2;
rear = 0.11;
nx = 18;       // elements along the chord
ny = 36;       // along the span
nz = 5;        // along the height

For k In {0:2}
  y = k*span/2;
  Point(10*k + 1) = {0, y, -front/2};
  Point(10*k + 2) = {chord, y, -rear/2};
  Point(10*k + 3) = {chord, y, rear/2};
  Point(10*k + 4) = {0, y, front/2};
  Point(10*k + 5) = {0.45*chord, y, -middle/2};
  Point(10*k + 6) = {0.45*chord, y, middle/2};
  Spline(10*k + 1) = {10*k + 1, 10*k + 5, 10*k + 2};
  Line(10*k + 2) = {10*k + 2, 10*k + 3};
  Spline(10*k + 3) = {10*k + 3, 10*k + 6, 10*k + 4};
  Line(10*k + 4) = {10*k + 4, 10*k + 1};
  Transfinite Curve {10*k + 1, 10*k + 3} = nx + 1;
  Transfinite Curve {10*k + 2, 10*k + 4} = nz + 1;
  Curve Loop(10*k + 1) = {10*k + 1, 10*k + 2, 10*k + 3, 10*k + 4};
  Plane Surface(10*k + 1) = {10*k + 1};
  Transfinite Surface {10*k + 1};
  Recombine Surface {10*k + 1};
EndFor
For k In {0:1}
  For i In {1:4}
    Line(100 + 10*k + i) = {10*k + i, 10*(k + 1) + i};
    Transfinite Curve {100 + 10*k + i} = ny/2 + 1;
  EndFor
  For i In {1:4}
    j = (i % 4) + 1;
    Curve Loop(100 + 10*k + i) = {10*k + i, 100 + 10*k + j, -(10*(k + 1) + i), -(100 + 10*k + i)};
    Surface(100 + 10*k + i) = {100 + 10*k + i};
    Transfinite Surface {100 + 10*k + i};
    Recombine Surface {100 + 10*k + i};
  EndFor
EndFor
Physical Surface("skins", 1) = {101, 103, 111, 113};
Physical Surface("spars", 2) = {102, 104, 112, 114};
Physical Surface("ribs", 3) = {1, 11, 21};
