// What the fuel fills: both bays of the tank of wing.geo, less a margin to every wall (half a particle and the shell). SI.
// Made into fuel.msh by make-mesh.
chord = 0.6;
half_span = 0.6;
front = 0.16;
middle = 0.2;
rear = 0.11;
m = 0.0125;  // margin
Mesh.MeshSizeMin = 0.1;
Mesh.MeshSizeMax = 0.1;

For b In {0:1}
  For k In {0:1}
    o = 100*b + 10*k;
    y = b*half_span + (k == 0 ? m : half_span - m);
    // The skins lean by up to 0.15: a margin across them is one along z, but for a hundredth.
    Point(o + 1) = {m, y, -front/2 + m};
    Point(o + 2) = {chord - m, y, -rear/2 + m};
    Point(o + 3) = {chord - m, y, rear/2 - m};
    Point(o + 4) = {m, y, front/2 - m};
    Point(o + 5) = {0.45*chord, y, -middle/2 + m};
    Point(o + 6) = {0.45*chord, y, middle/2 - m};
    Spline(o + 1) = {o + 1, o + 5, o + 2};
    Line(o + 2) = {o + 2, o + 3};
    Spline(o + 3) = {o + 3, o + 6, o + 4};
    Line(o + 4) = {o + 4, o + 1};
    Curve Loop(o + 1) = {o + 1, o + 2, o + 3, o + 4};
    Plane Surface(o + 1) = {o + 1};
  EndFor
  o = 100*b;
  For i In {1:4}
    Line(o + 20 + i) = {o + i, o + 10 + i};
  EndFor
  For i In {1:4}
    j = (i % 4) + 1;
    Curve Loop(o + 20 + i) = {o + i, o + 20 + j, -(o + 10 + i), -(o + 20 + i)};
    Surface(o + 20 + i) = {o + 20 + i};
  EndFor
EndFor
Physical Surface("fuel", 1) = {1, 11, 21, 22, 23, 24, 101, 111, 121, 122, 123, 124};
