# Draws the tables that physics_figures wrote: gnuplot -c figures.gnuplot DIRECTORY
directory = ARG1
file(name) = directory . "/" . name

set terminal svg size 900,540 font "sans-serif,13" background "white"
set datafile separator ","
set grid lc rgb "#dddddd"
set border 3
set tics nomirror
set key outside right top
set style data lines

set output file("pull_out_torque.svg")
set title "Pull-out torque at 24 V and rated current, load inertia as the rotor's\n{/*0.8 solid: integrated; dashed: averaged model}"
set xlabel "speed, rpm"
set ylabel "torque at the shaft, N m"
names = "QSH5718-41-28-055 QSH5718-51-28-101 QSH5718-56-28-126 QSH5718-76-28-189 QSH6018-45-28-110 QSH6018-56-28-165 QSH6018-65-28-210 QSH6018-86-28-310"
table(i) = file("pull_out_torque_" . word(names, i) . ".csv")
plot for [i = 1:words(names)] table(i) skip 1 using 1:2 lw 2 lc i title word(names, i), \
     for [i = 1:words(names)] table(i) skip 1 using 1:3 lw 1 dt 2 lc i notitle

set output file("step_response.svg")
set title "One full step of the field: QSH5718-41-28-055 with a load inertia of 100 g cm²"
set xlabel "ms"
set ylabel "full steps"
plot file("step_response.csv") skip 1 using 1:2 lw 2 title "field", "" skip 1 using 1:3 lw 2 title "rotor"

set output file("resonance.svg")
set title "Ripple of the speed (rms over mean) in full steps and in 1/256 steps"
set xlabel "full steps per second"
set ylabel "ripple"
set logscale xy
plot file("resonance.csv") skip 1 using 1:2 lw 2 title "full steps", "" skip 1 using 1:3 lw 2 title "1/256 steps"
unset logscale

set output file("mid_band_instability.svg")
set title "QSH5718-51-28-101 at 800 rpm, the load rising to 0.37 N m until 1.5 s"
set xlabel "s"
set ylabel "electrical degrees that the field leads the rotor"
plot file("mid_band_instability.csv") skip 1 using 1:2 lw 1 title "loaded", "" skip 1 using 1:3 lw 2 title "without load"

set output file("stall_guard.svg")
set title "stallGuard2 with SGT = 0 over the load, QSH5718-41-28-055 at 24 V"
set xlabel "load, percent of the holding torque"
set ylabel "SG"
plot file("stall_guard.csv") skip 1 using 1:2 lw 2 title "120 rpm", "" skip 1 using 1:3 lw 2 title "290 rpm", \
     "" skip 1 using 1:4 lw 2 title "500 rpm"

set output file("stall.svg")
set title "A brake of 0.7 N m from 0.4 s to 0.45 s; QSH5718-41-28-055 at 290 rpm"
set xlabel "s"
set xrange [0.3:0.8]
set ylabel "rpm; SG"
set y2label "full steps lost"
set y2tics
plot file("stall.csv") skip 1 using 1:2 lw 2 title "field, rpm", "" skip 1 using 1:3 lw 2 title "rotor, rpm", \
     "" skip 1 using 1:5 lw 1 title "SG", "" skip 1 using 1:4 axes x1y2 lw 2 title "full steps lost"

# ---- With the firmware: recordings of examples/scenarios

# Currents in the two coils are sine and cosine of one amplitude: their losses together are its square times R.
losses(amplitude) = 0.70 * amplitude**2 # W; QSH5718-41-28-055 at 20 °C
interval = 0.005                        # s, between two lines
half = 10                               # s: from here on with coolStep
spent(amplitude) = losses(amplitude) * interval
stats file("cool_step.csv") skip 1 using ($1 < half ? spent($3) : 0) name "without" nooutput
stats file("cool_step.csv") skip 1 using ($1 >= half && $1 < 2 * half ? spent($3) : 0) name "with" nooutput
set output file("cool_step.svg")
set title sprintf("coolStep: 10 s under one load cost %.0f J in the coils without it, %.0f J with it", without_sum, with_sum)
set xlabel "s"
set xrange [0:half]
set ylabel "A, peak of the sine; W"
set yrange [0:12]
set y2label "load, N m; SG / 1000"
set y2range [0:1.2]
set y2tics
early(y) = column(1) < half ? y : NaN
late(y) = column(1) >= half ? y : NaN
plot file("cool_step.csv") skip 1 using 1:(early($3)) lw 2 lc 1 title "without: A", \
     "" skip 1 using 1:(early(losses($3))) lw 1 dt 2 lc 1 title "without: W", \
     "" skip 1 using ($1 - half):(late($3)) lw 2 lc 2 title "with: A", \
     "" skip 1 using ($1 - half):(late(losses($3))) lw 1 dt 2 lc 2 title "with: W", \
     "" skip 1 using ($1 - half):(late($4 / 1000)) axes x1y2 lw 1 lc rgb "#999999" title "with: SG / 1000", \
     "" skip 1 using 1:(early($2)) axes x1y2 lw 2 lc 4 title "load, N m"
unset y2tics
unset y2label
set autoscale y

set output file("deviation_stop.svg")
set title "A brake of 0.6 N m at 36 rpm, and parameter 212 = 1500 microsteps"
set xrange [1.95:2.2]
set ylabel "full steps since 1.95 s"
begin = 1.95
stats file("lost_steps.csv") skip 1 using ($1 <= begin ? $2 : NaN) name "field" nooutput
stats file("lost_steps.csv") skip 1 using ($1 <= begin ? $3 : NaN) name "rotor" nooutput
full_steps(place, before) = (place - before) / 256.0
set arrow 1 from 2.0, graph 0 to 2.0, graph 1 nohead dt 2 lc rgb "#999999"
set arrow 2 from 2.1, graph 0 to 2.1, graph 1 nohead dt 2 lc rgb "#999999"
set label 1 "brake on" at 2.0, graph 0.05 offset 0.5
set label 2 "brake off" at 2.1, graph 0.05 offset 0.5
plot file("lost_steps.csv") skip 1 using 1:(full_steps($2, field_max)) with steps lw 2 title "field: position", \
     "" skip 1 using 1:(full_steps($3, rotor_max)) with steps lw 2 title "rotor"
