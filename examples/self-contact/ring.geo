// The right half of a ring, of mean radius 1, so that it may be pressed flat.
DefineConstant[
  n = {40, Name "n"},                // cells along a quarter of the ring
  thickness = {0.1, Name "thickness"}
];

outer = 1 + thickness / 2;
inner = 1 - thickness / 2;
Point(1) = {0, 0, 0};
Point(2) = {0, -outer, 0};
Point(3) = {outer, 0, 0};
Point(4) = {0, outer, 0};
Point(5) = {0, -inner, 0};
Point(6) = {inner, 0, 0};
Point(7) = {0, inner, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {5, 1, 6};
Circle(4) = {6, 1, 7};
Line(5) = {2, 5};
Line(6) = {3, 6};
Line(7) = {4, 7};
Curve Loop(1) = {1, 6, -3, -5};
Curve Loop(2) = {2, 7, -4, -6};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve {1, 2, 3, 4} = n + 1;
Transfinite Curve {5, 6, 7} = 4;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
Physical Surface("ring") = {1, 2};
Physical Curve("outside") = {1, 2};
Physical Curve("inside") = {3, 4};
Physical Curve("cut") = {5, 7};
