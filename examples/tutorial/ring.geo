// A ring of 12 cm, lying flat: the tutorial's stand-in for a mesh of your own (docs/tutorial.md).
//   gmsh -2 ring.geo -o ring.stl
SetFactory("OpenCASCADE");
Torus(1) = {0, 0, 0, 40, 18};  // mm, about z
Rotate {{1, 0, 0}, {0, 0, 0}, Pi / 2} { Volume{1}; }
MeshSize{:} = 14;
