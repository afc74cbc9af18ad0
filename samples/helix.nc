% helix
(Helical entry into a bore: three turns down, one flat turn, out over the middle.)
N10 G0 X18 Y0
N20 G0 Z1
N30 G3 X18 Y0 I-18 J0 Z-1 F25 E600 E-600
N40 G3 X18 Y0 I-18 J0 Z-3
N50 G3 X18 Y0 I-18 J0 Z-5
N60 G3 X18 Y0 I-18 J0
N70 G3 X0 Y0 R9
N80 G0 Z10
