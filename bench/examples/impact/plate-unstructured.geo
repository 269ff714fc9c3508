// Plate of the impact test, 50.8 x 50.8 x 12 mm, unstructured: 198,431 tetrahedra in section 5.2 of the thesis. The
// plate is hit at z = 6 mm.
//     build/rhegma mesh bench/examples/impact/plate-unstructured.geo -o plate-unstructured.h5 --scale 1e-3
// Surfaces by Gmsh's Delaunay algorithm, volume by HXT, which also mends what is flatter than the threshold: the smallest
// height is 0.28 mm, not 0.19, which saves a third of the time steps. One thread; still the count has
// differed by up to 0.5 % from one hour to another (190,697 to 191,598).
Mesh.Algorithm = 5;
Mesh.Algorithm3D = 10;
Mesh.OptimizeThreshold = 0.5;
General.NumThreads = 1;

DefineConstant[ edge = 0.92 ]; // mm
Point(1) = {-25.4, -25.4, -6, edge};
Point(2) = {25.4, -25.4, -6, edge};
Point(3) = {25.4, 25.4, -6, edge};
Point(4) = {-25.4, 25.4, -6, edge};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
plate[] = Extrude {0, 0, 12} { Surface{1}; };

Physical Surface("z-") = {1};
Physical Surface("z+") = {plate[0]};
Physical Surface("y-") = {plate[2]};
Physical Surface("x+") = {plate[3]};
Physical Surface("y+") = {plate[4]};
Physical Surface("x-") = {plate[5]};
Physical Volume("plate") = {plate[1]};
