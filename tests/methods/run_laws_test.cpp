// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 14 s at -O0, 0.4 s at -O1.
// Runs of every method, with noise and without: merged letters change nothing but rounding; observing,
// cutting and lanes change no bit; a method by its type is the method as data; and all costs what is
// declared.
#include "../laws/models.hpp"
#include "nysalt/families/thermostatted.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Of a dynamic dimension, and with masses; in potentials that let go of none, and split, so that every
/// method can step them.
std::vector<specimen> bound_specimens() {
  return specimens_with([](const model& system) {
    return describe(system).find("with a quadratic part") != std::string::npos && system.size() > 1;
  });
}

std::vector<tabulated> quiet_methods() {
  draws random;
  return methods_as_data(random);
}
std::vector<tabulated> noisy_methods() {
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

BOOST_AUTO_TEST_CASE(merged_is_unmerged_to_rounding) {
  const auto exact = specimens_with(has_exact_derivatives);
  try_all(exact, quiet_methods(),
          [](const model& system, const tabulated& method, double step, const any_state& x) {
            BOOST_TEST((run_of{system, method, step}.merging_broken(x, 10)) <= 1.0);
          });
}

BOOST_AUTO_TEST_CASE(merged_is_unmerged_with_noise_too) {
  for (const any_noise& noise : std::vector<any_noise>{fresh_noise(7), noise_of_a_path(7)}) {
    try_all(specimens_in_baths(), noisy_methods(),
            [&](const model& system, const tabulated& method, double step, const any_state& x) {
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
          [&](const model& system, const tabulated& method, double step, const any_state& x) {
            check({system, method, step}, x, 200);
          });
  for (const any_noise& noise : std::vector<any_noise>{fresh_noise(7), noise_of_a_path(7)}) {
    try_all(specimens_in_baths(), noisy_methods(),
            [&](const model& system, const tabulated& method, double step, const any_state& x) {
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

// A type and its table take the same steps: of fixed and dynamic dimension, with masses, without noise and
// with.
BOOST_AUTO_TEST_CASE(a_method_by_its_type_is_the_method_as_data) {
  draws random;
  const auto check = [&](const auto& system, const auto& method, const auto& noise) {
    const tabulated as_data(method);
    const auto x = random.state(system, 0.5);
    const auto by_type = make_stepper(system, method, 0.05, noise);
    const auto by_data = make_stepper(system, as_data, 0.05, noise);
    BOOST_TEST_CONTEXT(method.name() << " on " << describe(system)) {
      const auto whole = finish(by_type, x, 200);
      BOOST_TEST(same_bits(finish(by_data, x, 200), whole));
      BOOST_TEST(same_bits(finish(by_type, x, 200, 77), whole));
      auto watched = by_type.open(x, 5);
      by_type.advance(watched, 200, 3, [](auto&&...) {});
      BOOST_TEST(same_bits(by_type.synchronous(watched), whole));
      auto plain = x;
      auto plain_as_data = x;
      by_type.step(plain, 5, 9);
      by_data.step(plain_as_data, 5, 9);
      BOOST_TEST(same_bits(plain_as_data, plain));
      // Another table takes other steps: the comparison can tell.
      auto changed = as_data.coefficients();
      changed.front() += 1e-9;
      const tabulated another("another", as_data.letters(), changed, as_data);
      BOOST_TEST(!same_bits(finish(make_stepper(system, another, 0.05, noise), x, 200), whole));
    }
  };
  const auto masses = split_masses();
  const auto ring = split_ring();
  check(masses, verlet(), no_noise());
  check(masses, chin4a(), no_noise());
  check(masses, member<fd_chin>(fd_chin::start()), no_noise());
  check(masses, impulse(), no_noise());
  check(ring, verlet(), no_noise());
  check(ring, member<r_fg4>(r_fg4::start()), no_noise());
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
      const run_time_word& word = method.letters();
      const tabulated expected("expected", conservative_part(word),
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
  const auto check = [&](const auto& system, const std::vector<tabulated>& methods, const auto& noise) {
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
  check(split_ring(), quiet_methods(), no_noise());
  check(split_masses(), quiet_methods(), no_noise());
  check(in_bath(fpu_chain<3>(10.0), bath::of_sigma(0.1, 0.1)), noisy_methods(), counter_noise(1));
  check(in_bath(fpu_chain<3>(10.0), bath::of_sigma(0.0, 0.0)), noisy_methods(), no_noise());
  // By its type, numbers by hand; the kicks of the chain are its own, and count.
  static_assert(HasKick<counted<fpu_chain<3>>, double>);
  const counted watched(fpu_chain<3>(10.0));
  auto y = random.state(watched, 0.5);
  finish(make_stepper(watched, verlet(), 0.01), y, 10);
  BOOST_TEST(watched.evaluations == 11);
  make_stepper(watched, verlet(), 0.01).step(y);
  BOOST_TEST(watched.evaluations == 11 + 2);
}
