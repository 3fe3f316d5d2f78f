// SPDX-License-Identifier: BSL-1.0
// The paper's initial law has the paper's moments, and is a function of seed and number.
#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/fpu_law.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::uint64_t count = 20'000;
constexpr double omega = 50.0;
const fpu_chain<3> chain(omega);
const fpu_law<3> law(chain);

/// A mode's coordinate over many trajectories: mode k of q, or of p.
std::vector<double> sample(std::uint64_t which, Eigen::Index k, bool momentum, std::uint64_t first = 0) {
  const Eigen::MatrixXd basis = chain.modes().basis;
  std::vector<double> result;
  for (std::uint64_t n = first; n < first + count; ++n) {
    const auto x = law(which, n);
    result.push_back(basis.col(k).dot(momentum ? x.p : x.q));
  }
  return result;
}

double in_standard_errors(double r) { return std::abs(r) * std::sqrt(static_cast<double>(count)); }

}  // namespace

BOOST_AUTO_TEST_CASE(slow_modes_start_at_one) {
  for (std::uint64_t n = 0; n < 100; ++n) {
    const auto x = law(7, n);
    for (int i = 0; i < 3; ++i) {  // two products and a sum, on numbers up to 2
      const Eigen::VectorXd slow = chain.modes().basis.col(i);
      BOOST_TEST(std::abs(slow.dot(x.q) - 1.0) <= 8.0 * eps);
      BOOST_TEST(std::abs(slow.dot(x.p) - 1.0) <= 8.0 * eps);
    }
  }
}

BOOST_AUTO_TEST_CASE(stiff_modes_are_normal_with_deviation_one_over_omega) {
  constexpr double each = false_alarms / 15;  // three modes, five comparisons
  const double allowed = standard_errors(each);
  for (Eigen::Index k = 3; k < 6; ++k) {
    const auto x = sample(seed(1), k, false);  // 1/omega + zeta
    const auto y = sample(seed(1), k, true);   // 1 + eta
    BOOST_TEST(mean_off(x, 1.0 / omega, 1.0 / omega) <= allowed);
    BOOST_TEST(mean_off(y, 1.0, 1.0 / omega) <= allowed);
    for (const auto& numbers : {x, y}) {
      BOOST_TEST(deviation_off(numbers, 1.0 / omega) <= allowed);
      BOOST_TEST(deviation_off(numbers, 1.0 / std::sqrt(omega)) > allowed);  // the rival reading
    }
    auto standard = y;
    for (double& value : standard) value = (value - 1.0) * omega;
    BOOST_TEST(kolmogorov_smirnov(standard) <= kolmogorov_smirnov_limit(each));
  }
}

BOOST_AUTO_TEST_CASE(modes_and_trajectories_are_independent) {
  const double allowed = standard_errors(false_alarms / 3);
  BOOST_TEST(in_standard_errors(correlation(sample(seed(1), 3, false), sample(seed(1), 4, false))) <=
             allowed);
  BOOST_TEST(in_standard_errors(correlation(sample(seed(1), 3, false), sample(seed(1), 3, true))) <= allowed);
  BOOST_TEST(in_standard_errors(correlation(sample(seed(1), 3, false), sample(seed(1), 3, false, 1))) <=
             allowed);
}

BOOST_AUTO_TEST_CASE(seeds_are_independent_and_no_shift_of_trajectories) {
  const double allowed = standard_errors(false_alarms / 6);
  const auto one = sample(seed(1), 3, false);
  BOOST_TEST(in_standard_errors(correlation(one, sample(seed(1), 3, false))) > allowed);  // itself
  for (std::uint64_t shift = 0; shift < 3; ++shift) {
    BOOST_TEST(in_standard_errors(correlation(one, sample(seed(2), 3, false, shift))) <= allowed);
    BOOST_TEST(in_standard_errors(correlation(sample(seed(1), 3, false, shift), sample(seed(2), 3, false))) <=
               allowed);
  }
}

BOOST_AUTO_TEST_CASE(the_same_seed_and_number_give_the_same_bits) {
  const fpu_law<Eigen::Dynamic> dynamic(fpu_chain<>(3, omega));
  for (const std::uint64_t n : {0U, 1U, 41U}) {
    BOOST_TEST(same_bits(law(5, n), law(5, n)));
    BOOST_TEST(!same_bits(law(5, n), law(5, n + 1)));
    BOOST_TEST(!same_bits(law(5, n), law(6, n)));
    BOOST_TEST((law(5, n).q == dynamic(5, n).q && law(5, n).p == dynamic(5, n).p));
  }
  BOOST_TEST(law.description() == "fpu_law(omega=50)");
}

BOOST_AUTO_TEST_CASE(a_spread_multiplies_the_deviations) {
  const fpu_law<3> wide(chain, 3.0);
  const Eigen::MatrixXd basis = chain.modes().basis;
  for (std::uint64_t n = 0; n < 100; ++n) {
    const auto x = law(5, n);
    const auto y = wide(5, n);
    for (Eigen::Index k = 3; k < 6; ++k) {  // as for the slow modes
      BOOST_TEST(std::abs(basis.col(k).dot(y.q - 3.0 * x.q) + 2.0 / omega) <= 32.0 * eps);
      BOOST_TEST(std::abs(basis.col(k).dot(y.p - 3.0 * x.p) + 2.0) <= 32.0 * eps);
    }
  }
  BOOST_TEST(same_bits(fpu_law<3>(chain, 1.0)(5, 7), law(5, 7)));
  BOOST_TEST(wide.description() == "fpu_law(omega=50, spread=3)");
  for (const double bad : {-1.0, std::numeric_limits<double>::infinity()}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { fpu_law<3>(chain, bad); }, {"spread", "not negative"}));
  }
}

BOOST_AUTO_TEST_CASE(soft_dominated_starts_hold_omega_squared_in_the_soft_springs) {
  const auto soft = fpu_law<3>::soft_dominated(chain);
  double stiff = 0.0;
  for (std::uint64_t n = 0; n < 1000; ++n) {
    const auto x = soft(seed(3), n);
    const double energy_of_soft = 0.5 * x.p.squaredNorm() + chain.potential(x.q) - chain.stiff_energy(x);
    // The springs at the ends are shorter and longer by x_1: with x_0 = sqrt(omega) their share, a half,
    // changes by 2 (x_1 of the last pair - x_1 of the first)/x_0, of deviation 2 sqrt 2/omega^(3/2) = .008,
    // here halved.
    BOOST_TEST(std::abs(energy_of_soft / (omega * omega) - 1.0) <=
               6.0 * std::sqrt(2.0) / std::pow(omega, 1.5));  // six: one of 1000 beyond in 2e-6 of runs
    BOOST_TEST(std::abs(energy_of_soft - (law(seed(3), n).p.squaredNorm())) >
               1e3);  // the paper's starts hold little
    stiff += chain.stiff_energy(x) / 1000.0;
  }
  BOOST_TEST(std::abs(stiff - 4.5) <= 0.5);  // as of the paper's starts: 3 (1 + 1/2 + ...); 7 standard errors
  BOOST_TEST(soft.description() == "fpu_law(omega=50, x_0=7.0710678118654755, y_0=28.86751345948129)");
  BOOST_TEST(refuses<std::invalid_argument>(
      [] {
        fpu_law<3>(chain, 1.0, {std::nan(""), 1.0});
      },
      {"soft", "finite"}));
}
