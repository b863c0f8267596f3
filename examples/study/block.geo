// A block of 40 x 20 x 20 mm: gmsh -3 -format msh2 -o block.msh block.geo
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 40, 20, 20};
MeshSize{:} = 3.9;
Physical Volume("body") = {1};
Physical Surface("left") = {1};
Physical Surface("right") = {2};
Physical Surface("front") = {3};
Physical Surface("back") = {4};
Physical Surface("bottom") = {5};
Physical Surface("top") = {6};
