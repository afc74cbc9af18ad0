% loop
(A square drilled four times: the jump goes back while the implicit variable is not 0.)
N10 G0 Z2
N20 G36 D4
N30 G91
N40 G1 X20 F30 E500 E-500
N50 G1 Y20
N60 G1 X-20
N70 G1 Y-20
N80 G1 Z-0.5 F5
N90 G37 D-1
N100 G20 L40
N110 G90
N120 G0 Z20
