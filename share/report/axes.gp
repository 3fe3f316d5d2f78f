# Ranges of logarithmic axes. Of y: all points within Tukey's outer fences of log10 y, three interquartile ranges from
# the quartiles and at least three decades, as an error of 1e30 would leave the others a line; levels are always within,
# and points up to ten times the highest, as there is where an error is compared. Axes of less than two decades have
# numbers at 1, 2 and 5 times powers of ten, as gnuplot writes those of powers of ten alone.
larger(a, b) = a > b ? a : b
unset logscale
set autoscale
set xtics autofreq
set ytics autofreq
if (log_x) {
  stats data index first:last using ($1 > 0 ? log10($1) : NaN) name 'x' nooutput
}
if (log_y) {
  stats data index first:last using ($2 > 0 ? log10($2) : NaN) name 'y' nooutput
  reach = larger(3, 3 * (y_up_quartile - y_lo_quartile))
  low = y_lo_quartile - reach
  high = larger(y_up_quartile + reach, highest + 1)
  stats data index first:last using ($2 > 0 && log10($2) >= low && log10($2) <= high ? log10($2) : NaN) name 'in' nooutput
  low = highest > -300 && lowest < in_min ? lowest : in_min
  high = larger(in_max, highest)
  margin = larger(log10(2), 0.05 * (high - low))
  set yrange [10 ** (low - margin) : 10 ** (high + margin)]
  if (y_records > in_records) {
    set label sprintf('%d beyond the frame', y_records - in_records) at graph 0.01, graph 0.03 left tc '#555555' font ',10'
  }
  if (high - low + 2 * margin < 2) {
    set ytics (1e-320)
    do for [power = floor(low - margin) : ceil(high + margin)] {
      do for [digit in '1 2 5'] { set ytics add (sprintf('%ge%d', digit + 0, power) digit * 10.0 ** power) }
    }
  }
}
if (log_x) {
  widen = larger(0, (log10(3) - (x_max - x_min)) / 2)
  margin = widen + 0.05 * (x_max - x_min + 2 * widen)
  set xrange [10 ** (x_min - margin) : 10 ** (x_max + margin)]
  if (x_max - x_min + 2 * margin < 2) {
    set xtics (1e-320)
    do for [power = floor(x_min - margin) : ceil(x_max + margin)] {
      do for [digit in '1 2 5'] { set xtics add (sprintf('%g', digit * 10.0 ** power) digit * 10.0 ** power) }
    }
  }
}
if (log_x) { set logscale x }
if (log_y) { set logscale y }
