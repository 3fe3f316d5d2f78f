// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 19.8 s at -O0, 0.4 s at -O1.
// Autocovariances: their sums along a trajectory, their error bars, and what follows from them: the distance
// of two autocorrelation functions and the integrated autocorrelation time.
#include "nysalt/analysis/autocovariance.hpp"

#include <complex>

#include "../support/autoregression.hpp"
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/acf_error.hpp"
#include "nysalt/analysis/integrated_time.hpp"

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
pair_sums by_definition(const series& x, std::size_t lag, double centre) {
  pair_sums sum;
  for (std::size_t t = 0; t + lag < x.size(); ++t) {
    const double head = x[t] - centre;
    const double tail = x[t + lag] - centre;
    sum = sum + pair_sums{1.0, head * tail, head, tail};
  }
  return sum;
}

autocovariance_sums along(const series& x, int lags, double centre) {
  autocovariance_along<double> sums(lags, centre);
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
  autocovariance_sums one(2);
  one[0] = {3.0, 6.0, 1.0, 1.0};
  one[1] = {2.0, 2.0, 1.0, 0.0};
  const autocovariance alone(1.0, 0.0, {one});
  const autocovariance among_none(1.0, 0.0, {autocovariance_sums(2), one, autocovariance_sums(2)});
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
  const auto near = boost::test_tools::tolerance(100.0 * eps);  // some thirty operations
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
  using wrong = std::invalid_argument;
  using failure = std::runtime_error;
  BOOST_TEST(refuses<wrong>([] { autocovariance_along<double>(0, 0.0); }, {"got 0"}));
  BOOST_TEST(refuses<wrong>([] { autocovariance_along<double>(1'000'000, 0.0); }, {"got 1000000"}));
  BOOST_TEST(refuses<wrong>([] { autocovariance_along<double>(3, std::nan("")); }, {"centre"}));
  BOOST_TEST(refuses<wrong>([] { along({1.0, 2.0, 3.0}, 3, 0.0); }, {"3 lags", "got 3"}));
  const autocovariance none(1.0, 0.0, {autocovariance_sums(3)});
  BOOST_TEST(std::isnan(none.mean()));
  BOOST_TEST(refuses<failure>([&] { none.normalised(); }, {"no trajectory counts"}));
  const autocovariance frozen(1.0, 4.0, {along(series(9, 4.0), 2, 4.0)});
  BOOST_TEST(refuses<failure>([&] { frozen.normalised(); }, {"does not vary"}));
  BOOST_TEST(refuses<wrong>([] { autocovariance(1.0, 0.0, {}); }, {"groups", "must be one or more"}));
  const std::vector unequal{autocovariance_sums(3), autocovariance_sums(5)};
  BOOST_TEST(refuses<wrong>([&] { autocovariance(1.0, 0.0, unequal); }, {"got 2 and 4"}));
  BOOST_TEST(
      refuses<wrong>([] { integrated_autocorrelation_time(series{1.0}); }, {"lags must be one or more"}));

  const auto a = short_one(0.6, 1, 2);
  const auto fewer = autocovariance_of(0.6, 1, 2, 200, 9);
  BOOST_TEST(refuses<wrong>([&] { acf_error(a, fewer); }, {"10 lags", "9 lags"}));
  autocovariance_sums sums(11);
  sums[0].pairs = 1.0;
  const autocovariance slower(1.01, 0.0, {sums});
  BOOST_TEST(refuses<wrong>([&] { acf_error(a, slower); }, {"1.01", "same times"}));
  BOOST_TEST(acf_error(a, a).rms == 0.0);
}
