// Plate of the impact test, 50.8 x 50.8 x 12 mm, in equal cubes of 6 tetrahedra: 183,673 tetrahedra in section 5.2 of
// the thesis, 51 x 51 x 12 x 6 = 187,272 here. The plate is hit at z = 6 mm.
//     build/rhegma mesh bench/examples/impact/plate-structured.geo -o plate-structured.h5 --scale 1e-3
// Transfinite: no algorithm chooses anything. (impact-structured.yaml takes as many cubes of the built-in box, which
// are cut alike and so have a mirror symmetry that these lack.)
General.NumThreads = 1;
Point(1) = {-25.4, -25.4, -6};
Point(2) = {25.4, -25.4, -6};
Point(3) = {25.4, 25.4, -6};
Point(4) = {-25.4, 25.4, -6};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
plate[] = Extrude {0, 0, 12} { Surface{1}; Layers{12}; };
Transfinite Curve{1, 2, 3, 4} = 52;
Transfinite Surface{1};

Physical Surface("z-") = {1};
Physical Surface("z+") = {plate[0]};
Physical Surface("y-") = {plate[2]};
Physical Surface("x+") = {plate[3]};
Physical Surface("y+") = {plate[4]};
Physical Surface("x-") = {plate[5]};
Physical Volume("plate") = {plate[1]};
