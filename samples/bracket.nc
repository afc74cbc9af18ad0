% bracket
(Mounting bracket, 120 x 80 mm, milled in passes of 1 mm. Units: mm, mm/s, mm/s2.)
(Origin: lower left corner of the plate, top face. Rapids at Z5.)

N10 G92 X0 Y0 Z20
N20 M3 (spindle on, wait for the acknowledge)
N30 G0 Z5

(Four bolt holes, 6 mm; the coolant switch comes on half way down to the first.)
N100 G0 X15 Y12
N110 G1 Z-3 F8 E800 E-800 H1 O0.5
N120 G3 X15 Y12 I-3 J0 F15
N130 G0 Z5
N140 G0 X111 Y12
N150 G1 Z-3 F8
N160 G3 X111 Y12 I-3 J0 F15
N170 G0 Z5
N180 G0 X15 Y68
N190 G1 Z-3 F8
N200 G3 X15 Y68 I-3 J0 F15
N210 G0 Z5
N220 G0 X111 Y42
N230 G1 Z-3 F8
N240 G3 X111 Y42 I-3 J0 F15
N250 G0 Z5

(Slot, 8 mm wide, three passes counted with the implicit variable; each pass feeds 1 mm down.)
N300 G0 X28 Y60
N310 G1 Z0 F8
N320 G36 D3
N330 G91
N340 G1 Z-1 F8
N350 G90
N360 G1 X28 Y56 F20
N370 G1 X58 Y56
N380 G3 X58 Y64 R4
N390 G1 X28 Y64
N400 G3 X28 Y56 R4
N410 G1 X28 Y60
N420 G37 D-1
N430 G20 L330
N440 G0 Z5

(Elliptic window, half-axes 26 and 13 mm, in two halves.)
N500 G0 X34 Y30
N510 G1 Z-3 F8
N520 G9 X86 Y30 I26 J0 K0 R0.5 F25
N530 G9 X34 Y30 I-26 J0 K0 R0.5
N540 G0 Z5

(Outline, clockwise, three passes; the upper right edge is a spline, the corners are arcs.)
N600 G0 X-6 Y40
N610 G36 D3
N620 G1 Z0 F8
N630 G91
N640 G1 Z-1 F8
N650 G90
N660 G1 X0 Y40 F30
N670 G1 X0 Y70
N680 G2 X10 Y80 R10
N690 G1 X62 Y80
N700 G5 X74 Y76
N710 G5 X84 Y66
N720 G5 X96 Y60
N730 G5 X108 Y59
N740 G5 X120 Y52
N750 G1 X120 Y10
N760 G2 X110 Y0 I-10 J0
N770 G1 X10 Y0
N780 G2 X0 Y10 I0 J10
N790 G1 X0 Y40
N800 G1 X-6 Y40
N810 G37 D-1
N820 G20 L630

(Coolant off 10 mm before the end of the way out.)
N900 G1 X-26 Y40 H-1 L-10
N910 G0 Z20
N920 M5
N930 G0 X0 Y0
