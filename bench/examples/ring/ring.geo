// Ring of mean circumference 50 mm and square section b, unstructured, edges of h. mm
SetFactory("OpenCASCADE");
DefineConstant[ h = 0.1, b = 0.25, seed = 1 ];
General.NumThreads = 1; Mesh.RandomSeed = seed; Mesh.RandomFactor3D = 1e-6*seed; Mesh.Algorithm3D = 1; Mesh.OptimizeThreshold = 0.5; // HXT (10) gives another mesh each time
R = 50/(2*Pi);
Cylinder(1) = {0,0,-b/2, 0,0,b, R+b/2}; Cylinder(2) = {0,0,-b/2, 0,0,b, R-b/2};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.CharacteristicLengthMax = h; Mesh.CharacteristicLengthMin = h;
Physical Volume("ring") = {3};
