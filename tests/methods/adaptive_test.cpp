// SPDX-License-Identifier: BSL-1.0
// Methods that depend on z, the step times a frequency. Phase-fitted ones turn the oscillator exactly, and
// are the classical ones for small steps; the coefficients of s-AIA are the best there are up to the highest
// frequency, by brute force.
#include "../laws/models.hpp"
#include "../support/dense.hpp"
#include "../support/refusal.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/methods/s_aia.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using bagab = fitted<fg_chin, chin4a>;

/// Up to 5 all are defined; pi and 2, where sin z and nearly cos z vanish, are no exceptions.
constexpr std::array some_z{1e-7, 1e-3, 0.1, 0.5, 1.0, 1.57, 2.0, 3.0, std::numbers::pi, 3.2, 4.0, 5.0};

struct comparison {
  double difference;
  double rounding;
};

/// The step's matrix in (q, z p) against the rotation by z. Each of its letters adds two roundings of a
/// product that is at most the product of the letters' norms; solving for the coefficients can leave as much
/// again, and is doubled for the rounding of theta itself.
comparison against_rotation(const method& method, double z) {
  const word& word = method.letters();
  const auto c = method.coefficients();
  const auto m = detail::matrix_on_oscillator(word, c, z * z);
  double size = 1.0;
  for (std::size_t i = 0; i < word.length; ++i) {
    const double first = std::abs(c[word.first_slot(i)]);
    const double bent = word.slots_of(i) == 2 ? 2.0 * std::abs(c[word.first_slot(i) + 1]) * z * z * z : 0.0;
    size *= 1.0 + first * z + bent;
  }
  const double cosine = std::cos(z);
  const double sine = std::sin(z);
  return {std::max({std::abs(m.qq - cosine), std::abs(m.pp - cosine), std::abs(m.qp * z - sine),
                    std::abs(m.pq / z + sine)}),
          6.0 * static_cast<double>(word.slots) * eps * size};
}

/// A fitted method at any z, the classical one that it began with, and how far their parameters are apart.
struct fitted_example {
  std::function<method(double)> at;
  method classical;
  std::function<double(double)> moved;
};
std::vector<fitted_example> all_fitted() {
  std::vector<fitted_example> all;
  for_each<fitted_methods>([&]<class M>() {
    const auto moved = [](double z) {
      const auto theta = M::family::of(M::at(z));
      const auto from = M::family::of(typename M::classical());
      double most = 0.0;
      for (std::size_t k = 0; k < theta.size(); ++k) most = std::max(most, std::abs(theta[k] - from[k]));
      return most;
    };
    all.push_back({M::at, typename M::classical(), moved});
  });
  return all;
}

const double best_at_zero = (3.0 - std::sqrt(5.0)) / 4.0;

/// A method by its one free coefficient.
struct stages {
  const char* letters;
  double (*rho)(double coefficient, double x);  // the closed form
  std::vector<double> (*coefficients)(double coefficient);
  method (*at)(double z);
  std::pair<double, double> drawn, searched;  // ranges of the coefficient
  double highest_x;                           // stable up to there for all that are drawn
  double (*meeting)(double coefficient);      // the x where the step is -1, next to which it tells nothing
  std::pair<double, double> in_gap;           // a coefficient, and an x where it is unstable
  double best_at(double z) const { return at(z).coefficients()[0]; }
  /// The largest rho on that many points up to z.
  double worst(double coefficient, double z, int points) const {
    double most = 0.0;
    for (int i = 1; i <= points; ++i) most = std::max(most, rho(coefficient, z * z * i / points));
    return most;
  }
};
template <std::size_t N>
std::vector<double> as_list(const std::array<double, N>& c) {
  return {c.begin(), c.end()};
}
const stages two{"ABABA",
                 detail::energy_error_of_two_stages,
                 [](double a) { return as_list(detail::palindrome<5>({a})); },
                 [](double z) { return method(s_aia2(z)); },
                 {0.15, 0.35},
                 {0.0, 0.5},
                 5.5,  // below 2/(1/2 - a) and 2/a
                 [](double) { return infinite; },
                 {0.2, 7.0}};
const stages three{"BABABAB",
                   detail::energy_error_of_three_stages,
                   [](double b) {
                     return as_list(detail::palindrome<7>({b, (1.0 - 2.0 * b) / (4.0 - 12.0 * b)}));
                   },
                   [](double z) { return method(s_aia3(z)); },
                   {0.105, 0.165},
                   {0.1, 1.0 / 6.0},
                   19.0,  // 20.6 for the least b
                   [](double b) { return 8.0 * (1.0 - 3.0 * b) / ((1.0 - 2.0 * b) * (1.0 - 2.0 * b)); },
                   {0.12, 27.0}};

struct with_rounding {
  double value;
  double error;
};

/// rho by its definition, from the matrix of the step. With entries wrong by delta, B + C errs by
/// 2 delta max(z, 1/z) and 1 - A^2 by 2 delta; both are doubled, for the closed form.
with_rounding rho_of_step(const nysalt::word& word, const std::vector<double>& c, double x) {
  const auto m = detail::matrix_on_oscillator(word, c, x);
  const double z = std::sqrt(x);
  const double sum = m.qp * z + m.pq / z;
  const double rotation = 1.0 - m.half_trace() * m.half_trace();
  double size = 1.0;  // of the product of the letters, each of which adds 2 eps of it
  for (std::size_t k = 0; k < c.size(); ++k) size *= 1.0 + c[k] * (word.letters()[k] == 'B' ? x : 1.0);
  const double delta = 2.0 * 10.0 * eps * size;
  const double rho = sum * sum / (2.0 * rotation);
  const double of_sum = 2.0 * delta * std::max(z, 1.0 / z);
  return {rho, ((std::abs(sum) + of_sum) * of_sum + 2.0 * delta * rho) / rotation};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_phase_fitted_step_is_the_rotation) {
  for (const auto& each : all_fitted()) {
    for (const double z : some_z) {
      const auto [difference, rounding] = against_rotation(each.at(z), z);
      BOOST_TEST(difference <= rounding, each.at(z).name()
                                             << " at " << z << ": " << difference << " > " << rounding);
    }
    // The classical method is not, nor is one that is fitted to a frequency a thousandth higher.
    const auto classical = against_rotation(each.classical, 2.0);
    BOOST_TEST(classical.difference > 100.0 * classical.rounding);
    const auto nearby = against_rotation(each.at(2.002), 2.0);
    BOOST_TEST(nearby.difference > 100.0 * nearby.rounding);
  }
}

// The methods' own errors on the oscillator are of order z^2 relative to their coefficients, which have to
// make up for them; and for the smallest z, rounding of theta remains.
BOOST_AUTO_TEST_CASE(for_small_steps_phase_fitted_methods_are_the_classical_ones) {
  for (const auto& each : all_fitted()) {
    for (const double z : {1e-9, 1e-4, 1e-2, 0.1}) BOOST_TEST(each.moved(z) <= 0.1 * z * z + 16.0 * eps);
    BOOST_TEST(each.moved(1.0) > 1e-6);
  }
}

// Of the members that turn the oscillator so, the nearest: what it moved lies in the span of the gradients of
// the equations, to the square root of rounding's effect on a minimum's place, in double.
BOOST_AUTO_TEST_CASE(a_phase_fitted_method_is_the_nearest_member) {
  const double z = 2.5;
  const auto check = [&](const auto& family, const auto& theta, const auto& from, bool nearest) {
    const auto n = static_cast<Eigen::Index>(theta.size());
    const Eigen::VectorXd here = Eigen::Map<const Eigen::VectorXd>(theta.data(), n);
    const Eigen::VectorXd moved = here - Eigen::Map<const Eigen::VectorXd>(from.data(), n);
    const nysalt::family data(family);
    const Eigen::MatrixXd normals =
        detail::defects_of_rotation(data, here, {z * z}).front().jacobian.transpose();
    const double beside = (normals * least_squares(normals, moved, 1e-9) - moved).norm();
    BOOST_TEST((beside <= 1e-8 * moved.norm()) == nearest);
  };
  const auto theta = fg4::of(fitted<fg4, omelyan_fg4>::at(z));
  check(fg4{}, theta, fg4::of(omelyan_fg4()), true);
  check(bab<6>{}, bab<6>::of(fitted<bab<6>, srkn6b>::at(z)), bab<6>::of(srkn6b()), true);
  check(fg4{}, theta, fg4::start(), false);  // it is not the nearest to Chin's
}

// Fitted anew at each step, omega fixed; allowed as in measured_order. With the coefficients of one step it
// is 2.
BOOST_AUTO_TEST_CASE(the_order_is_that_of_the_classical_method) {
  constexpr double allowed = 0.15;
  constexpr double omega = 1.3;
  draws random;
  const auto problem_of = [&](const char* name) {
    auto one = specimen_of(name);
    one.reach.reach *= 2.0;
    return solved(one.system, {one.at_random(random), one.at_random(random), one.at_random(random)}, 4.0);
  };
  const auto of_pendulum = problem_of("pendulum()");
  const auto of_galaxy = problem_of("henon_heiles");
  for (const auto& each : all_fitted()) {
    const auto at = [&](double h) { return table(each.at(omega * std::min(h, 1.0))); };
    BOOST_TEST(std::abs(measured_order(of_pendulum, at, 8) - each.classical.order) <= allowed);
    BOOST_TEST(std::abs(measured_order(of_galaxy, at, 8) - each.classical.order) <= allowed);
    BOOST_TEST(each.at(1.0).order == each.classical.order);
    BOOST_TEST(std::abs(measured_order(of_galaxy, table(each.at(2.0)), 64) - 2.0) <= allowed);
  }
}

BOOST_AUTO_TEST_CASE(rho_is_that_of_the_step) {
  draws random;
  for (const stages& method : {two, three}) {
    for (int n = 0; n < 200; ++n) {
      const double c = random.uniform(method.drawn.first, method.drawn.second);
      const double x = random.uniform(0.1, method.highest_x);
      if (std::abs(x - method.meeting(c)) < 0.1) continue;
      const auto [rho, error] = rho_of_step(nysalt::word(method.letters), method.coefficients(c), x);
      BOOST_TEST_CONTEXT(method.letters << ", coefficient " << c << ", x " << x) {
        BOOST_TEST(std::abs(method.rho(c, x) - rho) <= error);
        BOOST_TEST(std::abs(method.rho(c + 1e-3, x) - rho) > error);
      }
    }
    BOOST_TEST(method.rho(method.in_gap.first, method.in_gap.second) == infinite);
  }
}

// For small z, with e = a - a_0: rho is x^2 (p x - 2 sqrt(5) e)^2/32, p = a_0^2 (1 - 2 a_0). Its hump, at
// half its zero, is as high as its end where sqrt(5) e = (sqrt(2) - 1) p x. The next term is of order x^2.
BOOST_AUTO_TEST_CASE(for_small_z_two_stages_have_a_closed_form) {
  const double p = best_at_zero * best_at_zero * (1.0 - 2.0 * best_at_zero);
  for (const double z : {1e-200, 1e-30, 1e-8, 1e-4, 1e-3, 1e-2}) {
    const double closed = best_at_zero + (std::sqrt(2.0) - 1.0) * p * z * z / std::sqrt(5.0);
    BOOST_TEST(std::abs(two.best_at(z) - closed) <= z * z * z * z + 4.0 * eps);
  }
  BOOST_TEST(std::abs(two.best_at(1e-2) - best_at_zero) > 1e-8 + 4.0 * eps);  // the limit itself is another
}

// That many points miss a hump by 2 (1.2/points)^2 of its height (it is at half its zero, and that is at 0.83
// x), which is 1e-8 and 1e-5 here. A change of a coefficient by 1e-8 raises hump or end by more than 1e-7.
BOOST_AUTO_TEST_CASE(no_other_coefficient_is_better) {
  const auto check = [](const stages& method, double z) {
    const double best = method.best_at(z);
    BOOST_TEST_CONTEXT(method.letters << ", z " << z << ", coefficient " << best) {
      const double least = method.worst(best, z, 20'000);
      BOOST_TEST(method.worst(best - 1e-8, z, 20'000) > least);
      BOOST_TEST(method.worst(best + 1e-8, z, 20'000) > least);
      const auto [low, high] = method.searched;
      for (int i = 1; i < 500; ++i) {
        BOOST_TEST(method.worst(low + (high - low) * i / 500.0, z, 500) >= least * (1.0 - 1e-4));
      }
    }
  };
  for (const double z : {0.3, 1.0, 2.0, 2.5, 2.8}) check(two, z);
  for (const double z : {0.5, 1.5, 3.0, 4.0, 5.0}) check(three, z);
}

// Stable up to z needs 2/(1/2 - a) > z^2, and 16 (1 - 3b)^2 > (1 - 4b)(1 - 2b)^2 z^2, of which the bound on z
// is sqrt 27 at 1/6.
BOOST_AUTO_TEST_CASE(from_sqrt_8_and_sqrt_27_on_they_are_verlet) {
  for (const double z : {2.7, 2.8, 2.828, 2.828427}) {
    BOOST_TEST(two.best_at(z) < 0.25);
    BOOST_TEST(two.best_at(z) > 0.5 - 2.0 / (z * z));
  }
  for (const double z : {2.829, 3.0, 3.5, 3.999}) BOOST_TEST(two.best_at(z) == 0.25);
  for (const double z : {5.0, 5.19, 5.196, 5.19615}) BOOST_TEST(three.best_at(z) < 1.0 / 6.0);
  for (const double z : {5.19616, 5.5, 5.999}) {
    const auto c = s_aia3(z).coefficients();
    BOOST_TEST(c[0] == 1.0 / 6.0);
    BOOST_TEST(std::abs(c[1] - 1.0 / 3.0) <= 4.0 * eps);
  }
}

BOOST_AUTO_TEST_CASE(a_method_is_stable_up_to_the_z_it_is_made_for) {
  const auto stable = [](const auto& method, double z) {
    return is_stable(stability_windows(method), 0.0, z);
  };
  for (const double z : {1e-3, 1.0, 2.0, 2.6, 2.7, 2.8, 2.82, 2.829, 3.0, 3.5, 3.999}) {
    BOOST_TEST(stable(s_aia2(z), z), z);
  }
  for (const double z : {1e-3, 2.9, 3.1, 4.0, 5.0, 5.19, 5.2, 5.9}) BOOST_TEST(stable(s_aia3(z), z), z);
  BOOST_TEST(!stable(bcss3(), 4.8));
  BOOST_TEST(!stable(bcss2(), 2.7));
  BOOST_TEST(!stable(s_aia2(2.6), 2.8));
}

// Phase-fitted methods take the frequency of the modes, as bands have room for what soft forces add, and of a
// system without modes the highest. s-AIA takes the highest frequency.
BOOST_AUTO_TEST_CASE(a_system_and_a_step_give_the_z) {
  const fpu_chain<3> chain(50.0);
  const double highest = chain.frequency_bands().back().high;
  BOOST_TEST(highest > 50.0);
  for (const double step : {0.04, -0.04}) {
    BOOST_TEST(s_aia2_for(harmonic_oscillator(50.0), step).highest_z() == 50.0 * 0.04);
  }
  BOOST_TEST(frequency_to_fit(harmonic_oscillator(50.0)) == 50.0);
  BOOST_TEST(frequency_to_fit(chain) == 50.0);
  BOOST_TEST(frequency_to_fit(henon_heiles()) == 1.0);
  BOOST_TEST(frequency_to_fit(pendulum()) == 1.0);  // one band, 0 to 1
  BOOST_TEST(frequency_to_fit(black_box()) == 0.0);
  BOOST_TEST(s_aia2_for(chain, 0.02).highest_z() == 0.02 * highest);
  BOOST_TEST((s_aia2(1.5).coefficients() == as_list(detail::palindrome<5>({two.best_at(1.5)}))));
  BOOST_TEST(s_aia3(2.0).highest_z() == 2.0);
  BOOST_TEST(bagab::at(1.0).name() == "phase_fitted_chin4a");
  BOOST_TEST(s_aia2(1.0).name() == "s_aia2");
  BOOST_TEST(s_aia3(1.0).name() == "s_aia3");
}

BOOST_AUTO_TEST_CASE(impossible_z_are_refused_with_a_sentence) {
  const auto refused = [](const auto& action, said words) { BOOST_TEST(refuses(action, words)); };
  for (const double z : {0.0, -1.0, infinite, not_a_number}) {
    refused([&] { bagab::at(z); }, {"phase_fitted_chin4a", "positive and finite"});
    refused([&] { s_aia2{z}; }, {"s_aia2", "positive and finite"});
    refused([&] { s_aia3{z}; }, {"s_aia3", "positive and finite"});
  }
  // b = 2/z^2 - cot(z/2)/z grows without bound towards 2 pi.
  refused([] { bagab::at(2.0 * std::numbers::pi); },
          {"phase_fitted_chin4a", "at most 6.2", "6.283", "take a smaller step"});
  using of_pefrl = fitted<aba<4>, pefrl>;
  refused([] { of_pefrl::at(5.5); }, {"phase_fitted_pefrl", "at most 5.38"});
  BOOST_CHECK_NO_THROW(of_pefrl::at(5.38));
  for (const double z : {4.0, 1e300}) refused([&] { s_aia2{z}; }, {"s_aia2", "take a smaller step", "z < 4"});
  refused([] { s_aia3{6.0}; }, {"s_aia3", "three stages", "z < 6"});
  const harmonic_oscillator system(50.0);
  refused([&] { s_aia2_for(system, 0.08); }, {"z = step * highest frequency must", "got 4"});
  refused([&] { s_aia2_for(system, 0.0); }, {"positive and finite"});
  refused([] { s_aia2_for(black_box(), 0.1); }, {"positive and finite", "got 0"});
  // Families and methods that do not belong together.
  refused([] { phase_fitted(nystrom(), mclachlan2(), 1.0); },
          {"phase_fitted_mclachlan2", "must be symmetric"});
  refused([] { phase_fitted(fg4(), chin4a(), 1.0); }, {"of the word BAGAB", "got fg4"});
  refused([] { phase_fitted(aba<2>(), mclachlan2(), 1.0); }, {"two parameters or more"});
  const method low("low", bab<4>::letters, vefrl().coefficients(), {2, true, false});
  refused([&] { phase_fitted(bab<4>(), low, 1.0); }, {"a method of order 4 or more", "of order 2"});
  refused([] { phase_fitted(r_aba<4>(), pefrl(), 1.0); }, {"without rotations"});
}
