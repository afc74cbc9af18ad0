% comments
N10 G1 X1 F20 (outer (inner) outer)
N20 G1 X2 (never closed
N30 G1 X3 )
N40 G1 X4 (fine)
