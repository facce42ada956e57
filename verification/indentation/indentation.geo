// Half-space under a sphere, axisymmetric: x is the radius, y the axis; it fills [0, domain] x [-domain, 0].
// Cells are uniform on [0, 1.3 a] along the radius and grow by `growth` from there on, and in depth from 1.3 a on.

DefineConstant[
  n = {30, Name "n"},            // cells on [0, a]
  a = {0.01, Name "a"},          // contact radius expected
  domain = {50, Name "domain"},  // radius and depth of the half-space, in units of a
  growth = {1.15, Name "growth"} // ratio of the lengths of neighbouring cells outside the uniform part
];

fine = 1.3 * a;
extent = domain * a;
n_fine = Ceil(1.3 * n);
n_graded = Ceil(Log(1 + (extent - fine) * (growth - 1) * n / a) / Log(growth));

Point(1) = {0, 0, 0};
Point(2) = {fine, 0, 0};
Point(3) = {extent, 0, 0};
Point(4) = {0, -fine, 0};
Point(5) = {fine, -fine, 0};
Point(6) = {extent, -fine, 0};
Point(7) = {0, -extent, 0};
Point(8) = {fine, -extent, 0};
Point(9) = {extent, -extent, 0};

Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {4, 5};
Line(4) = {5, 6};
Line(5) = {7, 8};
Line(6) = {8, 9};
Line(7) = {1, 4};
Line(8) = {2, 5};
Line(9) = {3, 6};
Line(10) = {4, 7};
Line(11) = {5, 8};
Line(12) = {6, 9};

Transfinite Curve{1, 3, 5, 7, 8, 9} = n_fine + 1;
Transfinite Curve{2, 4, 6, 10, 11, 12} = n_graded + 1 Using Progression growth;

Curve Loop(1) = {3, -8, -1, 7};
Curve Loop(2) = {4, -9, -2, 8};
Curve Loop(3) = {5, -11, -3, 10};
Curve Loop(4) = {6, -12, -4, 11};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};
Plane Surface(4) = {4};
Transfinite Surface{1, 2, 3, 4};
Recombine Surface{1, 2, 3, 4};

Physical Surface("halfspace") = {1, 2, 3, 4};
Physical Curve("top") = {1, 2};
Physical Curve("bottom") = {5, 6};
Physical Curve("axis") = {7, 10};
