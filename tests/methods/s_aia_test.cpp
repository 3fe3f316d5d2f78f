// SPDX-License-Identifier: BSL-1.0
// The adaptive coefficient is the best there is up to the highest frequency, by brute force.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <limits>
#include <vector>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/step_matrix.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/s_aia.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

using namespace nysalt;
using namespace nysalt::test;
using detail::energy_error_of_three_stages;
using detail::energy_error_of_two_stages;

namespace {

const double best_at_zero = (3.0 - std::sqrt(5.0)) / 4.0;

double a_at(double highest_z) { return s_aia2(highest_z).coefficients()[0]; }

double b_at(double highest_z) { return s_aia3(highest_z).coefficients()[0]; }

/// The worst rho on that many points up to z.
double worst_of(double (*rho)(double, double), double coefficient, double z, int points) {
  double most = 0.0;
  for (int i = 1; i <= points; ++i) {
    const double x = z * z * i / points;
    most = std::max(most, rho(coefficient, x));
  }
  return most;
}
double worst(double a, double z, int points) { return worst_of(energy_error_of_two_stages, a, z, points); }
double worst3(double b, double z, int points) { return worst_of(energy_error_of_three_stages, b, z, points); }

struct with_rounding {
  double value;
  double error;
};

/// rho by its definition, from the matrix of the step. With entries wrong by delta, B + C errs by
/// 2 delta max(z, 1/z) and 1 - A^2 by 2 delta; both are doubled, for the closed form.
with_rounding rho_of_step(const run_time_word& word, const std::vector<double>& c, double x) {
  const auto m = matrix_on_oscillator(word, c, x);
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

with_rounding rho_of_two_stages(double a, double x) {
  const auto c = palindrome<5>({a});
  return rho_of_step(run_time_word("ABABA"), {c.begin(), c.end()}, x);
}
with_rounding rho_of_three_stages(double b, double x) {
  const auto c = palindrome<7>({b, (1.0 - 2.0 * b) / (4.0 - 12.0 * b)});
  return rho_of_step(run_time_word("BABABAB"), {c.begin(), c.end()}, x);
}

}  // namespace

BOOST_AUTO_TEST_CASE(rho_is_that_of_the_step) {
  draws random;
  for (int n = 0; n < 200; ++n) {
    const double a = random.uniform(0.15, 0.35);
    const double x = random.uniform(0.1, 5.5);  // below 2/(1/2 - a) and 2/a, hence stable
    const auto [rho, error] = rho_of_two_stages(a, x);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", a " << a << ", x " << x) {
      BOOST_TEST(std::abs(energy_error_of_two_stages(a, x) - rho) <= error);
      BOOST_TEST(std::abs(energy_error_of_two_stages(a + 1e-3, x) - rho) > error);
    }
  }
  BOOST_TEST(energy_error_of_two_stages(0.2, 7.0) == std::numeric_limits<double>::infinity());  // in the gap
}

// The matrix is -1 where (1 - 2b)^2 x = 8 (1 - 3b), at x from 9 to 9.1, and next to that it tells nothing.
BOOST_AUTO_TEST_CASE(rho_of_three_stages_is_that_of_the_step) {
  draws random;
  for (int n = 0; n < 200; ++n) {
    const double b = random.uniform(0.105, 0.165);
    const double meeting = 8.0 * (1.0 - 3.0 * b) / ((1.0 - 2.0 * b) * (1.0 - 2.0 * b));
    const double x = random.uniform(0.1, 19.0);  // stable up to 20.6 for the least b
    if (std::abs(x - meeting) < 0.1) continue;
    const auto [rho, error] = rho_of_three_stages(b, x);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", b " << b << ", x " << x) {
      BOOST_TEST(std::abs(energy_error_of_three_stages(b, x) - rho) <= error);
      BOOST_TEST(std::abs(energy_error_of_three_stages(b + 1e-3, x) - rho) > error);
    }
  }
  BOOST_TEST(energy_error_of_three_stages(0.12, 27.0) == std::numeric_limits<double>::infinity());
}

// 0.211781 is printed with six digits.
BOOST_AUTO_TEST_CASE(up_to_two_it_is_bcss) {
  BOOST_TEST(std::abs(a_at(2.0) - bcss2::coefficients()[0]) <= 5e-7);
  BOOST_TEST(std::abs(a_at(1.99) - bcss2::coefficients()[0]) > 5e-7);
}

// For small z, with e = a - a_0: rho is x^2 (p x - 2 sqrt(5) e)^2/32, p = a_0^2 (1 - 2 a_0). Its hump, at
// half its zero, is as high as its end where sqrt(5) e = (sqrt(2) - 1) p x. The next term is of order x^2.
BOOST_AUTO_TEST_CASE(for_small_z_it_is_the_closed_one) {
  const double p = best_at_zero * best_at_zero * (1.0 - 2.0 * best_at_zero);
  for (const double z : {1e-200, 1e-30, 1e-8, 1e-4, 1e-3, 1e-2}) {
    const double closed = best_at_zero + (std::sqrt(2.0) - 1.0) * p * z * z / std::sqrt(5.0);
    BOOST_TEST(std::abs(a_at(z) - closed) <= z * z * z * z + 4.0 * eps);
  }
  BOOST_TEST(std::abs(a_at(1e-2) - best_at_zero) > 1e-8 + 4.0 * eps);  // the limit itself is another
}

// That many points miss a hump by 2 (1.2/points)^2 of its height (it is at half its zero, and that is at 0.83
// x), which is 1e-8 and 1e-5 here. A change of a by 1e-8 raises hump or end by more than 1e-7.
BOOST_AUTO_TEST_CASE(no_other_coefficient_is_better) {
  for (const double z : {0.3, 1.0, 2.0, 2.5, 2.8}) {
    const double a = a_at(z);
    BOOST_TEST_CONTEXT("z " << z << ", a " << a) {
      const double least = worst(a, z, 20'000);
      BOOST_TEST(worst(a - 1e-8, z, 20'000) > least);
      BOOST_TEST(worst(a + 1e-8, z, 20'000) > least);
      for (int i = 1; i < 500; ++i) BOOST_TEST(worst(i * 1e-3, z, 500) >= least * (1.0 - 1e-4));
    }
  }
}

// The same of three stages: between 0.1 and 1/6 other coefficients on the curve are worse.
BOOST_AUTO_TEST_CASE(no_other_three_stages_on_the_curve_are_better) {
  for (const double z : {0.5, 1.5, 3.0, 4.0, 5.0}) {
    const double b = b_at(z);
    BOOST_TEST_CONTEXT("z " << z << ", b " << b) {
      const double least = worst3(b, z, 20'000);
      BOOST_TEST(worst3(b - 1e-8, z, 20'000) > least);
      BOOST_TEST(worst3(b + 1e-8, z, 20'000) > least);
      for (int i = 0; i < 200; ++i) {
        const double other = 0.1 + (1.0 / 6.0 - 0.1) * i / 200.0;
        BOOST_TEST(worst3(other, z, 500) >= least * (1.0 - 1e-4));
      }
    }
  }
}

// Up to 3 it is that of BCSS, who searched to ten digits; for z -> 0 that of predescu3.
BOOST_AUTO_TEST_CASE(three_stages_begin_at_predescu_and_pass_bcss) {
  const auto bcss = bcss3::coefficients();
  const auto at_three = s_aia3(3.0).coefficients();
  BOOST_TEST(std::abs(at_three[0] - bcss[0]) <= 1e-9);
  BOOST_TEST(std::abs(at_three[1] - bcss[1]) <= 1e-9);
  BOOST_TEST(std::abs(s_aia3(2.99).coefficients()[0] - bcss[0]) > 1e-9);
  const auto first = predescu3::coefficients();
  const auto at_zero = s_aia3(1e-6).coefficients();
  // b grows by z^2 times a number of order one hundredth.
  BOOST_TEST(std::abs(at_zero[0] - first[0]) <= 1e-13);
  BOOST_TEST(std::abs(at_zero[1] - first[1]) <= 1e-13);
  BOOST_TEST(std::abs(s_aia3(1e-2).coefficients()[0] - first[0]) > 1e-13);
}

BOOST_AUTO_TEST_CASE(other_methods_are_worse_where_they_are_not_the_best) {
  const double least = worst(a_at(2.0), 2.0, 1000);
  BOOST_TEST(worst(mclachlan2::coefficients()[0], 2.0, 1000) > 2.0 * least);
  BOOST_TEST(worst(0.25, 2.0, 1000) > 2.0 * least);
  BOOST_TEST(worst(bcss2::coefficients()[0], 2.5, 1000) > 2.0 * worst(a_at(2.5), 2.5, 1000));
}

// Stable up to z needs 2/(1/2 - a) > z^2.
BOOST_AUTO_TEST_CASE(from_sqrt_8_on_it_is_verlet) {
  for (const double z : {2.7, 2.8, 2.828, 2.828427}) {
    BOOST_TEST(a_at(z) < 0.25);
    BOOST_TEST(a_at(z) > 0.5 - 2.0 / (z * z));
  }
  for (const double z : {2.829, 3.0, 3.5, 3.999}) BOOST_TEST(a_at(z) == 0.25);
}
// Stable up to z needs 16 (1 - 3b)^2 > (1 - 4b)(1 - 2b)^2 z^2, of which the bound on z is sqrt 27 at 1/6.
BOOST_AUTO_TEST_CASE(from_sqrt_27_on_three_stages_are_verlet) {
  for (const double z : {5.0, 5.19, 5.196, 5.19615}) BOOST_TEST(b_at(z) < 1.0 / 6.0);
  for (const double z : {5.19616, 5.5, 5.999}) {
    const auto c = s_aia3(z).coefficients();
    BOOST_TEST(c[0] == 1.0 / 6.0);
    BOOST_TEST(std::abs(c[1] - 1.0 / 3.0) <= 4.0 * eps);
  }
}

BOOST_AUTO_TEST_CASE(a_method_is_stable_up_to_the_z_it_is_made_for) {
  for (const double z : {1e-3, 1.0, 2.0, 2.6, 2.7, 2.8, 2.82, 2.829, 3.0, 3.5, 3.999}) {
    BOOST_TEST_CONTEXT("z " << z) { BOOST_TEST(is_stable(stability_windows(s_aia2(z)), 0.0, z)); }
  }
  for (const double z : {1e-3, 2.9, 3.1, 4.0, 5.0, 5.19, 5.2, 5.9}) {
    BOOST_TEST_CONTEXT("three stages, z " << z) {
      BOOST_TEST(is_stable(stability_windows(s_aia3(z)), 0.0, z));
    }
  }
  BOOST_TEST(!is_stable(stability_windows(bcss3()), 0.0, 4.8));
  BOOST_TEST(!is_stable(stability_windows(bcss2()), 0.0, 2.7));
  BOOST_TEST(!is_stable(stability_windows(s_aia2(2.6)), 0.0, 2.8));
}

BOOST_AUTO_TEST_CASE(a_system_and_a_step_give_the_z) {
  BOOST_TEST(s_aia2_for(harmonic_oscillator(50.0), 0.04).highest_z() == 50.0 * 0.04);
  BOOST_TEST(s_aia2_for(harmonic_oscillator(50.0), -0.04).highest_z() == 50.0 * 0.04);
  const fpu_chain<3> chain(50.0);
  const auto method = s_aia2_for(chain, 0.02);
  BOOST_TEST(method.highest_z() == 0.02 * chain.frequency_bands().back().high);
  BOOST_TEST((method.coefficients() == palindrome<5>({a_at(method.highest_z())})));
  BOOST_TEST(s_aia2::name() == "s_aia2");
  BOOST_TEST(s_aia3(2.0).highest_z() == 2.0);
  BOOST_TEST(s_aia3::name() == "s_aia3");
}

BOOST_AUTO_TEST_CASE(impossible_z_are_refused_with_a_sentence) {
  using wrong = std::invalid_argument;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  for (const double z : {0.0, -1.0, infinite, not_a_number}) {
    BOOST_TEST(refuses<wrong>([&] { s_aia2{z}; }, {"s_aia2", "positive and finite"}));
  }
  for (const double z : {4.0, 1e300}) {
    BOOST_TEST(refuses<wrong>([&] { s_aia2{z}; }, {"s_aia2", "take a smaller step", "z < 4"}));
  }
  const harmonic_oscillator system(50.0);
  BOOST_TEST(
      refuses<wrong>([&] { s_aia2_for(system, 0.08); }, {"z = step * highest frequency must", "got 4"}));
  BOOST_TEST(refuses<wrong>([&] { s_aia2_for(system, 0.0); }, {"positive and finite"}));
  BOOST_TEST(refuses<wrong>([] { s_aia3{0.0}; }, {"s_aia3", "positive and finite"}));
  BOOST_TEST(refuses<wrong>([] { s_aia3{6.0}; }, {"s_aia3", "three stages", "z < 6"}));
}
