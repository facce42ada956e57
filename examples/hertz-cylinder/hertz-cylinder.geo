// Right half of an elastic cylinder (its lower half) that rests on an elastic block along the line x = y = 0, plane
// strain. Both bodies have a fine block of cells at the contact and graded cells around it; the two meshes do not match.

DefineConstant[
  R = {1, Name "R"},                     // radius of the cylinder
  b = {0.02, Name "b"},                  // contact half-width expected
  n_cylinder = {60, Name "n_cylinder"},  // cells on [0, b] of the cylinder
  n_block = {30, Name "n_block"},        // cells on [0, b] of the block
  growth = {1.12, Name "growth"}         // ratio of the lengths of neighbouring cells outside the fine blocks
];

fine = 1.25; // width and height of the fine blocks, in units of b
w = fine * b;

// The cylinder: one fine and two graded blocks.
n_fine = Ceil(fine * n_cylinder);
n_graded = Ceil(Log(1 + R * (growth - 1) * n_cylinder / b) / Log(growth));

Point(1) = {0, 0, 0};
Point(2) = {w, R - Sqrt(R^2 - w^2), 0};
Point(3) = {w, w, 0};
Point(4) = {0, w, 0};
Point(5) = {R, R, 0};
Point(6) = {0.55 * R, R, 0};
Point(7) = {0, R, 0}; // centre of the cylinder

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

// The block [0, R] x [-R, 0]: columns uniform below the contact, rows graded from the surface.
h = b / n_block;
n_below = Ceil(fine * n_block);
n_side = Ceil(Log(1 + (R - w) * (growth - 1) / h) / Log(growth));
n_depth = Ceil(Log(1 + R * (growth - 1) / h) / Log(growth));

Point(11) = {0, 0, 0};
Point(12) = {w, 0, 0};
Point(13) = {R, 0, 0};
Point(14) = {0, -R, 0};
Point(15) = {w, -R, 0};
Point(16) = {R, -R, 0};

Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {14, 15};
Line(14) = {15, 16};
Line(15) = {11, 14};
Line(16) = {12, 15};
Line(17) = {13, 16};

Transfinite Curve{11, 13} = n_below + 1;
Transfinite Curve{12, 14} = n_side + 1 Using Progression growth;
Transfinite Curve{15, 16, 17} = n_depth + 1 Using Progression growth;

Curve Loop(11) = {13, -16, -11, 15};
Curve Loop(12) = {14, -17, -12, 16};
Plane Surface(11) = {11};
Plane Surface(12) = {12};

Transfinite Surface{1, 2, 3, 11, 12};
Recombine Surface{1, 2, 3, 11, 12};

Physical Surface("cylinder") = {1, 2, 3};
Physical Surface("block") = {11, 12};
Physical Curve("cylinder_bottom") = {1, 5};
Physical Curve("block_top") = {11, 12};
Physical Curve("block_bottom") = {13, 14};
Physical Curve("symmetry") = {4, 9, 15};
Physical Curve("mid_plane") = {6, 8};
