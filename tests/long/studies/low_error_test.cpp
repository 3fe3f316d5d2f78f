// SPDX-License-Identifier: BSL-1.0
// What the sampling page counts: draws until the error stays low, and modes of a lattice.
#include "../../../bench/studies/sampling/low_error.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include "../../../bench/studies/sampling/power_spectrum.hpp"

using namespace nysalt::sampling_benchmark;

BOOST_AUTO_TEST_CASE(the_error_is_low_when_it_stays_low) {
  const auto of = [](std::vector<double> mean) { return error_curve{mean, mean}; };
  const std::vector<error_curve> one{of({0.5, 0.001, 0.02, 0.005, 0.001})};
  BOOST_TEST(draws_to_low_error(one, &error_curve::mean) == 4.0);  // it was above at draw 3
  BOOST_TEST(draws_to_low_error({of({0.5, 0.001, 0.02})}, &error_curve::mean) ==
             std::numeric_limits<double>::infinity());
  BOOST_TEST(draws_to_low_error({of({0.001, 0.001})}, &error_curve::mean) == 1.0);
  BOOST_TEST(draws_to_low_error({of({0.5, std::nan("")})}, &error_curve::mean) ==
             std::numeric_limits<double>::infinity());
  // The median of three chains is that of the second.
  const std::vector<error_curve> three{of({0.5, 0.5, 0.5}), of({0.5, 0.001, 0.001}), of({0.001, 0.0, 0.0})};
  BOOST_TEST(draws_to_low_error(three, &error_curve::largest) == 2.0);
}

BOOST_AUTO_TEST_CASE(errors_are_of_means_so_far) {
  const statistic squares{[](const Eigen::VectorXd& q, Eigen::VectorXd& f) { f = q.cwiseAbs2(); },
                          Eigen::Vector2d(1.0, 4.0), Eigen::Vector2d(2.0, 32.0)};
  running_errors errors(squares, 1);
  errors.take(0, Eigen::Vector2d(1.0, 2.0));  // no error
  errors.take(0, Eigen::Vector2d(3.0, 2.0));  // the mean of the first is 5
  const auto& curve = errors.curves().front();
  BOOST_TEST(curve.mean[0] == 0.0);
  BOOST_TEST(curve.largest[1] == 8.0);  // 16/2
  BOOST_TEST(curve.mean[1] == 4.0);
}

BOOST_AUTO_TEST_CASE(a_wave_has_its_modes_alone) {
  constexpr Eigen::Index side = 8;
  Eigen::VectorXd q(side * side);
  for (Eigen::Index r = 0; r < side; ++r) {
    for (Eigen::Index c = 0; c < side; ++c)
      q[r * side + c] = 3.0 * std::cos(2.0 * std::numbers::pi * static_cast<double>(2 * r + c) / side);
  }
  Eigen::VectorXd power;
  power_spectrum(q, side, power);
  // A cosine of amplitude 3 has 3/2 L^2 in two modes: their power is (9/4) L^2.
  for (Eigen::Index r = 0; r < side; ++r) {
    for (Eigen::Index c = 0; c < side; ++c) {
      const bool is_its_own = (r == 2 && c == 1) || (r == 6 && c == 7);
      const double expected = is_its_own ? 2.25 * side * side : 0.0;
      BOOST_TEST(std::abs(power[r * side + c] - expected) <
                 1e-11);  // 64 log 64 roundings of numbers below 100
    }
  }
  const Eigen::VectorXd shared = over_symmetries(power, side);
  BOOST_TEST(std::abs(shared[1 * side + 2] - 2.25 * side * side * 2.0 / 8.0) < 1e-11);  // 2 of 8 have it
  BOOST_TEST(std::abs(shared.sum() - power.sum()) < 1e-10);
}
