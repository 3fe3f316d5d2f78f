// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 19.8 s at -O0, 0.4 s at -O1.
// Autocovariances: their sums along a trajectory, their error bars, and what follows from them: the distance
// of two autocorrelation functions and the integrated autocorrelation time. Statistics of ensembles: those of
// a law that is known, and those that stored trajectories give; and the kinetic temperature, one of them.
#include <complex>

#include "../support/allocations.hpp"
#include "../support/autoregression.hpp"
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using series = std::vector<double>;

series random_walk(int samples, double offset) {
  draws random;
  series x{random.uniform(-1.0, 1.0)};
  while (std::ssize(x) < samples) x.push_back(0.9 * x.back() + random.uniform(-1.0, 1.0));
  for (double& value : x) value += offset;
  return x;
}

/// By the definition, term by term.
detail::pair_sums by_definition(const series& x, std::size_t lag, double centre) {
  detail::pair_sums sum;
  for (std::size_t t = 0; t + lag < x.size(); ++t) {
    const double head = x[t] - centre;
    const double tail = x[t + lag] - centre;
    sum = sum + detail::pair_sums{1.0, head * tail, head, tail};
  }
  return sum;
}

detail::autocovariance_sums along(const series& x, int lags, double centre) {
  detail::autocovariance_along<double> sums(lags, centre);
  for (const double value : x) sums.add(value);
  return sums.in_lane(0);
}

constexpr int groups = 256;
constexpr int samples = 300;
constexpr int lags = 20;
constexpr double n = 8.0 * groups * samples;

/// Bartlett's formula for the variance of rho(k) from n samples, for phi^k.
double bartlett(double phi, double k) {
  const double square = phi * phi;
  const double at_lag = std::pow(square, k);
  return ((1.0 + square) * (1.0 - at_lag) / (1.0 - square) - 2.0 * k * at_lag) / n;
}

/// For acf_error: ten lags of 200 samples.
autocovariance short_one(double phi, std::uint64_t number, int of_groups = 32) {
  return autocovariance_of(phi, seed(number), of_groups, 200, 10);
}

series powers(double phi, int last) {
  series rho{1.0};
  while (std::ssize(rho) <= last) rho.push_back(rho.back() * phi);
  return rho;
}

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

stepper<model> stepper_of(const model& system, double step) {
  return make_stepper(system, method(verlet()), step);
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

// As many samples as may be, and a few more: whole intervals and rests, barely more samples than lags.
BOOST_AUTO_TEST_CASE(sums_are_those_of_the_definition) {
  for (const int of_lags : {1, 3, 8, 20}) {
    for (const int length : {of_lags + 1, of_lags + 2, of_lags + 7, of_lags + 8, 100}) {
      const auto x = random_walk(length, 0.3);
      const auto sums = along(x, of_lags, 0.3);
      // Values below 10, and a rounding a term, twice for heads and tails.
      const double rounding = 200.0 * length * eps;
      for (std::size_t lag = 0; lag < sums.size(); ++lag) {
        const auto expected = by_definition(x, lag, 0.3);
        BOOST_TEST(sums[lag].pairs == expected.pairs);
        BOOST_TEST(sums[lag].products == expected.products);  // the same terms in the same order
        BOOST_TEST(std::abs(sums[lag].heads - expected.heads) <= rounding);
        BOOST_TEST(std::abs(sums[lag].tails - expected.tails) <= rounding);
      }
      // Heads are not tails, else the test could not tell.
      BOOST_TEST(std::abs(sums[1].heads - sums[1].tails) > rounding);
    }
  }
}

// With an offset of 1e6 and a variance near 1, the samples keep 1e-10, and so do sums about a centre; sums
// about zero keep no more than 1e12 eps a term, and its mean over 1000 roundings is off by 1e-5 at least.
BOOST_AUTO_TEST_CASE(a_centre_keeps_the_digits) {
  const auto x = random_walk(1000, 0.0);
  const auto far = random_walk(1000, 1e6);
  const auto error = [&](double centre) {
    return std::abs(along(far, 3, centre)[1].covariance() - by_definition(x, 1, 0.0).covariance());
  };
  BOOST_TEST(error(1e6 + 2.0) < 1e-8);  // 2 x 5 x 1e-10, and 5 of a centre that is not the mean
  BOOST_TEST(error(0.0) > 1e-6);
}

// 256 groups tell an error to 1/sqrt(510) = 4.4 %, lags after 300 samples change Bartlett's by less than 7 %.
BOOST_AUTO_TEST_CASE(errors_are_those_of_theory) {
  const double allowed = standard_errors(false_alarms / lags) * 0.044 + 0.07;
  const auto error = autocovariance_of(0.7, seed(11), groups, samples, lags).standard_error();
  BOOST_TEST(error[0] == 0.0);
  for (std::size_t k = 1; k < error.size(); ++k) {
    const double ratio = error[k] / std::sqrt(bartlett(0.7, static_cast<double>(k)));
    BOOST_TEST(std::abs(ratio - 1.0) < allowed);
    BOOST_TEST(std::abs(2.0 * ratio - 1.0) > allowed);
  }
}

BOOST_AUTO_TEST_CASE(groups_without_a_trajectory_do_not_count) {
  detail::autocovariance_sums one(2);
  one[0] = {3.0, 6.0, 1.0, 1.0};
  one[1] = {2.0, 2.0, 1.0, 0.0};
  const autocovariance alone(1.0, 0.0, {one});
  const autocovariance among_none(1.0, 0.0,
                                  {detail::autocovariance_sums(2), one, detail::autocovariance_sums(2)});
  BOOST_TEST(among_none.groups() == 1U);
  BOOST_TEST(among_none.covariance(1) == alone.covariance(1));
  BOOST_TEST(std::isnan(among_none.standard_error()[1]));
  const autocovariance twice(1.0, 0.0, {one, one});
  BOOST_TEST(twice.standard_error()[1] < 10.0 * eps);  // groups that agree have no spread
}

BOOST_AUTO_TEST_CASE(the_distance_is_a_root_mean_square_and_its_floor_that_of_the_errors) {
  const auto a = short_one(0.6, 1);
  const auto b = short_one(0.7, 2);
  const auto found = acf_error(a, b);
  double squares = 0.0;
  double of_errors = 0.0;
  for (std::size_t k = 1; k <= 10; ++k) {
    squares += std::pow(a.normalised()[k] - b.normalised()[k], 2) / 10.0;
    of_errors += (std::pow(a.standard_error()[k], 2) + std::pow(b.standard_error()[k], 2)) / 10.0;
  }
  const auto near = tolerance(100.0 * eps);  // some thirty operations
  BOOST_TEST(found.rms == std::sqrt(squares), near);
  BOOST_TEST(found.floor == std::sqrt(of_errors), near);
}

// The scatter of the error over 200 repetitions is known to 1/sqrt(400) = 5 %, each error to 1/sqrt(28) = 19
// %, and their mean to 1.3 %.
BOOST_AUTO_TEST_CASE(the_standard_error_is_that_of_repetitions) {
  std::vector<double> rms;
  double error = 0.0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const auto found = acf_error(short_one(0.5, 3000 + 2 * k, 8), short_one(0.7, 3001 + 2 * k, 8));
    rms.push_back(found.rms);
    error += found.standard_error / 200.0;
  }
  const double ratio = error / std::sqrt(covariance(rms, rms));
  const double allowed = standard_errors(false_alarms) * std::hypot(0.05, 0.013);
  BOOST_TEST(std::abs(ratio - 1.0) < allowed);
  BOOST_TEST(std::abs(2.0 * ratio - 1.0) > allowed);
}

// tau = (1 + phi)/(1 - phi) >= 2/(-log phi): the rest beyond W >= 5 tau is 2 phi^W/(1 + phi) of it, below
// 2 exp(-10) = 1e-4. Where samples alternate, tau is far below one.
BOOST_AUTO_TEST_CASE(powers_have_a_known_time) {
  for (const double phi : {0.1, 0.5, 0.9, 0.99}) {
    const double expected = (1.0 + phi) / (1.0 - phi);
    const auto time = integrated_autocorrelation_time(powers(phi, 2000));
    BOOST_TEST(time.enough);
    BOOST_TEST(std::abs(time.tau / expected - 1.0) < 1e-4);
    BOOST_TEST(time.memory == time.tau);
    BOOST_TEST(static_cast<double>(time.window) >= 5.0 * time.tau);
    BOOST_TEST(static_cast<double>(time.window - 1) < 5.0 * expected);
    BOOST_TEST(effective_sample_size(1e6, time) == 1e6 / time.tau);
  }
  const auto alternating = integrated_autocorrelation_time(powers(-0.8, 500));
  BOOST_TEST(alternating.enough);
  BOOST_TEST(std::abs(alternating.tau - 0.2 / 1.8) < 1e-4);
  BOOST_TEST(effective_sample_size(1e7, alternating) > 8.9e7);
  BOOST_TEST(effective_sample_size(100.0, alternating) < 100.0);        // too few to tell
  BOOST_TEST(integrated_autocorrelation_time(powers(0.9, 95)).enough);  // 5 x 19
  const auto of_few_lags = integrated_autocorrelation_time(powers(0.9, 90));
  BOOST_TEST(!of_few_lags.enough);
  BOOST_TEST(of_few_lags.window == 90U);
  BOOST_TEST(std::isnan(effective_sample_size(1000.0, of_few_lags)));
}

// tau = Re (1 + a)/(1 - a), a = exp(-decay + i omega). Its partial sums dip at three quarters of a turn:
// there a window that asks tau would close, far from the end of all memory.
BOOST_AUTO_TEST_CASE(an_oscillation_does_not_close_the_window) {
  const std::complex<double> a = std::exp(std::complex<double>(-0.05, 0.4));
  const double expected = ((1.0 + a) / (1.0 - a)).real();
  series rho;
  for (int k = 0; k <= 500; ++k) rho.push_back(std::exp(-0.05 * k) * std::cos(0.4 * k));
  const auto time = integrated_autocorrelation_time(rho);
  BOOST_TEST(time.enough);
  // The window is at 5 memory, memory > 2/pi x 2/0.05 - 1 = 24: the rest is below 2 exp(-6)/|1 - a|.
  const double rest = 2.0 * std::exp(-6.0) / std::abs(1.0 - a);
  BOOST_TEST(std::abs(time.tau - expected) < rest);
  BOOST_TEST(time.memory > 20.0 * time.tau);
  double partial = 1.0;
  std::size_t closes = 0;
  while (static_cast<double>(closes) < 5.0 * partial) partial += 2.0 * rho[++closes];
  BOOST_TEST(std::abs(partial - expected) > 10.0 * rest);
}

BOOST_AUTO_TEST_CASE(what_has_no_autocovariance_is_refused) {
  using failure = std::runtime_error;
  BOOST_TEST(refuses([] { detail::autocovariance_along<double>(0, 0.0); }, {"got 0"}));
  BOOST_TEST(refuses([] { detail::autocovariance_along<double>(1'000'000, 0.0); }, {"got 1000000"}));
  BOOST_TEST(refuses([] { detail::autocovariance_along<double>(3, std::nan("")); }, {"centre"}));
  BOOST_TEST(refuses([] { along({1.0, 2.0, 3.0}, 3, 0.0); }, {"3 lags", "got 3"}));
  const autocovariance none(1.0, 0.0, {detail::autocovariance_sums(3)});
  BOOST_TEST(std::isnan(none.mean()));
  BOOST_TEST(refuses<failure>([&] { none.normalised(); }, {"no trajectory counts"}));
  const autocovariance frozen(1.0, 4.0, {along(series(9, 4.0), 2, 4.0)});
  BOOST_TEST(refuses<failure>([&] { frozen.normalised(); }, {"does not vary"}));
  BOOST_TEST(refuses([] { autocovariance(1.0, 0.0, {}); }, {"groups", "must be one or more"}));
  const std::vector unequal{detail::autocovariance_sums(3), detail::autocovariance_sums(5)};
  BOOST_TEST(refuses([&] { autocovariance(1.0, 0.0, unequal); }, {"got 2 and 4"}));
  BOOST_TEST(refuses([] { integrated_autocorrelation_time(series{1.0}); }, {"lags must be one or more"}));

  const auto a = short_one(0.6, 1, 2);
  const auto fewer = autocovariance_of(0.6, 1, 2, 200, 9);
  BOOST_TEST(refuses([&] { acf_error(a, fewer); }, {"10 lags", "9 lags"}));
  detail::autocovariance_sums sums(11);
  sums[0].pairs = 1.0;
  const autocovariance slower(1.01, 0.0, {sums});
  BOOST_TEST(refuses([&] { acf_error(a, slower); }, {"1.01", "same times"}));
  BOOST_TEST(acf_error(a, a).rms == 0.0);
}

BOOST_AUTO_TEST_CASE(the_kinetic_temperature_counts_masses) {
  const state x{Eigen::VectorXd{{0.5, -1.0}}, Eigen::VectorXd{{3.0, 2.0}}};
  // (9/1 + 4/4)/2; the force is -(3 q0 - q1, -q0 + 2 q1) = (-2.5, 2.5), and half a step of .4 gives
  // (2.5, 2.5): (6.25 + 6.25/4)/2.
  BOOST_TEST(kinetic_temperature<double>(masses, x) == 5.0, tolerance(10 * eps));
  BOOST_TEST(half_step_kinetic_temperature<double>(masses, 0.4, x) == 3.90625, tolerance(10 * eps));
}

// p dK/dp for K = sqrt(1 + p^2): equipartition, not 2 K.
BOOST_AUTO_TEST_CASE(any_kinetic_energy_has_a_temperature) {
  draws random;
  const relativistic system;
  const auto x = random.state(system, 2.0);
  double sum = 0.0;
  for (const double p : x.p) sum += p * p / std::sqrt(1.0 + p * p);
  BOOST_TEST(kinetic_temperature<double>(system, x) == sum / static_cast<double>(x.size()),
             tolerance(20 * eps));
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
  BOOST_TEST(once.effective_sample_size == 1024.0, tolerance(1e4 * eps));
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
      integrate_ensemble(galaxy::system, method(verlet()), 0.1, galaxy::law, options, position, take);
  histogram all(*wanted.histogram);
  std::int64_t counted = 0;
  std::size_t lost = 0;
  detail::pair_sums at_lag;
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
      at_lag = at_lag + detail::pair_sums{1.0, x[t] * x[t + 5], x[t], x[t + 5]};
    }
    means.push_back(mean(x));
  }
  BOOST_TEST(lost > 0U);
  BOOST_TEST(counted > 10);
  BOOST_TEST(found.lost.size() == lost);
  BOOST_TEST(found.counted == counted);
  BOOST_TEST(found.histogram->counts() == all.counts(), per_element());
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
    const std::int64_t size = detail::trajectories_of_group(n);
    const std::int64_t groups = (n - 1) / size + 1;
    if (groups > 64 || groups < std::min<std::int64_t>(n, 33)) BOOST_ERROR(groups << " groups of " << n);
    if (16 % size != 0 && size % 16 != 0) BOOST_ERROR(size << " in a group do not fit lanes");
  }
}

BOOST_AUTO_TEST_CASE(statistics_that_cannot_be_are_refused) {
  const auto refused = [](const ensemble_options& options, const statistics_wanted& wanted, auto... words) {
    return refuses([&] { galaxy::run(options, wanted); }, {words...});
  };
  BOOST_TEST(refused({.trajectories = 0}, {}, "trajectories 0"));
  BOOST_TEST(refused({.steps = -1}, {}, "steps -1"));
  BOOST_TEST(refused({.every = 0}, {}, "every 0"));
  BOOST_TEST(refused({.execution = {.threads = 0}}, {}, "thread"));
  BOOST_TEST(refused({.steps = 10}, {.from = 11}, "from 11"));
  BOOST_TEST(refused({.steps = 10, .every = 2}, {.lags = 6}, "6 samples", "6 lags"));
  BOOST_TEST(refused({.steps = 10, .every = 2}, {.lags = 3, .from = 5}, "3 samples"));
  BOOST_TEST(refused({.steps = 10}, {.lags = 0}, "lags must be 1 to 100000, got 0"));
  BOOST_TEST(refused({.steps = 10}, {.lags = -1}, "got -1"));
  BOOST_TEST(refused({.steps = 10}, {.histogram = equal_bins{1.0, 0.0, 3}}, "bins"));
  BOOST_TEST(galaxy::run({.steps = 10, .every = 2}, {.lags = 5}).samples == 6);
}
