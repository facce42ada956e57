// Two concentric tubes whose nodes match, axisymmetric: x is the radius, y the axis.

DefineConstant[
  r_inner = {0.2, Name "r_inner"},
  r_fit = {0.6, Name "r_fit"},
  r_outer = {1, Name "r_outer"},
  interference = {0, Name "interference"}, // radial, at rest
  n = {40, Name "n"}                       // cells across each tube
];

height = 0.04;
n_along = 4;

// A tube from radius r to R; leaves its curves in l: bottom, outside, top, bore.
Macro Tube
  p = newp;
  Point(p) = {r, 0, 0};
  Point(p + 1) = {R, 0, 0};
  Point(p + 2) = {R, height, 0};
  Point(p + 3) = {r, height, 0};
  l = newl;
  For i In {0:3}
    Line(l + i) = {p + i, p + (i + 1) % 4};
  EndFor
  Transfinite Curve{l, l + 2} = n + 1;
  Transfinite Curve{l + 1, l + 3} = n_along + 1;
  c = newll;
  Curve Loop(c) = {l, l + 1, l + 2, l + 3};
  s = news;
  Plane Surface(s) = {c};
  Transfinite Surface{s};
  Recombine Surface{s};
Return

r = r_inner;
R = r_fit + interference;
Call Tube;
Physical Surface("inner_tube") = {s};
Physical Curve("inner_rim") = {l + 1};
below = l;

r = r_fit;
R = r_outer;
Call Tube;
Physical Surface("outer_tube") = {s};
Physical Curve("outer_bore") = {l + 3};
Physical Curve("outside") = {l + 1};
Physical Curve("end") = {below, l};
