// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 70 s and more at -O0, 1.2 s at -O1.
// Units of Hybrid Monte Carlo: durations, kT, masses, the acceptance that it is tuned to; and it draws the
// same where it is cut and goes on from a kept state. Moments of what it draws are those of the law, within
// their standard errors and for several seeds; a wrong law, or a wrong rule of Metropolis, the same
// comparison rejects. And effective draws are not too many, however short the chains and however long their
// memory.
#include "nysalt/hmc.hpp"
#include "../support/autoregression.hpp"
#include "../support/refusal.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/gaussian.hpp"
#include "nysalt/systems/phi4.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

vector<double, 1> number(double x) { return vector<double, 1>(x); }

normal_around<1> around_zero(double deviation) { return {{number(0.0), number(0.0)}, deviation, 1.0}; }
const normal_around<1> at_zero = around_zero(1.0);

const method by_verlet{verlet{}};
const auto ignored = [](const hmc_draw&) {};

hmc_options changed(hmc_options options, auto member, auto value) {
  options.*member = value;
  return options;
}

/// What is told of a run, and the mean square of coordinate 1 over its chains.
struct squared_draws {
  hmc_result result;
  estimate variance;
};
squared_draws sampled(const model& system, const initial_states& starts, const hmc_options& options) {
  std::vector<double> of_chains(static_cast<std::size_t>(options.chains));
  const hmc_result result = hmc(system, by_verlet, starts, options, [&](const hmc_draw& draw) {
    of_chains[static_cast<std::size_t>(draw.chain)] += draw.q[0] * draw.q[0] / double(options.draws);
  });
  return {result, mean_and_error(of_chains)};
}

normal_around<Eigen::Dynamic> around_rest(Eigen::Index size, double deviation) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(size);
  return {{rest, rest}, deviation, 1.0};
}

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

/// Nothing acts on these masses: a trajectory of duration T is accepted, and moves q_i by p_i T/m_i.
struct free_masses {
  static constexpr int dimension = 3;
  template <class T>
  T potential(const vector<T, 3>&) const {
    return T(0.0);
  }
  double inverse_mass(Eigen::Index i) const { return 1.0 / masses[i]; }
};

/// The mean square of the moves in each coordinate, over 2000 chains, for each of 40 durations of mean 1.
struct free_moves {
  explicit free_moves(std::uint64_t of_seed) : squares(40, Eigen::Array3d::Zero()) {
    constexpr std::int64_t chains = 2000;
    std::vector<Eigen::Vector3d> before(chains, Eigen::Vector3d::Zero());
    const normal_around<3> at_rest({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}, 0.0, 1.0);
    result = hmc(free_masses{}, by_verlet, at_rest,
                 {.step = 0.01, .length = 1.0, .chains = chains, .burn_in = 0, .draws = 40, .seed = of_seed},
                 [&](const hmc_draw& draw) {
                   auto& last = before[static_cast<std::size_t>(draw.chain)];
                   squares[static_cast<std::size_t>(draw.number)] +=
                       (draw.q - last).array().square() / chains;
                   last = draw.q;
                 });
  }
  std::vector<Eigen::Array3d> squares;
  hmc_result result;
};
/// V = 20 (q^2 - 1)^2: between the wells at -1 and 1 stands a barrier of 20.
struct two_wells {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    const T y = q[0] * q[0] - 1.0;
    return y * y * 20.0;
  }
};

const phi4_chain<> wells(5);
const auto around_wells = around_rest(5, 0.5);

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
  all.result = hmc(wells, method(bcss3{}), around_wells, options, [&](const hmc_draw& draw) {
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

constexpr std::uint64_t seeds = 5;
constexpr std::int64_t chains = 48;

/// Functions of the position whose means are known.
using moments_of = Eigen::VectorXd (*)(const Eigen::VectorXd& q);

/// The largest distance of a mean over chains from what is exact, in standard errors.
double worst_distance(const std::vector<Eigen::VectorXd>& means_of_chains, const Eigen::VectorXd& exact) {
  double worst = 0.0;
  for (Eigen::Index k = 0; k < exact.size(); ++k) {
    std::vector<double> means;
    for (const auto& mean : means_of_chains) means.push_back(mean[k]);
    const estimate found = mean_and_error(means);
    const double distance = std::abs(found.mean - exact[k]) / found.standard_error;
    if (!std::isfinite(distance)) return std::numeric_limits<double>::infinity();  // a chain diverged
    worst = std::max(worst, distance);
  }
  return worst;
}

double distance_of_hmc(const model& system, double step, double length, const moments_of& f,
                       const Eigen::VectorXd& exact, std::uint64_t number) {
  std::vector<Eigen::VectorXd> means(chains, Eigen::VectorXd::Zero(exact.size()));
  constexpr std::int64_t draws = 2000;
  hmc(system, by_verlet, around_rest(size(system), 0.5),
      {.step = step,
       .length = length,
       .chains = chains,
       .burn_in = 100,
       .draws = draws,
       .seed = seed(number)},
      [&](const hmc_draw& draw) { means[static_cast<std::size_t>(draw.chain)] += f(draw.q) / draws; });
  return worst_distance(means, exact);
}

Eigen::VectorXd lattice_moments(const Eigen::VectorXd& q) {
  Eigen::VectorXd f(4);
  f << q[0], q[0] * q[0], q[0] * q[3], q[1] * q[1] * q[2] * q[2];
  return f;
}

/// By the trapezoidal rule, which converges faster than any power where the integrand decays.
Eigen::VectorXd by_quadrature(const phi4_lattice& lattice) {
  constexpr int nodes = 33;
  constexpr double reach = 2.4;  // exp(-V) is below 1e-15 beyond
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(4);
  double weights = 0.0;
  Eigen::VectorXd q(4);
  for (int i = 0; i < nodes * nodes * nodes * nodes; ++i) {
    for (int k = 0, left = i; k < 4; ++k, left /= nodes)
      q[k] = reach * (2.0 * (left % nodes) / (nodes - 1) - 1.0);
    const double weight = std::exp(-lattice.potential<double>(q));
    weights += weight;
    sums += weight * lattice_moments(q);
  }
  return sums / weights;
}

/// The force of the lattice with the potential of another: proposals are accepted by a wrong energy.
struct wrong_energy {
  static constexpr int dimension = Eigen::Dynamic;
  phi4_lattice forces{2, -2.0, 3.0};
  phi4_lattice energies{2, -2.0, 2.7};
  Eigen::Index size() const { return 4; }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    forces.force(q, f);
  }
  template <class T>
  T potential(const vector<T, dimension>& q) const {
    return energies.potential(q);
  }
};

using draws_of_chains = std::vector<std::vector<double>>;

/// The effective draws of four chains, whose tau is (1 + phi)/(1 - phi).
double independent(double phi, int length) { return 4.0 * length * (1.0 - phi) / (1.0 + phi); }

constexpr double memories[] = {-0.9, -0.5, 0.0, 0.5, 0.9};
constexpr int lengths[] = {20, 50, 100, 200, 500};
constexpr int repetitions = 50;

/// Four chains of a memory, tau = (1 + phi)/(1 - phi), the n-th of a seed.
draws_of_chains autoregressions(double phi, std::uint64_t of_seed, std::uint64_t n, int length) {
  draws_of_chains all(4);
  for (std::uint64_t k = 0; k < 4; ++k) {
    autoregression<double> next(phi, of_seed, 4 * n + k);
    for (int i = 0; i < length; ++i) all[k].push_back(next.next());
  }
  return all;
}

}  // namespace

// Of momenta of kT = 1 and mass 1 the mean square of a move is T^2 to 3 % (one standard error, sqrt(2/2000)).
// T is uniform in 0 .. 2: of 40 the mean is 1 to 0.09, here within four such errors.
BOOST_AUTO_TEST_CASE(durations_are_uniform_up_to_twice_the_length) {
  const free_moves found(1);
  BOOST_TEST(found.result.acceptance.mean == 1.0);
  std::vector<double> durations;
  for (const auto& square : found.squares) durations.push_back(std::sqrt(square[0]));
  BOOST_TEST(std::abs(mean(durations) - 1.0) < 0.36);
  BOOST_TEST(std::ranges::min(durations) < 0.5);  // of 40 all above 0.5: once in 100,000
  BOOST_TEST(std::ranges::max(durations) > 1.5);
  BOOST_TEST(std::ranges::max(durations) < 2.2);  // 2, with four errors
  // A step of Verlet is one evaluation, and one more opens the trajectory.
  BOOST_TEST(found.result.evaluations_of_draw - 1.0 == 100.0 * mean(durations),
             boost::test_tools::tolerance(0.03));
}

// Moves have the variance kT T^2/m_i. T is common to all coordinates and cancels in ratios. T^2 of uniform T
// weighs 80,000 moves like 44,000, and a ratio of two variances is known to sqrt(4/44,000).
BOOST_AUTO_TEST_CASE(momenta_have_the_variances_of_their_masses) {
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  for (const auto& of_duration : free_moves(seed(1)).squares) squares += of_duration;
  const double allowed = standard_errors(false_alarms / 2) * std::sqrt(4.0 / 44'000.0);
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
  const auto [result, variance] = sampled(springs, around_rest(3, 1.0),
                                          {.step = step,
                                           .length = 0.74 * step,  // always one step
                                           .temperature = 2.0,
                                           .chains = 64,
                                           .burn_in = 50,
                                           .draws = 2000,
                                           .seed = seed(1)});
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
  BOOST_TEST(std::abs(variance.mean - 2.0 / stiffness[0]) <= allowed * variance.standard_error);
}

BOOST_AUTO_TEST_CASE(the_step_is_tuned_to_the_acceptance) {
  for (const double wanted : {0.7, 0.9}) {
    hmc_options options{.step = 0.1, .length = 1.5, .chains = 32, .acceptance = wanted, .seed = seed(1)};
    options.burn_in = 400;
    options.draws = 200;
    const auto result =
        hmc(linear_chain::between_walls(12, 1.0), by_verlet, around_rest(12, 1.0), options, ignored);
    BOOST_TEST_MESSAGE("acceptance " << result.acceptance.mean << " at step " << result.step);
    // Known to .3/sqrt(32 400) = .003; averages of the step lag behind by some of its last changes.
    BOOST_TEST(std::abs(result.acceptance.mean - wanted) < 0.05);
  }
}

// With the wrong sign of the force a trajectory of length 1 ends where the energy is e^20 times as large, at
// every step: the burn-in must end with a sentence, not with steps that become ever smaller.
BOOST_AUTO_TEST_CASE(an_acceptance_that_no_step_has_is_refused) {
  const hmc_options options{.step = 0.1, .length = 1.0, .burn_in = 100, .draws = 10, .acceptance = 0.9};
  BOOST_TEST(hmc(spring_of_sign{-1.0}, by_verlet, at_zero, options, ignored).step > 0.01);
  BOOST_TEST(
      refuses<std::runtime_error>([&] { hmc(spring_of_sign{1.0}, by_verlet, at_zero, options, ignored); },
                                  {"acceptance must reach 0.9", "smaller first step"}));
}

// Steps so small that positions do not change by a rounding have no variance to make masses of.
BOOST_AUTO_TEST_CASE(a_coordinate_that_does_not_vary_has_no_mass) {
  hmc_options options{.step = 1e-40, .length = 1.0e-38, .chains = 2, .burn_in = 100, .draws = 1};
  options.acceptance = 0.9;
  options.diagonal_masses = true;
  const normal_around<1> at_one({number(1.0), number(0.0)}, 0.0, 1.0);
  BOOST_TEST(
      refuses<std::runtime_error>([&] { hmc(harmonic_oscillator(1.0), by_verlet, at_one, options, ignored); },
                                  {"coordinate 1 must vary", "diagonal_masses"}));
}

BOOST_AUTO_TEST_CASE(diagonal_masses_are_found_and_the_law_stays) {
  const Eigen::VectorXd stiffness{{1.0, 400.0}};
  const linear_chain wide(stiffness.asDiagonal().toDenseMatrix());
  hmc_options options{.step = 0.01, .length = 1.5, .temperature = 2.0, .chains = 32, .seed = seed(1)};
  options.burn_in = options.draws = 600;
  options.acceptance = 0.9;
  options.diagonal_masses = true;
  const auto [result, variance] = sampled(wide, around_rest(2, 0.1), options);
  BOOST_REQUIRE(result.deviations.size() == 2u);
  BOOST_TEST(std::abs(result.deviations[0] - std::sqrt(2.0)) < 0.1);  // 32 chains of 150 draws
  BOOST_TEST(std::abs(result.deviations[1] - std::sqrt(2.0) / 20.0) < 0.005);
  BOOST_TEST(result.step > 0.5);  // where both frequencies are one; without masses it is below 2/20
  BOOST_TEST(std::abs(variance.mean - 2.0) <= standard_errors(false_alarms, 31) * variance.standard_error);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_sampled_is_refused) {
  const hmc_options sound{.step = 0.1, .length = 1.0, .chains = 2, .burn_in = 100, .draws = 2};
  const auto refused = [](const char* words, const hmc_options& options, const method& method = by_verlet,
                          const initial_states& starts = at_zero) {
    return refuses([&] { hmc(harmonic_oscillator(1.0), method, starts, options, ignored); }, {words});
  };
  BOOST_TEST(refused("step must be positive", changed(sound, &hmc_options::step, 0.0)));
  BOOST_TEST(refused("kT must be positive", changed(sound, &hmc_options::temperature, -1.0)));
  BOOST_TEST(refused("draws must be at least 1", changed(sound, &hmc_options::draws, 0)));
  BOOST_TEST(refused("acceptance must be between", changed(sound, &hmc_options::acceptance, 1.5)));
  BOOST_TEST(refused("ask for an acceptance", changed(sound, &hmc_options::diagonal_masses, true)));
  const nysalt::method one_way("one way", word("AB"), {1.0, 1.0}, {1, false, false});
  BOOST_TEST(refused("must be reversible", sound, one_way));
  // Beyond the first block of lanes, whose width depends on the machine.
  std::vector<phase_point<double, 1>> starts(40, {number(1.0), number(0.0)});
  starts[37].q[0] = 1e200;
  const auto many = changed(sound, &hmc_options::chains, 40);
  BOOST_TEST(refused("must be finite at a start", many, by_verlet, listed(starts)));
  BOOST_TEST(refused("at start 37", many, by_verlet, listed(starts)));
}

// With kT/var(q) as masses all numbers scale with kT, by a power of two without rounding: the step, which is
// in units of the masses, has the same bits.
BOOST_AUTO_TEST_CASE(with_masses_the_step_does_not_depend_on_the_temperature) {
  const auto at = [](double deviation) {
    hmc_options options{.step = 0.1, .length = 1.5, .chains = 8, .burn_in = 200, .draws = 10};
    options.temperature = deviation * deviation;
    options.acceptance = 0.9;
    options.diagonal_masses = true;
    return hmc(harmonic_oscillator(3.0), by_verlet, around_zero(deviation), options, ignored);
  };
  const auto cold = at(1.0);
  const auto hot = at(4.0);
  BOOST_TEST(cold.step == hot.step);
  BOOST_TEST_REQUIRE(cold.deviations.size() == 1U);
  BOOST_TEST(hot.deviations[0] == 4.0 * cold.deviations[0]);
  BOOST_TEST(std::abs(cold.deviations[0] - 1.0 / 3.0) < 0.1);  // sqrt(kT)/omega
}

// No chain leaves its well, and half of them are in each: the variance is 1 between chains, 1/160 within.
BOOST_AUTO_TEST_CASE(masses_know_the_variance_between_chains) {
  std::vector<phase_point<double, 1>> starts;
  for (int m = 0; m < 8; ++m) starts.push_back({number(m % 2 == 0 ? 1.0 : -1.0), number(0.0)});
  hmc_options options{.step = 0.02, .length = 0.5, .chains = 8, .burn_in = 100, .draws = 1};
  options.acceptance = 0.8;
  options.diagonal_masses = true;
  const auto result = hmc(two_wells(), by_verlet, listed(starts), options, ignored);
  BOOST_TEST_REQUIRE(result.deviations.size() == 1U);
  BOOST_TEST(std::abs(result.deviations[0] - 1.0) < 0.05);
}

BOOST_AUTO_TEST_CASE(cut_and_resumed_they_draw_the_same_bits) {
  for (const bool with_masses : {false, true}) {
    const hmc_options options = changed(tuned, &hmc_options::diagonal_masses, with_masses);
    const course whole = run_from(options);
    BOOST_TEST_REQUIRE(whole.kept.size() == 8U);  // 160 trajectories
    for (const auto& state : whole.kept) {
      BOOST_TEST(goes_on_as(whole, run_from(options, &state), options, state), state.trajectories);
    }
    // What is looked at can tell: another seed goes on otherwise.
    const hmc_options another = changed(options, &hmc_options::seed, 2U);
    BOOST_TEST(!goes_on_as(whole, run_from(another, &whole.kept[4]), options, whole.kept[4]));
    // How often states are kept changes nothing.
    BOOST_TEST((run_from(changed(options, &hmc_options::keep_every, 0)).draws == whole.draws));
  }
}

BOOST_AUTO_TEST_CASE(a_state_of_other_options_is_refused) {
  const course whole = run_from(tuned);
  const auto refused = [&](const hmc_options& options, const hmc_state& state) {
    return refuses([&] { run_from(options, &state); }, {"the state to go on from"});
  };
  BOOST_TEST(refused(changed(tuned, &hmc_options::chains, 36), whole.kept[2]));
  BOOST_TEST(refused(changed(tuned, &hmc_options::diagonal_masses, true), whole.kept[2]));
  BOOST_TEST(refused(changed(tuned, &hmc_options::draws, 10), whole.kept.back()));
  BOOST_CHECK_NO_THROW(run_from(tuned, &whole.kept.back()));
}

BOOST_AUTO_TEST_CASE(moments_of_a_small_lattice) {
  const wrong_energy wrong;
  const Eigen::VectorXd exact = by_quadrature(wrong.forces);
  const double allowed = standard_errors(false_alarms / (4 * seeds), chains - 1);  // 4 moments
  for (std::uint64_t number = 1; number <= seeds; ++number)
    BOOST_TEST(distance_of_hmc(wrong.forces, 0.3, 0.8, lattice_moments, exact, number) < allowed);
  // By a wrong rule: more than what one of four moments is off by chance.
  BOOST_TEST(distance_of_hmc(wrong, 0.1, 0.8, lattice_moments, exact, 1) >
             standard_errors(false_alarms / 4, chains - 1));
}

// In many dimensions H' - H is normal with the mean mu and the variance 2 mu, and erfc(sqrt(mu)/2) are
// accepted. One step of Verlet's method on an oscillator has (1 - z^2/2, z; -z + z^3/4, 1 - z^2/2), and
// mu = z^6/32 for each.
BOOST_AUTO_TEST_CASE(acceptance_in_many_dimensions_is_that_of_a_normal_energy_error) {
  constexpr Eigen::Index size = 1000;
  const gaussian system(Eigen::VectorXd::Ones(size));
  for (const double z : {0.4, 0.6}) {
    const auto found = hmc(
        system, by_verlet, around_rest(size, 1.0),
        {.step = z, .length = 0.1 * z, .chains = 16, .burn_in = 100, .draws = 500, .seed = seed(1)}, ignored);
    const double mu = size * std::pow(z, 6) / 32.0;
    const double expected = std::erfc(0.5 * std::sqrt(mu));
    // The next term of the normal law's expansion is of relative order 1/sqrt(size), and odd: it drops out.
    BOOST_TEST(std::abs(found.acceptance.mean - expected) <
               standard_errors(false_alarms / 2, 15) * found.acceptance.standard_error + 2e-3);
    BOOST_TEST(std::abs(found.acceptance.mean - std::erfc(0.5 * std::sqrt(2.0 * mu))) > 0.02);
  }
}

// An estimate z of its errors e tau below tau is tau (1 - z e), and counts as 2 e tau at least: it is too
// small by a factor of (2 + z)/2 at most, where the two are equal.
BOOST_AUTO_TEST_CASE(effective_draws_stay_below_their_bound) {
  const double z = standard_errors(false_alarms / (5 * 5 * repetitions));
  double worst = 0.0;
  std::uint64_t number = 0;
  for (const double phi : memories) {
    for (const int length : lengths) {
      for (int n = 0; n < repetitions; ++n) {
        const double found = effective_draws(autoregressions(phi, seed(1), number++, length));
        if (std::isfinite(found)) worst = std::max(worst, found / independent(phi, length));
      }
    }
  }
  BOOST_TEST(worst < 0.5 * (2.0 + z));
  BOOST_TEST(0.5 * (2.0 + z) < 4.0);
}

// Draws over an estimated tau, without that floor: of these chains one in 16 gives more than 4 times too
// many, so that none of 250 does in 1e-7 of runs.
BOOST_AUTO_TEST_CASE(draws_over_an_estimated_time_exceed_the_bound) {
  double worst = 0.0;
  for (std::uint64_t n = 0; n < 250; ++n) {
    const auto all = autoregressions(-0.5, seed(1), n, 100);
    std::vector<detail::autocovariance_sums> groups;
    for (const auto& chain : all) {
      detail::autocovariance_along<double> sums(static_cast<int>(chain.size() / 3), 0.0);
      for (const double x : chain) sums.add(x);
      groups.push_back(sums.in_lane(0));
    }
    const auto time =
        integrated_autocorrelation_time(autocovariance(1.0, 0.0, std::move(groups)).normalised());
    if (time.enough) worst = std::max(worst, 400.0 / time.tau / independent(-0.5, 100));
  }
  BOOST_TEST(worst > 4.0);
}

// Of chains that are long enough the floor does not count, and they agree.
BOOST_AUTO_TEST_CASE(long_chains_count_as_they_should) {
  for (const double phi : {-0.3, 0.0, 0.9}) {
    const double expected = independent(phi, 20'000);
    auto all = autoregressions(phi, seed(2), 0, 20'000);
    const double found = effective_draws(all);
    // tau is known to sqrt((4 W + 2)/80000), W = 5 (1 + |phi|)/(1 - |phi|) rounded up.
    const double window = 1.0 + 5.0 * (1.0 + std::abs(phi)) / (1.0 - std::abs(phi));
    const double error = std::sqrt((4.0 * window + 2.0) / 80'000.0);
    const double z = standard_errors(false_alarms / 3);
    BOOST_TEST(found / expected < 1.0 / (1.0 - z * error));
    BOOST_TEST(found / expected > 1.0 / (1.0 + z * error));
    // Means have the deviation sqrt(tau/20000) = .03 at most, of whose square R - 1 is the half.
    BOOST_TEST(std::abs(potential_scale_reduction(all) - 1.0) < 0.02);
    for (double& x : all[2]) x += 2.0;
    BOOST_TEST(potential_scale_reduction(all) > 1.3);
  }
  BOOST_TEST(std::isnan(potential_scale_reduction({{1.0, 1.0, 1.0, 1.0}})));
}
