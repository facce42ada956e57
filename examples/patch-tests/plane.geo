// Two blocks of 2 x 1, one on the other, with meshes of their own.

DefineConstant[
  n_lower = {4, Name "n_lower"}, // cells per unit length, lower block
  n_upper = {4, Name "n_upper"}  // cells per unit length, upper block
];

Point(1) = {0, 0, 0};
Point(2) = {2, 0, 0};
Point(3) = {2, 1, 0};
Point(4) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 2 * n_lower + 1;
Transfinite Curve{2, 4} = n_lower + 1;

Point(11) = {0, 1, 0};
Point(12) = {2, 1, 0};
Point(13) = {2, 2, 0};
Point(14) = {0, 2, 0};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(11) = {11, 12, 13, 14};
Plane Surface(11) = {11};
Transfinite Curve{11, 13} = 2 * n_upper + 1;
Transfinite Curve{12, 14} = n_upper + 1;

Transfinite Surface{1, 11};
Recombine Surface{1, 11};

Physical Surface("lower") = {1};
Physical Surface("upper") = {11};
Physical Curve("bottom") = {1};
Physical Curve("lower_top") = {3};
Physical Curve("upper_bottom") = {11};
Physical Curve("top") = {13};
Physical Curve("left") = {4, 14};
