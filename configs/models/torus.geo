// A ring: a tube of 4 cm about a circle of 8 cm, in metres, its axis y.
// Meshed by irdm-precompute, which calls gmsh; to look at it: gmsh torus.geo
SetFactory("OpenCASCADE");

Torus(1) = {0, 0, 0, 0.04, 0.02};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi / 2} { Volume{1}; }

// Quadratic tetrahedra with curved edges: the nodes in their middles lie on the torus, too. Those inside are moved where
// an element would fold over.
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 2;
Mesh.MeshSizeMin = 0.022;
Mesh.MeshSizeMax = 0.022;
Physical Volume("torus") = {1};
