// The slab of slide, with at most 128 nodes in touch.
SetFactory("OpenCASCADE");
Box(1) = {-0.04, 0, -0.04, 0.08, 0.04, 0.08};
Field[1] = MathEval;
Field[1].F = "0.0115 + 0.2*(0.04 - y)";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
