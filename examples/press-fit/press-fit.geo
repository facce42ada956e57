// A quarter of two concentric rings, plane stress: the inner one from r_inner to r_fit + interference, the outer one
// from r_fit to r_outer. n_inner cells of the inner ring meet n_outer of the outer one: with equal numbers the nodes match.

DefineConstant[
  r_inner = {0.2, Name "r_inner"},
  r_fit = {0.6, Name "r_fit"},
  r_outer = {1, Name "r_outer"},
  interference = {0, Name "interference"}, // radial, at rest
  n_inner = {192, Name "n_inner"},          // cells along the quarter circle, inner ring
  n_outer = {192, Name "n_outer"},          // cells along the quarter circle, outer ring
  slenderness = {1, Name "slenderness"}     // length of the cells in the radius over that along the middle circle of the ring
];

cells_inner = Ceil((r_fit - r_inner) / (slenderness * Pi / 4 * (r_fit + r_inner) / n_inner));
cells_outer = Ceil((r_outer - r_fit) / (slenderness * Pi / 4 * (r_outer + r_fit) / n_outer));
r_shrunk = r_fit + interference;

Point(1) = {0, 0, 0};

Point(2) = {r_inner, 0, 0};
Point(3) = {r_shrunk, 0, 0};
Point(4) = {0, r_shrunk, 0};
Point(5) = {0, r_inner, 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Transfinite Curve{1, 3} = cells_inner + 1;
Transfinite Curve{2, 4} = n_inner + 1;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Point(12) = {r_fit, 0, 0};
Point(13) = {r_outer, 0, 0};
Point(14) = {0, r_outer, 0};
Point(15) = {0, r_fit, 0};
Line(11) = {12, 13};
Circle(12) = {13, 1, 14};
Line(13) = {14, 15};
Circle(14) = {15, 1, 12};
Transfinite Curve{11, 13} = cells_outer + 1;
Transfinite Curve{12, 14} = n_outer + 1;
Curve Loop(11) = {11, 12, 13, 14};
Plane Surface(11) = {11};

Transfinite Surface{1, 11};
Recombine Surface{1, 11};

Physical Surface("inner_ring") = {1};
Physical Surface("outer_ring") = {11};
Physical Curve("inner_rim") = {2};  // of the inner ring, at the fit
Physical Curve("outer_bore") = {14}; // of the outer ring, at the fit
Physical Curve("outside") = {12};
Physical Curve("on_x_axis") = {1, 11};
Physical Curve("on_y_axis") = {3, 13};
