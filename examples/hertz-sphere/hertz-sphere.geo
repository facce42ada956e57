// Lower half of a sphere whose pole rests on the plane y = 0, axisymmetric: x is the radius, y the axis.
// A fine block of uniform cells about the pole is wide enough for the contact; two graded blocks fill the rest.

DefineConstant[
  R = {1, Name "R"},               // radius of the sphere
  a = {0.02, Name "a"},            // contact radius expected
  n = {60, Name "n"},              // cells on [0, a]
  growth = {1.12, Name "growth"}   // ratio of the lengths of neighbouring cells outside the fine block
];

fine = 1.25; // width and height of the fine block, in units of a
b = fine * a;
n_fine = Ceil(fine * n);
n_graded = Ceil(Log(1 + R * (growth - 1) * n / a) / Log(growth));

Point(1) = {0, 0, 0};
Point(2) = {b, R - Sqrt(R^2 - b^2), 0};
Point(3) = {b, b, 0};
Point(4) = {0, b, 0};
Point(5) = {R, R, 0};
Point(6) = {0.55 * R, R, 0};
Point(7) = {0, R, 0}; // centre of the sphere

Circle(1) = {1, 7, 2};
Line(2) = {2, 3};
Line(3) = {4, 3};
Line(4) = {1, 4};
Circle(5) = {2, 7, 5};
Line(6) = {6, 5};
Line(7) = {3, 6};
Line(8) = {7, 6};
Line(9) = {4, 7};

Transfinite Curve{1, 2, 3, 4, 6, 8} = n_fine + 1;
Transfinite Curve{5, 7, 9} = n_graded + 1 Using Progression growth;

Curve Loop(1) = {1, 2, -3, -4};
Curve Loop(2) = {5, -6, -7, -2};
Curve Loop(3) = {3, 7, -8, -9};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};
Transfinite Surface{1, 2, 3};
Recombine Surface{1, 2, 3};

Physical Surface("sphere") = {1, 2, 3};
Physical Curve("sphere_bottom") = {1, 5};
Physical Curve("axis") = {4, 9};
Physical Curve("equator") = {6, 8};
