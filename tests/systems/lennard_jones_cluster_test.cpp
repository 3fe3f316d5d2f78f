// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 1.3 s at -O0, 0.1 s at -O1.
// Clusters are at rest, and of the energies that their shapes have.
#include "nysalt/systems/lennard_jones_cluster.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/dense.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

struct distances {
  double pairs;
  double length;  // of each
};

/// The least of 4 sum (r^-12 - r^-6) over the scale of a shape: with S_k = sum length^-k it is
/// -S_6^2/S_12. A shape whose only free length is its scale is in equilibrium there.
double least_energy(const std::vector<distances>& shape) {
  double sixth = 0.0;
  double twelfth = 0.0;
  for (const auto& [pairs, length] : shape) {
    sixth += pairs * std::pow(length, -6);
    twelfth += pairs * std::pow(length, -12);
  }
  return -sixth * sixth / twelfth;
}

/// At rest to 1e-12 in each force: the energy errs by the square of that, and rounds.
double energy_off(Eigen::Index space, Eigen::Index atoms, double expected) {
  const lennard_jones<> system(space, atoms);
  return std::abs(system.potential(cluster_at_rest(system)) - expected) / (100.0 * eps * std::abs(expected));
}

const double golden = 0.5 * (1.0 + std::sqrt(5.0));
const double radius = 0.5 * std::sqrt(golden * golden + 1.0);  // of the icosahedron of edge 1

}  // namespace

BOOST_AUTO_TEST_CASE(shapes_have_the_energies_that_their_distances_give) {
  BOOST_TEST(energy_off(2, 2, -1.0) <= 1.0);
  BOOST_TEST(energy_off(2, 3, -3.0) <= 1.0);
  BOOST_TEST(energy_off(3, 4, -6.0) <= 1.0);
  // Centred hexagon, -12.53: six spokes and six sides, six that skip one, three across.
  const double hexagon = least_energy({{12.0, 1.0}, {6.0, std::sqrt(3.0)}, {3.0, 2.0}});
  BOOST_TEST(energy_off(2, 7, hexagon) <= 1.0);
  BOOST_TEST(std::abs(hexagon + 12.53) < 0.005);
  // Icosahedron with an atom in its centre, -44.33: twelve spokes, thirty edges, thirty diagonals, six
  // across.
  const double icosahedron = least_energy({{12.0, radius}, {30.0, 1.0}, {30.0, golden}, {6.0, 2.0 * radius}});
  BOOST_TEST(energy_off(3, 13, icosahedron) <= 1.0);
  BOOST_TEST(std::abs(icosahedron + 44.33) < 0.005);
  BOOST_TEST(energy_off(3, 13, icosahedron * (1.0 + 1e-9)) > 1.0);
}

// The octahedron, which this growth does not find: eight faces make no tetrahedra.
BOOST_AUTO_TEST_CASE(a_cluster_need_not_be_the_lowest) {
  const double octahedron = least_energy({{12.0, 1.0}, {3.0, std::sqrt(2.0)}});
  const lennard_jones<> six(3, 6);
  BOOST_TEST(six.potential(cluster_at_rest(six)) > octahedron + 0.1);
}

BOOST_AUTO_TEST_CASE(clusters_rest_around_the_origin) {
  for (const Eigen::Index space : {2, 3}) {
    for (const Eigen::Index atoms : {2, 3, 4, 6, 9, 14, 20}) {
      const lennard_jones<> system(space, atoms);
      const Eigen::VectorXd q = cluster_at_rest(system);
      Eigen::VectorXd f(q.size());
      system.force(q, f);
      // To 1e-12, and the shift of the centre rounds distances, of stiffness 57 to each of some 12
      // neighbours.
      BOOST_TEST(f.cwiseAbs().maxCoeff() <= 1e-12 + 12.0 * 57.0 * 8.0 * eps);
      for (Eigen::Index axis = 0; axis < space; ++axis) {
        double sum = 0.0;
        for (Eigen::Index i = axis; i < q.size(); i += space) sum += q[i];
        BOOST_TEST(std::abs(sum) <= 8.0 * static_cast<double>(atoms) * eps);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(it_is_a_minimum) {
  for (const auto& [space, atoms] : {std::pair{2, 7}, {3, 13}}) {
    const lennard_jones<> system(space, atoms);
    const Eigen::VectorXd q = cluster_at_rest(system);
    const Eigen::Index rigid = space == 2 ? 3 : 6;
    const Eigen::VectorXd stiffness = symmetric_eigen(hessian(system, q)).values;
    const double unit = static_cast<double>(q.size()) * eps * stiffness.tail(1)[0] + 1e-11;  // and the force
    BOOST_TEST(stiffness.head(rigid).cwiseAbs().maxCoeff() <= 8.0 * unit);
    BOOST_TEST(stiffness[rigid] > 1.0);
  }
}
