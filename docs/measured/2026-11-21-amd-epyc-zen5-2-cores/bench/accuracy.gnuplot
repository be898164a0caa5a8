# accuracy: gnuplot accuracy.gnuplot > accuracy.svg
$p0c0 << EOD
80.29868 0.1232704
110.3906 0.05880301
152.7233 0.02918152
238.9726 0.01904632
776.6799 0.002193816
EOD
$p0c1 << EOD
80.29868 0.1232704
110.3906 0.05880301
152.7233 0.02918152
238.9726 0.01904632
776.6799 0.002193816
EOD
$p0c2 << EOD
84.73942 0.1764954
104.8245 0.08347869
140.2561 0.04484218
189.8413 0.02285135
629.091 0.004527225
EOD
$p0c3 << EOD
84.73942 0.1764954
104.8245 0.08347869
140.2561 0.04484218
189.8413 0.02285135
629.091 0.004527225
EOD
$p0c4 << EOD
125.8841 0.1043861
169.5049 0.03199676
256.123 0.01602421
388.8539 0.004767919
1325.129 0.000998108
EOD
$p0c5 << EOD
125.8841 0.1043861
169.5049 0.03199676
256.123 0.01602421
388.8539 0.004767919
1325.129 0.000998108
EOD
$p0c6 << EOD
87.77493 0.328099
113.2124 0.1102415
170.5506 0.04454642
285.0444 0.03091974
1053.358 0.009787126
EOD
$p0c7 << EOD
87.77493 0.328099
113.2124 0.1102415
170.5506 0.04454642
285.0444 0.03091974
1053.358 0.009787126
EOD
set encoding utf8
set minussign
set terminal svg size 900,420 dynamic enhanced rounded font 'sans-serif,15' name 'accuracy'
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
set tmargin at screen 0.91905
set bmargin at screen 0.15714
set xrange [10:10000]
set yrange [0.0001:1]
set logscale x
set format x '10^{%L}'
set logscale y
set format y '10^{%L}'
set xlabel 'cost of a simulated second [s]' offset 0,0.3
set ylabel 'error, mean over steps [g h]'
set key at screen 0.97556, screen 0.95714 right center horizontal maxcols 4 samplen 1.6 spacing 1.0
set arrow from graph 0, first 0.001 to graph 1, first 0.001 nohead front lw 1.2 dt (3,4) lc rgb '#767676'
set label '1e-3' at graph 0.995, first 0.001 right offset character 0, 0.5 front font ',13' tc rgb '#1a1a1a'
plot $p0c0 using 1:2 with lines lc rgb '#0072b2' lw 1.6 title 'nncg', \
     $p0c1 using 1:2 with points pt 7 ps 0.56 lc rgb '#0072b2' notitle, \
     $p0c2 using 1:2 with lines lc rgb '#d55e00' lw 1.6 title 'pgs', \
     $p0c3 using 1:2 with points pt 7 ps 0.56 lc rgb '#d55e00' notitle, \
     $p0c4 using 1:2 with lines lc rgb '#009e73' lw 1.6 title 'anderson_pgs', \
     $p0c5 using 1:2 with points pt 7 ps 0.56 lc rgb '#009e73' notitle, \
     $p0c6 using 1:2 with lines lc rgb '#e69f00' lw 1.6 title 'apgd', \
     $p0c7 using 1:2 with points pt 7 ps 0.56 lc rgb '#e69f00' notitle
unset multiplot
