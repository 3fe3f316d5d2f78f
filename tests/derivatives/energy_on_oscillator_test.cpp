// SPDX-License-Identifier: BSL-1.0
// The expected energy error of a word on an oscillator is that of the powers of its matrix.
#include "nysalt/derivatives/energy_on_oscillator.hpp"

#include <boost/test/unit_test.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/step_matrix.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/classical_methods.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

tabulated classical_word(const std::string& name) {
  for (const auto& row : classical_table) {
    if (row.name == name) return as_data(row);
  }
  throw std::invalid_argument(name);
}

double rho(const tabulated& method, double z) {
  return energy_error_on_oscillator(method.letters(), method.coefficients(), z);
}

/// The mean growth of (omega q)^2/2 + p^2/2 after n steps from independent normal omega q and p.
double growth(const tabulated& method, double z, int steps) {
  const auto m = matrix_on_oscillator(method.letters(), method.coefficients(), z * z);
  Eigen::Matrix2d step;
  step << m.qq, m.qp * z, m.pq / z, m.pp;
  Eigen::Matrix2d power = Eigen::Matrix2d::Identity();
  for (int n = 0; n < steps; ++n) power = step * power;
  return 0.5 * (power.squaredNorm() - 2.0);
}

}  // namespace

// After n steps the energy has grown by sin^2(n t) rho, cos t = trace/2. The matrix errs by some 10 roundings
// of its entries, which are below z + 1/z here, and its n-th power by n times that.
BOOST_AUTO_TEST_CASE(the_energy_grows_by_rho_times_the_square_of_a_sine) {
  for (const char* name : {"verlet", "mclachlan2", "mclachlan2v", "bcss3", "bcss4", "omelyan5v", "srkn6b",
                           "chin4a", "chin4a_displaced"}) {
    const tabulated method = classical_word(name);
    for (const double z : {0.3, 0.9, 1.5}) {
      const auto m = matrix_on_oscillator(method.letters(), method.coefficients(), z * z);
      const double angle = std::acos(m.half_trace());
      for (const int steps : {1, 2, 7}) {
        const double sine = std::sin(steps * angle);
        const double expected = sine * sine * rho(method, z);
        const double rounding = 2.0 * steps * 10.0 * eps * (z + 1.0 / z) * (z + 1.0 / z);
        BOOST_TEST_CONTEXT(name << " at z = " << z << ", " << steps << " steps") {
          BOOST_TEST(std::abs(growth(method, z, steps) - expected) <= rounding);
          BOOST_TEST(std::abs(growth(method, z, steps) - 1.01 * expected) > 1e-3 * expected);
        }
      }
    }
  }
}

// Of Verlet's method rho = z^4/(32 (1 - z^2/4)); the difference of B and C that makes it cancels to a part of
// z^2.
BOOST_AUTO_TEST_CASE(of_verlet_it_is_the_closed_form) {
  for (const double z : {0.1, 0.5, 1.0, 1.9}) {
    const double closed = std::pow(z, 4) / (32.0 * (1.0 - z * z / 4.0));
    const double relative = 40.0 * eps / (z * z * (1.0 - z * z / 4.0));
    BOOST_TEST(std::abs(rho(tabulated(verlet{}), z) - closed) <= relative * closed);
    BOOST_TEST(std::abs(rho(tabulated(bcss2{}), z) - closed) > relative * closed);
  }
  BOOST_TEST(rho(tabulated(verlet{}), 2.01) == std::numeric_limits<double>::infinity());
  BOOST_TEST(rho(tabulated(verlet{}), 2.0) == std::numeric_limits<double>::infinity());
}

// Exchanging kicks and drifts exchanges omega q and p, up to a sign. B + C is the difference of entries below
// z + 1/z, each right to some 10 roundings, and 1 - A^2 that of numbers below 1.
BOOST_AUTO_TEST_CASE(a_word_and_its_velocity_form_err_alike) {
  const tabulated method(mclachlan2{});
  for (const double z : {0.4, 1.3, 2.2}) {
    const auto m = matrix_on_oscillator(method.letters(), method.coefficients(), z * z);
    const double defect = std::abs(m.qp * z + m.pq / z);
    const double rotation = 1.0 - m.half_trace() * m.half_trace();
    const double relative = 40.0 * eps * ((z + 1.0 / z) / defect + 1.0 / rotation);
    BOOST_TEST(std::abs(rho(method, z) / rho(tabulated(mclachlan2v{}), z) - 1.0) <= relative);
    BOOST_TEST(std::abs(rho(method, z) / rho(tabulated(bcss2v{}), z) - 1.0) > relative);
  }
}

// Against a central difference over 1e-5, which errs by the third derivative, of order one, times 1e-10/6,
// and by roundings of 1e-15 over 1e-5.
BOOST_AUTO_TEST_CASE(slopes_are_those_of_the_value) {
  draws random;
  for (const char* name : {"mclachlan2v", "bcss3", "chin4a", "chin4a_displaced"}) {
    const tabulated method = classical_word(name);
    const double z = random.uniform(0.7, 1.3);
    auto c = method.coefficients();
    const auto at = detail::energy_defect_on_oscillator(method.letters(), c, z);
    BOOST_TEST(at.value * at.value == rho(method, z), boost::test_tools::tolerance(1e-12));
    for (std::size_t i = 0; i < c.size(); ++i) {
      constexpr double change = 1e-5;
      const double before = c[i];
      c[i] = before + change;
      const double above = detail::energy_defect_on_oscillator(method.letters(), c, z).value;
      c[i] = before - change;
      const double below = detail::energy_defect_on_oscillator(method.letters(), c, z).value;
      c[i] = before;
      const double slope = at.slopes[static_cast<Eigen::Index>(i)];
      BOOST_TEST_CONTEXT(name << ", coefficient " << i + 1) {
        BOOST_TEST(std::abs((above - below) / (2.0 * change) - slope) <= 1e-8 * (1.0 + std::abs(slope)));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(words_that_are_no_plain_step_are_refused) {
  using wrong = std::invalid_argument;
  for (const char* name : {"impulse", "baoab", "takahashi_imada_processed"}) {
    for (const auto* table : {&classical_table[0], &processed_table[0]}) {
      const std::size_t rows =
          table == &classical_table[0] ? std::size(classical_table) : std::size(processed_table);
      for (std::size_t k = 0; k < rows; ++k) {
        if (table[k].name != name) continue;
        BOOST_TEST(refuses<wrong>([&] { rho(as_data(table[k]), 0.5); }, {"no rotation", "no processor"}));
      }
    }
  }
  BOOST_TEST(refuses<wrong>([] { energy_error_on_oscillator(run_time_word("BAB"), {0.5, 1.0}, 0.5); }, {}));
}
