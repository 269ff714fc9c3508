// Kalthoff-Winkler, upper half: 100 x 100 mm, wedge notch 0.3 mm wide at its mouth, 50 mm long, 25 mm above the symmetry
// plane. Unstructured triangles, drawn out by one layer into tetrahedra. mm.
DefineConstant[ h = 2.0, coarse = 5.0, t = 2.0, seed = 1 ];
General.NumThreads = 1; Mesh.RandomSeed = seed; Mesh.Algorithm = 5;
Point(1) = {0,0,0,coarse}; Point(2) = {100,0,0,coarse}; Point(3) = {100,100,0,coarse}; Point(4) = {0,100,0,coarse};
Point(5) = {0,25.15,0,coarse}; Point(6) = {50,25,0,h}; Point(7) = {0,24.85,0,coarse};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,5}; Line(5) = {5,6}; Line(6) = {6,7}; Line(7) = {7,1};
Curve Loop(1) = {1,2,3,4,5,6,7}; Plane Surface(1) = {1};
// fine in a box to the upper right of the notch tip
Field[1] = Box; Field[1].VIn = h; Field[1].VOut = coarse; Field[1].XMin = 38; Field[1].XMax = 100; Field[1].YMin = 15;
Field[1].YMax = 100; Field[1].ZMin = -9; Field[1].ZMax = 9; Field[1].Thickness = 8;
Background Field = 1; Mesh.CharacteristicLengthExtendFromBoundary = 0; Mesh.CharacteristicLengthFromPoints = 0;
out[] = Extrude {0,0,t} { Surface{1}; Layers{1}; };
Physical Surface("z-") = {1}; Physical Surface("z+") = {out[0]};
Physical Surface("sym") = {out[2]}; Physical Surface("hit") = {out[8]};
Physical Volume("steel") = {out[1]};
