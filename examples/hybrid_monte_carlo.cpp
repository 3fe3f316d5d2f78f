// SPDX-License-Identifier: BSL-1.0
// Hybrid Monte Carlo with a learned method: independent chains, an expectation that is known, standard
// errors.
//
// A proposal is the end of a trajectory with fresh momenta; Metropolis' rule accepts it by its error of the
// energy, so that exp(-V/kT) is sampled exactly at any step. That asks for a map that keeps volume and
// is reversible: we learn in a family of symmetric words, and ask it for the least error of the energy over
// the whole trajectory, as only this decides what is rejected. Equipartition gives the expected result:
// <q . grad V> is kT for each coordinate and any V.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

constexpr int N = 4;

/// A chain of quartic wells with a stiff spring between neighbours.
struct wells {
  static constexpr int dimension = N;

  template <class T>
  void force(const vector<T, N>& q, vector<T, N>& f) const {
    for (int i = 0; i < N; ++i) f[i] = -q[i] * q[i] * q[i];
    for (int i = 0; i + 1 < N; ++i) {
      const T pull = 20.0 * (q[i + 1] - q[i]);
      f[i] += pull;
      f[i + 1] -= pull;
    }
  }
  template <class T>
  T potential(const vector<T, N>& q) const {
    T sum(0.0);
    for (int i = 0; i < N; ++i) sum += q[i] * q[i] * q[i] * q[i] * 0.25;
    for (int i = 0; i + 1 < N; ++i) sum += (q[i + 1] - q[i]) * (q[i + 1] - q[i]) * 10.0;
    return sum;
  }
  std::string description() const { return "wells()"; }
};

// [chain]
struct chain_result {
  double accepted = 0.0;  // share of the proposals
  double virial = 0.0;    // mean of q . grad V
  phase_point<double, N> last;
};

/// A chain of Hybrid Monte Carlo for exp(-V), kT = 1 [duane_kennedy_pendleton_roweth_1987]. Each chain has
/// its own random numbers, by its number.
template <class Stepper>
chain_result sample(const Stepper& stepper, int steps, std::uint64_t chain, int burn_in, int samples,
                    bool accepts_all = false) {
  const wells& system = stepper.system();
  phase_point<double, N> x{vector<double, N>::Zero(), vector<double, N>::Zero()};
  chain_result result{.last = x};
  for (int n = 0; n < burn_in + samples; ++n) {
    vector<double, N + 2> normals;
    standard_normals(5, {.trajectory = chain, .step = n, .purpose = noise_purpose::initial_state}, normals);
    x.p = normals.head<N>();  // fresh momenta, of unit mass
    auto run = stepper.open(x);
    stepper.advance(run, steps);
    const auto proposal = stepper.synchronous(run);
    const double rise = energy<double>(system, proposal) - energy<double>(system, x);
    // -log of a uniform number is half the square of two normal ones. A trajectory that diverged (nan) is
    // rejected.
    const bool accepted = accepts_all || rise < 0.5 * normals.tail<2>().squaredNorm();
    if (accepted) x = proposal;
    result.last = x;
    if (n < burn_in) continue;
    vector<double, N> f;
    system.force(x.q, f);
    result.accepted += accepted ? 1.0 / samples : 0.0;
    result.virial -= x.q.dot(f) / samples;
  }
  return result;
}
// [/chain]

int main() {
  const wells system;
  constexpr double step = 0.28;  // of two evaluations
  constexpr int steps = 6;

  // [learn]
  // Data like what comes: the ends of short chains by Verlet's method, of small steps.
  const auto pilot = make_stepper(system, verlet{}, step / 4);
  std::vector<phase_point<double, N>> states;
  for (std::uint64_t chain = 1000; chain < 1400; ++chain) {
    states.push_back(sample(pilot, 4 * steps, chain, 50, 0).last);
  }
  const listed<N> starts(states);
  const data_options training{.step = step, .horizon = steps * step, .trajectories = 200};
  data_options others = training;
  others.first = 200;  // the second half of the list
  const auto reference = fine_steps(step / 40);
  const auto data = make_flow_map_data(system, starts, reference, training);
  const auto unseen = make_flow_map_data(system, starts, reference, others);
  const fit found = learn(aba<2>{}, system, data, unseen, {.loss = loss_named("energy:6")});
  // [/learn]
  fmt::print("a1 = {:.4f} +- {:.4f}, usable: {}\n", found.theta[0],
             found.summary.parameters[0].standard_error, found.summary.usable ? "yes" : found.summary.reason);

  fmt::print("                accepted           <q . grad V>, {} is exact\n", N);
  const std::vector<nysalt::method> methods{found.method.anywhere(), mclachlan2{}, bcss2{}, verlet_2x{}};
  const auto report = [&](const nysalt::method& each,
                          bool accepts_all) {  // all of them: twelve evaluations a proposal
    const auto stepper = make_stepper(system, each, step);
    std::vector<double> accepted;
    std::vector<double> virial;
    for (std::uint64_t chain = 0; chain < 100; ++chain) {
      const chain_result result = sample(stepper, steps, chain, 100, 1000, accepts_all);
      accepted.push_back(result.accepted);
      virial.push_back(result.virial);
    }
    // Chains are independent, so that the spread of their means is an honest error bar.
    const auto a = mean_and_error(accepted);
    const auto v = mean_and_error(virial);
    fmt::print("{:<12} {:.4f} +- {:.4f}    {:.3f} +- {:.3f}\n", each.name(), a.mean, a.standard_error, v.mean,
               v.standard_error);
  };
  for (const auto& each : methods) report(each, false);
  fmt::print("without Metropolis' rule the distribution is another:\n");
  report(methods.back(), true);
}

// Expected output:
// a1 = 0.2230 +- 0.0008, usable: yes
//                 accepted           <q . grad V>, 4 is exact
// aba2         0.9695 +- 0.0006    4.004 +- 0.027
// mclachlan2   0.9166 +- 0.0009    4.002 +- 0.030
// bcss2        0.9508 +- 0.0007    3.992 +- 0.028
// verlet_2x    0.8712 +- 0.0011    3.988 +- 0.027
// without Metropolis' rule the distribution is another:
// verlet_2x    1.0000 +- 0.0000    4.843 +- 0.029
