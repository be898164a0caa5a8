# What became of the headline numbers, from history.csv.
# In this folder:  gnuplot history.gnuplot > history.svg
set encoding utf8
set terminal svg dynamic enhanced rounded font 'sans-serif,13' background '#ffffff' size 900,340
set border 3 lw 1 lc rgb '#767676'
set tics nomirror out scale 0.6 tc rgb '#1a1a1a'
set grid lw 0.6 lt 1 lc rgb '#e0e0e0'
set xdata time
set timefmt '%Y-%m-%d'
set format x '%d %b'
set xtics 345600
set xrange ['2026-11-20':*]
set offsets graph 0, graph 0.05, 0, 0
set key outside bottom center vertical maxrows 3 samplen 1.2
# date and value of a quantity; machines side by side
of(name) = sprintf("< awk -v name=\"%s\" 'index($0, name) { print $1 \",\" $NF }' FS=, history.csv", name)
set datafile separator ','
set style line 1 pt 7 ps 0.7 lc rgb '#0072b2'
set style line 2 pt 5 ps 0.7 lc rgb '#d55e00'
set style line 3 pt 9 ps 0.8 lc rgb '#009e73'
set multiplot layout 1,3
set logscale y
set yrange [0.1:1]
set title 'time over that of others'
plot of('step of 20 iterations') using 1:2 with points ls 1 title 'step, 20 iterations, over Bullet', \
     of('step of 200 iterations') using 1:2 with points ls 2 title 'step, 200 iterations, over Bullet', \
     of('to 1e-4') using 1:2 with points ls 3 title 'auto, piles to 1e-4, over Siconos'
set yrange [10:1000]
set title 'a driven second, two threads (s)'
plot of('driven second at 2e-2') using 1:2 with points ls 3 title 'to 2e-2 g h', \
     of('driven second at 1e-2') using 1:2 with points ls 1 title 'to 1e-2 g h', \
     of('driven second at 1e-3') using 1:2 with points ls 2 title 'to 1e-3 g h'
unset logscale y
set yrange [0:80]
set title 'lines of C++ outside tests (thousands)'
set key off
plot of('lines of C++') using 1:($2/1000) with linespoints ls 1
