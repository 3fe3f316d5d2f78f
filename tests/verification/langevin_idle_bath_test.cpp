// SPDX-License-Identifier: BSL-1.0
// In a bath that does not act, a Langevin method has the bits of its word with the letters O deleted.
#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/langevin_methods.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, 2>;
constexpr double step = 0.1;
constexpr std::int64_t steps = 1000;

bool same_bits(const state& x, const state& y) { return x.q == y.q && x.p == y.p; }

/// No random number may be drawn.
struct unasked {
  static constexpr bool is_memoryless = true;
  template <class T, int N>
  void normals(const noise_place&, vector<T, N>&) const {
    throw std::logic_error("a number was drawn");
  }
  template <class T, int N>
  void halving(const noise_place&, vector<T, N>&) const {
    throw std::logic_error("a number was drawn");
  }
};

/// After all steps of the merged loop, unobserved; the sum of what is seen on the way comes on top.
struct run_of {
  state finish, seen;
};
run_of run(const auto& stepper, const state& x) {
  run_of result{x, x};
  auto open = stepper.open(x);
  stepper.advance(open, steps);
  result.finish = stepper.synchronous(open);
  auto watched = stepper.open(x);
  stepper.advance(watched, steps, 7, [&](std::int64_t, const state& y) {
    result.seen.q += y.q;
    result.seen.p += y.p;
  });
  return result;
}
bool same_bits(const run_of& a, const run_of& b) {
  return same_bits(a.finish, b.finish) && same_bits(a.seen, b.seen);
}

/// The letters without O, made by hand and stepped as data.
tabulated deleted(const Method auto& method) {
  std::string letters;
  std::vector<double> coefficients;
  for (const auto& [letter, c] : spell(method)) {
    if (letter == 'O') continue;
    letters += letter;
    coefficients.push_back(c);
  }
  return tabulated("deleted", run_time_word(letters), coefficients, {1, false, false});
}

const henon_heiles alone;
in_bath<henon_heiles> coupled(const bath& b) { return {alone, b}; }

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(an_idle_bath_changes_no_bit, M, langevin_methods) {
  draws random;
  const auto x = random.state(alone, 0.25);
  const M method;
  const auto plain = run(make_stepper(alone, deleted(method), step), x);
  const tabulated as_data(method);
  BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
    for (const auto& idle : {bath::of_sigma(0.0, 0.0), bath::of_temperature(0.0, 1.5)}) {
      const auto system = coupled(idle);
      BOOST_TEST(same_bits(run(make_stepper(system, method, step), x), plain));
      BOOST_TEST(same_bits(run(make_stepper(system, method, step, unasked()), x), plain));
      BOOST_TEST(same_bits(run(make_stepper(system, as_data, step), x), plain));
      BOOST_TEST(same_bits(run(make_stepper(system, as_data, step, unasked()), x), plain));
    }
    BOOST_TEST(same_bits(run(make_stepper(alone, method, step), x), plain));   // and in none at all
    BOOST_TEST(same_bits(run(make_stepper(alone, as_data, step), x), plain));  // as data

    // The least friction is noticed, and draws nothing where there is no noise.
    const auto damped = coupled(bath::of_sigma(1e-13, 0.0));
    BOOST_TEST(!same_bits(run(make_stepper(damped, method, step, unasked()), x), plain));
    BOOST_TEST(!same_bits(run(make_stepper(damped, as_data, step, unasked()), x), plain));
    const auto warm = coupled(bath::of_sigma(0.0, 1e-13));
    BOOST_CHECK_THROW(run(make_stepper(warm, method, step, unasked()), x), std::logic_error);
  }
}
