// SPDX-License-Identifier: BSL-1.0
// Statistics of ensembles: those of a law that is known, and those that stored trajectories give; and the
// kinetic temperature, which is one of them.
#include "../support/allocations.hpp"
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, Eigen::Dynamic>;

/// q_1, or a function of it that has no value everywhere.
struct observed {
  bool is_root = false;
  template <class T>
  T operator()(const phase_point<T, Eigen::Dynamic>& x) const {
    using std::sqrt;
    return is_root ? sqrt(T(2.0) - x.q[0]) : x.q[0];
  }
};
const over_lanes<observed> position{{}};

const statistics_wanted everything{.histogram = equal_bins{-1.0, 1.0, 50},
                                   .lags = 12,
                                   .moments = true,
                                   .kinetic_temperature = true,
                                   .half_step_kinetic_temperature = true};

normal_around<Eigen::Dynamic> around_zero(Eigen::Index size, double of_q, double of_p) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
  return {{zero, zero}, of_q, of_p};
}

stepper<model, run_time_word> stepper_of(const model& system, double step) {
  return make_stepper(system, tabulated(verlet()), step);
}

/// Of Verlet on the oscillator omega = 2 at z = omega h = 1.2: q = A cos(n turn + phase), and normal starts
/// with omega^2 <q^2> = kT = 4 and <p^2> = (1 - z^2/4) kT stay what they are.
namespace oscillation {
const model system{harmonic_oscillator(2.0)};
constexpr double step = 0.6;
constexpr double low = 1.0 - 1.44 / 4.0;
constexpr double kt = 4.0;
const double turn = std::acos(1.0 - 1.44 / 2.0);
const auto law = around_zero(1, 1.0, std::sqrt(kt* low));
constexpr std::int64_t trajectories = 1024;

gathered_statistics run(std::int64_t steps, std::int64_t every, const statistics_wanted& wanted) {
  return ensemble_statistics(stepper_of(system, step), law,
                             {.trajectories = trajectories, .steps = steps, .every = every, .seed = seed(1)},
                             position, wanted);
}
}  // namespace oscillation

/// Some of these leave the well, at times of their own.
namespace galaxy {
const model system{henon_heiles()};
const auto law = around_zero(2, 0.5, 0.5);

gathered_statistics run(const ensemble_options& options, const statistics_wanted& wanted = everything) {
  return ensemble_statistics(stepper_of(system, 0.1), law, options, position, wanted);
}
}  // namespace galaxy

/// As one of two comparisons of a test.
bool agrees(const estimate& of, double expected) {
  return std::abs(of.mean - expected) < standard_errors(false_alarms / 2) * of.standard_error;
}

const linear_chain masses(Eigen::MatrixXd{{3.0, -1.0}, {-1.0, 2.0}}, Eigen::VectorXd{{1.0, 4.0}});

}  // namespace

BOOST_AUTO_TEST_CASE(the_kinetic_temperature_counts_masses) {
  const state x{Eigen::VectorXd{{0.5, -1.0}}, Eigen::VectorXd{{3.0, 2.0}}};
  // (9/1 + 4/4)/2; the force is -(3 q0 - q1, -q0 + 2 q1) = (-2.5, 2.5), and half a step of .4 gives
  // (2.5, 2.5): (6.25 + 6.25/4)/2.
  BOOST_TEST(kinetic_temperature<double>(masses, x) == 5.0, boost::test_tools::tolerance(10 * eps));
  BOOST_TEST(half_step_kinetic_temperature<double>(masses, 0.4, x) == 3.90625,
             boost::test_tools::tolerance(10 * eps));
}

// p dK/dp for K = sqrt(1 + p^2): equipartition, not 2 K.
BOOST_AUTO_TEST_CASE(any_kinetic_energy_has_a_temperature) {
  draws random;
  const relativistic system;
  const auto x = random.state(system, 2.0);
  double sum = 0.0;
  for (const double p : x.p) sum += p * p / std::sqrt(1.0 + p * p);
  BOOST_TEST(kinetic_temperature<double>(system, x) == sum / static_cast<double>(x.size()),
             boost::test_tools::tolerance(20 * eps));
}

// Verlet takes q = A cos(n turn + phase) to momenta of the amplitude omega A cos(turn/2) at the steps: over
// all phases <p^2> = (1 - z^2/4) omega^2 <q^2>. Half a kick later they have omega^2 <q^2>, which is kT.
BOOST_AUTO_TEST_CASE(oscillators_show_their_temperature) {
  const auto all = oscillation::run(30, 2, everything);
  BOOST_TEST(all.counted == oscillation::trajectories);
  BOOST_TEST(all.samples == 16);
  BOOST_TEST(all.autocovariance->interval() == 2.0 * oscillation::step);
  BOOST_TEST(all.autocovariance->groups() == 64U);
  BOOST_TEST(agrees(all.half_step_kinetic_temperature, oscillation::kt));
  BOOST_TEST(agrees(all.kinetic_temperature, oscillation::kt * oscillation::low));
  BOOST_TEST(!agrees(all.kinetic_temperature, oscillation::kt));
}

// One look at each: independent samples, of which each counts, exactly but for rounding. Along the way the
// time mean of n samples is A cos(...) D, D = sin(n turn/2)/(n sin(turn/2)): that many more samples are worth
// 1/D^2 each; the variance of 1024 means is known to sqrt(2/1024).
BOOST_AUTO_TEST_CASE(samples_count_as_they_do) {
  const statistics_wanted moments{.moments = true};
  const auto once = oscillation::run(0, 1, moments);
  BOOST_TEST(once.effective_sample_size == 1024.0, boost::test_tools::tolerance(1e4 * eps));
  const double allowed = standard_errors(false_alarms / 3);
  BOOST_TEST(std::abs(once.variance - 1.0) < allowed * std::sqrt(2.0 / 1024.0));
  BOOST_TEST(agrees(once.mean, 0.0));
  BOOST_TEST(!agrees(once.mean, 0.4));  // 13 errors of 1/32
  const auto seven = oscillation::run(6, 1, moments);
  const double ratio = std::sin(3.5 * oscillation::turn) / (7.0 * std::sin(0.5 * oscillation::turn));
  const double expected = 1024.0 / (ratio * ratio);
  BOOST_TEST(std::abs(seven.effective_sample_size / expected - 1.0) <
             allowed * 2.0 * std::sqrt(2.0 / 1024.0));
  BOOST_TEST(std::abs(expected / 7168.0 - 1.0) > 1.0);  // it is not the number of samples
}

// From all that was ever seen, stored: lost trajectories count in nothing.
BOOST_AUTO_TEST_CASE(statistics_are_those_of_stored_trajectories) {
  ensemble_options options{.trajectories = 50, .steps = 200, .every = 3};
  options.first = 7;
  statistics_wanted wanted = everything;
  wanted.from = 10;
  const auto found = galaxy::run(options, wanted);
  std::vector<std::vector<double>> seen(50);
  const auto take = [&](std::int64_t m, std::int64_t n, double x) {
    if (n >= 10) seen[static_cast<std::size_t>(m) - 7].push_back(x);
  };
  const auto diverged =
      integrate_ensemble(galaxy::system, tabulated(verlet()), 0.1, galaxy::law, options, position, take);
  histogram all(*wanted.histogram);
  std::int64_t counted = 0;
  std::size_t lost = 0;
  pair_sums at_lag;
  std::vector<double> means;
  for (std::size_t m = 0; m < 50; ++m) {
    if (diverged[m]) {
      BOOST_TEST(found.lost.at(lost).trajectory == static_cast<std::int64_t>(m) + 7);
      BOOST_TEST(found.lost.at(lost).step == *diverged[m]);
      ++lost;
      continue;
    }
    ++counted;
    const auto& x = seen[m];
    BOOST_TEST(std::ssize(x) == found.samples);
    for (const double value : x) all.add(value);
    for (std::size_t t = 0; t + 5 < x.size(); ++t) {
      at_lag = at_lag + pair_sums{1.0, x[t] * x[t + 5], x[t], x[t + 5]};
    }
    means.push_back(mean(x));
  }
  BOOST_TEST(lost > 0U);
  BOOST_TEST(counted > 10);
  BOOST_TEST(found.lost.size() == lost);
  BOOST_TEST(found.counted == counted);
  BOOST_TEST(found.histogram->counts() == all.counts(), boost::test_tools::per_element());
  BOOST_TEST(found.histogram_of_groups.size() == 50U);  // here of one trajectory each
  for (const auto& group : found.histogram_of_groups) all -= group;
  BOOST_TEST(all.total() == 0);
  // About 2000 terms below 1, whose roundings add up.
  const double rounding = 1e4 * eps;
  BOOST_TEST(std::abs(found.autocovariance->covariance(5) - at_lag.covariance()) < rounding);
  BOOST_TEST(std::abs(found.autocovariance->covariance(4) - at_lag.covariance()) > rounding);
  BOOST_TEST(std::abs(found.mean.mean - mean_and_error(means).mean) < rounding);
  BOOST_TEST(std::abs(found.mean.standard_error - mean_and_error(means).standard_error) < rounding);
}

// An observable without a value ends a trajectory, where it has none.
BOOST_AUTO_TEST_CASE(what_is_not_finite_is_lost) {
  const over_lanes<observed> root{{.is_root = true}};
  const ensemble_options options{.trajectories = 200, .steps = 10};
  const auto stepper = stepper_of(oscillation::system, oscillation::step);
  const auto found = ensemble_statistics(stepper, oscillation::law, options, root, {.moments = true});
  std::size_t lost = 0;
  for (std::uint64_t m = 0; m < 200; ++m) {
    std::int64_t first = -1;
    const auto observe = [&](std::int64_t n, double, const auto& x) {
      if (first < 0 && x.q[0] > 2.0) first = n;
    };
    integrate(stepper, oscillation::law(1, m), 10, observe, 1);
    if (first < 0) continue;
    BOOST_TEST(found.lost.at(lost).trajectory == static_cast<std::int64_t>(m));
    BOOST_TEST(found.lost.at(lost).step == first);
    ++lost;
  }
  BOOST_TEST(lost > 0U);
  BOOST_TEST(found.lost.size() == lost);
  BOOST_TEST(std::isfinite(found.mean.mean));
}

BOOST_AUTO_TEST_CASE(only_what_is_wanted_is_gathered) {
  const auto nothing = oscillation::run(5, 1, {});
  BOOST_TEST(!nothing.histogram.has_value());
  BOOST_TEST(!nothing.autocovariance.has_value());
  for (const estimate& one :
       {nothing.mean, nothing.kinetic_temperature, nothing.half_step_kinetic_temperature}) {
    BOOST_TEST(std::isnan(one.mean));
  }
  BOOST_TEST(std::isnan(nothing.effective_sample_size));
  const auto half = oscillation::run(15, 1, {.half_step_kinetic_temperature = true});
  BOOST_TEST(std::isnan(half.kinetic_temperature.mean));
  BOOST_TEST(half.half_step_kinetic_temperature.mean ==
             oscillation::run(15, 1, everything).half_step_kinetic_temperature.mean);
}

// A step allocates some hundreds of bytes, which it gives back at once; samples that were kept would take 8
// bytes for each of 16 trajectories or fewer, and as much again when their storage grows.
BOOST_AUTO_TEST_CASE(memory_does_not_grow_with_the_steps) {
  const statistics_wanted wanted{.histogram = everything.histogram, .lags = 12, .moments = true};
  const auto bytes = [&](std::int64_t steps) {
    const auto before = allocated_bytes;
    oscillation::run(steps, 1, wanted);
    return static_cast<double>(allocated_bytes - before);
  };
  BOOST_TEST(bytes(1000) - bytes(100) < 0.5 * 900 * 8 * oscillation::trajectories);
}

// A jackknife over 33 groups knows its errors to 13 %.
BOOST_AUTO_TEST_CASE(there_are_enough_groups) {
  for (std::int64_t n = 1; n < 20'000; ++n) {
    const std::int64_t size = trajectories_of_group(n);
    const std::int64_t groups = (n - 1) / size + 1;
    if (groups > 64 || groups < std::min<std::int64_t>(n, 33)) BOOST_ERROR(groups << " groups of " << n);
    if (16 % size != 0 && size % 16 != 0) BOOST_ERROR(size << " in a group do not fit lanes");
  }
}

BOOST_AUTO_TEST_CASE(statistics_that_cannot_be_are_refused) {
  const auto refused = [](const ensemble_options& options, const statistics_wanted& wanted, auto... words) {
    return refuses<std::invalid_argument>([&] { galaxy::run(options, wanted); }, {words...});
  };
  BOOST_TEST(refused({.trajectories = 0}, {}, "trajectories 0"));
  BOOST_TEST(refused({.steps = -1}, {}, "steps -1"));
  BOOST_TEST(refused({.every = 0}, {}, "every 0"));
  BOOST_TEST(refused({.threads = 0}, {}, "thread"));
  BOOST_TEST(refused({.steps = 10}, {.from = 11}, "from 11"));
  BOOST_TEST(refused({.steps = 10, .every = 2}, {.lags = 6}, "6 samples", "6 lags"));
  BOOST_TEST(refused({.steps = 10, .every = 2}, {.lags = 3, .from = 5}, "3 samples"));
  BOOST_TEST(refused({.steps = 10}, {.lags = 0}, "lags must be 1 to 100000, got 0"));
  BOOST_TEST(refused({.steps = 10}, {.lags = -1}, "got -1"));
  BOOST_TEST(refused({.steps = 10}, {.histogram = equal_bins{1.0, 0.0, 3}}, "bins"));
  BOOST_TEST(galaxy::run({.steps = 10, .every = 2}, {.lags = 5}).samples == 6);
}
