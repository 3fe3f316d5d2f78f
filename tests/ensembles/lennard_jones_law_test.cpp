// SPDX-License-Identifier: BSL-1.0
// Clusters begin at rest as a whole, with the kinetic energy of what is left.
#include "nysalt/ensembles/lennard_jones_law.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/energy.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

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

}  // namespace

BOOST_AUTO_TEST_CASE(the_whole_neither_moves_nor_turns) {
  for (const auto& [space, atoms, directions] : clusters) {
    const lennard_jones<> system(space, atoms);
    const lennard_jones_law law(system, 0.1);
    for (std::uint64_t n = 0; n < 20; ++n) {
      const auto x = law(1, n);
      // A few roundings of each of at most six projections, of a sum over coordinates up to 2.
      BOOST_TEST(motion_of_the_whole(x, space) <= 50.0 * static_cast<double>(x.size()) * eps);
      BOOST_TEST(x.q == cluster_at_rest(system));
    }
  }
}

// 2 K/kT is the sum of that many squares of standard normals: of mean n and variance 2 n.
BOOST_AUTO_TEST_CASE(what_is_left_has_the_temperature) {
  constexpr std::uint64_t count = 10'000;
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
               allowed);  // 12 standard errors and more
  }
}

BOOST_AUTO_TEST_CASE(it_is_the_same_whether_the_size_is_in_the_type) {
  const lennard_jones_law by_type(lennard_jones<2, 7>(), 0.1);
  const lennard_jones_law by_number(lennard_jones<>(2, 7), 0.1);
  BOOST_TEST((by_type(5, 7).q == by_number(5, 7).q && by_type(5, 7).p == by_number(5, 7).p));
  BOOST_TEST(!same_bits(by_type(5, 7), by_type(5, 8)));
  BOOST_TEST(!same_bits(by_type(5, 7), by_type(6, 7)));
  BOOST_TEST(by_type.description() == "lennard_jones_law(temperature=0.1)");
}

BOOST_AUTO_TEST_CASE(temperatures_that_cannot_be_are_refused) {
  for (const double bad : {-0.1, std::numeric_limits<double>::infinity()}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { lennard_jones_law(lennard_jones<2, 3>(), bad); },
                                              {"temperature", "not negative"}));
  }
}
