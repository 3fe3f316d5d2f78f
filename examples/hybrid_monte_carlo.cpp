// SPDX-License-Identifier: BSL-1.0
// Hybrid Monte Carlo with a learned method: independent chains, an expectation that is known, standard
// errors.
//
// A proposal is the end of a trajectory with fresh momenta; Metropolis' rule accepts it by its error of the
// energy, so that exp(-V/kT) is sampled exactly whatever the step. That asks for a map that keeps volume and
// is reversible: we learn in a family of symmetric words, and ask it for the least error of the energy over
// the whole trajectory, as this alone decides who is rejected. Equipartition tells what must come out:
// <q . grad V> is kT for each coordinate, whatever V.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "nysalt/learner.hpp"
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
};

/// A chain of Hybrid Monte Carlo for exp(-V), kT = 1 [duane_kennedy_pendleton_roweth_1987]. Each chain has
/// its own random numbers, by its number.
template <class Stepper>
chain_result sample(const Stepper& stepper, int steps, std::uint64_t chain, int burn_in, int samples) {
  const wells& system = stepper.system();
  phase_point<double, N> x{vector<double, N>::Zero(), vector<double, N>::Zero()};
  chain_result result;
  for (int n = 0; n < burn_in + samples; ++n) {
    vector<double, N + 2> normals;
    standard_normals(5, {.trajectory = chain, .step = n, .purpose = noise_purpose::initial_state}, normals);
    x.p = normals.template head<N>();  // fresh momenta, of unit mass
    auto run = stepper.open(x);
    stepper.advance(run, steps);
    const auto proposal = stepper.synchronous(run);
    const double rise = energy<double>(system, proposal) - energy<double>(system, x);
    // -log of a uniform number is half the square of two normal ones. A trajectory that diverged (nan) is
    // rejected.
    const bool accepted = rise < 0.5 * normals.template tail<2>().squaredNorm();
    if (accepted) x = proposal;
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
  // Data like what comes: from exp(-H) itself.
  const gibbs starts(in_bath(system, bath::of_temperature(1.0, 1.0)),
                     normal_around<N>({vector<double, N>::Zero(), vector<double, N>::Zero()}, 0.5, 1.0));
  const data_options training{.step = step, .horizon = steps * step, .trajectories = 200, .seed = 1};
  data_options others = training;
  others.seed = 2;
  const fine_steps<> reference(step / 40);
  const auto data = make_flow_map_data(system, starts, reference, training);
  const auto unseen = make_flow_map_data(system, starts, reference, others);
  const auto [method, fit] = learn(aba<2>{}, system, data, unseen, {.loss = loss_named("energy:6")});
  // [/learn]
  fmt::print("a1 = {:.4f} +- {:.4f}, usable: {}\n", fit.parameters[0].value, fit.parameters[0].standard_error,
             fit.usable ? "yes" : fit.reason);

  fmt::print("                accepted           <q . grad V>, {} is exact\n", N);
  const std::vector methods{tabulated(method.anywhere()), tabulated(mclachlan2{}), tabulated(bcss2{}),
                            tabulated(verlet_2x{})};
  for (const auto& each : methods) {  // all of them: twelve evaluations a proposal
    const auto stepper = make_stepper(system, each, step);
    std::vector<double> accepted;
    std::vector<double> virial;
    for (std::uint64_t chain = 0; chain < 100; ++chain) {
      const auto [share, mean] = sample(stepper, steps, chain, 100, 1000);
      accepted.push_back(share);
      virial.push_back(mean);
    }
    // Chains are independent, so that the spread of their means is an honest error bar.
    const auto a = mean_and_error(accepted);
    const auto v = mean_and_error(virial);
    fmt::print("{:<12} {:.4f} +- {:.4f}    {:.3f} +- {:.3f}\n", each.name(), a.mean, a.standard_error, v.mean,
               v.standard_error);
  }
}

// Expected output:
