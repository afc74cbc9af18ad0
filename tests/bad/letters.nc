% letters
N10 G1 X Y5 F20
N20 G1 X 5
N30 Hello world
N40 G1 Ä1
N50 G1 X1,5
N60 G1 X5 ; half way
N70 5
N80 G1 X−5
