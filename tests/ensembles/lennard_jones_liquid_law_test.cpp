// SPDX-License-Identifier: BSL-1.0
// A crystal that fills the box, heated, at rest as a whole.
#include "nysalt/ensembles/lennard_jones_liquid_law.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(atoms_are_on_sites_of_a_crystal) {
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

BOOST_AUTO_TEST_CASE(the_whole_rests_and_has_the_temperature) {
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
