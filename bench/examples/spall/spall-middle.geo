// Bar of the spall test, uniformly refined in the middle, where no flat plane is on offer: 150,742 tetrahedra with edges
// of about 14.8 um there in section 5.1.2 of the thesis.
//     build/rhegma mesh bench/examples/spall/spall-middle.geo -o spall-middle.h5 --scale 1e-3 --improve
// Surfaces by Gmsh's frontal Delaunay algorithm, volume by its Delaunay algorithm, one thread: the same mesh every time.
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.OptimizeThreshold = 0.7; // without it the flattest elements cost a third of the time step
General.NumThreads = 1;

DefineConstant[ edge = 0.06, fine = 0.0111, half = 0.129 ]; // mm: edges, and half the length of the fine part
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

Field[1] = Box;
Field[1].VIn = fine;
Field[1].VOut = edge;
Field[1].XMin = -1;
Field[1].XMax = 1;
Field[1].YMin = -1;
Field[1].YMax = 1;
Field[1].ZMin = -half;
Field[1].ZMax = half;
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
