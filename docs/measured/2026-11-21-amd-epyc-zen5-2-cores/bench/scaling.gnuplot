# scaling: gnuplot scaling.gnuplot > scaling.svg
$p0c0 << EOD
1200 2776.95
10800 3023.786
97200 1648.395
EOD
$p0c1 << EOD
1200 813.4042
10800 1058.38
97200 622.8487
EOD
$p0c2 << EOD
1200 55.60417
10800 183.5965
97200 268.8411
EOD
$p1c0 << EOD
1200 0
10800 185
97200 185
EOD
$p1c1 << EOD
1200 0
10800 118
97200 118
EOD
set encoding utf8
set minussign
set terminal svg size 900,620 dynamic enhanced rounded font 'sans-serif,15' name 'scaling'
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
set tmargin at screen 0.94516
set bmargin at screen 0.56290
set xrange [1000:100000]
set yrange [10:10000]
set logscale x
set format x '10^{%L}'
set logscale y
set format y '10^{%L}'
set xlabel ''
set format x ''
set ylabel 'ns per grain'
set key at screen 0.97556, screen 0.97097 right center horizontal maxcols 3 samplen 1.6 spacing 1.0
plot $p0c0 using 1:2 with lines lc rgb '#d55e00' lw 1.6 title 'detection', \
     $p0c1 using 1:2 with lines lc rgb '#e69f00' lw 1.6 title 'assembly', \
     $p0c2 using 1:2 with lines lc rgb '#0072b2' lw 1.6 title 'a sweep'
unset arrow
unset label
unset logscale
set format x '%g'
set format y '%g'
set lmargin at screen 0.10889
set rmargin at screen 0.97556
set tmargin at screen 0.48871
set bmargin at screen 0.10645
set xrange [1000:100000]
set yrange [0:196.1]
set logscale x
set format x '10^{%L}'
set xlabel 'grains' offset 0,0.3
set ylabel 'iterations needed'
set key at screen 0.97556, screen 0.51452 right center horizontal maxcols 2 samplen 1.6 spacing 1.0
plot $p1c0 using 1:2 with lines lc rgb '#0072b2' lw 1.6 title 'pgs', \
     $p1c1 using 1:2 with lines lc rgb '#009e73' lw 1.6 title 'nncg'
unset multiplot
