// The ball of two-spheres, finest at its top, where they meet.
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 0.05};
Field[1] = MathEval;
Field[1].F = "Min(0.025, 0.004 + 0.4*Max(0, Sqrt(x*x + (y-0.05)*(y-0.05) + z*z) - 0.012))";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = 2;
