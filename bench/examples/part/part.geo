// A real part: a flanged bearing housing with a bore and four bolt holes, from OpenCASCADE primitives, in mm.
//     build/rhegma mesh bench/examples/part/part.geo -o part.h5 --scale 1e-3
// Surfaces and volume by Gmsh's Delaunay algorithms, one thread: the same mesh every time.
SetFactory("OpenCASCADE");
Mesh.Algorithm = 5;
Mesh.Algorithm3D = 1;
General.NumThreads = 1;
Mesh.MeshSizeMax = 2.5;
Mesh.MeshSizeFromCurvature = 16; // edges in a full turn (Gmsh 4.8)

Box(1) = {-30, -30, 0, 60, 60, 8};     // flange
Cylinder(2) = {0, 0, 0, 0, 0, 30, 18}; // housing
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {0, 0, -1, 0, 0, 32, 11};
Cylinder(5) = {-22, -22, -1, 0, 0, 10, 3.5};
Cylinder(6) = {22, -22, -1, 0, 0, 10, 3.5};
Cylinder(7) = {-22, 22, -1, 0, 0, 10, 3.5};
Cylinder(8) = {22, 22, -1, 0, 0, 10, 3.5};
BooleanDifference(9) = { Volume{3}; Delete; }{ Volume{4:8}; Delete; };

e = 0.01;
bolts[] = Surface In BoundingBox{-26, -26, -e, -18, -18, 8 + e};
bolts[] += Surface In BoundingBox{18, -26, -e, 26, -18, 8 + e};
bolts[] += Surface In BoundingBox{-26, 18, -e, -18, 26, 8 + e};
bolts[] += Surface In BoundingBox{18, 18, -e, 26, 26, 8 + e};
Physical Surface("bolts") = bolts[];
Physical Surface("bore") = {Surface In BoundingBox{-11 - e, -11 - e, -e, 11 + e, 11 + e, 30 + e}};
Physical Surface("base") = {Surface In BoundingBox{-30 - e, -30 - e, -e, 30 + e, 30 + e, e}};
Physical Surface("rim") = {Surface In BoundingBox{-18 - e, -18 - e, 30 - e, 18 + e, 18 + e, 30 + e}};
Physical Volume("housing") = {9};
