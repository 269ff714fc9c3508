// A quarter of a ring of radii 4 and 5, so many elements through its thickness, one layer. mm
DefineConstant[ n = 4, around = 28 ];
General.NumThreads = 1; Mesh.Algorithm = 5;
Point(1) = {0,0,0}; Point(2) = {4,0,0}; Point(3) = {5,0,0}; Point(4) = {0,5,0}; Point(5) = {0,4,0};
Line(1) = {2,3}; Circle(2) = {3,1,4}; Line(3) = {4,5}; Circle(4) = {5,1,2};
Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1};
Transfinite Curve{1,3} = n + 1; Transfinite Curve{2,4} = around + 1; Transfinite Surface{1} Alternated;
a[] = Extrude {0,0,0.25} { Surface{1}; Layers{1}; };
Physical Surface("z-") = {1}; Physical Surface("z+") = {a[0]}; Physical Surface("y-") = {a[2]}; Physical Surface("outside") = {a[3]};
Physical Surface("x-") = {a[4]}; Physical Surface("hole") = {a[5]}; Physical Volume("ring") = {a[1]};
