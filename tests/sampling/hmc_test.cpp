// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 1.3 s at -O0, 0.1 s at -O1.
// Hybrid Monte Carlo samples exp(-V/kT) whatever the step and the masses, accepts as theory predicts, and
// draws the same where it is cut and goes on from a kept state.
#include "nysalt/hmc.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/pendulum.hpp"
#include "nysalt/systems/phi4_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;

const normal_around<1> at_zero({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 1.0, 1.0);

/// The draws of coordinate 1 of each chain.
std::vector<std::vector<double>> draws_of(const model& system, const tabulated& method,
                                          const initial_states& starts, const hmc_options& options,
                                          hmc_result* result = nullptr) {
  std::vector<std::vector<double>> chains(static_cast<std::size_t>(options.chains));
  for (auto& chain : chains) chain.resize(static_cast<std::size_t>(options.draws));
  const hmc_result found = hmc(system, method, starts, options, [&](const hmc_draw& draw) {
    chains[static_cast<std::size_t>(draw.chain)][static_cast<std::size_t>(draw.number)] = draw.q[0];
  });
  if (result != nullptr) *result = found;
  return chains;
}

/// The mean of f over each chain, as an estimate.
estimate mean_over_chains(const std::vector<std::vector<double>>& chains, const auto& f) {
  std::vector<double> means;
  for (const auto& chain : chains) {
    double sum = 0.0;
    for (const double x : chain) sum += f(x);
    means.push_back(sum / static_cast<double>(chain.size()));
  }
  return mean_and_error(means);
}

double square(double x) { return x * x; }

/// A stiff spring whose force has a sign of choice.
struct spring_of_sign {
  static constexpr int dimension = 1;
  double sign;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * 50.0;
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * (sign * 100.0);
  }
};

const Eigen::Array3d masses(1.0, 2.0, 5.0);

/// Nothing acts on these masses.
struct free_masses {
  static constexpr int dimension = 3;
  template <class T>
  T potential(const vector<T, 3>&) const {
    return T(0.0);
  }
  template <class T>
  void force(const vector<T, 3>&, vector<T, 3>& f) const {
    for (auto& one : f) one = T(0.0);
  }
  double inverse_mass(Eigen::Index i) const { return 1.0 / masses[i]; }
};

const phi4_chain<> wells(5);
const Eigen::VectorXd no_shift = Eigen::VectorXd::Zero(5);
const normal_around<Eigen::Dynamic> around_wells({no_shift, no_shift}, 0.5, 1.0);

struct course {
  std::vector<double> draws;  // coordinate 1, chain after chain; 0 where it was not drawn here
  std::vector<hmc_state> kept;
  hmc_result result;
};

course run_from(hmc_options options, const hmc_state* from = nullptr) {
  course all;
  all.draws.resize(static_cast<std::size_t>(options.chains * options.draws));
  options.from = from;
  options.keep = [&](const hmc_state& state) { all.kept.push_back(state); };
  all.result = hmc(wells, tabulated(bcss3{}), around_wells, options, [&](const hmc_draw& draw) {
    all.draws[static_cast<std::size_t>(draw.chain * options.draws + draw.number)] = draw.q[0];
  });
  return all;
}

/// Whether what was drawn after the state is the same, and the result.
bool goes_on_as(const course& whole, const course& rest, const hmc_options& options, const hmc_state& state) {
  const auto first = std::max<std::int64_t>(0, state.trajectories - options.burn_in);
  for (std::int64_t m = 0; m < options.chains; ++m) {
    for (std::int64_t n = first; n < options.draws; ++n) {
      const auto at = static_cast<std::size_t>(m * options.draws + n);
      if (whole.draws[at] != rest.draws[at]) return false;
    }
  }
  return whole.result.step == rest.result.step &&
         whole.result.acceptance.mean == rest.result.acceptance.mean &&
         whole.result.square_of_energy_error.mean == rest.result.square_of_energy_error.mean &&
         whole.result.diverged == rest.result.diverged &&
         whole.result.evaluations_of_draw == rest.result.evaluations_of_draw &&
         whole.result.evaluations_of_burn_in == rest.result.evaluations_of_burn_in &&
         whole.result.deviations == rest.result.deviations;
}

const hmc_options tuned{.step = 0.3,
                        .length = 1.0,
                        .chains = 37,
                        .burn_in = 120,
                        .draws = 40,
                        .acceptance = 0.9,
                        .keep_every = 20};

}  // namespace

// V = omega^2 q^2/2: <q^2> = kT/omega^2. Chains are independent but for their durations.
BOOST_AUTO_TEST_CASE(the_law_of_a_gaussian_is_exact_at_a_large_step) {
  constexpr double omega = 2.0;
  constexpr double temperature = 0.7;
  const harmonic_oscillator spring(omega);
  const hmc_options options{.step = 0.8,
                            .length = 1.1,
                            .temperature = temperature,
                            .chains = 64,
                            .burn_in = 50,
                            .draws = 2000,
                            .seed = seed(1)};
  hmc_result result;
  const auto chains = draws_of(spring, tabulated(verlet{}), at_zero, options, &result);
  const auto found = mean_over_chains(chains, square);
  const double exact = temperature / (omega * omega);
  const double allowed = standard_errors(false_alarms / 2, 63);
  BOOST_TEST(std::abs(found.mean - exact) <= allowed * found.standard_error);
  BOOST_TEST(found.standard_error < 0.02 * exact);
  BOOST_TEST(result.acceptance.mean < 0.97);  // some are rejected
  // The law of the map itself, which every proposal would have without Metropolis' rule.
  const double of_map = exact / (1.0 - square(omega * options.step) / 4.0);
  BOOST_TEST(std::abs(found.mean - of_map) > allowed * found.standard_error);
  const auto mean = mean_over_chains(chains, [](double x) { return x; });
  BOOST_TEST(std::abs(mean.mean) <= allowed * mean.standard_error);
}

// In one dimension the mean acceptance is 1 - 2/pi arctan sqrt(E[dH]/2), and E[dH] = E[dH^2]/(2 + ...)
// follows from the matrix of the trajectory [calvo_sanz_alonso_sanz_serna_2021].
BOOST_AUTO_TEST_CASE(acceptance_follows_the_arctangent_law) {
  constexpr double omega = 1.0;
  constexpr double step = 1.2;
  const harmonic_oscillator spring(omega);
  // Durations are uniform between 0 and twice this: one step or two, which are told apart by their counts.
  const hmc_options options{
      .step = step, .length = 0.74 * step, .chains = 64, .burn_in = 20, .draws = 4000, .seed = seed(1)};
  hmc_result result;
  draws_of(spring, tabulated(verlet{}), at_zero, options, &result);
  // One step of Verlet's method on the oscillator: (1 - z^2/2, z; -z + z^3/4, 1 - z^2/2).
  const double z = omega * step;
  const double a = 1.0 - z * z / 2.0;
  const double b = z;
  const double c = -z + z * z * z / 4.0;
  const auto accepted = [](double of_q, double of_p) {  // E[dH] = (b + c)^2/2 for a matrix of determinant 1
    return 1.0 - 2.0 / std::numbers::pi * std::atan(std::sqrt(square(of_q + of_p) / 4.0));
  };
  const double after_one = accepted(b, c);
  const double after_two = accepted(2.0 * a * b, 2.0 * a * c);
  // llround(1.48 u): one for u < 1.5/1.48, that is always.
  const double allowed = standard_errors(false_alarms, 63) * result.acceptance.standard_error;
  BOOST_TEST(std::abs(result.acceptance.mean - after_one) <= allowed);
  BOOST_TEST(std::abs(result.acceptance.mean - after_two) > allowed);
}

// But for the step that all tune, and for the durations that they share.
BOOST_AUTO_TEST_CASE(a_chain_does_not_depend_on_those_beside_it) {
  hmc_options options{.step = 0.2, .length = 1.0, .chains = 19, .burn_in = 10, .draws = 30};
  const auto many = draws_of(wells, tabulated(verlet{}), around_wells, options);
  options.chains = 1;
  BOOST_TEST((draws_of(wells, tabulated(verlet{}), around_wells, options).front() == many.front()));
  options.seed = 2;
  BOOST_TEST((draws_of(wells, tabulated(verlet{}), around_wells, options).front() != many.front()));
}

// Nothing acts: a trajectory of duration T moves q_i by p_i T/m_i, of variance kT T^2/m_i. T is common to all
// coordinates and cancels in ratios. T^2 of uniform T weighs 40,000 moves like 22,000, and a ratio of two
// variances is known to sqrt(4/22,000).
BOOST_AUTO_TEST_CASE(momenta_have_the_variances_of_their_masses) {
  constexpr std::int64_t chains = 1000;
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  std::vector<Eigen::Vector3d> before(chains, Eigen::Vector3d::Zero());
  const normal_around<3> at_rest({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}, 0.0, 1.0);
  const auto result =
      hmc(free_masses{}, tabulated(verlet{}), at_rest,
          {.step = 0.5, .length = 10.0, .chains = chains, .burn_in = 0, .draws = 40, .seed = seed(1)},
          [&](const hmc_draw& draw) {
            auto& last = before[static_cast<std::size_t>(draw.chain)];
            squares += (draw.q - last).array().square();
            last = draw.q;
          });
  BOOST_TEST(result.acceptance.mean == 1.0);
  const double allowed = standard_errors(false_alarms / 2) * std::sqrt(4.0 / 22'000.0);
  for (const Eigen::Index i : {1, 2}) {
    const double ratio = squares[i] / squares[0];
    BOOST_TEST(std::abs(ratio * masses[i] / masses[0] - 1.0) < allowed);
    BOOST_TEST(std::abs(ratio - 1.0) > allowed);                           // of velocities without masses
    BOOST_TEST(std::abs(ratio * std::pow(masses[i], 3) - 1.0) > allowed);  // of momenta with 1/m for m
  }
}

// One step of Verlet's method maps (sqrt(k) q, p/sqrt(m)) by M = (1 - z^2/2, z; -z + z^3/4, 1 - z^2/2), and
// (H' - H)/kT = x^T A x/2 of standard normal x, A = M^T M - 1: of mean tr A/2 and variance tr A^2/2.
BOOST_AUTO_TEST_CASE(energy_errors_of_masses_are_those_of_theory) {
  constexpr double step = 1.0;
  const Eigen::Array3d frequencies(1.0, 0.8, 0.5);
  const Eigen::VectorXd stiffness = masses * frequencies.square();
  const linear_chain springs(stiffness.asDiagonal().toDenseMatrix(), masses.matrix());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3);
  const normal_around<Eigen::Dynamic> starts({zero, zero}, 1.0, 1.0);
  hmc_result result;
  const auto chains = draws_of(springs, tabulated(verlet{}), starts,
                               {.step = step,
                                .length = 0.74 * step,  // always one step
                                .temperature = 2.0,
                                .chains = 64,
                                .burn_in = 50,
                                .draws = 2000,
                                .seed = seed(1)},
                               &result);
  const auto mean_square = [](const Eigen::Array3d& omega) {
    double mean = 0.0;
    double variance = 0.0;
    for (const double one : omega) {
      const double z = one * step;
      const Eigen::Matrix2d map{{1.0 - z * z / 2.0, z}, {-z + z * z * z / 4.0, 1.0 - z * z / 2.0}};
      const Eigen::Matrix2d a = map.transpose() * map - Eigen::Matrix2d::Identity();
      mean += 0.5 * a.trace();
      variance += 0.5 * (a * a).trace();
    }
    return variance + mean * mean;
  };
  const estimate& found = result.square_of_energy_error;
  const double allowed = standard_errors(false_alarms / 2, 63);
  BOOST_TEST(std::abs(found.mean - mean_square(frequencies)) <= allowed * found.standard_error);
  BOOST_TEST(std::abs(found.mean - mean_square(stiffness.array().sqrt())) > allowed * found.standard_error);
  const auto variance = mean_over_chains(chains, square);
  BOOST_TEST(std::abs(variance.mean - 2.0 / stiffness[0]) <= allowed * variance.standard_error);
}

BOOST_AUTO_TEST_CASE(the_step_is_tuned_to_the_acceptance) {
  const linear_chain chain = linear_chain::between_walls(12, 1.0);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(12);
  const normal_around<Eigen::Dynamic> starts({zero, zero}, 1.0, 1.0);
  for (const double wanted : {0.7, 0.9}) {
    hmc_result result;
    draws_of(chain, tabulated(verlet{}), starts,
             {.step = 0.1,
              .length = 1.5,
              .chains = 32,
              .burn_in = 400,
              .draws = 200,
              .acceptance = wanted,
              .seed = seed(1)},
             &result);
    BOOST_TEST_MESSAGE("acceptance " << result.acceptance.mean << " at step " << result.step);
    // Known to .3/sqrt(32 400) = .003; averages of the step lag behind by some of its last changes.
    BOOST_TEST(std::abs(result.acceptance.mean - wanted) < 0.05);
  }
}

// With the wrong sign of the force a trajectory of length 1 ends where the energy is e^20 times as large, at
// every step: the burn-in must end with a sentence, not with steps that become ever smaller.
BOOST_AUTO_TEST_CASE(an_acceptance_that_no_step_has_is_refused) {
  const hmc_options options{.step = 0.1, .length = 1.0, .burn_in = 100, .draws = 10, .acceptance = 0.9};
  const auto ignore = [](const hmc_draw&) {};
  BOOST_TEST(hmc(spring_of_sign{-1.0}, tabulated(verlet{}), at_zero, options, ignore).step > 0.01);
  BOOST_TEST(refuses<std::runtime_error>(
      [&] { hmc(spring_of_sign{1.0}, tabulated(verlet{}), at_zero, options, ignore); },
      {"acceptance must reach 0.9", "smaller first step"}));
}

// Steps so small that positions do not change by a rounding have no variance to make masses of.
BOOST_AUTO_TEST_CASE(a_coordinate_that_does_not_vary_has_no_mass) {
  const hmc_options options{.step = 1e-40,
                            .length = 1.0e-38,
                            .chains = 2,
                            .burn_in = 100,
                            .draws = 1,
                            .acceptance = 0.9,
                            .diagonal_masses = true};
  const normal_around<1> at_one({vector<double, 1>(1.0), vector<double, 1>(0.0)}, 0.0, 1.0);
  BOOST_TEST(refuses<std::runtime_error>(
      [&] { hmc(harmonic_oscillator(1.0), tabulated(verlet{}), at_one, options, [](const hmc_draw&) {}); },
      {"coordinate 1 must vary", "diagonal_masses"}));
}

BOOST_AUTO_TEST_CASE(diagonal_masses_are_found_and_the_law_stays) {
  const Eigen::VectorXd stiffness{{1.0, 400.0}};
  const linear_chain wide(stiffness.asDiagonal().toDenseMatrix(), Eigen::Vector2d(1.0, 1.0));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(2);
  const normal_around<Eigen::Dynamic> starts({zero, zero}, 0.1, 1.0);
  hmc_result result;
  const auto chains = draws_of(wide, tabulated(verlet{}), starts,
                               {.step = 0.01,
                                .length = 1.5,
                                .temperature = 2.0,
                                .chains = 32,
                                .burn_in = 600,
                                .draws = 600,
                                .acceptance = 0.9,
                                .diagonal_masses = true,
                                .seed = seed(1)},
                               &result);
  BOOST_REQUIRE(result.deviations.size() == 2u);
  BOOST_TEST(std::abs(result.deviations[0] - std::sqrt(2.0)) < 0.1);  // 32 chains of 150 draws
  BOOST_TEST(std::abs(result.deviations[1] - std::sqrt(2.0) / 20.0) < 0.005);
  BOOST_TEST(result.step > 0.5);  // where both frequencies are one; without masses it is below 2/20
  const auto found = mean_over_chains(chains, square);
  BOOST_TEST(std::abs(found.mean - 2.0) <= standard_errors(false_alarms, 31) * found.standard_error);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_sampled_is_refused) {
  const model spring{harmonic_oscillator(1.0)};
  const tabulated by_verlet{verlet{}};
  const hmc_options sound{.step = 0.1, .length = 1.0, .chains = 2, .burn_in = 0, .draws = 2};
  const auto refused = [&](const char* words, const std::function<void(hmc_options&)>& change,
                           const tabulated& method, const initial_states& starts = at_zero) {
    hmc_options options = sound;
    change(options);
    return refuses<wrong>([&] { hmc(spring, method, starts, options, [](const hmc_draw&) {}); }, {words});
  };
  const auto none = [](hmc_options&) {};
  const tabulated one_way("one way", run_time_word("AB"), {1.0, 1.0}, {1, false, false});
  BOOST_TEST(refused("must be reversible", none, one_way));
  BOOST_TEST(refused(
      "step must be positive", [](auto& o) { o.step = 0.0; }, by_verlet));
  BOOST_TEST(refused(
      "kT must be positive", [](auto& o) { o.temperature = -1.0; }, by_verlet));
  BOOST_TEST(refused(
      "draws must be at least 1", [](auto& o) { o.draws = 0; }, by_verlet));
  const auto tuning = [](hmc_options& o) {
    o.acceptance = 1.5;
    o.burn_in = 100;
  };
  BOOST_TEST(refused("acceptance must be between", tuning, by_verlet));
  const auto masses_alone = [](hmc_options& o) {
    o.diagonal_masses = true;
    o.burn_in = 100;
  };
  BOOST_TEST(refused("ask for an acceptance", masses_alone, by_verlet));
  const normal_around<1> far({vector<double, 1>(1e200), vector<double, 1>(0.0)}, 1.0, 1.0);
  BOOST_TEST(refused("must be finite at a start", none, by_verlet, far));
}

BOOST_AUTO_TEST_CASE(cut_and_resumed_they_draw_the_same_bits) {
  hmc_options with_masses = tuned;
  with_masses.diagonal_masses = true;
  for (const hmc_options& options : {tuned, with_masses}) {
    const course whole = run_from(options);
    BOOST_TEST_REQUIRE(whole.kept.size() == 8U);  // 160 trajectories
    for (const auto& state : whole.kept) {
      BOOST_TEST(goes_on_as(whole, run_from(options, &state), options, state), state.trajectories);
    }
    // What is looked at can tell: another seed goes on otherwise.
    hmc_options another = options;
    another.seed = 2;
    BOOST_TEST(!goes_on_as(whole, run_from(another, &whole.kept[4]), options, whole.kept[4]));
    // How often states are kept changes nothing.
    hmc_options never = options;
    never.keep_every = 0;
    BOOST_TEST((run_from(never).draws == whole.draws));
  }
}

BOOST_AUTO_TEST_CASE(a_state_of_other_options_is_refused) {
  const course whole = run_from(tuned);
  const auto refused = [&](const hmc_options& options, const hmc_state& state) {
    return refuses<wrong>([&] { run_from(options, &state); }, {"the state to go on from"});
  };
  hmc_options fewer_chains = tuned;
  fewer_chains.chains = 36;
  BOOST_TEST(refused(fewer_chains, whole.kept[2]));
  hmc_options with_masses = tuned;
  with_masses.diagonal_masses = true;
  BOOST_TEST(refused(with_masses, whole.kept[2]));
  hmc_options fewer_draws = tuned;
  fewer_draws.draws = 10;
  BOOST_TEST(refused(fewer_draws, whole.kept.back()));
  BOOST_CHECK_NO_THROW(run_from(tuned, &whole.kept.back()));
}

BOOST_AUTO_TEST_CASE(draws_of_chains_tell_whether_they_agree) {
  std::vector<std::vector<double>> chains(4, std::vector<double>(20'000));
  std::uint64_t state = seed(1);
  for (auto& chain : chains) {
    for (double& x : chain) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;  // Knuth's multiplier
      x = static_cast<double>(state >> 33U) / 2147483648.0;
    }
  }
  // Of independent draws R is 1 to within the scatter of variances, some 1/sqrt(10000).
  BOOST_TEST(std::abs(potential_scale_reduction(chains) - 1.0) < 0.02);
  BOOST_TEST(effective_draws(chains) > 40'000.0);
  for (double& x : chains[2]) x += 1.0;
  BOOST_TEST(potential_scale_reduction(chains) > 1.3);
  for (auto& chain : chains) {
    for (std::size_t n = 1; n < chain.size(); ++n) chain[n] = 0.9 * chain[n - 1] + 0.1 * chain[n];
  }
  BOOST_TEST(effective_draws({chains[0], chains[1]}) < 6000.0);  // 40000/tau, and tau is 19
  BOOST_TEST(std::isnan(potential_scale_reduction({{1.0, 1.0, 1.0, 1.0}})));
}
