# Times beside other programs: Siconos from the table of 21 November's comparison.md ("Beside
# Siconos' own programs", shift 0.01 ms), Bullet from step.md; the commands stand there. In the folder
# above this one:  gnuplot pictures/peers.gnuplot > pictures/peers.svg
$siconos << EOD
"our fastest, 1e-4" 0.50
"auto, 1e-4" 0.64
"our fastest, 1e-8" 0.42
"auto, 1e-8" 0.55
EOD
$bullet << EOD
"20 iterations, one thread" 0.17
"200 iterations, one thread" 0.37
"200 iterations, two threads" 0.21
"to an error of 0.01, one thread" 0.23
EOD
set encoding utf8
set terminal svg size 900,520 dynamic enhanced rounded font 'sans-serif,15' background '#ffffff'
set multiplot layout 2,1
set border 2 lw 1 lc rgb '#767676'
set tics nomirror out scale 0 tc rgb '#1a1a1a'
set grid x lw 0.6 lt 1 lc rgb '#e0e0e0'
set xrange [0:1.1]
set xtics 0.25
set yrange [3.6:-0.6]
set lmargin 38
set rmargin 3
unset key
set arrow from 1, graph 0 to 1, graph 1 nohead lw 1.4 dt (3,4) lc rgb '#767676'
bars = "using (0):0:(0):2:($0-0.3):($0+0.3):ytic(1) with boxxyerror fs solid noborder fc rgb "
set title '26 stored problems to 1e-4 and 1e-8: time over Siconos’ best of five'
plot $siconos @bars '#0072b2', '' using ($2-0.01):0:(sprintf('%.2f', $2)) with labels right tc rgb '#ffffff'
set title '1200 grains: time of a step over Bullet’s 10 iterations (errors in {/:Italic g h})'
plot $bullet @bars '#d55e00', '' using ($2-0.01):0:(sprintf('%.2f', $2)) with labels right tc rgb '#ffffff'
