// SPDX-License-Identifier: BSL-1.0
// Your own Hamiltonian in a bath: learn with the noise, and judge paths and distribution.
//
// A light atom hangs by a stiff bond on a heavy one in a soft well, and both feel friction and noise. We say
// the temperature, draw starts from its Gibbs distribution, follow fine paths together with their noise,
// learn two stages between two halves of the bath, and compare with BAOAB: along common noise, and in the
// mean energy of the bond, which is kT for any masses.
#include <fmt/format.h>

#include <vector>

#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

struct dumbbell {
  static constexpr int dimension = 2;
  static constexpr double heavy = 1.0, light = 0.04, stiffness = 100.0;

  double inverse_mass(Eigen::Index i) const { return i == 0 ? 1.0 / heavy : 1.0 / light; }

  template <class T>
  T potential(const vector<T, 2>& q) const {
    const T elongation = q[1] - q[0] - 1.0;
    return 0.25 * (q[0] * q[0]) * (q[0] * q[0]) + (0.5 * stiffness) * (elongation * elongation);
  }
  template <class T>  // by hand: it spares the compiler differentiating
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    const T pull = stiffness * (q[1] - q[0] - 1.0);
    f[0] = pull - q[0] * q[0] * q[0];
    f[1] = -pull;
  }
  template <class T>
  T bond_energy(const phase_point<T, 2>& x) const {
    const T elongation = x.q[1] - x.q[0] - 1.0;
    const T speed = x.p[1] * (1.0 / light) - x.p[0] * (1.0 / heavy);
    const double reduced_mass = heavy * light / (heavy + light);
    return (0.5 * stiffness) * (elongation * elongation) + (0.5 * reduced_mass) * (speed * speed);
  }
  std::string description() const { return "dumbbell()"; }
};

int main() {
  constexpr double temperature = 0.25;
  constexpr double step = 0.03;  // the bond swings with frequency 51
  // [bath]
  const in_bath system(dumbbell{}, bath::of_temperature(0.1, temperature));
  const phase_point<double, 2> rest{{0.0, 1.0}, {0.0, 0.0}};
  const gibbs starts(system, normal_around<2>(rest, 0.1, 0.1), {.step = 0.01});
  const auto paths = fine_paths(1e-4);  // BAOAB, which keeps its noise
  // [/bath]

  // [learn]
  // Each half of O needs the noise of its own half of the step.
  const auto nystrom_in_bath = thermostatted(family(nystrom{}), placement::symmetric);
  const data_options options{.step = step, .horizon = 1.5, .trajectories = 200, .seed = 1, .noise_parts = 2};
  data_options others = options;
  others.seed = 2;
  const auto data = make_flow_map_data(system, starts, paths, options);
  const fit found = learn(nystrom_in_bath, system, data, make_flow_map_data(system, starts, paths, others));
  // [/learn]
  fmt::print("{}: b1 = {:.3f}, beta1 = {:.3f}, usable: {}\n\n", found.method.name(), found.theta[0],
             found.theta[1], found.summary.usable ? "yes" : found.summary.reason);

  // [judge]
  const std::vector<method> methods{baoab{}, baoab_2x{}, found.method.anywhere()};
  const auto along_path = path_measure(system, over_lanes([&](const auto& x) { return energy(system, x); }));
  const auto errors = trajectory_errors(system, paths, starts, methods, along_path,
                                        {.step = step, .steps = 50, .trajectories = 400, .seed = 3});
  // [/judge]
  const auto bond = over_lanes([&](const auto& x) { return system.bond_energy(x); });
  const ensemble_options long_runs{.trajectories = 1600, .steps = 4000, .seed = 4};
  fmt::print("                   path error of H   energy of the bond / kT\n");
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const auto stepper = make_stepper(system, methods[k], step, counter_noise(4));
    const auto all = ensemble_statistics(stepper, starts, long_runs, bond, {.moments = true, .from = 1000});
    fmt::print("{:<17} {:>16.3f} {:>14.3f} +- {:.3f}\n", methods[k].name(), errors.methods[k].error.mean,
               all.mean.mean / temperature, all.mean.standard_error / temperature);
  }
}

// Expected output:
// nystrom: b1 = 0.523, beta1 = 0.408, usable: yes
//
//                    path error of H   energy of the bond / kT
// baoab                        0.295          0.713 +- 0.008
// baoab_2x                     0.111          0.921 +- 0.010
// nystrom                      0.126          1.001 +- 0.011
