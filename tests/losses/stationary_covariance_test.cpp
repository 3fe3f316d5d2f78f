// SPDX-License-Identifier: BSL-1.0
// The law that a word keeps, against the Lyapunov equation of the tests' own matrices, which are checked in
// methods/linear_langevin_test; and the two stages that keep it exactly, by the closed form in
// docs/langevin.md.
#include "nysalt/losses/stationary_covariance.hpp"

#include "../../src/nysalt/learning/minimise.hpp"
#include "../../src/nysalt/losses/lyapunov.hpp"
#include "../support/draws.hpp"
#include "../support/langevin.hpp"
#include "../support/losses.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/textbook.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr damped_oscillator oscillator{3.0, 1.5, 0.8};

const std::vector<method> bathed_methods = langevin_methods();
const method& baoab_as_data = bathed_methods.front();
method word_of_letters(const char* letters, const std::vector<double>& c) {
  return {letters, nysalt::word(letters), c, {1, false, false}};
}

template <System S>
Eigen::VectorXd residuals_of(const S& system, const method& method, double step) {
  const auto r = stationary_covariance(system, method.letters(), step).residuals(method.coefficients());
  return Eigen::Map<const Eigen::VectorXd>(r.data(), std::ssize(r));
}

/// The same from the matrices of the tests.
Eigen::Vector3d expected_residuals(const damped_oscillator& x, const method& method, double step) {
  const square<2> law = stationary(word_step(x, spell(method), step));
  const double kT = x.sigma * x.sigma / (2.0 * x.gamma);
  return {law(0, 0) * x.omega * x.omega / kT - 1.0, std::numbers::sqrt2 * law(0, 1) * x.omega / kT,
          law(1, 1) / kT - 1.0};
}
/// Of either: some hundred roundings of numbers below 10, over the denominator of the Lyapunov equation.
double rounding_of(const damped_oscillator& x, const method& method, double step) {
  const square<2> M = word_step(x, spell(method), step).map;
  const double d = M.determinant();
  return 2000.0 * eps / ((1.0 - d) * (1.0 + d - M.trace()) * (1.0 + d + M.trace()));
}

/// A system with modes that does not say what is soft.
struct whole_spring {
  static constexpr int dimension = 1;
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = -q[0];
  }
  normal_modes modes() const { return {Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Ones(1)}; }
};

/// With respect to all coefficients, those of O too.
Eigen::MatrixXd by_each(const std::vector<double>& c) {
  return Eigen::MatrixXd::Identity(std::ssize(c), std::ssize(c));
}

/// Where S keeps the circle: 4 a^2 - 6 a + 1 + z^2 a^2 (1 - 2 a) = 0, by bisection.
double closed_form(double z) {
  const auto f = [&](double a) { return 4.0 * a * a - 6.0 * a + 1.0 + z * z * a * a * (1.0 - 2.0 * a); };
  double low = 0.1;
  double high = 1.0 / 3.0;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (f(low) * f(middle) <= 0.0 ? high : low) = middle;
  }
  return low;
}

/// Of nystrom on the chain with omega = 50, three stiff modes and three of frequency zero.
objective law_of(placement where, double gamma, double z) {
  const in_bath chain(fpu_chain<3>(50.0), bath::of_temperature(gamma, 0.125));
  const nysalt::family family = thermostatted(nysalt::family(nystrom()), where);
  return detail::objective_of(stationary_covariance(chain, family.letters, z / 50.0), family);
}

/// Searched from two half steps of Verlet, which are stable wherever any two stages are.
minimum best(const objective& loss, const std::vector<Eigen::Index>& free) {
  const auto in_range = [](const Eigen::VectorXd& theta) {
    return 0.0 < theta[0] && theta[0] < 1.0 && 0.0 <= theta[1] && theta[1] <= 0.5;
  };
  return minimise(loss, in_range, Eigen::Vector2d(0.5, 0.375), free, 100);
}

/// beta1 = (1 - a)/2 is known as well as the residuals are, each to some 20 roundings of entries below z^2,
/// over their slope.
double rounding_of_optimum(const objective& loss, const minimum& found, double z) {
  const double slope = std::sqrt(loss(found.theta).normal_matrix(1, 1));
  return 20.0 * eps * (1.0 + z * z) / slope + eps;
}

/// A rotation by an angle between a shear and its inverse.
square<2> sheared_turn(double angle, double shear) {
  const square<2> there{{1.0, shear}, {0.0, 1.0}};
  const square<2> back{{1.0, -shear}, {0.0, 1.0}};
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return back * square<2>{{c, s}, {-s, c}} * there;
}

}  // namespace

// Also in other units and at another temperature, and where friction does not matter, of palindromes.
BOOST_AUTO_TEST_CASE(residuals_are_those_of_the_lyapunov_equation) {
  for (const method& method : bathed_methods) {
    for (const double step : {0.05, 0.2, 0.4, 0.6}) {
      for (const damped_oscillator& x :
           {damped_oscillator{3.0, 0.01, 0.8}, oscillator, damped_oscillator{3.0, 40.0, 0.8},
            damped_oscillator{2.0, 3.0, 0.1}}) {
        const auto expected = expected_residuals(x, method, step);
        const double rounding = rounding_of(x, method, step);
        BOOST_TEST_CONTEXT(method.name() << ", step " << step << ", gamma " << x.gamma) {
          BOOST_TEST((residuals_of(bathed_system(x), method, step) - expected).norm() <= rounding);
          BOOST_TEST((residuals_of(bathed_system(x), method, 0.99 * step) - expected).norm() > rounding);
        }
      }
    }
  }
}

// On an oscillator G(b, c) is B(b - 2 c z^2). R is exact, and S has nothing to do.
BOOST_AUTO_TEST_CASE(gradient_kicks_and_rotations_are_letters_as_others) {
  const double step = 0.4;
  const double z = step * oscillator.omega;
  const double b = 0.17;
  const double c = 0.013;
  const auto gradient = word_of_letters("OBAGABO", {0.5, b, 0.5, 1.0 - 2.0 * b, c, 0.5, b, 0.5});
  const auto kicks = word_of_letters("OBABABO", {0.5, b, 0.5, 1.0 - 2.0 * b - 2.0 * c * z * z, 0.5, b, 0.5});
  const auto expected = residuals_of(bathed_system(oscillator), kicks, step);
  const double rounding = rounding_of(oscillator, kicks, step);
  BOOST_TEST((residuals_of(bathed_system(oscillator), gradient, step) - expected).norm() <= rounding);
  BOOST_TEST(expected.norm() > 1e-4);

  const in_bath chain(linear_chain(Eigen::Vector2d(36.0, 8.0).asDiagonal()), bath::of_sigma(1.5, 0.8));
  const auto impulses = word_of_letters("OSRSO", {0.5, 0.5, 1.0, 0.5, 0.5});
  const auto split = word_of_letters("RSORSO", {0.5, 0.5, 0.7, 0.5, 0.5, 0.3});
  for (const method& method : {impulses, split}) {
    BOOST_TEST(residuals_of(chain, method, 0.2).norm() <= 100.0 * eps);  // of rotations, to rounding
  }
}

BOOST_AUTO_TEST_CASE(a_frequency_counts_as_often_as_there_are_modes_and_zero_not_at_all) {
  const nysalt::method method = two_stages(placement::symmetric);
  const bath heat_bath = bath::of_temperature(1.0, 0.125);
  const auto alone = residuals_of(in_bath(harmonic_oscillator(50.0), heat_bath), method, 0.03);
  const auto chain = residuals_of(in_bath(fpu_chain<3>(50.0), heat_bath), method, 0.03);
  BOOST_TEST(chain.size() == 3);  // three modes of frequency zero, three of frequency 50
  BOOST_TEST((chain - std::sqrt(3.0) * alone).norm() <= 4.0 * eps * chain.norm());  // a product each
  BOOST_TEST(alone.norm() > 1e-3);

  // Springs of different frequencies, with masses, from the lowest up.
  const Eigen::Vector3d stiffness(36.0, 8.0, 0.0);
  const Eigen::Vector3d masses(4.0, 2.0, 1.0);
  const linear_chain springs(stiffness.asDiagonal(), masses);
  const auto both = residuals_of(in_bath(springs, heat_bath), method, 0.3);
  BOOST_TEST(both.size() == 6);
  for (Eigen::Index k = 0; k < both.size() / 3; ++k) {
    const double omega = k == 0 ? 2.0 : 3.0;
    const auto mode = residuals_of(in_bath(harmonic_oscillator(omega), heat_bath), method, 0.3);
    // Frequencies are known to some eps, and residuals change by less than 10 of that and their own rounding.
    const double tolerance = 100.0 * eps + 2.0 * rounding_of({omega, 1.0, 0.5}, method, 0.3);
    BOOST_TEST((both.segment<3>(3 * k) - mode).norm() <= tolerance);
  }
}

BOOST_AUTO_TEST_CASE(the_gradient_is_the_slope_of_the_loss) {
  const Eigen::Vector2d stiffness(36.0, 8.0);
  const in_bath springs(linear_chain(stiffness.asDiagonal()), bath::of_sigma(1.5, 0.8));
  for (const method& method : bathed_methods) {
    const stationary_covariance loss(springs, method.letters(), 0.2);
    const auto c = method.coefficients();
    const auto here = loss.at(c, by_each(c));
    BOOST_TEST(here.value > 0.0);
    BOOST_TEST(here.half_gradient.size() == std::ssize(c));
    BOOST_TEST(loss.at(c, by_each(c).col(2)).half_gradient[0] == here.half_gradient[2]);
    BOOST_TEST(loss.at(c, Eigen::MatrixXd(std::ssize(c), 0)).half_gradient.size() == 0);
    const auto residuals_at = [&](const std::vector<double>& at) -> Eigen::VectorXd {
      const auto r = loss.residuals(at);
      return Eigen::Map<const Eigen::VectorXd>(r.data(), std::ssize(r));
    };
    const Eigen::VectorXd values = residuals_at(c);
    BOOST_TEST(std::abs(here.value - values.squaredNorm()) <= 4.0 * eps * here.value);
    for (std::size_t k = 0; k < c.size(); ++k) {
      const central_difference difference(residuals_at, c, k);
      // Truncation falls to a quarter with s, so it is a third of the change; residuals round as above.
      const double s = 1e-4;
      const Eigen::VectorXd slope = difference(s);
      const double error = (slope - difference(2.0 * s)).norm() / 3.0;
      const double rounding =
          (rounding_of({6.0, 1.5, 0.8}, method, 0.2) + rounding_of({std::sqrt(8.0), 1.5, 0.8}, method, 0.2)) /
          s;
      const auto column = static_cast<Eigen::Index>(k);
      const double tolerance = 2.0 * error + rounding;
      BOOST_TEST_CONTEXT(method.name() << ", coefficient " << k << ", slope " << slope.norm()) {
        BOOST_TEST(std::abs(here.half_gradient[column] - values.dot(slope)) <= tolerance * values.norm());
        BOOST_TEST(std::abs(here.normal_matrix(column, column) - slope.squaredNorm()) <=
                   (2.0 * slope.norm() + tolerance) * tolerance);
        BOOST_TEST(tolerance <= 1e-4 * slope.norm() + 1e-7);  // which says something
      }
    }
  }
}

// BAOAB is stable for z < 2, with friction to the same end.
BOOST_AUTO_TEST_CASE(a_word_that_keeps_no_law_is_infinitely_far) {
  const auto loss_of = [](double z) {
    const auto c = baoab_as_data.coefficients();
    return stationary_covariance(bathed_system(oscillator), baoab_as_data.letters(), z / oscillator.omega)
        .at(c, by_each(c));
  };
  BOOST_TEST(loss_of(1.999).is_finite());
  BOOST_TEST(!std::isfinite(loss_of(2.001).value));
  BOOST_TEST(!loss_of(2.001).is_finite());
  BOOST_TEST(!std::isfinite(loss_of(200.0).value));

  const stationary_covariance symmetric(bathed_system(oscillator), nysalt::word("OABAO"), 0.3);
  BOOST_TEST(std::isfinite(symmetric.residuals(std::vector{0.25, 0.5, 1.0, 0.5, 0.75})[0]));
  BOOST_TEST(!std::isfinite(symmetric.residuals(std::vector{-0.1, 0.5, 1.0, 0.5, 1.1})[0]));  // back in time
  BOOST_TEST(!std::isfinite(symmetric.residuals(std::vector{0.0, 0.5, 1.0, 0.5, 0.0})[0]));   // no bath left
}

BOOST_AUTO_TEST_CASE(what_has_no_law_is_refused) {
  const auto warm = bathed_system(oscillator);
  const nysalt::word word("OABAO");
  const auto made = [](const auto& system, const nysalt::word& w, double step) {
    return [=] { stationary_covariance(system, w, step); };
  };
  BOOST_TEST(refuses(made(warm, nysalt::word("ABA"), 0.1), {"ABA", "thermostat"}));
  BOOST_TEST(refuses(made(warm, word, 0.0), {"step", "positive"}));
  BOOST_TEST(refuses(made(warm, word, std::nan("")), {"step", "nan"}));
  const harmonic_oscillator alone(3.0);
  BOOST_TEST(refuses(made(in_bath(alone, bath::of_sigma(0.0, 1.0)), word, 0.1), {"friction"}));
  BOOST_TEST(refuses(made(in_bath(alone, bath::of_sigma(1.0, 0.0)), word, 0.1), {"temperature"}));
  const in_bath free_mass(linear_chain(Eigen::MatrixXd::Zero(1, 1)), bath::of_sigma(1.0, 1.0));
  BOOST_TEST(refuses(made(free_mass, word, 0.1), {"linear_chain", "frequency"}));
  BOOST_TEST(refuses(made(in_bath(whole_spring(), bath::of_sigma(1.0, 1.0)), nysalt::word("OSRSO"), 0.1),
                     {"OSRSO", "soft_force"}));
  const stationary_covariance loss(warm, word, 0.1);
  BOOST_TEST(refuses([&] { loss.residuals(std::vector{0.5, 0.5}); }, {"OABAO", "2 coefficients"}));
  BOOST_TEST(refuses(made(alone, word, 0.1), {"in a bath"}));
  BOOST_TEST(refuses(made(in_bath(pendulum(), bath::of_sigma(1.0, 1.0)), word, 0.1), {"declare modes()"}));
}

BOOST_AUTO_TEST_CASE(around_two_stages_the_law_is_exact_at_the_closed_form) {
  for (const double z : {0.5, 1.65, 3.5}) {
    for (const double gamma : {0.01, 1.0}) {
      for (const placement where : {placement::end, placement::symmetric}) {
        const auto loss = law_of(where, gamma, z);
        const double expected = 0.5 * (1.0 - closed_form(z));
        for (const std::vector<Eigen::Index>& free : {std::vector<Eigen::Index>{1}, {0, 1}}) {
          const auto found = best(loss, free);
          BOOST_TEST_CONTEXT(to_string(where)
                             << ", z = " << z << ", gamma = " << gamma << ", " << free.size() << " free") {
            BOOST_TEST(found.converged);
            BOOST_TEST(found.loss <= 1e-26);
            const double off = std::abs(found.theta[1] - expected);
            BOOST_TEST(off <= (free.size() == 1 ? rounding_of_optimum(loss, found, z) : 1e-12));
            BOOST_TEST(std::abs(found.theta[0] - 0.5) <= (free.size() == 1 ? 0.0 : 1e-12));
          }
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(what_a_map_of_determinant_one_adds) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const auto S = sheared_turn(random.uniform(0, 3), random.uniform(-2, 2));
    const square<2> expected = S * S.transpose() - square<2>::Identity();
    // Entries are below 6, their squares below 36: some ten roundings of each.
    BOOST_TEST((detail::excess_of_turn(S) - expected).cwiseAbs().maxCoeff() <= 360.0 * eps);
  }
  // Of a rotation the trace vanishes to twice as many digits; by products it does not.
  const auto turn = sheared_turn(0.7, 1e-17);
  const auto excess = detail::excess_of_turn(turn);
  BOOST_TEST(std::abs(excess.trace()) <= eps * eps);
}
