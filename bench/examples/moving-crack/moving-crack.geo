// A half-plane crack in a body of 45 x 40 mm, fine along its path on y = 0, one layer of thickness t; in mm. The crack ends at
// x = 0, 15 mm from the side.
DefineConstant[ h = 0.15, coarse = 2.0, t = 0.3, seed = 1 ];
General.NumThreads = 1; Mesh.Algorithm = 5;
Point(1) = {-15, -20, 0}; Point(2) = {30, -20, 0}; Point(3) = {30, 0, 0}; Point(4) = {30, 20, 0}; Point(5) = {-15, 20, 0};
Point(6) = {-15, 0, 0}; Point(7) = {0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {6, 7}; Line(8) = {7, 3};
Curve Loop(1) = {1, 2, -8, -7, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {7, 8, 3, 4, 5}; Plane Surface(2) = {2};
Point(8) = {-1, 0, 0}; Point(9) = {15, 0, 0}; Line(9) = {8, 9};
Field[1] = Distance; Field[1].EdgesList = {9}; Field[1].NNodesByEdge = 1000;
Field[2] = Threshold; Field[2].IField = 1; Field[2].LcMin = h; Field[2].LcMax = coarse; Field[2].DistMin = 0.4; Field[2].DistMax = 9 + 0.1*(seed - 1); // other triangles for each seed
Background Field = 2; Mesh.CharacteristicLengthExtendFromBoundary = 0; Mesh.CharacteristicLengthFromPoints = 0;
a[] = Extrude {0, 0, t} { Surface{1}; Layers{1}; }; b[] = Extrude {0, 0, t} { Surface{2}; Layers{1}; };
Physical Surface("z-") = {1, 2}; Physical Surface("z+") = {a[0], b[0]};
Physical Surface("y-") = {a[2]}; Physical Surface("x+") = {a[3], b[4]}; Physical Surface("y+") = {b[5]}; Physical Surface("x-") = {a[6], b[6]};
Physical Volume("glass") = {a[1], b[1]};
