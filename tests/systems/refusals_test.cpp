// SPDX-License-Identifier: BSL-1.0
// Systems that cannot be are refused with a sentence; what systems say of themselves.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/systems.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/gaussian.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/kepler.hpp"
#include "nysalt/systems/lennard_jones_cluster.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/logistic_regression.hpp"
#include "nysalt/systems/phi4_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

struct refusal {
  std::function<void()> made;
  std::vector<std::string> words;
};

std::vector<refusal> refusals() {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::MatrixXd rows = Eigen::MatrixXd::Ones(2, 1);
  const Eigen::Vector2d labels(0.0, 1.0);
  const auto chain = [](const Eigen::MatrixXd& k) { return [=] { linear_chain{k}; }; };
  const auto logistic = [](const Eigen::MatrixXd& x, const Eigen::VectorXd& y, double variance) {
    return [=] { logistic_regression(x, y, variance); };
  };
  std::vector<refusal> all{
      {[] { fpu_chain<>(0, 1.0); }, {"pairs must be", "got 0"}},
      {[] { fpu_chain<3>(2, 1.0); }, {"pairs must be", "got 2"}},
      {[] { phi4_chain<>(0); }, {"masses must be", "got 0"}},
      {[] { phi4_chain<3>(2); }, {"masses must be", "got 2"}},
      {[] { lennard_jones<>(4, 7); }, {"dimension must be 2 or 3", "got 4"}},
      {[] { lennard_jones<2, 7>(3, 7); }, {"dimension", "3"}},
      {[] { lennard_jones<>(2, 1); }, {"atoms must be >= 2", "got 1"}},
      {[] { lennard_jones<2, 7>(2, 8); }, {"got 8"}},
      {chain(Eigen::MatrixXd(2, 3)), {"square", "2 x 3"}},
      {chain(Eigen::MatrixXd(0, 0)), {"square"}},
      {chain(Eigen::Matrix2d{{1.0, 0.5}, {0.4, 1.0}}), {"symmetric"}},
      {chain(Eigen::Matrix2d{{1.0, not_a_number}, {not_a_number, 1.0}}), {"must be finite"}},
      {chain(Eigen::Matrix2d{{1.0, 2.0}, {2.0, 1.0}}), {"must be >= 0, got -"}},
      {[=] { linear_chain(one, Eigen::Vector3d::Ones()); }, {"positive and finite, 2 of them"}},
      {[] { gaussian{Eigen::VectorXd()}; }, {"frequencies", "got 0"}},
      {logistic(rows, Eigen::Vector3d(0.0, 1.0, 1.0), 1.0), {"logistic_regression"}},
      {logistic(Eigen::MatrixXd(), Eigen::VectorXd(), 1.0), {"logistic_regression"}},
      {logistic(rows * not_a_number, labels, 1.0), {"logistic_regression"}},
      {logistic(rows, Eigen::Vector2d(0.0, 2.0), 1.0), {"logistic_regression"}},
  };
  for (const Eigen::Index masses : {0, -1, -1'000'000}) {
    all.push_back(
        {[=] { linear_chain::between_walls(masses, 1.0); }, {"at least one mass", std::to_string(masses)}});
  }
  for (const double bad : {0.0, -1.0, infinite, not_a_number}) {
    all.push_back({[=] { harmonic_oscillator{bad}; }, {"omega", "positive"}});
    all.push_back({[=] { fpu_chain<3>{bad}; }, {"omega", "positive"}});
    all.push_back(
        {[=] { linear_chain(one, Eigen::Vector2d(1.0, bad)); }, {"positive and finite, 2 of them"}});
    all.push_back({[=] { linear_chain::between_walls(3, bad); }, {"spring and mass", "positive"}});
    all.push_back({[=] { linear_chain::between_walls(3, 1.0, bad); }, {"spring and mass", "positive"}});
    all.push_back({[=] { gaussian(Eigen::Vector2d(1.0, bad)); }, {"positive and finite"}});
    all.push_back({logistic(rows, labels, bad), {"logistic_regression"}});
  }
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(systems_that_cannot_be_are_refused) {
  for (const auto& [made, words] : refusals()) {
    BOOST_TEST_CONTEXT("words " << words.front()) {
      BOOST_TEST(refuses<std::invalid_argument>(made, {words.front(), words.back()}));
    }
  }
}

BOOST_AUTO_TEST_CASE(systems_that_can_be_are_not) {
  BOOST_TEST(fpu_chain<>(4, 1.0).size() == 8);
  BOOST_TEST(phi4_chain<>(4).size() == 4);
  BOOST_TEST(lennard_jones<>(3, 5).size() == 15);
  BOOST_TEST(linear_chain(Eigen::MatrixXd::Ones(2, 2)).modes().frequencies[0] == 0.0);  // singular is allowed
  BOOST_TEST(linear_chain::between_walls(1, 2.0).modes().frequencies[0] == 2.0);
  BOOST_CHECK_NO_THROW(logistic_regression(Eigen::MatrixXd::Ones(2, 1), Eigen::Vector2d(0.0, 1.0), 1.0));
}

BOOST_AUTO_TEST_CASE(a_chain_between_walls_has_the_known_frequencies) {
  const auto modes = linear_chain::between_walls(3, 2.0, 0.5).modes();
  for (int k = 0; k < 3; ++k) {  // w = 2 sqrt(spring/mass) sin(k pi/(2 (n + 1)))
    const double expected = 4.0 * std::sin((k + 1) * std::acos(-1.0) / 8.0);
    BOOST_TEST(std::abs(modes.frequencies[k] - expected) <=
               8.0 * 3 * std::numeric_limits<double>::epsilon() * 4);
  }
}

// The paper's formula, term by term, in the coordinates of the modes.
BOOST_AUTO_TEST_CASE(the_stiff_energy_is_that_of_the_stiff_modes) {
  const fpu_chain<3> chain(50.0);
  draws random;
  const auto x = random.state(chain, 1.0);
  const auto modes = chain.modes();
  double sum = 0.0;
  for (int j = 0; j < 3; ++j) {
    const double x1 = modes.basis.col(3 + j).dot(x.q);
    const double y1 = modes.basis.col(3 + j).dot(x.p);
    const double expected = 0.5 * (y1 * y1 + 2500.0 * x1 * x1);
    sum += expected;
    BOOST_TEST(chain.stiff_energy(x, j) == expected, boost::test_tools::tolerance(1e-14));  // 20 roundings
  }
  BOOST_TEST(chain.stiff_energy(x) == sum, boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(systems_say_what_they_are) {
  BOOST_TEST(describe(harmonic_oscillator(2.0)) == "harmonic_oscillator(omega=2)");
  BOOST_TEST(describe(fpu_chain<3>(50.0)) == "fpu_chain(pairs=3, omega=50)");
  BOOST_TEST(describe(fpu_chain<>(3, 50.0)) == describe(fpu_chain<3>(50.0)));
  BOOST_TEST(describe(kepler()) == "kepler()");
  BOOST_TEST(describe(phi4_chain<4>()) == "phi4_chain(masses=4)");
  BOOST_TEST(describe(lennard_jones<2, 7>()) == "lennard_jones(space=2, atoms=7)");
  BOOST_TEST(describe(lennard_jones<>(2, 7)) == describe(lennard_jones<2, 7>()));
  // FNV-1a as published, over the bytes of K and the inverse masses, by another program.
  BOOST_TEST(describe(linear_chain(Eigen::MatrixXd::Constant(1, 1, 4.0))) ==
             "linear_chain(masses=1, omega_max=2, fingerprint=2668491c07f49808)");
  Eigen::MatrixXd k(2, 2);
  k << 2.0, -1.0, -1.0, 2.0;
  BOOST_TEST(describe(linear_chain(k, Eigen::Vector2d(1.0, 4.0))).find("fingerprint=84492e0f2b897ac5)") !=
             std::string::npos);
  BOOST_TEST(describe(dynamic_potential{4}).find("4 degrees of freedom") != std::string::npos);
}

// Margins at which exp() would overflow, and descriptions that differ where the data differ.
BOOST_AUTO_TEST_CASE(a_logistic_regression_is_finite_far_out_and_known_by_its_data) {
  const Eigen::MatrixXd rows{{1.0, 0.5, -2.0}, {1.0, -1.5, 0.3}, {1.0, 2.0, 1.0}, {1.0, 0.1, -0.7}};
  const logistic_regression posterior(rows, Eigen::Vector4d(1.0, 0.0, 1.0, 0.0), 4.0);
  const Eigen::Vector3d far(3000.0, -2000.0, 1000.0);
  // log(1 + exp(m)) = m to rounding for the two rows that are on the wrong side.
  const auto tail = [](double margin) { return std::max(-margin, 0.0); };
  const double expected = tail(3000.0 - 1000.0 - 2000.0) + tail(-(3000.0 + 3000.0 + 300.0)) +
                          tail(3000.0 - 4000.0 + 1000.0) + tail(-(3000.0 - 200.0 - 700.0)) +
                          far.squaredNorm() / 8.0 + 2.0 * std::log(2.0);  // two margins are 0
  BOOST_TEST(posterior.potential<double>(far) == expected, boost::test_tools::tolerance(1e-12));
  Eigen::VectorXd f(3);
  posterior.force<double>(far, f);
  BOOST_TEST(f.allFinite());
  Eigen::MatrixXd others = Eigen::MatrixXd::Ones(4, 3);
  const Eigen::Vector4d labels(1.0, 0.0, 1.0, 0.0);
  const std::string first = logistic_regression(others, labels, 4.0).description();
  BOOST_TEST(logistic_regression(others, labels, 4.0).description() == first);
  BOOST_TEST(logistic_regression(others, 1.0 - labels.array(), 4.0).description() != first);
  BOOST_TEST(logistic_regression(others, labels, 5.0).description() != first);
  others(3, 2) = 1.5;
  BOOST_TEST(logistic_regression(others, labels, 4.0).description() != first);
}
