// SPDX-License-Identifier: BSL-1.0
// References that share nothing agree, on a chain with masses and a zero frequency, and tell their own error,
// which is of the right size.
#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/references/odeint.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinite = std::numeric_limits<double>::infinity();
constexpr double duration = 3.0;
using point = phase_point<double, Eigen::Dynamic>;

point after(const auto& reference, const linear_chain& system, point x) {
  reference.advance(system, x, duration);
  return x;
}

/// Rounding of the exact flow: two transforms of n terms each, on numbers magnified by t (free motion), by
/// the frequencies and by the roots of the masses, all below 6; cos and sin err by eps w t.
double exact_rounding(const point& x) { return 16.0 * 6.0 * 3.0 * eps * size_of(x); }

/// An oscillator of frequency 1 with a mistake.
struct flawed {
  static constexpr int dimension = 1;
  double cubic = 0.0;
  double constant = 0.0;
  double column = 1.0;     // of the modes, which should be a unit vector
  double frequency = 1.0;  // that it says it has
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = -q[0] - q[0] * q[0] * q[0] * cubic + constant;
  }
  normal_modes modes() const {
    return {Eigen::MatrixXd::Constant(1, 1, column), Eigen::VectorXd::Constant(1, frequency)};
  }
  std::string description() const { return "flawed()"; }
};

}  // namespace

BOOST_AUTO_TEST_CASE(exact_odeint_and_fine_steps_agree) {
  const linear_chain system = free_chain();
  BOOST_REQUIRE(system.modes().frequencies[0] == 0.0);
  draws random;
  for (int n = 0; n < 5; ++n) {
    const point x = random.state(system, 1.0);
    const point exact = after(exact_linear(system), system, x);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", draw " << n) {
      // Some t w/h = 600 steps of 23 letters, each of which rounds twice. Free motion magnifies by t.
      const double step = duration / 600.0;
      const double rounding = 600.0 * 23.0 * 2.0 * eps * size_of(x) * (1.0 + duration);
      BOOST_TEST(distance(after(fine_steps(step), system, x), exact) <= rounding + exact_rounding(x));
      // Each accepted step, at most a 13th of the evaluations, errs by the tolerance times 1 + |x|.
      const counted<linear_chain> watched(system);
      point by_odeint = x;
      odeint_reference(1e-12).advance(watched, by_odeint, duration);
      const double steps = static_cast<double>(watched.evaluations) / 13.0;
      BOOST_TEST(distance(by_odeint, exact) <=
                 steps * 2e-12 * size_of(x) * (1.0 + duration) + exact_rounding(x));
      // A coarse reference is told apart.
      BOOST_TEST(distance(after(fine_steps(0.3, verlet()), system, x), exact) > 1e-4);
      BOOST_TEST(reference_error(system, exact_linear(system), x, duration) == 0.0);
      point back = exact;
      exact_linear(system).advance(system, back, -duration);
      BOOST_TEST(distance(back, x) <= 4.0 * exact_rounding(x));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_exact_flow_is_of_linear_systems_only) {
  BOOST_TEST(refuses<wrong>([] { exact_linear(henon_heiles()); }, {"henon_heiles()", "must be linear"}));
  BOOST_TEST(refuses<wrong>([] { exact_linear(fpu_chain<3>(50.0)); }, {"fpu_chain(", "must be linear"}));
  BOOST_TEST(refuses<wrong>([] { exact_linear(fpu_chain<>(2, 1e3)); }, {"fpu_chain(", "must be linear"}));
  BOOST_TEST(refuses<wrong>([] { exact_linear(pendulum()); }, {"pendulum()", "must declare modes()"}));
  exact_linear(flawed{});
  for (const flawed& system : {flawed{.cubic = 1e-15}, flawed{.constant = 1e-15},
                               flawed{.frequency = 1.0 + 1e-13}, flawed{.cubic = not_a_number}}) {
    BOOST_TEST(refuses<wrong>([&] { exact_linear(system); }, {"flawed()", "must be linear", "coordinate 1"}));
  }
  // Right as a quadratic form, but not as a transformation.
  BOOST_TEST(refuses<wrong>([] { exact_linear(flawed{.column = 2.0, .frequency = 0.5}); },
                            {"flawed()", "orthonormal"}));
}

BOOST_AUTO_TEST_CASE(linear_systems_of_all_sizes_are_taken) {
  for (const Eigen::Index n : {1, 2, 17, 100}) {
    for (const double spring : {1e-6, 1.0, 1e8}) {
      exact_linear(linear_chain::between_walls(n, spring, 0.3));
    }
  }
  draws random;
  const Eigen::Index n = 20;
  for (int k = 0; k < 5; ++k) {  // without any structure, and masses over six decades
    const Eigen::MatrixXd root =
        Eigen::MatrixXd::NullaryExpr(n, n, [&] { return random.uniform(-1.0, 1.0); });
    const Eigen::VectorXd masses =
        Eigen::VectorXd::NullaryExpr(n, [&] { return std::pow(10.0, random.uniform(-3.0, 3.0)); });
    const Eigen::MatrixXd product = root * root.transpose();
    exact_linear(linear_chain(0.5 * (product + product.transpose()), masses));
  }
  for (const double omega : {1e-5, 0.1, 3.0, 1e5}) exact_linear(harmonic_oscillator(omega));
  exact_linear(linear_chain(Eigen::MatrixXd::Zero(3, 3)));  // free
}

BOOST_AUTO_TEST_CASE(the_exact_flow_is_of_the_system_it_was_made_for) {
  const harmonic_oscillator one(1.0);
  const harmonic_oscillator two(2.0);
  const reference exact = exact_linear(one);
  phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  BOOST_TEST(refuses<wrong>([&] { exact.advance(two, x, 1.0); },
                            {"harmonic_oscillator(omega=1)", "harmonic_oscillator(omega=2)"}));
  BOOST_TEST(refuses<wrong>([&] { exact.finer().advance(two, x, 1.0); }, {"omega=2"}));
  BOOST_TEST(refuses<wrong>([&] { reference_error(two, exact, x, 1.0); }, {"omega=2"}));
  BOOST_TEST(x.q[0] == 1.0);
  exact.advance(counted<harmonic_oscillator>(one), x, duration);
  BOOST_TEST(std::abs(x.q[0] - std::cos(duration)) <= 4.0 * eps);

  // Chains of one size and one largest frequency are told apart.
  const linear_chain chain = free_chain();
  const linear_chain turned(chain.modes().basis.col(2) * chain.modes().basis.col(2).transpose());
  const linear_chain other(turned.modes().basis.col(0) * turned.modes().basis.col(0).transpose());
  point y{Eigen::Vector3d::Ones(), Eigen::Vector3d::Zero()};
  BOOST_TEST(refuses<wrong>([&] { exact_linear(turned).advance(other, y, 1.0); }, {"linear_chain"}));
  exact_linear(chain).advance(counted<linear_chain>(chain), y, 1.0);
}

// What is held open is the preparation: letters of two intervals do not merge.
BOOST_AUTO_TEST_CASE(a_run_held_open_has_the_bits_of_one_opened_for_each_interval) {
  const linear_chain system = free_chain();
  const point start = draws().state(system, 1.0);
  for (const reference& accurate : {exact_linear(system), fine_steps(0.05), fine_steps(0.05, verlet()),
                                    reference(odeint_reference(1e-9))}) {
    const auto run = accurate.open(system, start, {.length = 0.1});
    point x = start;
    std::int64_t evaluations = 0;
    for (int n = 0; n < 5; ++n) {
      run->advance();
      evaluations += accurate.advance(system, x, 0.1);
      BOOST_TEST(same_bits(run->state(), x), accurate.description());
    }
    BOOST_TEST(run->evaluations() == evaluations);
  }
}

BOOST_AUTO_TEST_CASE(a_flow_of_single_trajectories_is_taken_lane_by_lane) {
  const pendulum system;
  const reference accurate = odeint_reference(1e-9);
  const auto start = detail::gather<detail::lanes, Eigen::Dynamic>(2, [](int k) {
    return point{Eigen::VectorXd::Constant(1, 0.5 + k), Eigen::VectorXd::Zero(1)};
  });
  const auto run = accurate.open(system, start, {.length = 1.0, .count = 2});
  run->advance();
  std::int64_t evaluations = 0;
  for (int k = 0; k < 2; ++k) {
    point x = lane(start, k);
    evaluations += accurate.advance(system, x, 1.0);
    BOOST_TEST(same_bits(lane(run->state(), k), x));
  }
  BOOST_TEST(run->evaluations() == evaluations);
}

// The difference from half the step is 3/4 of the error of a second-order method.
BOOST_AUTO_TEST_CASE(a_coarse_reference_is_honest) {
  const henon_heiles system;
  draws random;
  const auto x = random.state(system, 0.25);
  const reference coarse = fine_steps(0.05, verlet());
  auto truth = x;
  odeint_reference(1e-14).advance(system, truth, 2.0);
  auto y = x;
  coarse.advance(system, y, 2.0);
  const double error = distance(y, truth);
  const double reported = reference_error(system, coarse, x, 2.0);
  BOOST_TEST(error > 1e-6);
  BOOST_TEST(std::abs(reported / error - 0.75) <= 0.05);  // (w h)^2 relative, some 1e-2, is left
  auto finer = x;
  coarse.finer().advance(system, finer, 2.0);
  BOOST_TEST(std::abs(distance(finer, truth) / error - 0.25) <= 0.05);
}

BOOST_AUTO_TEST_CASE(times_steps_and_tolerances_that_cannot_be_are_refused) {
  const pendulum system;
  phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  const auto fine = fine_steps(0.1);
  for (const double t : {0.25, 0.05, 0.3001, -0.1, 0.0, not_a_number, infinite}) {
    BOOST_TEST(refuses<wrong>([&] { fine.advance(system, x, t); }, {"fine_steps", "multiple", "0.1"}));
  }
  BOOST_TEST(x.q[0] == 1.0);                           // untouched
  BOOST_CHECK_NO_THROW(fine.advance(system, x, 0.3));  // 0.3/0.1 is not 3 to the bit
  BOOST_TEST(fine.description() == "srkn11b with step 0.1");
  for (const double bad : {0.0, -0.1, not_a_number, infinite}) {
    BOOST_TEST(refuses<wrong>([&] { fine_steps(bad); }, {"fine_steps", "positive"}));
    BOOST_TEST(refuses<wrong>([&] { odeint_reference{bad}; }, {"odeint_reference", "tolerance", "(0, 1)"}));
  }
  BOOST_TEST(refuses<wrong>([] { odeint_reference{1.0}; }, {"tolerance", "(0, 1)"}));
  BOOST_TEST(odeint_reference(1e-9).finer().tolerance() == 1e-11, boost::test_tools::tolerance(1e-15));
}

// q = e^{-gamma t/2} (cos w t + gamma/(2 w) sin w t), w^2 = omega^2 - gamma^2/4. Some 50 steps, each within
// the tolerance times 1 + |x|, and the motion magnifies by omega at most.
BOOST_AUTO_TEST_CASE(odeint_damps_and_refuses_noise) {
  const double gamma = 0.6;
  const double omega = 2.0;
  const double t = 1.5;
  const harmonic_oscillator alone(omega);
  const in_bath damped(alone, bath::of_sigma(gamma, 0.0));
  const phase_point<double, 1> start{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  auto x = start;
  odeint_reference(1e-12).advance(damped, x, t);
  const double w = std::sqrt(omega * omega - 0.25 * gamma * gamma);
  const double decay = std::exp(-0.5 * gamma * t);
  const double q = decay * (std::cos(w * t) + 0.5 * gamma / w * std::sin(w * t));
  const double p = -decay * omega * omega / w * std::sin(w * t);
  BOOST_TEST(std::abs(x.q[0] - q) <= 50.0 * 4e-12 * omega);
  BOOST_TEST(std::abs(x.p[0] - p) <= 50.0 * 4e-12 * omega);
  auto undamped = start;
  odeint_reference(1e-12).advance(alone, undamped, t);
  BOOST_TEST(std::abs(undamped.q[0] - q) > 0.1);

  const in_bath noisy(alone, bath::of_sigma(gamma, 0.1));
  BOOST_TEST(refuses<wrong>([&] { odeint_reference(1e-12).advance(noisy, x, t); },
                            {"odeint_reference", "without noise", "fine_paths"}));
}
