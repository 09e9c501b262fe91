// The cube of pinch, with at most 128 nodes in touch with each ball.
SetFactory("OpenCASCADE");
Box(1) = {-0.03, -0.03, -0.03, 0.06, 0.06, 0.06};
Field[1] = MathEval;
Field[1].F = "0.011 + 0.2*(0.03 - Fabs(x))";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
