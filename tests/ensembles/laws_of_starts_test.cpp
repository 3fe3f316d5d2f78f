// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 5.6 s at -O0, 0.1 s at -O1.
// Initial laws have their moments: the paper's chain, Kepler's ellipses, clusters at rest as a whole, a
// liquid that begins as a crystal, and states around those that the user gives. Each is a function of seed
// and number.
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/given_states.hpp"

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

/// Towards the pericentre, of length e: p x L - q/|q|.
vector<double, 2> eccentricity_vector(const phase_point<double, 2>& x) {
  const double angular = x.q[0] * x.p[1] - x.q[1] * x.p[0];
  return vector<double, 2>(x.p[1] * angular, -x.p[0] * angular) - x.q / x.q.norm();
}

/// Some 30 roundings, of terms as large as 1/|q| <= 1/(1 - e).
double rounding(double e) { return 30.0 * eps / (1.0 - e); }

/// The largest total momentum and angular momentum along any axis.
double motion_of_the_whole(const phase_point<double, Eigen::Dynamic>& x, Eigen::Index space) {
  double largest = 0.0;
  for (Eigen::Index a = 0; a < space; ++a) {
    double momentum = 0.0;
    for (Eigen::Index i = 0; i < x.size(); i += space) momentum += x.p[i + a];
    largest = std::max(largest, std::abs(momentum));
    for (Eigen::Index b = a + 1; b < space; ++b) {
      double angular = 0.0;
      for (Eigen::Index i = 0; i < x.size(); i += space) {
        angular += x.q[i + a] * x.p[i + b] - x.q[i + b] * x.p[i + a];
      }
      largest = std::max(largest, std::abs(angular));
    }
  }
  return largest;
}

struct cluster {
  Eigen::Index space;
  Eigen::Index atoms;
  Eigen::Index directions;  // that are left
};
/// Two and three atoms lie on a line, or in a plane, of the space.
const std::vector<cluster> clusters{{2, 2, 1}, {2, 7, 11}, {3, 2, 1}, {3, 3, 3}, {3, 13, 33}};

using point = phase_point<double, 2>;
const point centre{{1.0, 2.0}, {3.0, 4.0}};
const normal_around<2> cloud(centre, 0.5, 0.1);

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

BOOST_AUTO_TEST_CASE(modes_trajectories_and_seeds_are_independent) {
  const double allowed = standard_errors(false_alarms / 8);
  const auto one = sample(seed(1), 3, false);
  const auto two = sample(seed(2), 3, false);
  for (const auto& other :
       {sample(seed(1), 4, false), sample(seed(1), 3, true), sample(seed(1), 3, false, 1), two})
    BOOST_TEST(correlation_off(one, other) <= allowed);
  for (const std::uint64_t shift : {1U, 2U}) {  // another seed is no shift of the numbers
    BOOST_TEST(correlation_off(one, sample(seed(2), 3, false, shift)) <= allowed);
    BOOST_TEST(correlation_off(sample(seed(1), 3, false, shift), two) <= allowed);
  }
  BOOST_TEST(correlation_off(one, one) > allowed);
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
}

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
  const double allowed = standard_errors(false_alarms / 5);
  BOOST_TEST(mean_off(x, 0.0, deviation) <= allowed);
  BOOST_TEST(mean_off(y, 0.0, deviation) <= allowed);
  BOOST_TEST(correlation_off(x, y) <= allowed);
  BOOST_TEST(correlation_off(x, in_or_out) <= allowed);
  BOOST_TEST(mean_off(in_or_out, 0.0, std::sqrt(covariance(in_or_out, in_or_out))) <= allowed);
}

BOOST_AUTO_TEST_CASE(the_whole_neither_moves_nor_turns) {
  for (const auto& [space, atoms, directions] : clusters) {
    const lennard_jones<> system(space, atoms);
    const lennard_jones_law law(system, 0.1);
    for (std::uint64_t n = 0; n < 20; ++n) {
      const auto x = law(1, n);
      // A few roundings of each of at most six projections, of a sum over coordinates up to 2.
      BOOST_TEST(motion_of_the_whole(x, space) <= 50.0 * static_cast<double>(x.size()) * eps);
      BOOST_TEST(x.q == detail::cluster_at_rest(system));
    }
  }
}

// 2 K/kT is the sum of that many squares of standard normals: of mean n and variance 2 n.
BOOST_AUTO_TEST_CASE(what_is_left_has_the_temperature) {
  constexpr double temperature = 0.3;
  const double allowed = standard_errors(false_alarms / 5);  // five clusters
  for (const auto& [space, atoms, directions] : clusters) {
    const lennard_jones<> system(space, atoms);
    const lennard_jones_law law(system, temperature);
    std::vector<double> squares;
    for (std::uint64_t n = 0; n < count; ++n) {
      squares.push_back(2.0 * kinetic_energy<double>(system, law(seed(1), n).p) / temperature);
    }
    const auto left = static_cast<double>(directions);
    BOOST_TEST(mean_off(squares, left, std::sqrt(2.0 * left)) <= allowed);
    BOOST_TEST(mean_off(squares, left + 1.0, std::sqrt(2.0 * left)) >
               allowed);  // 17 standard errors and more
  }
}

BOOST_AUTO_TEST_CASE(atoms_of_a_liquid_are_on_sites_of_a_crystal) {
  for (const Eigen::Index atoms : {256, 251, 300}) {  // with 0, 5 and 200 vacancies
    const lennard_jones_liquid system(atoms, 0.8);
    const Eigen::VectorXd q = lennard_jones_liquid_law(system, 1.0)(1, 0).q;
    const double cells = atoms > 256 ? 5.0 : 4.0;
    const double nearest = system.side() / cells / std::sqrt(2.0);
    double least = system.side();
    for (Eigen::Index i = 0; i < atoms; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        Eigen::Vector3d d = q.segment<3>(3 * i) - q.segment<3>(3 * j);
        for (double& along : d) along -= system.side() * std::nearbyint(along / system.side());
        least = std::min(least, d.norm());
      }
    }
    BOOST_TEST(std::abs(least - nearest) <= 8.0 * eps * system.side());
    BOOST_TEST(q.minCoeff() >= 0.0);
    BOOST_TEST(q.maxCoeff() < system.side());
  }
}

BOOST_AUTO_TEST_CASE(a_liquid_as_a_whole_rests_and_has_the_temperature) {
  const lennard_jones_liquid system(256, 0.8);
  const lennard_jones_liquid_law law(system, 1.44);
  double sum = 0.0;
  constexpr int starts = 200;
  for (std::uint64_t n = 0; n < starts; ++n) {
    const auto x = law(seed(3), n);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      double momentum = 0.0;
      for (Eigen::Index i = axis; i < x.size(); i += 3) momentum += x.p[i];
      // The mean is rounded by 256 eps of some 2, and so is the sum.
      BOOST_TEST(std::abs(momentum) <= 2.0 * 256.0 * 256.0 * eps * 2.0);
    }
    sum += x.p.squaredNorm() / 1.44;
  }
  // A sum of that many squares of standard normals, of variance twice their number.
  const double directions = starts * 3.0 * 255.0;
  const double allowed = standard_errors(false_alarms) * std::sqrt(2.0 * directions);
  BOOST_TEST(std::abs(sum - directions) <= allowed);
  BOOST_TEST(std::abs(1.05 * sum - directions) > allowed);  // 5 % too hot: 14 standard deviations
}

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
    BOOST_TEST(correlation_off(q, p) <= allowed);
  }
  BOOST_TEST(same_bits(normal_around<2>(centre, 0.0, 0.0)(1, 1), centre));
}

BOOST_AUTO_TEST_CASE(laws_that_cannot_be_are_refused) {
  for (const double bad : {-0.1, infinite}) {
    BOOST_TEST(refuses([&] { fpu_law<3>(chain, bad); }, {"spread", "not negative"}));
    BOOST_TEST(refuses([&] { normal_around<2>(centre, bad, 0.1); }, {"deviations must be"}));
    BOOST_TEST(refuses([&] { normal_around<2>(centre, 0.1, bad); }, {"deviations must be"}));
    BOOST_TEST(
        refuses([&] { lennard_jones_law(lennard_jones<2, 3>(), bad); }, {"temperature", "not negative"}));
  }
  BOOST_TEST(refuses([] { normal_around<2>(centre, not_a_number, 0.1); }, {"deviations must be"}));
  const point nowhere{{not_a_number, 0.0}, {0.0, 0.0}};
  BOOST_TEST(
      refuses([&] { normal_around<2>(nowhere, 0.1, 0.1); }, {"normal_around", "centre must be finite"}));
  const fpu_law<3>::soft_motion nowhere_soft{not_a_number, 1.0};
  BOOST_TEST(refuses([&] { fpu_law<3>(chain, 1.0, nowhere_soft); }, {"soft", "finite"}));
  for (const double e : {1.0, -0.1, 2.0, not_a_number}) {
    BOOST_TEST(refuses([&] { kepler_law{e}; }, {"eccentricity", "below 1"}));
  }
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
  check(lennard_jones_liquid_law(lennard_jones_liquid(256, 0.8), 1.44),
        "lennard_jones_liquid_law(temperature=1.44)");
  const lennard_jones_law cluster(lennard_jones<2, 7>(), 0.1);
  check(cluster, "lennard_jones_law(temperature=0.1)");
  // The size as a type has the bits of the size as a number.
  const fpu_law<Eigen::Dynamic> chain_by_number(fpu_chain<>(3, omega));
  const lennard_jones_law cluster_by_number(lennard_jones<>(2, 7), 0.1);
  BOOST_TEST(same_bits(law(5, 41), chain_by_number(5, 41)));
  BOOST_TEST(same_bits(cluster(5, 7), cluster_by_number(5, 7)));
}
