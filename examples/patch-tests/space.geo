// Two blocks of 2 x 1 x 1, one on the other, with meshes of their own. The points on z = 1 exist twice, so the blocks
// are built from their corners: an extrusion would weld them together.

DefineConstant[
  n_lower = {3, Name "n_lower"}, // cells per unit length, lower block
  n_upper = {3, Name "n_upper"}  // cells per unit length, upper block
];

// A brick [0, 2] x [0, 1] x [z, z + 1] of n cells per unit length; leaves its entities in face_... and brick.
Macro Brick
  p = newp;
  Point(p) = {0, 0, z};
  Point(p + 1) = {2, 0, z};
  Point(p + 2) = {2, 1, z};
  Point(p + 3) = {0, 1, z};
  Point(p + 4) = {0, 0, z + 1};
  Point(p + 5) = {2, 0, z + 1};
  Point(p + 6) = {2, 1, z + 1};
  Point(p + 7) = {0, 1, z + 1};
  l = newl;
  For i In {0:3}
    Line(l + i) = {p + i, p + (i + 1) % 4};
    Line(l + 4 + i) = {p + 4 + i, p + 4 + (i + 1) % 4};
    Line(l + 8 + i) = {p + i, p + 4 + i};
  EndFor
  Transfinite Curve{l, l + 2, l + 4, l + 6} = 2 * n + 1;
  Transfinite Curve{l + 1, l + 3, l + 5, l + 7, l + 8, l + 9, l + 10, l + 11} = n + 1;
  s = news;
  Curve Loop(s) = {l, l + 1, l + 2, l + 3};
  Plane Surface(s) = {s};
  Curve Loop(s + 1) = {l + 4, l + 5, l + 6, l + 7};
  Plane Surface(s + 1) = {s + 1};
  For i In {0:3}
    Curve Loop(s + 2 + i) = {l + i, l + 8 + (i + 1) % 4, -(l + 4 + i), -(l + 8 + i)};
    Plane Surface(s + 2 + i) = {s + 2 + i};
  EndFor
  Transfinite Surface{s, s + 1, s + 2, s + 3, s + 4, s + 5};
  Recombine Surface{s, s + 1, s + 2, s + 3, s + 4, s + 5};
  face_bottom = s;
  face_top = s + 1;
  face_front = s + 2; // y = 0
  face_left = s + 5;  // x = 0
  brick = newv;
  Surface Loop(brick) = {s, s + 1, s + 2, s + 3, s + 4, s + 5};
  Volume(brick) = {brick};
  Transfinite Volume{brick};
Return

z = 0;
n = n_lower;
Call Brick;
Physical Volume("lower") = {brick};
Physical Surface("bottom") = {face_bottom};
Physical Surface("lower_top") = {face_top};
lower_front = face_front;
lower_left = face_left;

z = 1;
n = n_upper;
Call Brick;
Physical Volume("upper") = {brick};
Physical Surface("upper_bottom") = {face_bottom};
Physical Surface("top") = {face_top};
Physical Surface("front") = {lower_front, face_front};
Physical Surface("left") = {lower_left, face_left};
