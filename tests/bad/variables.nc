% variables
N10 G36 O$width$ D40
N20 G1 X$widht$ F20
N30 G1 X$
N40 G1 X$a b$
N50 G1 X-$width$
N60 $width$
N70 G37 O$count$ D1
N80 G36 O5 D1
N90 G36 D0.5
N100 G37
