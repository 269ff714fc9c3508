// An octant of a body about a spherical hole of radius 1, fine at the hole. mm
DefineConstant[ h = 0.1, R = 5, coarse = 1.2, seed = 1 ];
General.NumThreads = 1; Mesh.RandomSeed = seed; Mesh.Algorithm = 5; Mesh.Algorithm3D = 1;
Point(1) = {0,0,0}; Point(2) = {1,0,0,h}; Point(3) = {0,1,0,h}; Point(4) = {0,0,1,h};
Point(5) = {R,0,0,coarse}; Point(6) = {0,R,0,coarse}; Point(7) = {0,0,R,coarse};
Circle(1) = {2,1,3}; Circle(2) = {3,1,4}; Circle(3) = {4,1,2}; Circle(4) = {5,1,6}; Circle(5) = {6,1,7}; Circle(6) = {7,1,5};
Line(7) = {2,5}; Line(8) = {3,6}; Line(9) = {4,7};
Curve Loop(1) = {1,2,3}; Surface(1) = {1} In Sphere {1}; Curve Loop(2) = {4,5,6}; Surface(2) = {2} In Sphere {1};
Curve Loop(3) = {1,8,-4,-7}; Plane Surface(3) = {3}; Curve Loop(4) = {2,9,-5,-8}; Plane Surface(4) = {4};
Curve Loop(5) = {3,7,-6,-9}; Plane Surface(5) = {5};
Surface Loop(1) = {1,2,3,4,5}; Volume(1) = {1};
Physical Surface("hole") = {1}; Physical Surface("far") = {2}; Physical Surface("z-") = {3}; Physical Surface("x-") = {4}; Physical Surface("y-") = {5};
Physical Volume("solid") = {1};
