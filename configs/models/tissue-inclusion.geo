// A block of tissue, 9 x 9 x 4 cm, with a ball of 2 cm inside, its centre 1.7 cm below the top: in metres, the origin in
// the middle of the underside. The mesh follows the ball, which is a group.
// Meshed by irdm-precompute, which calls gmsh; to look at it: gmsh tissue-inclusion.geo
SetFactory("OpenCASCADE");

Box(1) = {-0.045, -0.045, 0, 0.09, 0.09, 0.04};
Sphere(2) = {0.015, 0.01, 0.023, 0.01};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }

Mesh.MeshSizeMin = 0.0075;
Mesh.MeshSizeMax = 0.018;
MeshSize{ PointsOf{ Volume{2}; } } = 0.0075;
Physical Volume("inclusion") = {2};
Physical Volume("tissue") = {3};
