// Rigid flat punch on an elastic half-space, axisymmetric: x is the radius, y the axis.
// The half-space fills [0, domain] x [-domain, 0]; cells are uniform on [0, a] along the radius and grow by `growth`
// from there on, and in depth from the same size at the surface.

DefineConstant[
  n = {400, Name "n"},           // cells on [0, a]
  a = {1, Name "a"},             // radius of the punch
  domain = {100, Name "domain"}, // radius and depth of the half-space, in units of a
  growth = {1.1, Name "growth"}  // ratio of the lengths of neighbouring cells outside the uniform part
];

h = a / n;
extent = domain * a;

// Cells of a geometric series h, h g, h g^2, ... that fills a length: the ratio is kept, the first cell changes a little.
n_side = Ceil(Log(1 + (extent - a) * (growth - 1) / h) / Log(growth));
n_depth = Ceil(Log(1 + extent * (growth - 1) / h) / Log(growth));

Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0};
Point(3) = {extent, 0, 0};
Point(4) = {0, -extent, 0};
Point(5) = {a, -extent, 0};
Point(6) = {extent, -extent, 0};

Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {4, 5};
Line(4) = {5, 6};
Line(5) = {1, 4};
Line(6) = {2, 5};
Line(7) = {3, 6};

Transfinite Curve{1, 3} = n + 1;
Transfinite Curve{2, 4} = n_side + 1 Using Progression growth;
Transfinite Curve{5, 6, 7} = n_depth + 1 Using Progression growth;

Curve Loop(1) = {3, -6, -1, 5};
Curve Loop(2) = {4, -7, -2, 6};
Plane Surface(1) = {1};
Plane Surface(2) = {2};

// The punch has nodes of its own on y = 0.
n_punch = 10;
Point(11) = {0, 0, 0};
Point(12) = {a, 0, 0};
Point(13) = {a, a / 2, 0};
Point(14) = {0, a / 2, 0};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Transfinite Curve{11, 13} = n_punch + 1;
Transfinite Curve{12, 14} = n_punch / 2 + 1;
Curve Loop(11) = {11, 12, 13, 14};
Plane Surface(11) = {11};

Transfinite Surface{1, 2, 11};
Recombine Surface{1, 2, 11};

Physical Surface("halfspace") = {1, 2};
Physical Surface("punch") = {11};
Physical Curve("halfspace_top") = {1};
Physical Curve("punch_bottom") = {11};
Physical Curve("bottom") = {3, 4};
Physical Curve("side") = {7};
Physical Curve("axis") = {5};
