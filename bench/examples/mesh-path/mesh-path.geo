// Strip 12 x 8 mm of triangles drawn out by one layer; a crack of 3 mm lies in it. kind: 5 Delaunay, 6 Frontal, 0 structured. mm
DefineConstant[ h = 0.5, t = 0.25, kind = 5, seed = 1 ];
General.NumThreads = 1; Mesh.RandomSeed = seed; Mesh.RandomFactor = 1e-6*seed; Mesh.CharacteristicLengthMax = h; Mesh.CharacteristicLengthMin = h;
Point(1) = {0,-4,0}; Point(2) = {12,-4,0}; Point(3) = {12,4,0}; Point(4) = {0,4,0};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4};
If (kind == 0)
  Line(4) = {4,1};
  Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};
  Transfinite Curve{1,3} = 4*Round(3/h)+1; Transfinite Curve{2,4} = 2*Round(4/h)+1; Transfinite Surface{1} AlternateRight;
Else
  Mesh.Algorithm = kind;
  Point(5) = {0,0,0}; Point(6) = {3,0,0};
  Line(4) = {4,5}; Line(5) = {5,1}; Line(6) = {5,6};
  Curve Loop(1) = {1,2,3,4,5}; Plane Surface(1) = {1};
  Curve{6} In Surface{1};
EndIf
out[] = Extrude {0,0,t} { Surface{1}; Layers{1}; };
Physical Surface("z-") = {1}; Physical Surface("z+") = {out[0]};
Physical Surface("y-") = {out[2]}; Physical Surface("x+") = {out[3]}; Physical Surface("y+") = {out[4]};
Physical Volume("pmma") = {out[1]};
