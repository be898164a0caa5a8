# captured: gnuplot captured.gnuplot > captured.svg
$p0c0 << EOD
0.002128606 0.08287943
0.01219438 0.008769874
0.06302209 0.0008098007
0.4098931 8.398592e-05
EOD
$p0c1 << EOD
0.002128606 0.08287943
0.01219438 0.008769874
0.06302209 0.0008098007
0.4098931 8.398592e-05
EOD
$p0c2 << EOD
0.003516853 0.09238673
0.0230301 0.008469761
0.08723357 0.0007323632
0.4057925 8.625364e-05
EOD
$p0c3 << EOD
0.003516853 0.09238673
0.0230301 0.008469761
0.08723357 0.0007323632
0.4057925 8.625364e-05
EOD
$p0c4 << EOD
0.003114627 0.09381257
0.02264632 0.009560879
0.1826688 0.000986054
EOD
$p0c5 << EOD
0.003114627 0.09381257
0.02264632 0.009560879
0.1826688 0.000986054
EOD
$p0c6 << EOD
0.005498074 0.09676911
0.03148118 0.009253886
0.1829959 0.0009629147
EOD
$p0c7 << EOD
0.005498074 0.09676911
0.03148118 0.009253886
0.1829959 0.0009629147
EOD
$p0c8 << EOD
0.01550425 0.08249916
0.04258949 0.009108858
0.08162068 0.0009380453
0.152027 9.236205e-05
0.4450474 5.416398e-07
EOD
$p0c9 << EOD
0.01550425 0.08249916
0.04258949 0.009108858
0.08162068 0.0009380453
0.152027 9.236205e-05
0.4450474 5.416398e-07
EOD
$p0c10 << EOD
0.01743653 0.09322481
0.05294802 0.009248226
0.1119408 0.0008977092
0.2399604 9.466397e-05
0.6141009 5.426336e-07
EOD
$p0c11 << EOD
0.01743653 0.09322481
0.05294802 0.009248226
0.1119408 0.0008977092
0.2399604 9.466397e-05
0.6141009 5.426336e-07
EOD
$p1c0 << EOD
0.002128606 0.3939608
0.01219438 0.1359312
0.06302209 0.02444392
0.4098931 0.004618813
EOD
$p1c1 << EOD
0.002128606 0.3939608
0.01219438 0.1359312
0.06302209 0.02444392
0.4098931 0.004618813
EOD
$p1c2 << EOD
0.003516853 0.9849979
0.0230301 0.1156538
0.08723357 0.02197032
0.4057925 0.01044467
EOD
$p1c3 << EOD
0.003516853 0.9849979
0.0230301 0.1156538
0.08723357 0.02197032
0.4057925 0.01044467
EOD
$p1c4 << EOD
0.003114627 0.4248062
0.02264632 0.1327866
0.1826688 0.05743429
EOD
$p1c5 << EOD
0.003114627 0.4248062
0.02264632 0.1327866
0.1826688 0.05743429
EOD
$p1c6 << EOD
0.005498074 0.9326419
0.03148118 0.1167837
0.1829959 0.0334521
EOD
$p1c7 << EOD
0.005498074 0.9326419
0.03148118 0.1167837
0.1829959 0.0334521
EOD
$p1c8 << EOD
0.01550425 0.3939608
0.04258949 0.09705029
0.08162068 0.01846123
0.152027 0.003345935
0.4450474 8.468864e-06
EOD
$p1c9 << EOD
0.01550425 0.3939608
0.04258949 0.09705029
0.08162068 0.01846123
0.152027 0.003345935
0.4450474 8.468864e-06
EOD
$p1c10 << EOD
0.01743653 0.8635934
0.05294802 0.1225931
0.1119408 0.02018767
0.2399604 0.007597881
0.6141009 0.00568217
EOD
$p1c11 << EOD
0.01743653 0.8635934
0.05294802 0.1225931
0.1119408 0.02018767
0.2399604 0.007597881
0.6141009 0.00568217
EOD
$p2c0 << EOD
0.002128606 0.627539
0.01219438 0.2062085
0.06302209 0.0394742
0.4098931 0.008483562
EOD
$p2c1 << EOD
0.002128606 0.627539
0.01219438 0.2062085
0.06302209 0.0394742
0.4098931 0.008483562
EOD
$p2c2 << EOD
0.003516853 0.8303053
0.0230301 0.1684702
0.08723357 0.03703065
0.4057925 0.01433004
EOD
$p2c3 << EOD
0.003516853 0.8303053
0.0230301 0.1684702
0.08723357 0.03703065
0.4057925 0.01433004
EOD
$p2c4 << EOD
0.003114627 0.6446562
0.02264632 0.1927358
0.1826688 0.08907852
EOD
$p2c5 << EOD
0.003114627 0.6446562
0.02264632 0.1927358
0.1826688 0.08907852
EOD
$p2c6 << EOD
0.005498074 0.8456581
0.03148118 0.1746176
0.1829959 0.06027496
EOD
$p2c7 << EOD
0.005498074 0.8456581
0.03148118 0.1746176
0.1829959 0.06027496
EOD
$p2c8 << EOD
0.01550425 0.6275387
0.04258949 0.1505129
0.08162068 0.02634445
0.152027 0.006142067
0.4450474 1.122479e-05
EOD
$p2c9 << EOD
0.01550425 0.6275387
0.04258949 0.1505129
0.08162068 0.02634445
0.152027 0.006142067
0.4450474 1.122479e-05
EOD
$p2c10 << EOD
0.01743653 0.7875944
0.05294802 0.178191
0.1119408 0.03601405
0.2399604 0.01266721
0.6141009 0.008411816
EOD
$p2c11 << EOD
0.01743653 0.7875944
0.05294802 0.178191
0.1119408 0.03601405
0.2399604 0.01266721
0.6141009 0.008411816
EOD
$p3c0 << EOD
0.002128606 0.2226512
0.01219438 0.06990748
0.06302209 0.01338454
0.4098931 0.002738026
EOD
$p3c1 << EOD
0.002128606 0.2226512
0.01219438 0.06990748
0.06302209 0.01338454
0.4098931 0.002738026
EOD
$p3c2 << EOD
0.003516853 0.5160235
0.0230301 0.07194093
0.08723357 0.01068054
0.4057925 0.005090902
EOD
$p3c3 << EOD
0.003516853 0.5160235
0.0230301 0.07194093
0.08723357 0.01068054
0.4057925 0.005090902
EOD
$p3c4 << EOD
0.003114627 0.2145434
0.02264632 0.07804273
0.1826688 0.0315222
EOD
$p3c5 << EOD
0.003114627 0.2145434
0.02264632 0.07804273
0.1826688 0.0315222
EOD
$p3c6 << EOD
0.005498074 0.5249563
0.03148118 0.07637043
0.1829959 0.02728868
EOD
$p3c7 << EOD
0.005498074 0.5249563
0.03148118 0.07637043
0.1829959 0.02728868
EOD
$p3c8 << EOD
0.01550425 0.2226525
0.04258949 0.0476963
0.08162068 0.01264057
0.152027 0.001937232
0.4450474 3.689054e-06
EOD
$p3c9 << EOD
0.01550425 0.2226525
0.04258949 0.0476963
0.08162068 0.01264057
0.152027 0.001937232
0.4450474 3.689054e-06
EOD
$p3c10 << EOD
0.01743653 0.5160235
0.05294802 0.07961601
0.1119408 0.01450597
0.2399604 0.004218912
0.6141009 0.00200015
EOD
$p3c11 << EOD
0.01743653 0.5160235
0.05294802 0.07961601
0.1119408 0.01450597
0.2399604 0.004218912
0.6141009 0.00200015
EOD
$p4c0 << EOD
0.002128606 0.03149836
0.01219438 0.008365087
0.06302209 0.000919555
0.4098931 0.0003085036
EOD
$p4c1 << EOD
0.002128606 0.03149836
0.01219438 0.008365087
0.06302209 0.000919555
0.4098931 0.0003085036
EOD
$p4c2 << EOD
0.003516853 0.5086124
0.0230301 0.01716853
0.08723357 0.0006200193
0.4057925 0.0002590997
EOD
$p4c3 << EOD
0.003516853 0.5086124
0.0230301 0.01716853
0.08723357 0.0006200193
0.4057925 0.0002590997
EOD
$p4c4 << EOD
0.003114627 0.03171513
0.02264632 0.008428665
0.1826688 0.001969765
EOD
$p4c5 << EOD
0.003114627 0.03171513
0.02264632 0.008428665
0.1826688 0.001969765
EOD
$p4c6 << EOD
0.005498074 0.4547705
0.03148118 0.01801686
0.1829959 0.001453782
EOD
$p4c7 << EOD
0.005498074 0.4547705
0.03148118 0.01801686
0.1829959 0.001453782
EOD
$p4c8 << EOD
0.01550425 0.03149824
0.04258949 0.004022477
0.08162068 0.001295547
0.152027 7.995634e-05
0.4450474 2.843764e-07
EOD
$p4c9 << EOD
0.01550425 0.03149824
0.04258949 0.004022477
0.08162068 0.001295547
0.152027 7.995634e-05
0.4450474 2.843764e-07
EOD
$p4c10 << EOD
0.01743653 0.5086124
0.05294802 0.0120255
0.1119408 0.001794756
0.2399604 0.0001878571
0.6141009 0.0001250873
EOD
$p4c11 << EOD
0.01743653 0.5086124
0.05294802 0.0120255
0.1119408 0.001794756
0.2399604 0.0001878571
0.6141009 0.0001250873
EOD
$p5c0 << EOD
0.002128606 0.05523983
0.01219438 0.01870324
0.06302209 0.006104719
0.4098931 0.003114572
EOD
$p5c1 << EOD
0.002128606 0.05523983
0.01219438 0.01870324
0.06302209 0.006104719
0.4098931 0.003114572
EOD
$p5c2 << EOD
0.003516853 0.1138003
0.0230301 0.0204592
0.08723357 0.006229143
0.4057925 0.002303558
EOD
$p5c3 << EOD
0.003516853 0.1138003
0.0230301 0.0204592
0.08723357 0.006229143
0.4057925 0.002303558
EOD
$p5c4 << EOD
0.003114627 0.05634448
0.02264632 0.02044888
0.1826688 0.01130156
EOD
$p5c5 << EOD
0.003114627 0.05634448
0.02264632 0.02044888
0.1826688 0.01130156
EOD
$p5c6 << EOD
0.005498074 0.1128694
0.03148118 0.02144638
0.1829959 0.01469203
EOD
$p5c7 << EOD
0.005498074 0.1128694
0.03148118 0.02144638
0.1829959 0.01469203
EOD
$p5c8 << EOD
0.01550425 0.05523983
0.04258949 0.01570307
0.08162068 0.005869923
0.152027 0.002448672
0.4450474 0.0006674082
EOD
$p5c9 << EOD
0.01550425 0.05523983
0.04258949 0.01570307
0.08162068 0.005869923
0.152027 0.002448672
0.4450474 0.0006674082
EOD
$p5c10 << EOD
0.01743653 0.1138003
0.05294802 0.02057909
0.1119408 0.006700168
0.2399604 0.00229709
0.6141009 0.001557286
EOD
$p5c11 << EOD
0.01743653 0.1138003
0.05294802 0.02057909
0.1119408 0.006700168
0.2399604 0.00229709
0.6141009 0.001557286
EOD
$p6c0 << EOD
0.002128606 3.556774e+09
0.01219438 8.853137e+09
0.06302209 9.259835e+09
0.4098931 8.853741e+09
EOD
$p6c1 << EOD
0.002128606 3.556774e+09
0.01219438 8.853137e+09
0.06302209 9.259835e+09
0.4098931 8.853741e+09
EOD
$p6c2 << EOD
0.003516853 4.002363e+09
0.0230301 1.127487e+10
0.08723357 1.12936e+10
0.4057925 9.299978e+09
EOD
$p6c3 << EOD
0.003516853 4.002363e+09
0.0230301 1.127487e+10
0.08723357 1.12936e+10
0.4057925 9.299978e+09
EOD
$p6c4 << EOD
0.003114627 3.353793e+09
0.02264632 6.283754e+09
0.1826688 6.343489e+09
EOD
$p6c5 << EOD
0.003114627 3.353793e+09
0.02264632 6.283754e+09
0.1826688 6.343489e+09
EOD
$p6c6 << EOD
0.005498074 5.679531e+09
0.03148118 7.210132e+09
EOD
$p6c7 << EOD
0.005498074 5.679531e+09
0.03148118 7.210132e+09
EOD
$p6c8 << EOD
0.01550425 3.556775e+09
0.04258949 7.261263e+09
0.08162068 9.383804e+09
0.152027 9.550495e+09
0.4450474 9.558493e+09
EOD
$p6c9 << EOD
0.01550425 3.556775e+09
0.04258949 7.261263e+09
0.08162068 9.383804e+09
0.152027 9.550495e+09
0.4450474 9.558493e+09
EOD
$p6c10 << EOD
0.01743653 4.002363e+09
0.05294802 8.221119e+09
0.1119408 9.328255e+09
0.2399604 7.653421e+09
0.6141009 6.971062e+09
EOD
$p6c11 << EOD
0.01743653 4.002363e+09
0.05294802 8.221119e+09
0.1119408 9.328255e+09
0.2399604 7.653421e+09
0.6141009 6.971062e+09
EOD
set encoding utf8
set minussign
set terminal svg size 900,1250 dynamic enhanced rounded font 'sans-serif,15' name 'captured'
set border 3 lw 1 lc rgb '#767676'
set tics nomirror out scale 0.6 tc rgb '#1a1a1a'
set grid lw 0.6 lt 1 lc rgb '#e0e0e0'
set multiplot
unset arrow
unset label
unset logscale
set format x '%g'
set format y '%g'
set lmargin at screen 0.10889
set rmargin at screen 0.97556
set tmargin at screen 0.95520
set bmargin at screen 0.84274
set xrange [0.001795936:0.7278537]
set yrange [2.621736e-07:0.199921]
set logscale x
set format x '10^{%L}'
set logscale y
set format y '10^{%L}'
set xlabel ''
set format x ''
set ylabel 'error [g h]'
set key at screen 0.97556, screen 0.97680 right center horizontal maxcols 3 samplen 1.6 spacing 1.0
plot $p0c0 using 1:2 with lines lc rgb '#0072b2' lw 1.6 title 'nncg, warm', \
     $p0c1 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p0c2 using 1:2 with lines lc rgb '#0072b2' lw 1.6 dt (8,5) title 'nncg, cold', \
     $p0c3 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p0c4 using 1:2 with lines lc rgb '#d55e00' lw 1.6 title 'anderson\_pgs, warm', \
     $p0c5 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p0c6 using 1:2 with lines lc rgb '#d55e00' lw 1.6 dt (8,5) title 'anderson\_pgs, cold', \
     $p0c7 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p0c8 using 1:2 with lines lc rgb '#009e73' lw 1.6 title 'newton\_burst, warm', \
     $p0c9 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle, \
     $p0c10 using 1:2 with lines lc rgb '#009e73' lw 1.6 dt (8,5) title 'newton\_burst, cold', \
     $p0c11 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle
unset arrow
unset label
unset logscale
set format x '%g'
set format y '%g'
set lmargin at screen 0.10889
set rmargin at screen 0.97556
set tmargin at screen 0.82354
set bmargin at screen 0.71109
set xrange [0.001795936:0.7278537]
set yrange [4.206187e-06:1.983225]
set logscale x
set format x '10^{%L}'
set logscale y
set format y '10^{%L}'
set xlabel ''
set format x ''
set ylabel 'bodies off [g h]'
set key at screen 0.97556, screen 0.82754 right center horizontal maxcols 1 samplen 1.6 spacing 1.0
plot $p1c0 using 1:2 with lines lc rgb '#0072b2' lw 1.6 notitle, \
     $p1c1 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p1c2 using 1:2 with lines lc rgb '#0072b2' lw 1.6 dt (8,5) notitle, \
     $p1c3 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p1c4 using 1:2 with lines lc rgb '#d55e00' lw 1.6 notitle, \
     $p1c5 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p1c6 using 1:2 with lines lc rgb '#d55e00' lw 1.6 dt (8,5) notitle, \
     $p1c7 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p1c8 using 1:2 with lines lc rgb '#009e73' lw 1.6 notitle, \
     $p1c9 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle, \
     $p1c10 using 1:2 with lines lc rgb '#009e73' lw 1.6 dt (8,5) notitle, \
     $p1c11 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle
unset arrow
unset label
unset logscale
set format x '%g'
set format y '%g'
set lmargin at screen 0.10889
set rmargin at screen 0.97556
set tmargin at screen 0.69189
set bmargin at screen 0.57943
set xrange [0.001795936:0.7278537]
set yrange [5.722125e-06:1.658883]
set logscale x
set format x '10^{%L}'
set logscale y
set format y '10^{%L}'
set xlabel ''
set format x ''
set ylabel 'contacts off [g h]'
set key at screen 0.97556, screen 0.69589 right center horizontal maxcols 1 samplen 1.6 spacing 1.0
plot $p2c0 using 1:2 with lines lc rgb '#0072b2' lw 1.6 notitle, \
     $p2c1 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p2c2 using 1:2 with lines lc rgb '#0072b2' lw 1.6 dt (8,5) notitle, \
     $p2c3 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p2c4 using 1:2 with lines lc rgb '#d55e00' lw 1.6 notitle, \
     $p2c5 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p2c6 using 1:2 with lines lc rgb '#d55e00' lw 1.6 dt (8,5) notitle, \
     $p2c7 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p2c8 using 1:2 with lines lc rgb '#009e73' lw 1.6 notitle, \
     $p2c9 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle, \
     $p2c10 using 1:2 with lines lc rgb '#009e73' lw 1.6 dt (8,5) notitle, \
     $p2c11 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle
unset arrow
unset label
unset logscale
set format x '%g'
set format y '%g'
set lmargin at screen 0.10889
set rmargin at screen 0.97556
set tmargin at screen 0.56023
set bmargin at screen 0.44777
set xrange [0.001795936:0.7278537]
set yrange [1.810183e-06:1.069832]
set logscale x
set format x '10^{%L}'
set logscale y
set format y '10^{%L}'
set xlabel ''
set format x ''
set ylabel 'impulses off [1]'
set key at screen 0.97556, screen 0.56423 right center horizontal maxcols 1 samplen 1.6 spacing 1.0
plot $p3c0 using 1:2 with lines lc rgb '#0072b2' lw 1.6 notitle, \
     $p3c1 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p3c2 using 1:2 with lines lc rgb '#0072b2' lw 1.6 dt (8,5) notitle, \
     $p3c3 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p3c4 using 1:2 with lines lc rgb '#d55e00' lw 1.6 notitle, \
     $p3c5 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p3c6 using 1:2 with lines lc rgb '#d55e00' lw 1.6 dt (8,5) notitle, \
     $p3c7 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p3c8 using 1:2 with lines lc rgb '#009e73' lw 1.6 notitle, \
     $p3c9 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle, \
     $p3c10 using 1:2 with lines lc rgb '#009e73' lw 1.6 dt (8,5) notitle, \
     $p3c11 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle
unset arrow
unset label
unset logscale
set format x '%g'
set format y '%g'
set lmargin at screen 0.10889
set rmargin at screen 0.97556
set tmargin at screen 0.42857
set bmargin at screen 0.31611
set xrange [0.001795936:0.7278537]
set yrange [1.198792e-07:1.206526]
set logscale x
set format x '10^{%L}'
set logscale y
set format y '10^{%L}'
set xlabel ''
set format x ''
set ylabel 'wall force off [1]'
set key at screen 0.97556, screen 0.43257 right center horizontal maxcols 1 samplen 1.6 spacing 1.0
plot $p4c0 using 1:2 with lines lc rgb '#0072b2' lw 1.6 notitle, \
     $p4c1 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p4c2 using 1:2 with lines lc rgb '#0072b2' lw 1.6 dt (8,5) notitle, \
     $p4c3 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p4c4 using 1:2 with lines lc rgb '#d55e00' lw 1.6 notitle, \
     $p4c5 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p4c6 using 1:2 with lines lc rgb '#d55e00' lw 1.6 dt (8,5) notitle, \
     $p4c7 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p4c8 using 1:2 with lines lc rgb '#009e73' lw 1.6 notitle, \
     $p4c9 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle, \
     $p4c10 using 1:2 with lines lc rgb '#009e73' lw 1.6 dt (8,5) notitle, \
     $p4c11 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle
unset arrow
unset label
unset logscale
set format x '%g'
set format y '%g'
set lmargin at screen 0.10889
set rmargin at screen 0.97556
set tmargin at screen 0.29691
set bmargin at screen 0.18446
set xrange [0.001795936:0.7278537]
set yrange [0.0004903277:0.154899]
set logscale x
set format x '10^{%L}'
set logscale y
set format y '10^{%L}'
set xlabel ''
set format x ''
set ylabel 'statuses off [1]'
set key at screen 0.97556, screen 0.30091 right center horizontal maxcols 1 samplen 1.6 spacing 1.0
plot $p5c0 using 1:2 with lines lc rgb '#0072b2' lw 1.6 notitle, \
     $p5c1 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p5c2 using 1:2 with lines lc rgb '#0072b2' lw 1.6 dt (8,5) notitle, \
     $p5c3 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p5c4 using 1:2 with lines lc rgb '#d55e00' lw 1.6 notitle, \
     $p5c5 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p5c6 using 1:2 with lines lc rgb '#d55e00' lw 1.6 dt (8,5) notitle, \
     $p5c7 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p5c8 using 1:2 with lines lc rgb '#009e73' lw 1.6 notitle, \
     $p5c9 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle, \
     $p5c10 using 1:2 with lines lc rgb '#009e73' lw 1.6 dt (8,5) notitle, \
     $p5c11 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle
unset arrow
unset label
unset logscale
set format x '%g'
set format y '%g'
set lmargin at screen 0.10889
set rmargin at screen 0.97556
set tmargin at screen 0.16526
set bmargin at screen 0.05280
set xrange [0.001795936:0.7278537]
set yrange [1e+09:1e+11]
set logscale x
set format x '10^{%L}'
set logscale y
set format y '10^{%L}'
set xlabel 'cost of a solve, median over problems [s]' offset 0,0.3
set ylabel 'k_{art} [N/m]'
set key at screen 0.97556, screen 0.16926 right center horizontal maxcols 1 samplen 1.6 spacing 1.0
plot $p6c0 using 1:2 with lines lc rgb '#0072b2' lw 1.6 notitle, \
     $p6c1 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p6c2 using 1:2 with lines lc rgb '#0072b2' lw 1.6 dt (8,5) notitle, \
     $p6c3 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p6c4 using 1:2 with lines lc rgb '#d55e00' lw 1.6 notitle, \
     $p6c5 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p6c6 using 1:2 with lines lc rgb '#d55e00' lw 1.6 dt (8,5) notitle, \
     $p6c7 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p6c8 using 1:2 with lines lc rgb '#009e73' lw 1.6 notitle, \
     $p6c9 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle, \
     $p6c10 using 1:2 with lines lc rgb '#009e73' lw 1.6 dt (8,5) notitle, \
     $p6c11 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle
unset multiplot
