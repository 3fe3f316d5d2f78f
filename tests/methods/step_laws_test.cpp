// SPDX-License-Identifier: BSL-1.0
// What one step of every method keeps, on every system: symplecticity, reversibility, consistency; and its
// declared order, measured on nonlinear problems.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "../laws/laws.hpp"
#include "nysalt/detail/palindrome.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical_methods.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

std::vector<specimen> differentiable_specimens() { return specimens_with(has_exact_derivatives); }

/// Sum of the first coefficients of letters of these kinds.
double sum_of(const tabulated& method, const std::string& kinds) {
  const auto& word = method.letters();
  const auto c = method.coefficients();
  double sum = 0.0;
  for (std::size_t i = 0; i < word.length; ++i) {
    if (kinds.find(word.letters()[i]) != std::string::npos) sum += c[word.first_slot(i)];
  }
  return sum;
}

}  // namespace

BOOST_AUTO_TEST_CASE(steps_are_symplectic) {
  try_all_methods(differentiable_specimens(), 2,
                  [](const model& system, const tabulated& method, double step, const any_state& x) {
                    if (method.letters().is_symplectic) {
                      BOOST_TEST(symplecticity_broken(system, method, step, x) <= 1.0);
                    } else {
                      BOOST_TEST(volume_broken(system, method, step, x) <= 1.0);
                    }
                  });
}

BOOST_AUTO_TEST_CASE(explicit_euler_is_not_and_a_displaced_kick_is_not) {
  draws random;
  for (const auto& one : differentiable_specimens()) {
    const auto x = one.at_random(random);
    const double step = 0.25 / shears_at(one.system, x).frequency();
    BOOST_TEST_CONTEXT(describe(one.system)) {
      BOOST_TEST(symplecticity_broken_by_euler(one.system, step, x) > 1e6);
    }
  }
  const auto& galaxy = specimen_of("henon_heiles");
  const tabulated displaced("displaced", run_time_word("BADAB"), {0.2, 0.5, 0.6, 0.05, 0.5, 0.2},
                            {2, true, true});
  const auto x = galaxy.at_random(random);
  BOOST_TEST(!displaced.letters().is_symplectic);
  BOOST_TEST(symplecticity_broken(galaxy.system, displaced, 0.2, x) > 1e3);
  BOOST_TEST(volume_broken(galaxy.system, displaced, 0.2, x) <= 1.0);
  const auto& spring = specimen_of("harmonic_oscillator");
  BOOST_TEST(symplecticity_broken(spring.system, displaced, 0.2, spring.at_random(random)) <= 1.0);
}

// J^T Omega J is e^{-gamma h} Omega for the friction gamma.
BOOST_AUTO_TEST_CASE(in_a_bath_steps_are_conformally_symplectic) {
  draws random;
  std::vector<specimen> exact;
  for (const auto& one : specimens_in_baths()) {
    if (has_exact_derivatives(one.system)) exact.push_back(one);
  }
  try_all(exact, methods_for_baths(random),
          [](const model& system, const tabulated& method, double step, const any_state& x) {
            BOOST_TEST(symplecticity_broken(system, method, step, x) <= 1.0);
            const model other = system.in(bath::of_sigma(system.bath().friction() + 1e-3, 0.1));
            BOOST_TEST(std::abs(other.bath().decay(step) - system.bath().decay(step)) > 1e-6);
          });
}

BOOST_AUTO_TEST_CASE(reversible_where_declared_symmetric_and_else_not) {
  try_all_methods(differentiable_specimens(), 2,
                  [](const model& system, const tabulated& method, double step, const any_state& x) {
                    const double reversible = reversibility_broken(system, method, step, x);
                    const double undone = undoing_broken(system, method, step, x);
                    if (method.symmetric) {
                      BOOST_TEST(reversible <= 1.0);
                      BOOST_TEST(undone <= 1.0);
                    } else if (!describe(system).starts_with("lennard_jones")) {  // atoms hardly move
                      BOOST_TEST(reversible > 1.0);
                      BOOST_TEST(undone > 1.0);
                    }
                  });
}

BOOST_AUTO_TEST_CASE(members_with_equal_kicks_are_reversible) {
  draws random;
  const auto& one = specimen_of("pendulum");
  for (int n = 0; n < 20; ++n) {
    const double beta1 = random.uniform(0.0, 0.5);
    const auto x = one.at_random(random);
    const auto broken = [&](double b1) {
      return reversibility_broken(one.system, tabulated(member<nystrom>({b1, beta1})), 0.25, x);
    };
    BOOST_TEST_CONTEXT("beta1 = " << beta1) {
      BOOST_TEST(broken(0.5) <= 1.0);
      BOOST_TEST(broken(0.51) > 10.0);
    }
  }
}

// Consistency: kicks of every kind sum to 1, and so do drifts and rotations, and letters O. Declared
// symmetric: the word and its coefficients read the same backwards, letter by letter.
BOOST_AUTO_TEST_CASE(coefficients_are_consistent) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    auto all = methods_as_data(random);
    for (auto& method : methods_for_baths(random)) all.push_back(std::move(method));
    for (const auto& method : all) {
      const auto& word = method.letters();
      const auto c = method.coefficients();
      double size = 1.0;
      for (const double x : c) size += std::abs(x);
      BOOST_TEST_CONTEXT(method.name() << ", draw " << n) {
        for (const char* kinds : {"AR", "BDGSH"}) {  // each coefficient and each sum rounds once
          BOOST_TEST(std::abs(sum_of(method, kinds) - 1.0) <= static_cast<double>(c.size()) * eps * size);
        }
        const double of_bath = word.stochastic_letters > 0 ? 1.0 : 0.0;
        BOOST_TEST(std::abs(sum_of(method, "O") - of_bath) <= 2.0 * eps);  // of thirds, too
        for (std::size_t i = 0; method.symmetric && i < word.length; ++i) {
          const std::size_t other = word.length - 1 - i;
          BOOST_TEST(word.letters()[i] == word.letters()[other]);
          for (std::size_t k = 0; k < word.slots_of(i); ++k) {
            BOOST_TEST(c[word.first_slot(i) + k] == c[word.first_slot(other) + k]);
          }
        }
      }
    }
  }
}

// Orders.

namespace {

constexpr double allowed = 0.15;  // see measured_order

/// Far out, where V is nonlinear, for a while; or less far and for longer, where a method of high order errs
/// by more than rounding at steps that are small enough.
const solved& problem(const std::string& system, bool for_longer) {
  static std::map<std::pair<std::string, bool>, solved> known;
  const auto found = known.find({system, for_longer});
  if (found != known.end()) return found->second;
  draws random;
  auto one = specimen_of(system);
  one.reach.reach *= for_longer ? 1.0 : 2.0;
  solved made(one.system, {one.at_random(random), one.at_random(random), one.at_random(random)},
              for_longer ? 24.0 : 4.0);
  return known.emplace(std::pair{system, for_longer}, std::move(made)).first->second;
}

double order_on(const std::string& system, const table& method, int declared = 0) {
  return declared < 6 ? measured_order(problem(system, false), method, 8)
                      : measured_order(problem(system, true), method, 64);
}
double order_on(const std::string& system, const tabulated& method) {
  return order_on(system, method, method.order);
}

const std::string split_pendulum = "pendulum() with";
const std::string galaxy = "henon_heiles";

tabulated row(std::string_view name) {
  for (const auto& one : classical_table) {
    if (one.name == name) return as_data(one);
  }
  throw std::invalid_argument("no such row");
}

/// The order of those that are fitted to a frequency is that of steps for each of which they are fitted: see
/// phase_fitted_test.cpp.
bool changes_with_step(const tabulated& method) { return method.name().starts_with("phase_fitted_"); }

}  // namespace

BOOST_AUTO_TEST_CASE(the_declared_order_is_the_measured_one) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    if (changes_with_step(method)) continue;
    for (const auto& one : specimens_with([](const model& system) {
           const std::string name = describe(system);
           return name.starts_with(split_pendulum) || name.starts_with(galaxy) ||
                  (has_quadratic_part(system) && !system.has_unit_mass() && system.size() == 2) ||
                  !has_quadratic_kinetic(system);
         })) {
      if (!suits(one.system, method)) continue;
      BOOST_TEST_CONTEXT(method.name() << " on " << describe(one.system)) {
        BOOST_TEST(std::abs(order_on(describe(one.system), method) - method.order) <= allowed);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(methods_lose_their_order_where_they_are_refused) {
  const auto another_kinetic = specimens_with([](const model& s) { return !has_quadratic_kinetic(s); });
  const std::string fast = describe(another_kinetic.front().system);
  BOOST_TEST(order_on(fast, table(row("srkn11b"))) < 6 - 1.0);
  BOOST_TEST(order_on(fast, table(row("mclachlan_atela4"))) < 4 - 0.5);
}

// Mistakes that a typist makes. The method stays consistent and symmetric, and order 2 is what remains.
BOOST_AUTO_TEST_CASE(a_slip_in_a_table_lowers_the_order) {
  BOOST_TEST(std::abs(order_on(split_pendulum, table(row("pefrl"))) - 4.0) <= allowed);
  const auto with_slip = [](const char* name, const std::function<void(std::vector<double>&)>& slip) {
    table wrong = row(name);
    slip(wrong.coefficients);
    return Eigen::Array2d(order_on(split_pendulum, wrong), order_on(galaxy, wrong));
  };
  const auto digit = with_slip("pefrl", [](auto& c) {  // of the first coefficient; drifts still sum to 1
    for (const std::size_t k : {0U, 8U}) c[k] += 0.005;
    c[4] -= 0.01;
  });
  BOOST_TEST(digit.maxCoeff() < 3.0);
  const auto swapped = with_slip("srkn11b", [](auto& c) {
    std::swap(c[1], c[3]);
    std::swap(c[21], c[19]);
  });
  BOOST_TEST(swapped.maxCoeff() < 3.0);
  // With another factor of the gradient Chin's method is three stages of order 2.
  for (const double factor : {0.0, -1.0, 2.0}) {
    const auto gradient = with_slip("chin4a", [&](auto& c) { c[3] *= factor; });
    BOOST_TEST((gradient - 2.0).abs().maxCoeff() <= allowed);
  }
}

// Why orders are not measured on the oscillator. Its Lie algebra is small: this method solves the four
// conditions on its matrix up to h^6 (by Newton's method) and no more.
BOOST_AUTO_TEST_CASE(the_oscillator_alone_is_not_to_be_trusted) {
  const auto c = palindrome<11>({0.18685656311551122, 0.5642486163110636,  //
                                 0.5520581660514783, -0.23936270217732913});
  const table method{run_time_word("BABABABABAB"), {c.begin(), c.end()}};
  BOOST_TEST(std::abs(order_on("harmonic_oscillator", method) - 6.0) <= allowed);
  BOOST_TEST(std::abs(order_on(split_pendulum, method) - 4.0) <= allowed);
  BOOST_TEST(std::abs(order_on(galaxy, method) - 4.0) <= allowed);
}
