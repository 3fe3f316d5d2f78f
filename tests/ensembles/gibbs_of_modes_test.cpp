// SPDX-License-Identifier: BSL-1.0
// The Gibbs law of linear systems, without chains.
#include "nysalt/ensembles/gibbs_of_modes.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/dense.hpp"
#include "../support/refusal.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

struct two_masses {  // joined to a wall and to each other, of masses 1 and 4
  static constexpr int dimension = 2;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    return (q[0] * q[0] + (q[1] - q[0]) * (q[1] - q[0])) * 0.5;
  }
  double inverse_mass(Eigen::Index i) const { return i == 0 ? 1.0 : 0.25; }
  normal_modes modes() const {
    Eigen::Matrix2d stiffness;  // M^{-1/2} K M^{-1/2}
    stiffness << 2.0, -0.5, -0.5, 0.25;
    const symmetric_eigen solved(stiffness);
    return {solved.vectors, solved.values.cwiseSqrt()};
  }
};

constexpr int states = 4000;
/// Of a normal variance, one of `comparisons`.
double allowed(int comparisons) {
  return nysalt::test::standard_errors(nysalt::test::false_alarms / comparisons) * std::sqrt(2.0 / states);
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_mode_has_the_temperature) {
  const auto chain = linear_chain::between_walls(100, 1.0);
  const normal_modes modes = chain.modes();
  const gibbs_of_modes<Eigen::Dynamic> law(chain, 0.7);
  Eigen::VectorXd of_x = Eigen::VectorXd::Zero(100);
  Eigen::VectorXd of_y = Eigen::VectorXd::Zero(100);
  for (int n = 0; n < states; ++n) {
    const auto start = law(seed(3), static_cast<std::uint64_t>(n));
    const Eigen::VectorXd x = modes.basis.transpose() * start.q;
    const Eigen::VectorXd y = modes.basis.transpose() * start.p;
    of_x += x.cwiseProduct(modes.frequencies).cwiseAbs2() / (0.7 * states);
    of_y += y.cwiseAbs2() / (0.7 * states);
  }
  const double error = allowed(200);
  BOOST_TEST((of_x.array() - 1.0).abs().maxCoeff() < error);
  BOOST_TEST((of_y.array() - 1.0).abs().maxCoeff() < error);
  BOOST_TEST((of_x.array() - 1.3).abs().minCoeff() > error);  // no mode has another temperature
}

// <q_i f_i> = -kT and <p_i^2> = m_i kT, masses or not.
BOOST_AUTO_TEST_CASE(masses_share_the_temperature) {
  const two_masses system;
  const gibbs_of_modes<2> law(system, 2.0);
  Eigen::Array4d means = Eigen::Array4d::Zero();
  for (int n = 0; n < states; ++n) {
    const auto x = law(seed(5), static_cast<std::uint64_t>(n));
    vector<double, 2> f;
    force<double>(system, x.q, f);
    means += Eigen::Array4d(-x.q[0] * f[0], -x.q[1] * f[1], x.p[0] * x.p[0], x.p[1] * x.p[1] / 4.0) / states;
  }
  // Var(q f) of correlated normal q and f is kT^2 (1 + q^2 f^2 correlation) <= 3 kT^2 here.
  const double of_virial = 2.0 * allowed(4) * std::sqrt(1.5);
  BOOST_TEST((means.head<2>() - 2.0).abs().maxCoeff() < of_virial);
  BOOST_TEST((means.tail<2>() - 2.0).abs().maxCoeff() < 2.0 * allowed(4));
  BOOST_TEST(std::abs(4.0 * means[3] - 2.0) > 2.0 * allowed(4));  // without its mass
}

BOOST_AUTO_TEST_CASE(what_is_not_linear_or_has_no_temperature_is_refused) {
  const auto chain = linear_chain::between_walls(4, 1.0);
  using wrong = std::invalid_argument;
  using of_chain = gibbs_of_modes<Eigen::Dynamic>;
  BOOST_TEST(refuses<wrong>([&] { of_chain(chain, 0.0); }, {"temperature", "above 0"}));
  BOOST_TEST(refuses<wrong>([&] { of_chain(chain, -1.0); }, {"linear_chain", "temperature"}));
  BOOST_TEST(refuses<wrong>([] { gibbs_of_modes<6>(fpu_chain<3>(50.0), 1.0); }, {"exact_linear"}));
}
