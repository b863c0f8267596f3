// A block of 40 x 20 x 20 mm in 4 x 2 x 2 cells; the last quarters of its top and its bottom are surfaces of their own,
// to be moved against each other: gmsh -3 -format msh2 -o twist.msh twist.geo
Point(1) = {0, 0, 0};
Point(2) = {0, 20, 0};
Line(1) = {1, 2};
Transfinite Curve {1} = 3;
left[] = Extrude {0, 0, 20} { Line{1}; Layers{2}; };
a[] = Extrude {30, 0, 0} { Surface{left[1]}; Layers{3}; };
b[] = Extrude {10, 0, 0} { Surface{a[0]}; Layers{1}; };
Physical Volume("body") = {a[1], b[1]};
Physical Surface("left") = {left[1]};
Physical Surface("bottom") = Surface In BoundingBox {29.9, -0.1, -0.1, 40.1, 20.1, 0.1};
Physical Surface("top") = Surface In BoundingBox {29.9, -0.1, 19.9, 40.1, 20.1, 20.1};
