// A ring: a tube of 4 cm about a circle of 8 cm, in metres, its axis y.
// Meshed by irdm-precompute, which calls gmsh; to look at it: gmsh torus.geo
SetFactory("OpenCASCADE");

Torus(1) = {0, 0, 0, 0.04, 0.02};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi / 2} { Volume{1}; }

Mesh.MeshSizeMin = 0.012;
Mesh.MeshSizeMax = 0.012;
Physical Volume("torus") = {1};
