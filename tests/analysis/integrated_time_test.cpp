// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/integrated_time.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <complex>
#include <vector>

#include "../support/autoregression.hpp"
#include "../support/refusal.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using numbers = std::vector<double>;

numbers powers(double phi, int lags) {
  numbers rho{1.0};
  while (std::ssize(rho) <= lags) rho.push_back(rho.back() * phi);
  return rho;
}

numbers damped_cosine(double decay, double omega, int lags) {
  numbers rho;
  for (int k = 0; k <= lags; ++k) rho.push_back(std::exp(-decay * k) * std::cos(omega * k));
  return rho;
}

double tau(const numbers& rho) { return integrated_autocorrelation_time(rho).tau; }

}  // namespace

// tau = (1 + phi)/(1 - phi) >= 2/(-log phi): the rest beyond W >= 5 tau is 2 phi^W/(1 + phi) of it, below
// 2 exp(-10) = 1e-4.
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
}

BOOST_AUTO_TEST_CASE(too_few_lags_are_said) {
  BOOST_TEST(integrated_autocorrelation_time(powers(0.9, 95)).enough);  // 5 x 19
  const auto time = integrated_autocorrelation_time(powers(0.9, 90));
  BOOST_TEST(!time.enough);
  BOOST_TEST(time.window == 90U);
  BOOST_TEST(std::isnan(effective_sample_size(1000.0, time)));
  BOOST_TEST(refuses<std::invalid_argument>([] { tau({1.0}); }, {"lags must be one or more"}));
}

// tau = Re (1 + a)/(1 - a), a = exp(-decay + i omega). Its partial sums dip at three quarters of a turn:
// there a window that asks tau would close, far from the end of all memory.
BOOST_AUTO_TEST_CASE(an_oscillation_does_not_close_the_window) {
  const std::complex<double> a = std::exp(std::complex<double>(-0.05, 0.4));
  const double expected = ((1.0 + a) / (1.0 - a)).real();
  const auto rho = damped_cosine(0.05, 0.4, 500);
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

// Every second sample against the first: 1 - .8 ... is far below one.
BOOST_AUTO_TEST_CASE(what_alternates_counts_for_more) {
  const auto time = integrated_autocorrelation_time(powers(-0.8, 500));
  BOOST_TEST(time.enough);
  BOOST_TEST(std::abs(time.tau - 0.2 / 1.8) < 1e-4);
  BOOST_TEST(effective_sample_size(1e7, time) > 8.9e7);
  BOOST_TEST(effective_sample_size(100.0, time) < 100.0);  // too few to tell
}

// Measured, with the error by the jackknife.
BOOST_AUTO_TEST_CASE(the_time_of_a_measured_autocovariance) {
  const auto measured = autocovariance_of(0.8, seed(21), 64, 1000, 60);
  const auto of = [](const numbers& rho) { return numbers{tau(rho)}; };
  const double error = std::sqrt(measured.jackknife(of)[0]);
  const double allowed = standard_errors(false_alarms, 63) * error;
  BOOST_TEST(std::abs(tau(measured.normalised()) - 9.0) < allowed);
  BOOST_TEST(allowed < 1.1);  // .82 would have 10.1
}
