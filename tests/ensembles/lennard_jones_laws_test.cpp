// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 3.5 s at -O0, 0.1 s at -O1.
// Clusters begin at rest as a whole, with the kinetic energy of what is left; a liquid begins as a crystal
// that fills the box, heated.
#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/ensembles/lennard_jones_law.hpp"
#include "nysalt/ensembles/lennard_jones_liquid_law.hpp"

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
  BOOST_TEST(std::abs(1.05 * sum - directions) >
             allowed);  // a temperature 5 % too high: 14 standard deviations
  BOOST_TEST(same_bits(law(3, 5), law(3, 5)));
  BOOST_TEST(!same_bits(law(3, 5), law(3, 6)));
  BOOST_TEST(!same_bits(law(3, 5), law(4, 5)));
  BOOST_TEST(law.description() == "lennard_jones_liquid_law(temperature=1.44)");
}
