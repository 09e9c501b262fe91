// The cylinder of palpation; faces of elements lie on the stiff ball's surface.
SetFactory("OpenCASCADE");
Cylinder(1) = {0, 0, 0, 0, 0.06, 0, 0.06};
Sphere(2) = {0, 0.045, 0, 0.01};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Field[1] = MathEval;
Field[1].F = "Min(0.025, 0.005 + 0.4*Max(0, Sqrt(x*x + (y-0.06)*(y-0.06) + z*z) - 0.011))";
Field[2] = MathEval;
Field[2].F = "0.005 + 0.4*Fabs(Sqrt(x*x + (y-0.045)*(y-0.045) + z*z) - 0.01)";
Field[3] = Min;
Field[3].FieldsList = {1, 2};
Background Field = 3;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
