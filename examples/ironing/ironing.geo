// Shallow ironing (Fischer and Wriggers): an indenter with a round lower face is pressed into a block and drawn along.
// The block's upper face is y = 0.

DefineConstant[
  n_block = {120, Name "n_block"},          // cells along the block; a quarter of it in height
  n_indenter = {12, Name "n_indenter"}      // cells along the indenter; half of it in height
];

length = 12;
height = 4;
indenter_width = 1.2;
indenter_height = 1.2; // above its lowest point
radius = 0.75; // of the indenter's lower face
start = 0.2;   // of the indenter, from the end of the block
gap = 0.2;     // between the indenter's lowest point and the block

Point(1) = {0, -height, 0};
Point(2) = {length, -height, 0};
Point(3) = {length, 0, 0};
Point(4) = {0, 0, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Transfinite Curve{1, 3} = n_block + 1;
Transfinite Curve{2, 4} = Round(n_block / 4) + 1;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

middle = start + indenter_width / 2;
corner = gap + radius - Sqrt(radius^2 - (indenter_width / 2)^2); // height of the round face's ends
Point(11) = {start, corner, 0};
Point(12) = {start + indenter_width, corner, 0};
Point(13) = {start + indenter_width, gap + indenter_height, 0};
Point(14) = {start, gap + indenter_height, 0};
Point(15) = {middle, gap + radius, 0}; // centre of the round face
Circle(11) = {11, 15, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Transfinite Curve{11, 13} = n_indenter + 1;
Transfinite Curve{12, 14} = Round(n_indenter / 2) + 1;
Curve Loop(11) = {11, 12, 13, 14};
Plane Surface(11) = {11};

Transfinite Surface{1, 11};
Recombine Surface{1, 11};

Physical Surface("block") = {1};
Physical Surface("indenter") = {11};
Physical Curve("block_bottom") = {1};
Physical Curve("block_top") = {3};
Physical Curve("indenter_face") = {11, 12, 14}; // the round face and the sides
Physical Curve("indenter_top") = {13};
