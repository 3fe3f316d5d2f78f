// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 14 s at -O0, 0.4 s at -O1.
// What one step of every method keeps, on every system: symplecticity, reversibility, consistency; and its
// declared order, measured on nonlinear problems. Classical methods: their rows, their steps by formulas
// written out, several of them in one, and tables that cannot be. Runs of every method, with noise and
// without: merged letters change nothing but rounding; observing, cutting and lanes change no bit; a system
// steps as its model; and all costs what is declared.
#include <set>

#include "../laws/models.hpp"
#include "../support/members.hpp"
#include "../support/refusal.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

std::vector<specimen> differentiable_specimens() { return specimens_with(has_exact_derivatives); }

/// Sum of the first coefficients of letters of these kinds.
double sum_of(const nysalt::method& method, const std::string& kinds) {
  const auto& word = method.letters();
  const auto c = method.coefficients();
  double sum = 0.0;
  for (std::size_t i = 0; i < word.length; ++i) {
    if (kinds.find(word.letters()[i]) != std::string::npos) sum += c[word.first_slot(i)];
  }
  return sum;
}

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
double order_on(const std::string& system, const method& method) {
  return order_on(system, method, method.order);
}

const std::string split_pendulum = "pendulum() with";
const std::string galaxy = "henon_heiles";

method row(std::string_view name) {
  return detail::as_data(*std::ranges::find(detail::classical_table, name, &detail::classical_row::name));
}

/// The order of those that are fitted to a frequency is that of steps for each of which they are fitted: see
/// adaptive_test.cpp.
bool changes_with_step(const method& method) { return method.name().starts_with("phase_fitted_"); }

constexpr double h = 0.3;

void must_be_row(const nysalt::method& method) {
  const nysalt::method data = row(method.name());
  BOOST_TEST((method.letters() == data.letters() && method.coefficients() == data.coefficients()));
  BOOST_TEST(method.order == data.order);
  BOOST_TEST(method.symmetric == data.symmetric);
  BOOST_TEST(method.requires_quadratic_kinetic == data.requires_quadratic_kinetic);
}

/// Of a dynamic dimension, and with masses; in potentials that let go of none, and split, so that every
/// method can step them.
std::vector<specimen> bound_specimens() {
  return specimens_with([](const model& system) {
    return describe(system).find("with a quadratic part") != std::string::npos && system.size() > 1;
  });
}

std::vector<method> quiet_methods() {
  draws random;
  return methods_as_data(random);
}
std::vector<method> noisy_methods() {
  draws random;
  return methods_for_baths(random);
}

/// Where a run is that is cut there, by a stepper of types.
template <int N>
phase_point<double, N> finish(const auto& fixed, const phase_point<double, N>& x, std::int64_t steps,
                              std::int64_t first = 0) {
  auto run = fixed.open(x, 5);
  fixed.advance(run, first);
  fixed.advance(run, steps - first);
  return fixed.synchronous(run);
}

}  // namespace

BOOST_AUTO_TEST_CASE(steps_are_symplectic) {
  try_all_methods(differentiable_specimens(), 2,
                  [](const model& system, const method& method, double step, const any_state& x) {
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
  const method displaced("displaced", nysalt::word("BADAB"), {0.2, 0.5, 0.6, 0.05, 0.5, 0.2},
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
  try_all(specimens_in_baths(), methods_for_baths(random),
          [](const model& system, const method& method, double step, const any_state& x) {
            if (!has_exact_derivatives(system)) return;
            BOOST_TEST(symplecticity_broken(system, method, step, x) <= 1.0);
            const model other = system.in(bath::of_sigma(system.bath().friction() + 1e-3, 0.1));
            BOOST_TEST(std::abs(other.bath().decay(step) - system.bath().decay(step)) > 1e-6);
          });
}

BOOST_AUTO_TEST_CASE(reversible_where_declared_symmetric_and_else_not) {
  try_all_methods(differentiable_specimens(), 2,
                  [](const model& system, const method& method, double step, const any_state& x) {
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

BOOST_AUTO_TEST_CASE(the_declared_order_is_the_measured_one) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    if (changes_with_step(method)) continue;
    for (const auto& one : specimens_with([](const model& system) {
           const std::string name = describe(system);
           return name.starts_with(split_pendulum) || name.starts_with(galaxy) ||
                  (system.facts().has_quadratic_part && !system.has_unit_mass() && system.size() == 2) ||
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
// More mistakes: derivatives/words_test.cpp.
BOOST_AUTO_TEST_CASE(a_slip_in_a_table_lowers_the_order) {
  table method = row("pefrl");
  BOOST_TEST(std::abs(order_on(split_pendulum, method) - 4.0) <= allowed);
  for (const std::size_t k : {0U, 8U}) method.coefficients[k] += 0.005;  // drifts still sum to 1
  method.coefficients[4] -= 0.01;
  for (const auto& system : {split_pendulum, galaxy}) BOOST_TEST(order_on(system, method) < 3.0);
}

BOOST_AUTO_TEST_CASE(a_row_as_a_type_is_the_row_as_data) {
  must_be_row(verlet());
  must_be_row(mclachlan_atela4());  // not symmetric, for quadratic K alone
  must_be_row(omelyan_fg4());
  must_be_row(impulse());
  must_be_row(baoab());
}

BOOST_AUTO_TEST_CASE(names_are_unique_and_palindromes_are_symmetric) {
  std::set<std::string_view> names;
  for (const auto& row : detail::classical_table) {
    BOOST_TEST(names.insert(row.name).second, row.name);
    BOOST_TEST(!row.source.empty(), row.name);
    const nysalt::method method = detail::as_data(row);
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
  BOOST_TEST(refuses([] { repeated(nysalt::method(baoab{}), 2); }, {"BAOAB"}));
  BOOST_TEST(refuses([] { repeated(nysalt::classical_methods().front(), 0); }, {"0 steps"}));
}

BOOST_AUTO_TEST_CASE(tables_that_cannot_be_are_refused) {
  const method_properties nothing{1, false, false};
  const auto made = [&](const std::string& letters, const std::vector<double>& c) {
    return [=] { method("mine", nysalt::word(letters), c, nothing); };
  };
  BOOST_TEST(refuses(made("ABA", {0.5, 1.0}), {"2 coefficients for the 3 letters ABA"}));
  BOOST_TEST(refuses(made("AGA", {0.5, 1.0, 0.5}), {"3 coefficients", "G and H take two"}));
  BOOST_TEST(refuses(made("AB", {not_a_number, 1.0}), {"coefficient 1 must be finite, got nan"}));
  BOOST_TEST(!refuses(made("AB", {1.0, 1.0}), {}));
  const relativistic fast;
  BOOST_TEST(refuses([&] { make_stepper(fast, srkn11b(), 0.1); },
                     {"srkn11b", "kinetic energy must be quadratic", "blanes_moan_s10"}));
  BOOST_CHECK_NO_THROW(make_stepper(fast, srkn6b(), 0.1));
  std::string letters;
  for (int n = 0; n < 65; ++n) letters += "BA";
  const method too_long("long", nysalt::word(letters), std::vector<double>(130, 1.0 / 65.0), nothing);
  BOOST_TEST(refuses([&] { stability_windows(too_long); }, {"<= 64"}));
}

BOOST_AUTO_TEST_CASE(merged_is_unmerged_to_rounding) {
  const auto exact = specimens_with(has_exact_derivatives);
  try_all(exact, quiet_methods(),
          [](const model& system, const method& method, double step, const any_state& x) {
            BOOST_TEST((run_of{system, method, step}.merging_broken(x, 10)) <= 1.0);
          });
}

BOOST_AUTO_TEST_CASE(merged_is_unmerged_with_noise_too) {
  for (const any_noise& noise : std::vector<any_noise>{fresh_noise(7), noise_of_a_path(7)}) {
    try_all(specimens_in_baths(), noisy_methods(),
            [&](const model& system, const method& method, double step, const any_state& x) {
              const run_of run{system, method, step, noise};
              if (has_exact_derivatives(system)) BOOST_TEST(run.merging_broken(x, 20) <= 1.0);
              const auto merged = run.finish(x, 20);
              BOOST_TEST(distance(merged, run.plain(x, 20)) < 1e-9);
              if (system.bath().sigma() == 0.0) return;
              // Plain steps that take the noise of the step before, or of another trajectory.
              BOOST_TEST(distance(merged, run.plain(x, 20, 1)) > 1e-6);
              BOOST_TEST(distance(merged, run_of{system, method, step, noise, 1}.plain(x, 20)) > 1e-6);
            });
  }
}

BOOST_AUTO_TEST_CASE(observed_and_cut_runs_have_the_bits_of_one_go) {
  const auto check = [](const run_of& run, const any_state& x, std::int64_t steps) {
    const auto whole = run.finish(x, steps);
    for (const std::int64_t every : {1, 3, 64, 1000}) {
      BOOST_TEST(same_bits(run.observed(x, steps, every), whole));
      BOOST_TEST(same_bits(run.watched(x, steps, every), whole));
    }
    for (const std::int64_t first : {std::int64_t{0}, std::int64_t{1}, std::int64_t{77}, steps}) {
      BOOST_TEST(same_bits(run.cut(x, steps, first), whole));
    }
    BOOST_TEST(!same_bits(run.finish(x, steps + 1), whole));
  };
  try_all(bound_specimens(), quiet_methods(),
          [&](const model& system, const method& method, double step, const any_state& x) {
            check({system, method, step}, x, 200);
          });
  for (const any_noise& noise : std::vector<any_noise>{fresh_noise(7), noise_of_a_path(7)}) {
    try_all(specimens_in_baths(), noisy_methods(),
            [&](const model& system, const nysalt::method& method, double step, const any_state& x) {
              check({system, method, step, noise}, x, 100);
              if (system.bath().sigma() == 0.0) return;  // another trajectory, another seed: other noise
              const auto whole = run_of{system, method, step, noise}.finish(x, 100);
              BOOST_TEST(!same_bits(run_of{system, method, step, noise, 1}.finish(x, 100), whole));
              BOOST_TEST(!same_bits(run_of{system, method, step, fresh_noise(8)}.finish(x, 100), whole));
            });
  }
}

BOOST_AUTO_TEST_CASE(each_lane_has_the_bits_of_one_trajectory) {
  draws random;
  for (const auto& one : specimens_in_baths()) {
    if (!one.system.facts().in_lanes) continue;
    for (const auto& method : noisy_methods()) {
      for (const any_noise& noise : std::vector<any_noise>{fresh_noise(3), noise_of_a_path(3)}) {
        const run_of run{one.system, method, 0.02, noise};
        BOOST_TEST(run.lanes_are_alone(one, random));
        BOOST_TEST(!run.lanes_are_alone(one, random, 32));  // a step apart
        if (one.system.bath().sigma() > 0.0) BOOST_TEST(!run.lanes_are_alone(one, random, 31, 41));
      }
    }
  }
}

// A system by its type takes the same steps as its model: of fixed and dynamic dimension, with masses,
// without noise and with.
BOOST_AUTO_TEST_CASE(a_system_by_its_type_steps_as_its_model) {
  draws random;
  const auto check = [&](const auto& system, const method& method, const auto& noise) {
    const model erased(system);
    const auto x = random.state(system, 0.5);
    const any_state same{x.q, x.p};
    const auto by_type = make_stepper(system, method, 0.05, noise);
    const auto by_model = make_stepper(erased, method, 0.05, noise);
    BOOST_TEST_CONTEXT(method.name() << " on " << describe(system)) {
      const auto whole = finish(by_type, x, 200);
      BOOST_TEST(same_bits(finish(by_model, same, 200), whole));
      BOOST_TEST(same_bits(finish(by_type, x, 200, 77), whole));
      auto watched = by_type.open(x, 5);
      by_type.advance(watched, 200, 3, [](auto&&...) {});
      BOOST_TEST(same_bits(by_type.synchronous(watched), whole));
      auto plain = x;
      auto plain_of_model = same;
      by_type.step(plain, 5, 9);
      by_model.step(plain_of_model, 5, 9);
      BOOST_TEST(same_bits(plain_of_model, plain));
      // Another table takes other steps: the comparison can tell.
      auto changed = method.coefficients();
      changed.front() += 1e-9;
      const nysalt::method another("another", method.letters(), changed, method);
      BOOST_TEST(!same_bits(finish(make_stepper(system, another, 0.05, noise), x, 200), whole));
    }
  };
  const auto masses = split_masses();
  const auto ring = split_ring();
  check(masses, verlet(), no_noise());
  check(masses, chin4a(), no_noise());
  check(masses, start_of<fd_chin>(), no_noise());
  check(masses, impulse(), no_noise());
  check(ring, verlet(), no_noise());
  check(ring, start_of<r_fg4>(), no_noise());
  const in_bath warm_masses(masses, bath::of_sigma(0.4, 0.3));
  const in_bath warm_ring(ring, bath::of_temperature(0.3, 0.02));
  check(warm_masses, obabo(), counter_noise(7));
  check(warm_ring, baoab(), noise_of_a_path(7));
}

// In no bath, or in one that does not act, a word with letters O is the word without them, to the bit.
BOOST_AUTO_TEST_CASE(in_a_quiet_bath_a_step_is_that_of_the_word_without_letters_o) {
  draws random;
  for (const auto& name : {"fpu_chain(pairs=3", "linear_chain(masses=3", "kepler"}) {
    const auto& one = specimen_of(name);
    for (const auto& method : noisy_methods()) {
      const nysalt::word& word = method.letters();
      const nysalt::method expected("expected", conservative_part(word),
                                    conservative_part(word, method.coefficients()), method);
      const auto x = one.at_random(random);
      const auto alike = [&](const model& system) {
        const run_of found{system, method, 0.02};
        const run_of wanted{one.system, expected, 0.02};
        return same_bits(found.plain(x, 1), wanted.plain(x, 1)) &&
               same_bits(found.finish(x, 1), wanted.finish(x, 1)) &&
               same_bits(found.finish(x, 200), wanted.finish(x, 200));
      };
      BOOST_TEST_CONTEXT(method.name() << " on " << describe(one.system)) {
        BOOST_TEST(alike(one.system));
        BOOST_TEST(alike(one.system.in(bath::of_sigma(0.0, 0.0))));
        BOOST_TEST(alike(one.system.in(bath::of_temperature(0.0, 1.0))));
        BOOST_TEST(!alike(one.system.in(bath::of_sigma(1e-9, 0.0))));  // the least friction is seen
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(evaluations_are_those_declared) {
  draws random;
  const auto check = [&](const auto& system, const std::vector<method>& methods, const auto& noise) {
    const auto x = random.state(system, 0.5);
    const counted watched(system);
    for (const auto& method : methods) {
      const auto& word = method.letters();
      const auto fixed = make_stepper(watched, method, 0.02, noise);
      for (const std::int64_t n : {0, 1, 2, 17}) {
        watched.evaluations = 0;
        auto run = fixed.open(x);
        for (std::int64_t k = 0; k < n; ++k) {
          fixed.advance(run, 1);
          fixed.synchronous(run);
        }
        BOOST_TEST(watched.evaluations == word.evaluations_to_open + n * word.evaluations_per_step,
                   method.name());
      }
      watched.evaluations = 0;
      auto y = x;
      fixed.step(y);
      BOOST_TEST(watched.evaluations == word.evaluations_of_plain_step, method.name());
    }
  };
  check(split_masses(), quiet_methods(), no_noise());
  check(in_bath(fpu_chain<3>(10.0), bath::of_sigma(0.1, 0.1)), noisy_methods(), counter_noise(1));
  // Numbers by hand; the kicks of the chain are its own, and count.
  static_assert(HasKick<counted<fpu_chain<3>>, double>);
  const counted watched(fpu_chain<3>(10.0));
  auto y = random.state(watched, 0.5);
  finish(make_stepper(watched, verlet(), 0.01), y, 10);
  BOOST_TEST(watched.evaluations == 11);
  make_stepper(watched, verlet(), 0.01).step(y);
  BOOST_TEST(watched.evaluations == 11 + 2);
}
