// A plate of 3 x 6 x 0.2 mm with a hole of 0.8 mm, drawn in mm, fine where it will break.
//     cd bench/examples/plate-with-hole
//     ../../../build/rhegma mesh plate-with-hole.geo -o plate-with-hole.h5 --scale 1e-3 --improve
SetFactory("OpenCASCADE");
General.NumThreads = 1;

Box(1) = {-1.5, -3, -0.1, 3, 6, 0.2};
Cylinder(2) = {0, 0, -1, 0, 0, 2, 0.4};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };

// The names by which the case file calls the ends.
e = 0.01;
Physical Surface("top") = Surface In BoundingBox{-2, 3 - e, -1, 2, 3 + e, 1};
Physical Surface("bottom") = Surface In BoundingBox{-2, -3 - e, -1, 2, -3 + e, 1};
Physical Volume("plate") = {3};

// Edges of 0.1 mm within 0.8 mm of the middle, of 0.25 mm elsewhere.
Field[1] = Box;
Field[1].XMin = -2; Field[1].XMax = 2;
Field[1].YMin = -0.8; Field[1].YMax = 0.8;
Field[1].ZMin = -1; Field[1].ZMax = 1;
Field[1].VIn = 0.1; Field[1].VOut = 0.25; Field[1].Thickness = 0.5;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
