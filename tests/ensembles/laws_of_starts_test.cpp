// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 5.6 s at -O0, 0.1 s at -O1.
// Initial laws have their moments: the paper's chain, Kepler's ellipses, and states around those that the
// user gives. Each is a function of seed and number.
#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/kepler_law.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"

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

namespace {

/// Towards the pericentre, of length e: p x L - q/|q|.
vector<double, 2> eccentricity_vector(const phase_point<double, 2>& x) {
  const double angular = x.q[0] * x.p[1] - x.q[1] * x.p[0];
  return vector<double, 2>(x.p[1] * angular, -x.p[0] * angular) - x.q / x.q.norm();
}

/// Some 30 roundings, of terms as large as 1/|q| <= 1/(1 - e).
double rounding(double e) { return 30.0 * eps / (1.0 - e); }

}  // namespace

BOOST_AUTO_TEST_CASE(the_ellipses_have_axis_1_and_the_eccentricity) {
  for (const double e : {0.0, 0.3, 0.6, 0.95}) {
    const kepler_law law(e);
    for (std::uint64_t n = 0; n < 100; ++n) {
      const auto x = law(3, n);
      const double angular = x.q[0] * x.p[1] - x.q[1] * x.p[0];
      BOOST_TEST(std::abs(energy<double>(kepler(), x) + 0.5) <= rounding(e));
      BOOST_TEST(std::abs(angular - std::sqrt(1.0 - e * e)) <= rounding(e));  // counterclockwise
      BOOST_TEST(std::abs(eccentricity_vector(x).norm() - e) <= rounding(e));
    }
  }
}

// Means over time: of r 1 + e^2/2, of r^2 1 + 3 e^2/2. Over E, uniform, they were 1 and 1 + e^2/2.
BOOST_AUTO_TEST_CASE(times_are_uniform) {
  for (const double e : {0.6, 0.95}) {
    const kepler_law law(e);
    std::vector<double> radius;
    for (std::uint64_t n = 0; n < count; ++n) radius.push_back(law(seed(1), n).q.norm());
    const double deviation = std::sqrt(1.0 + 1.5 * e * e - std::pow(1.0 + 0.5 * e * e, 2));
    const double allowed = standard_errors(false_alarms / 2);
    BOOST_TEST(mean_off(radius, 1.0 + 0.5 * e * e, deviation) <= allowed);
    BOOST_TEST(mean_off(radius, 1.0, deviation) > allowed);
  }
}

BOOST_AUTO_TEST_CASE(orientations_are_uniform_and_independent_of_times) {
  const kepler_law law(0.6);
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> in_or_out;  // the radial velocity: 0 in the mean
  for (std::uint64_t n = 0; n < count; ++n) {
    const auto start = law(seed(2), n);
    const vector<double, 2> axis = eccentricity_vector(start) / 0.6;
    x.push_back(axis[0]);
    y.push_back(axis[1]);
    in_or_out.push_back(start.q.dot(start.p));
  }
  const double deviation = std::sqrt(0.5);  // of a cosine
  const double root = std::sqrt(static_cast<double>(count));
  const double allowed = standard_errors(false_alarms / 5);
  BOOST_TEST(mean_off(x, 0.0, deviation) <= allowed);
  BOOST_TEST(mean_off(y, 0.0, deviation) <= allowed);
  BOOST_TEST(std::abs(correlation(x, y)) * root <= allowed);
  BOOST_TEST(std::abs(correlation(x, in_or_out)) * root <= allowed);
  BOOST_TEST(std::abs(mean(in_or_out)) * root <= allowed * std::sqrt(covariance(in_or_out, in_or_out)));
}

BOOST_AUTO_TEST_CASE(what_is_no_ellipse_is_refused) {
  for (const double e : {1.0, -0.1, 2.0, std::numeric_limits<double>::quiet_NaN()}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { kepler_law{e}; }, {"eccentricity", "below 1"}));
  }
}

namespace {
const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinite = std::numeric_limits<double>::infinity();
using point = phase_point<double, 2>;
const point centre{{1.0, 2.0}, {3.0, 4.0}};
using wrong = std::invalid_argument;
const normal_around<2> cloud(centre, 0.5, 0.1);
}  // namespace

BOOST_AUTO_TEST_CASE(listed_states_come_in_their_order_and_no_further) {
  const point other{{5.0, 6.0}, {7.0, 8.0}};
  const listed<2> two({centre, other});
  BOOST_TEST(same_bits(two(1, 0), centre));
  BOOST_TEST(same_bits(two(2, 0), centre));  // the seed is of no account
  BOOST_TEST(same_bits(two(1, 1), other));
  BOOST_TEST(refuses<std::out_of_range>([&] { two(1, 2); }, {"listed", "number 3 of 2"}));
  BOOST_TEST(refuses<std::out_of_range>([] { listed<2>({})(1, 0); }, {"number 1 of 0"}));
  BOOST_TEST(two.description() == "listed(2 states)");
}

BOOST_AUTO_TEST_CASE(normal_around_has_the_given_mean_and_deviations) {
  const double allowed = standard_errors(false_alarms / 10);  // two coordinates, five comparisons
  for (int i = 0; i < 2; ++i) {
    std::vector<double> q;
    std::vector<double> p;
    for (std::uint64_t n = 0; n < count; ++n) {
      const point x = cloud(seed(3), n);
      q.push_back(x.q[i]);
      p.push_back(x.p[i]);
    }
    BOOST_TEST(mean_off(q, centre.q[i], 0.5) <= allowed);
    BOOST_TEST(mean_off(p, centre.p[i], 0.1) <= allowed);
    BOOST_TEST(deviation_off(q, 0.5) <= allowed);
    BOOST_TEST(deviation_off(p, 0.1) <= allowed);
    BOOST_TEST(deviation_off(q, 0.1) > allowed);
    BOOST_TEST(std::abs(correlation(q, p)) * std::sqrt(static_cast<double>(count)) <= allowed);
  }
}

BOOST_AUTO_TEST_CASE(without_deviation_it_is_the_centre) {
  BOOST_TEST(same_bits(normal_around<2>(centre, 0.0, 0.0)(1, 1), centre));
}

BOOST_AUTO_TEST_CASE(deviations_and_centres_that_cannot_be_are_refused) {
  for (const double bad : {-0.1, not_a_number, infinite}) {
    BOOST_TEST(
        refuses<wrong>([&] { normal_around<2>(centre, bad, 0.1); }, {"normal_around", "deviations must be"}));
    BOOST_TEST(
        refuses<wrong>([&] { normal_around<2>(centre, 0.1, bad); }, {"normal_around", "deviations must be"}));
  }
  const point nowhere{{not_a_number, 0.0}, {0.0, 0.0}};
  BOOST_TEST(refuses<wrong>([&] { normal_around<2>(nowhere, 0.1, 0.1); },
                            {"normal_around", "centre must be finite"}));
}

BOOST_AUTO_TEST_CASE(a_start_is_a_function_of_seed_and_number) {
  const auto check = [](const auto& starts, std::string_view description) {
    BOOST_TEST_CONTEXT(description) {
      for (const std::uint64_t n : {0U, 1U, 41U}) {
        BOOST_TEST(same_bits(starts(5, n), starts(5, n)));
        BOOST_TEST(!same_bits(starts(5, n), starts(5, n + 1)));
        BOOST_TEST(!same_bits(starts(5, n), starts(6, n)));
        BOOST_TEST(!same_bits(starts(5, n + 1), starts(6, n)));
      }
      BOOST_TEST(starts.description() == description);
    }
  };
  check(law, "fpu_law(omega=50)");
  check(kepler_law(0.6), "kepler_law(eccentricity=0.6)");
  check(cloud, cloud.description());
  const fpu_law<Eigen::Dynamic> dynamic(fpu_chain<>(3, omega));  // has the bits of the size as a type
  BOOST_TEST((law(5, 41).q == dynamic(5, 41).q && law(5, 41).p == dynamic(5, 41).p));
}
