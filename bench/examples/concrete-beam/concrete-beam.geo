// Beam of 229 x 76 mm on a span of 203 mm; below, at `gamma` of half the span to the left of the middle, a notch of 19 mm. Triangles
// drawn out by one layer, fine between notch and middle. mm
DefineConstant[ h = 2.0, coarse = 8.0, t = 2.0, gamma = 0.5, seed = 1, w = 0.5 ];
General.NumThreads = 1; Mesh.RandomSeed = seed; Mesh.Algorithm = 5;
n = -101.5 * gamma;
Point(1) = {-114.5,0,0}; Point(2) = {-104.5,0,0}; Point(3) = {-98.5,0,0};
Point(4) = {n-w,0,0}; Point(5) = {n,19,0}; Point(6) = {n+w,0,0};
Point(7) = {98.5,0,0}; Point(8) = {104.5,0,0}; Point(9) = {114.5,0,0}; Point(10) = {114.5,76,0};
Point(11) = {3,76,0}; Point(12) = {-3,76,0}; Point(13) = {-114.5,76,0};
For k In {1:13}
  Line(k) = {k, k % 13 + 1};
EndFor
Curve Loop(1) = {1:13}; Plane Surface(1) = {1};
Field[1] = Box; Field[1].VIn = h; Field[1].VOut = coarse; Field[1].XMin = n - 10; Field[1].XMax = 15; Field[1].YMin = -1;
Field[1].YMax = 77; Field[1].ZMin = -99; Field[1].ZMax = 99; Field[1].Thickness = 30;
Background Field = 1; Mesh.CharacteristicLengthExtendFromBoundary = 0; Mesh.CharacteristicLengthFromPoints = 0;
out[] = Extrude {0,0,t} { Surface{1}; Layers{1}; };
Physical Surface("left") = {out[3]}; Physical Surface("right") = {out[8]}; Physical Surface("hammer") = {out[12]};
Physical Volume("concrete") = {out[1]};
