// Bar of the spall test, 0.4 x 0.4 x 4 mm, uniform and unstructured: 13,683 tetrahedra in section 5.1.1 of the thesis.
//     build/rhegma mesh bench/examples/spall/spall-uniform.geo -o spall-uniform.h5 --scale 1e-3
// Surfaces by Gmsh's Delaunay algorithm, volume by its Delaunay algorithm, one thread: the same mesh every time.
Mesh.Algorithm = 5;
Mesh.Algorithm3D = 1;
Mesh.OptimizeThreshold = 0.7; // without it the flattest elements cost a third of the time step
General.NumThreads = 1;

DefineConstant[ edge = 0.06 ]; // mm
Point(1) = {-0.2, -0.2, -2, edge};
Point(2) = {0.2, -0.2, -2, edge};
Point(3) = {0.2, 0.2, -2, edge};
Point(4) = {-0.2, 0.2, -2, edge};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
bar[] = Extrude {0, 0, 4} { Surface{1}; };

Physical Surface("z-") = {1};
Physical Surface("z+") = {bar[0]};
Physical Surface("y-") = {bar[2]};
Physical Surface("x+") = {bar[3]};
Physical Surface("y+") = {bar[4]};
Physical Surface("x-") = {bar[5]};
Physical Volume("bar") = {bar[1]};
