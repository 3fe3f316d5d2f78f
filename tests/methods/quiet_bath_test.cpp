// SPDX-License-Identifier: BSL-1.0
// In no bath, or in one that does not act, a word with letters O is the word without them, to the bit.
#include <boost/test/unit_test.hpp>

#include "../laws/noisy_models.hpp"
#include "../laws/run_laws.hpp"
#include "../laws/trials.hpp"
#include "nysalt/noises/counter_noise.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::int64_t steps = 200;

const std::vector<bath> quiet{bath::of_sigma(0.0, 0.0), bath::of_temperature(0.0, 1.0)};

using quiet_systems = std::tuple<an_fpu_chain, a_free_chain>;

/// Merged, looked at, and as a plain step.
template <int N>
bool alike(const auto& one, const auto& other, const phase_point<double, N>& x) {
  auto y = x;
  auto z = x;
  one.step(y);
  other.step(z);
  return same_bits(y, z) && same_bits(run_finish(one, x, steps), run_finish(other, x, steps)) &&
         same_bits(run_finish(one, x, 1), run_finish(other, x, 1));
}

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(a_step_is_that_of_the_word_without_letters_o, M, noisy_methods) {
  using W = typename M::word;
  try_on<M, quiet_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    using S = std::remove_cvref_t<decltype(system)>;
    const stepper<S, conservative_word<W>> expected(system, conservative_part(W{}, method.coefficients()),
                                                    step);
    BOOST_TEST(alike(make_stepper(system, method, step), expected, x));
    BOOST_TEST(alike(make_stepper(system, tabulated(method), step), expected, x));
    for (const auto& heat_bath : quiet) {
      const in_bath in_it(system, heat_bath);
      BOOST_TEST(alike(make_stepper(in_it, method, step), expected, x));
      BOOST_TEST(alike(make_stepper(in_it, tabulated(method), step), expected, x));
    }
    // The least friction is seen.
    const in_bath damped(system, bath::of_sigma(1e-9, 0.0));
    BOOST_TEST(!alike(make_stepper(damped, method, step), expected, x));
  });
}

// It costs what the word without O costs, and lanes are its lanes.
BOOST_AUTO_TEST_CASE(evaluations_and_lanes_are_those_of_the_word_without) {
  const in_bath system(fpu_chain<3>(10.0), bath::of_sigma(0.0, 0.0));
  draws random;
  const auto x = random.state(system, 0.5);
  const auto count = [&](const auto& method) { return evaluations_of_run(system, method, 0.01, x, 10); };
  BOOST_TEST(count(baoab()) == 11);
  BOOST_TEST(count(obabo()) == 11);
  BOOST_TEST(count(aboba()) == 10);
  BOOST_TEST(count(tabulated(obabo{})) == 11);
  BOOST_TEST(count(nystrom_symmetric({0.5, 0.4})) == 20);
  BOOST_TEST(lanes_are_alone<8>(make_stepper(system, obabo(), 0.01), random, 0.5));
}

// With noise the force is reused where merging is prevented: it costs no more.
BOOST_AUTO_TEST_CASE(evaluations_in_a_warm_bath_are_those_declared) {
  const counted system(in_bath(fpu_chain<3>(10.0), bath::of_sigma(0.1, 0.1)));
  draws random;
  const auto x = random.state(system, 0.5);
  const auto count = [&](const auto& method) {
    system.evaluations = 0;
    const auto fixed = make_stepper(system, method, 0.01, counter_noise(1));
    auto run = fixed.open(x);
    fixed.advance(run, 10, 1, [](auto&&...) {});
    return system.evaluations;
  };
  const auto declared = [](const auto& method) {
    const auto word = word_of(method);
    return word.evaluations_to_open + 10 * word.evaluations_per_step;
  };
  const auto check = [&](const auto& method, std::int64_t expected) {
    BOOST_TEST(count(method) == expected);
    BOOST_TEST(declared(method) == expected);
    BOOST_TEST(count(tabulated(method)) == expected);
  };
  check(baoab(), 11);
  check(obabo(), 11);
  check(aboba(), 10);
  check(baoab_2x(), 21);
  check(nystrom_symmetric({0.5, 0.4}), 20);
  check(nystrom_middle({0.5, 0.4}), 20);
}
