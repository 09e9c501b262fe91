// The bar of swing, finest where it is pushed.
SetFactory("OpenCASCADE");
Box(1) = {-0.02, 0, -0.02, 0.04, 0.2, 0.04};
Field[1] = MathEval;
Field[1].F = "Min(0.016, 0.005 + 0.35*Max(0, Sqrt((x+0.02)*(x+0.02) + z*z + Max(0, Fabs(y-0.16)-0.012)*Max(0, Fabs(y-0.16)-0.012)) - 0.008))";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
