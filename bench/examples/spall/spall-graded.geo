// Bar of the spall test, graded towards the middle, where one plane of faces is exactly flat: 223,394 tetrahedra with
// edges of about 11.4 um at the plane in section 5.1.2 of the thesis.
//     build/rhegma mesh bench/examples/spall/spall-graded.geo -o spall-graded.h5 --scale 1e-3 --improve
// Surfaces by Gmsh's frontal Delaunay algorithm, volume by its Delaunay algorithm, one thread: the same mesh every time.
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.OptimizeThreshold = 0.7; // without it the flattest elements cost a third of the time step
General.NumThreads = 1;

// Two halves that share the plane.
Point(1) = {-0.2, -0.2, 0};
Point(2) = {0.2, -0.2, 0};
Point(3) = {0.2, 0.2, 0};
Point(4) = {-0.2, 0.2, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
up[] = Extrude {0, 0, 2} { Surface{1}; };
down[] = Extrude {0, 0, -2} { Surface{1}; };

Physical Surface("z-") = {down[0]};
Physical Surface("z+") = {up[0]};
Physical Surface("y-") = {up[2], down[2]};
Physical Surface("x+") = {up[3], down[3]};
Physical Surface("y+") = {up[4], down[4]};
Physical Surface("x-") = {up[5], down[5]};
Physical Volume("bar") = {up[1], down[1]};

DefineConstant[ fine = 0.0091, slope = 0.0395 ]; // mm: edge at the plane; its growth with the distance
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g*Abs(z)", fine, slope);
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
