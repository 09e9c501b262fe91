// The cylinder of press, tap and push, finest where the ball meets it.
SetFactory("OpenCASCADE");
Cylinder(1) = {0, 0, 0, 0, 0.06, 0, 0.06};
Field[1] = MathEval;
Field[1].F = "Min(0.025, 0.005 + 0.4*Max(0, Sqrt(x*x + (y-0.06)*(y-0.06) + z*z) - 0.011))";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
