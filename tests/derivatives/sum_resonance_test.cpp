// SPDX-License-Identifier: BSL-1.0
// Two modes that a soft force couples grow where the sum of their angles is a whole turn.
#include "nysalt/derivatives/sum_resonance.hpp"

#include <boost/test/unit_test.hpp>

#include <numbers>

#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// V = q K q/2 with a matrix K.
struct coupled {
  static constexpr int dimension = 2;
  Eigen::Matrix2d stiffness;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    T sum(0.0);
    for (Eigen::Index i = 0; i < 2; ++i) {
      for (Eigen::Index j = 0; j < 2; ++j) sum += q[i] * q[j] * (0.5 * stiffness(i, j));
    }
    return sum;
  }
};

const Eigen::Array2d omega(1.0, 2.2);
const Eigen::Matrix2d soft = 0.05 * Eigen::Matrix2d{{1.0, 0.8}, {0.8, 1.0}};

with_quadratic_part<coupled> two_modes(const Eigen::Matrix2d& rest) {
  const Eigen::Matrix2d squares = omega.square().matrix().asDiagonal();
  return {coupled{squares + rest}, squares};
}

/// Logarithm of the spectral radius of the matrix of one step.
double growth_of_step(const auto& system, const run_time_word& word, const std::vector<double>& c, double h) {
  const stepper<std::remove_cvref_t<decltype(system)>, run_time_word> one(system, word, c, h);
  Eigen::Matrix4d step;
  for (Eigen::Index j = 0; j < 4; ++j) {
    phase_point<double, 2> x{vector<double, 2>(0.0, 0.0), vector<double, 2>(0.0, 0.0)};
    (j < 2 ? x.q : x.p)[j % 2] = 1.0;
    one.step(x);
    step.col(j) << x.q, x.p;
  }
  return std::log(spectral_radius(step));
}

const run_time_word impulse("SRS");
const std::vector<double> halves{0.5, 1.0, 0.5};

}  // namespace

BOOST_AUTO_TEST_CASE(growth_is_that_of_the_eigenvalues_of_a_step) {
  draws random;
  int growing = 0;
  for (const char* letters : {"SRS", "RSRSR", "SRHRS"}) {
    const run_time_word word{std::string(letters)};
    for (int n = 0; n < 200; ++n) {
      std::vector<double> c(word.slots, 0.5);
      if (word.slots == 3) c[1] = 1.0;
      if (word.slots == 6) c = {0.25, 0.5, 0.5, 0.01, 0.5, 0.25};
      const double h = random.uniform(0.1, 4.0);
      const Eigen::Matrix2d k = random.uniform(0.1, 3.0) * soft;
      const auto system = two_modes(k);
      const double expected = growth_of_step(system, word, c, h);
      const double found = growth_of_pair(word, c, h * omega, h * h * k);
      // Eigenvalues of a defective matrix err by the root of rounding, times entries of some tens.
      BOOST_TEST(std::abs(found - expected) < 1e-6,
                 letters << " at " << h << ": " << found << ", " << expected);
      growing += expected > 1e-3;
    }
  }
  BOOST_TEST(growing > 10);
}

BOOST_AUTO_TEST_CASE(the_guard_objects_to_a_sum_resonance) {
  const auto system = two_modes(soft);
  const std::vector<phase_point<double, 2>> states(
      3, {vector<double, 2>(0.1, 0.2), vector<double, 2>(0.3, 0.1)});
  const stability_guard guard(system, states);
  const double resonance = 2.0 * std::numbers::pi / omega.sum();
  // (omega_1 + omega_2) h = 2 pi, moved by what the soft force adds to the frequencies.
  constexpr double step = 1.9415;
  BOOST_TEST(std::abs(step / resonance - 1.0) < 0.02);
  BOOST_TEST(growth_of_step(system, impulse, halves, step) > 0.02);
  const auto said = guard.objection(impulse, halves, step);
  BOOST_TEST(said.find("which soft forces couple") != std::string::npos, said);
  for (const double part : {0.8, 0.9, 1.15}) {
    BOOST_TEST(guard.admits(impulse, halves, part * step), guard.objection(impulse, halves, part * step));
  }
  // Without the coupling there is nothing, and at a difference resonance there is nothing either.
  const Eigen::Matrix2d apart = soft.diagonal().asDiagonal();
  BOOST_TEST(stability_guard(two_modes(apart), states).admits(impulse, halves, step));
  const double difference = 2.0 * std::numbers::pi / (omega[1] - omega[0]);
  BOOST_TEST(growth_of_pair(impulse, halves, difference * omega, difference * difference * soft) < 1e-6);
}
