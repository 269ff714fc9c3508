// Strip of 32 x 16 mm with a wedge notch of 4 mm, triangles drawn out by one layer, fine along the middle. mm
DefineConstant[ h = 0.4, coarse = 1.0, t = 0.4, seed = 1, w = 0.02 ];
General.NumThreads = 1; Mesh.RandomSeed = seed; Mesh.Algorithm = 5;
Point(1) = {0,-8,0}; Point(2) = {32,-8,0}; Point(3) = {32,8,0}; Point(4) = {0,8,0};
Point(5) = {0,w,0}; Point(6) = {4,0,0}; Point(7) = {0,-w,0};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,5}; Line(5) = {5,6}; Line(6) = {6,7}; Line(7) = {7,1};
Curve Loop(1) = {1,2,3,4,5,6,7}; Plane Surface(1) = {1};
Field[1] = Box; Field[1].VIn = h; Field[1].VOut = coarse; Field[1].XMin = 3; Field[1].XMax = 32; Field[1].YMin = -4;
Field[1].YMax = 4; Field[1].ZMin = -9; Field[1].ZMax = 9; Field[1].Thickness = 2;
Background Field = 1; Mesh.CharacteristicLengthExtendFromBoundary = 0; Mesh.CharacteristicLengthFromPoints = 0;
out[] = Extrude {0,0,t} { Surface{1}; Layers{1}; };
Physical Surface("z-") = {1}; Physical Surface("z+") = {out[0]};
Physical Surface("y-") = {out[2]}; Physical Surface("x+") = {out[3]}; Physical Surface("y+") = {out[4]};
Physical Volume("pmma") = {out[1]};
