// SPDX-License-Identifier: BSL-1.0
// What one step of every method keeps, on every system: symplecticity, reversibility, consistency; and its
// declared order, measured on nonlinear problems. Classical methods: their rows as types and as data, their
// steps by formulas written out, several of them in one, and tables that cannot be.
#include <set>
#include "../laws/laws.hpp"
#include "../support/refusal.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/classical_methods.hpp"
#include "nysalt/methods/repeated.hpp"

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
                    const double broken = reversibility_broken(system, method, step, x);
                    if (method.symmetric) {
                      BOOST_TEST(broken <= 1.0);
                    } else if (!describe(system).starts_with("lennard_jones")) {  // atoms hardly move
                      BOOST_TEST(broken > 1.0);
                    }
                  });
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
        BOOST_TEST(sum_of(method, "O") == (word.stochastic_letters > 0 ? 1.0 : 0.0));
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
/// adaptive_test.cpp.
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

// A typist's mistake in one digit. The method stays consistent and symmetric, and order 2 is what remains.
// More mistakes: derivatives/taylor_order_test.cpp.
BOOST_AUTO_TEST_CASE(a_slip_in_a_table_lowers_the_order) {
  table method = row("pefrl");
  BOOST_TEST(std::abs(order_on(split_pendulum, method) - 4.0) <= allowed);
  for (const std::size_t k : {0U, 8U}) method.coefficients[k] += 0.005;  // drifts still sum to 1
  method.coefficients[4] -= 0.01;
  for (const auto& system : {split_pendulum, galaxy}) BOOST_TEST(order_on(system, method) < 3.0);
}

// Classical methods.

namespace {

constexpr double h = 0.3;

template <Method M>
void must_be_row(const M& method) {
  const tabulated as_type(method);
  const tabulated data = row(method.name());
  BOOST_TEST(as_type.letters().letters() == data.letters().letters());
  BOOST_TEST((as_type.coefficients() == data.coefficients()));
  BOOST_TEST(as_type.order == data.order);
  BOOST_TEST(as_type.symmetric == data.symmetric);
  BOOST_TEST(as_type.requires_quadratic_kinetic == data.requires_quadratic_kinetic);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_row_as_a_type_is_the_row_as_data) {
  must_be_row(verlet());
  must_be_row(mclachlan_atela4());  // not symmetric, for quadratic K alone
  must_be_row(omelyan_fg4());
  must_be_row(impulse());
  must_be_row(baoab());
}

BOOST_AUTO_TEST_CASE(names_are_unique_and_palindromes_are_symmetric) {
  std::set<std::string_view> names;
  for (const auto& row : classical_table) {
    BOOST_TEST(names.insert(row.name).second, row.name);
    BOOST_TEST(!row.source.empty(), row.name);
    const tabulated method = as_data(row);
    BOOST_TEST(is_palindrome(method.letters(), method.coefficients()) == row.symmetric, row.name);
  }
}

BOOST_AUTO_TEST_CASE(rivals_are_rows_without_a_bath_that_repeat_no_other) {
  std::set<std::string> names;
  for (const auto& method : nysalt::classical_methods()) names.insert(method.name());
  BOOST_TEST(names.contains("pefrl"));
  BOOST_TEST(names.contains("impulse"));
  BOOST_TEST(!names.contains("baoab"));
  BOOST_TEST(!names.contains("verlet_2x"));
}

BOOST_AUTO_TEST_CASE(a_repeated_method_is_its_steps_one_after_the_other) {
  draws random;
  const auto& galaxy = specimen_of("henon_heiles");
  for (const auto& method : nysalt::classical_methods()) {
    if (method.letters().letters().find('R') != std::string::npos) continue;
    for (const int times : {1, 2, 3}) {
      if (times > 1 && method.letters().is_processed()) continue;  // refused: see processed_test.cpp
      const auto whole = repeated(method, times);
      BOOST_TEST(whole.letters().evaluations_per_step == times * method.letters().evaluations_per_step);
      const auto x = galaxy.at_random(random);
      // Coefficients times h / n, or times h and then 1/n: two roundings for each of some 60 letters.
      BOOST_TEST(distance(run_of{galaxy.system, whole, h}.plain(x, 1),
                          run_of{galaxy.system, method, h / times}.plain(x, times)) < 1e-14,
                 method.name() << " " << times);
    }
  }
  BOOST_TEST(refuses<std::invalid_argument>([] { repeated(tabulated(baoab{}), 2); }, {"BAOAB"}));
  BOOST_TEST(
      refuses<std::invalid_argument>([] { repeated(nysalt::classical_methods().front(), 0); }, {"0 steps"}));
}

BOOST_AUTO_TEST_CASE(tables_that_cannot_be_are_refused) {
  const method_properties nothing{1, false, false};
  const auto made = [&](const std::string& letters, const std::vector<double>& c) {
    return [=] { tabulated("mine", run_time_word(letters), c, nothing); };
  };
  using error = std::invalid_argument;
  BOOST_TEST(refuses<error>(made("ABA", {0.5, 1.0}), {"2 coefficients for the 3 letters ABA"}));
  BOOST_TEST(refuses<error>(made("AGA", {0.5, 1.0, 0.5}), {"3 coefficients", "G and H take two"}));
  BOOST_TEST(refuses<error>(made("AB", {std::numeric_limits<double>::quiet_NaN(), 1.0}),
                            {"coefficient 1 must be finite, got nan"}));
  BOOST_TEST(!refuses<error>(made("AB", {1.0, 1.0}), {}));
  // The order of srkn11b needs a quadratic kinetic energy; as data it can only say so when it is run.
  const relativistic fast;
  const tabulated needs_quadratic(srkn11b{});
  BOOST_TEST(refuses<error>([&] { make_stepper(fast, needs_quadratic, 0.1); },
                            {"kinetic energy must be quadratic"}));
  BOOST_CHECK_NO_THROW(make_stepper(fast, tabulated(srkn6b{}), 0.1));
  std::string letters;
  for (int n = 0; n < 65; ++n) letters += "BA";
  const tabulated too_long("long", run_time_word(letters), std::vector<double>(130, 1.0 / 65.0), nothing);
  BOOST_TEST(refuses<error>([&] { stability_windows(too_long); }, {"<= 64"}));
}
