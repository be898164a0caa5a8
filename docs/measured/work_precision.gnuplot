# Cost against accuracy on the vibrated box, from accuracy.csv (ballast bench accuracy).
# In this folder:  gnuplot work_precision.gnuplot > work_precision.svg
set encoding utf8
set terminal svg size 900,480 dynamic enhanced rounded font 'sans-serif,15' background '#ffffff'
set border 3 lw 1 lc rgb '#767676'
set tics nomirror out scale 0.6 tc rgb '#1a1a1a'
set grid lw 0.6 lt 1 lc rgb '#e0e0e0'
set logscale xy
set format x '10^{%L}'
set xrange [0.3:7e-4]
set yrange [15:2000]
set xlabel 'error of a step, rms over contacts  ({/:Italic g h});  to the right: more accurate'
set ylabel 'time of a simulated second  (s)'
set key top left samplen 1.6
# error and cost of one backend, budgets of iterations from the smallest
of(name) = sprintf("< awk -F, '{ gsub(/\"/, \"\") } $1 == \"%s\" && $3 ~ /^cost/ { cost = $5 } \
  $1 == \"%s\" && $3 ~ /^error rms/ && $4 ~ /mean/ { print $6, cost }' accuracy.csv | sort -gr", name, name)
array names[4] = ['nesterov_pgs', 'nncg', 'pgs', 'newton_burst']
array inks[4] = ['#0072b2', '#d55e00', '#009e73', '#e69f00']
plot for [k=1:4] of(names[k]) using 1:2 with linespoints pt 7 ps 0.6 lw 1.8 lc rgb inks[k] \
  title names[k] noenhanced
