// The cube of two-cubes.
SetFactory("OpenCASCADE");
Box(1) = {-0.05, 0, -0.05, 0.1, 0.1, 0.1};
Mesh.MeshSizeMin = 0.022;
Mesh.MeshSizeMax = 0.022;
