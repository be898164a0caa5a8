# What became of the headline numbers, from history.csv.
# In this folder:  gnuplot history.gnuplot > history.svg
set encoding utf8
set terminal svg size 900,330 dynamic enhanced rounded font 'sans-serif,13' background '#ffffff'
set border 3 lw 1 lc rgb '#767676'
set tics nomirror out scale 0.6 tc rgb '#1a1a1a'
set grid lw 0.6 lt 1 lc rgb '#e0e0e0'
set xdata time
set timefmt '%Y-%m-%d'
set format x '%d.%m.'
set xtics 86400
set offsets 43200, 43200, 0, 0
set logscale y
set key bottom left samplen 1.2 Left reverse
# date and value of the quantities whose name begins so, machines side by side
of(begin) = sprintf("< awk -v name=\"%s\" 'index($0, name) { print $1 \",\" $NF }' FS=, history.csv", begin)
set datafile separator ','
set multiplot layout 1,3
set title 'over Bullet and over Siconos (1: as fast)'
plot of('step of 20 iterations') using 1:2 with points pt 7 ps 0.7 lc rgb '#0072b2' \
       title 'step, 20 iterations', \
     of('step of 200 iterations') using 1:2 with points pt 5 ps 0.7 lc rgb '#d55e00' \
       title 'step, 200 iterations', \
     of('auto over Siconos') using 1:2 with points pt 9 ps 0.8 lc rgb '#009e73' title 'auto'
set title 'a driven second, two threads (s)'
plot of('driven second at 2e-2') using 1:2 with points pt 9 ps 0.8 lc rgb '#009e73' \
       title 'to 2e-2 g h', \
     of('driven second at 1e-2') using 1:2 with points pt 7 ps 0.7 lc rgb '#0072b2' \
       title 'to 1e-2 g h', \
     of('driven second at 1e-3') using 1:2 with points pt 5 ps 0.7 lc rgb '#d55e00' \
       title 'to 1e-3 g h'
unset logscale y
set yrange [0:*]
set title 'lines outside tests'
plot of('lines of C++') using 1:2 with linespoints pt 7 ps 0.7 lc rgb '#0072b2' notitle
