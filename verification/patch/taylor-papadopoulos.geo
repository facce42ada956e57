// A punch [1, 2] x [1, 2] on the middle of a foundation [0, 3] x [0, 1], with meshes of their own.

DefineConstant[
  n_foundation = {4, Name "n_foundation"}, // cells per unit length, foundation
  n_punch = {4, Name "n_punch"}            // cells per unit length, punch
];

Point(1) = {0, 0, 0};
Point(2) = {3, 0, 0};
Point(3) = {3, 1, 0};
Point(4) = {2, 1, 0};
Point(5) = {1, 1, 0};
Point(6) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Transfinite Curve{1} = 3 * n_foundation + 1;
Transfinite Curve{2, 3, 4, 5, 6} = n_foundation + 1;
Transfinite Surface{1} = {1, 2, 3, 6};

Point(11) = {1, 1, 0};
Point(12) = {2, 1, 0};
Point(13) = {2, 2, 0};
Point(14) = {1, 2, 0};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(11) = {11, 12, 13, 14};
Plane Surface(11) = {11};
Transfinite Curve{11, 12, 13, 14} = n_punch + 1;
Transfinite Surface{11};
Recombine Surface{1, 11};

Physical Surface("foundation") = {1};
Physical Surface("punch") = {11};
Physical Curve("bottom") = {1};
Physical Curve("below_punch") = {4};
Physical Curve("beside_punch") = {3, 5};
Physical Curve("punch_bottom") = {11};
Physical Curve("punch_top") = {13};
Physical Curve("foundation_left") = {6};
Physical Curve("punch_left") = {14};
