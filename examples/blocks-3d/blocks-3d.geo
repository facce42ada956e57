// A small block on a larger one, hexahedra that do not match.

DefineConstant[
  n_small = {8, Name "n_small"}, // cells per unit length, small block
  n_large = {6, Name "n_large"}  // cells per unit length, large block
];

length = 4; // of the large block, along x
width = 2;  // of the large block, along y
height = 1; // of the large block, along z
side = 1;   // of the small block, a cube
start = 0.4; // of the small block, from the end of the large one

Point(1) = {0, -width / 2, -height};
large[] = Extrude{length, 0, 0} { Point{1}; Layers{length * n_large}; };
large[] = Extrude{0, width, 0} { Curve{large[1]}; Layers{width * n_large}; Recombine; };
large_bottom = large[1];
large[] = Extrude{0, 0, height} { Surface{large_bottom}; Layers{height * n_large}; Recombine; };

Point(101) = {start, -side / 2, 0};
small[] = Extrude{side, 0, 0} { Point{101}; Layers{side * n_small}; };
small[] = Extrude{0, side, 0} { Curve{small[1]}; Layers{side * n_small}; Recombine; };
small_bottom = small[1];
small[] = Extrude{0, 0, side} { Surface{small_bottom}; Layers{side * n_small}; Recombine; };

Physical Volume("large") = {large[1]};
Physical Volume("small") = {small[1]};
Physical Surface("large_bottom") = {large_bottom};
Physical Surface("large_top") = {large[0]};
Physical Surface("small_bottom") = {small_bottom};
Physical Surface("small_top") = {small[0]};
