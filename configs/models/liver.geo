// A body like a liver, 15 x 6 x 10 cm, 0.38 litres, in metres: a thick lobe that runs out into a thin one. A spline is turned
// about the x axis, and the outcome flattened in y and widened in z. The pole at either end is smooth, because the
// first and last pieces of the spline leave the axis at a right angle.
// Meshed by irdm-precompute, which calls gmsh; to look at it: gmsh liver.geo
SetFactory("OpenCASCADE");

Point(1) = {-0.070, 0, 0};
Point(2) = {-0.070, 0.022, 0};
Point(3) = {-0.050, 0.042, 0};
Point(4) = {-0.010, 0.040, 0};
Point(5) = {0.035, 0.024, 0};
Point(6) = {0.080, 0.016, 0};
Point(7) = {0.080, 0, 0};
BSpline(1) = {1:7};
Line(2) = {7, 1};
Curve Loop(1) = {1, 2};
Plane Surface(1) = {1};
Extrude {{1, 0, 0}, {0, 0, 0}, 2 * Pi} { Surface{1}; }
Dilate {{0, 0, 0}, {1, 0.7, 1.3}} { Volume{:}; }
Recursive Delete { Surface{1}; }

Mesh.MeshSizeMin = 0.0145;
Mesh.MeshSizeMax = 0.0145;
Physical Volume("liver") = {Volume{:}};
