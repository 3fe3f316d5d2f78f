// SPDX-License-Identifier: BSL-1.0
// Five planets around the sun by Kepler motions and kicks.
//
// Wisdom's and Holman's method moves each planet along its ellipse exactly, and kicks with what the planets
// do to each other: its error is a thousandth, as the planets' masses are, of that of a method that splits H
// into K and V. We learn words of the same letters with two kicks a step, and compare the largest error of
// the energy in 500 years, at the same number of kicks. SRKN6b [blanes_moan_2002], of six kicks with all
// forces and order 6, has no Kepler motions to compute: these cost some ten kicks, so that in seconds it
// leads.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"
#include "systems/planets.hpp"

using namespace nysalt;
using namespace examples;

const auto planets = outer_solar_system();
const auto start = outer_solar_system_start();

double energy_error(const method& method, double step) {
  const double before = energy<double>(planets, start);
  double worst = 0.0;
  const auto watch = [&](std::int64_t, double, const auto& x) {
    worst = std::max(worst, std::abs(energy<double>(planets, x) / before - 1.0));
  };
  integrate(planets, method, step, start, static_cast<std::int64_t>(182'625.0 / step), watch);
  return worst;
}

/// Eight states of the next hundred years: four to learn from, four to judge by.
listed<15> states(std::size_t first) {
  std::vector<phase_point<double, 15>> all{start};
  for (int k = 0; k < 7; ++k) all.push_back(integrate(planets, srkn11b{}, 100.0, all.back(), 50).finish);
  return listed<15>({all.begin() + static_cast<std::ptrdiff_t>(first),
                     all.begin() + static_cast<std::ptrdiff_t>(first) + 4});
}

int main() {
  fmt::print("days a kick  verlet   srkn6b   wisdom_holman  planetary_2\n");
  for (const double step : {50.0, 100.0, 200.0, 400.0}) {
    const auto reference = fine_steps(step / 10.0);
    const data_options options{.step = 2.0 * step, .horizon = 40.0 * step, .trajectories = 4, .seed = 1};
    const auto data = make_flow_map_data(planets, states(0), reference, options);
    const auto unseen = make_flow_map_data(planets, states(4), reference, options);
    const auto [theta, summary, method] =
        learn(planetary<2>{}, planets, data, unseen, {.random_starts = 4, .planned_steps = 2000});
    fmt::print("{:>11}  {:.1e}  {:.1e}  {:.1e}        {:.1e} ({})\n", step, energy_error(verlet{}, step),
               energy_error(srkn6b{}, 6.0 * step), energy_error(wisdom_holman(), step),
               energy_error(method, 2.0 * step),
               summary.usable ? fmt::format("a1 = {:.4f}", theta[0]) : summary.reason);
  }
}

// Expected output:
// days a kick  verlet   srkn6b   wisdom_holman  planetary_2
//          50  2.0e-04  9.5e-07  2.7e-07        6.9e-10 (a1 = 0.2114)
//         100  7.4e-04  5.2e-05  1.1e-06        1.3e-08 (a1 = 0.2112)
//         200  2.0e-03  1.4e-03  4.3e-06        1.6e-07 (a1 = 0.2125)
//         400  7.7e-03  3.4e-02  1.8e-05        1.0e-05 (a1 = 0.2513)
