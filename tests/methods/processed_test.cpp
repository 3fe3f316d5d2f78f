// SPDX-License-Identifier: BSL-1.0
// Processed words: P(h)^-1 once, the kernel step by step, and P(-h) on what is looked at.
#include "../laws/laws.hpp"
#include "../support/refusal.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "nysalt/derivatives/taylor_order.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/families/gradient_composition.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/stepping/lockstep.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

method random_member(const family& family, draws& random) {
  Eigen::VectorXd theta = family.starts.front().theta;
  for (Eigen::Index k = theta.size() - std::ssize(family.letters.processor()) + 2; k < theta.size(); ++k) {
    theta[k] = random.uniform(-0.3, 0.3);
  }
  return {family.name,
          family.letters,
          family.coefficients(theta),
          {family.order, family.symmetric, family.requires_quadratic_kinetic}};
}

/// Members of families with processors, and the classical ones.
std::vector<method> processed_methods(draws& random) {
  std::vector<method> all{random_member(processed(family(fg4()), 3), random),
                          random_member(processed(family(bab<4>()), 2), random),
                          random_member(processed(family(fg_chin()), 5), random)};
  for (const auto& row : detail::processed_table) all.push_back(detail::as_data(row));
  return all;
}

/// f(system, method, step, x) for processed methods on all systems whose derivatives are exact.
void try_processed(const trial& f) {
  draws random;
  try_all(specimens_with(has_exact_derivatives), processed_methods(random), f);
}

/// Steps of a part of a word.
any_state after_part(const run_of& whole, const nysalt::word& letters, const std::vector<double>& all,
                     const any_state& x, std::int64_t steps = 1) {
  const method part("part", letters, all, whole.method);
  const run_of run{whole.system, part, whole.step};
  return steps == 1 ? run.plain(x, 1) : run.finish(x, steps);
}
any_state after_kernel(const run_of& whole, const any_state& x, std::int64_t steps = 1) {
  const nysalt::word& word = whole.method.letters();
  const auto c = whole.method.coefficients();
  return after_part(whole, nysalt::word(word.letters().substr(0, word.length)),
                    {c.begin(), c.begin() + static_cast<std::ptrdiff_t>(word.kernel_slots)}, x, steps);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_letters_of_kernel_and_processor) {
  const nysalt::word word("ABA|BABA");
  BOOST_TEST(word.is_processed());
  BOOST_TEST(word.letters() == "ABA|BABA");
  BOOST_TEST(word.processor() == "BABA");
  BOOST_TEST(word.length == 3U);
  BOOST_TEST(word.kernel_slots == 3U);
  BOOST_TEST(word.slots == 7U);
  BOOST_TEST(word.evaluations_per_step == 1);
  BOOST_TEST(word.evaluations_to_open == 2);
  BOOST_TEST(word.evaluations_to_observe == 2);
  BOOST_TEST(word.evaluations_of_plain_step == 5);
  BOOST_TEST(!nysalt::word("ABA").is_processed());
  BOOST_TEST(detail::pre_processor(word).letters() == "ABAB");
  BOOST_TEST((detail::pre_processor_coefficients<double>(word, {0.5, 1.0, 0.5, 1.0, 2.0, 3.0, 4.0}) ==
              std::vector{-4.0, -3.0, -2.0, -1.0}));
  BOOST_TEST((detail::post_processor_coefficients<double>(word, {0.5, 1.0, 0.5, 1.0, 2.0, 3.0, 4.0}) ==
              std::vector{-1.0, -2.0, -3.0, -4.0}));
}

BOOST_AUTO_TEST_CASE(steps_are_symplectic) {
  try_processed([](const model& system, const method& method, double step, const any_state& x) {
    BOOST_TEST(symplecticity_broken(system, method, step, x) <= 1.0);
  });
}

// n steps forth, momenta turned, n steps forth, and momenta turned: the start. Rounding is that of 200 steps
// of some 20 letters at a quarter of a radian, magnified by less than 100: 1e-12 of the state.
BOOST_AUTO_TEST_CASE(there_and_back_returns_to_rounding) {
  try_processed([](const model& system, const method& method, double step, const any_state& x) {
    const auto turned = [](any_state y) {
      y.p = -y.p;
      return y;
    };
    const auto there = run_of{system, method, step}.finish(x, 20);
    const auto back = turned(run_of{system, method, step}.finish(turned(there), 20));
    BOOST_TEST(distance(back, x) <= 1e-12 * size_of(x));
    BOOST_TEST(distance(run_of{system, method, -step}.finish(there, 20), x) <= 1e-12 * size_of(x));
  });
}

// P K^n P^-1, which the literature has, is reversible only as far as P is even in h.
BOOST_AUTO_TEST_CASE(the_same_processor_before_and_after_is_not_reversible) {
  draws random;
  const auto method = processed_methods(random).front();
  const auto& one = specimen_of("pendulum");
  const run_of run{one.system, method, 0.25};
  const auto x = one.at_random(random);
  const nysalt::word& word = method.letters();
  const auto c = method.coefficients();
  auto same = detail::post_processor_coefficients(word, c);
  for (double& each : same) each = -each;
  auto y = x;
  for (int turn = 0; turn < 2; ++turn) {
    y = after_part(run, detail::pre_processor(word), detail::pre_processor_coefficients(word, c), y);
    y = after_part(run, detail::post_processor(word), same, after_kernel(run, y));
    y.p = -y.p;
  }
  BOOST_TEST(distance(y, x) > 1e-6);
}

BOOST_AUTO_TEST_CASE(a_run_is_its_parts_however_it_is_cut_and_observed) {
  try_processed([](const model& system, const method& method, double step, const any_state& x) {
    const nysalt::word& word = method.letters();
    const auto c = method.coefficients();
    const run_of run{system, method, step};
    auto y = after_part(run, detail::pre_processor(word), detail::pre_processor_coefficients(word, c), x);
    y = after_kernel(run, y, 20);
    y = after_part(run, detail::post_processor(word), detail::post_processor_coefficients(word, c), y);
    const auto whole = run.finish(x, 20);
    BOOST_TEST(same_bits(whole, y));
    BOOST_TEST(same_bits(run.finish(x, 0), x));  // the sample at the start is the start
    BOOST_TEST(same_bits(run.watched(x, 20, 3), whole));
    BOOST_TEST(same_bits(run.observed(x, 20, 1), whole));
    for (const int first : {0, 1, 13, 20}) BOOST_TEST(same_bits(run.cut(x, 20, first), whole));
    // Processing anew at every step is another trajectory.
    BOOST_TEST(!same_bits(run.reopened(x, 20), whole));
  });
}

BOOST_AUTO_TEST_CASE(typed_systems_and_lanes_have_the_same_bits) {
  draws random;
  const fpu_chain<3> chain(10.0);
  const auto& one = specimen_of(describe(chain));
  for (const auto& method : processed_methods(random)) {
    const run_of run{one.system, method, 0.01};
    BOOST_TEST(run.lanes_are_alone(one, random), method.name());
    const auto x = random.state(chain, 0.1);
    const auto typed = make_stepper(chain, method, 0.01);
    auto open = typed.open(x);
    typed.advance(open, 20);
    const auto y = typed.synchronous(open);
    BOOST_TEST(same_bits(run.finish({x.q, x.p}, 20), any_state{y.q, y.p}), method.name());
  }
}

// A run that is watched over for divergence pays for no observation that was not requested.
BOOST_AUTO_TEST_CASE(what_is_counted_is_what_is_evaluated) {
  draws random;
  const counted watched{pendulum()};
  for (const auto& method : processed_methods(random)) {
    const auto x = random.state(watched, 1.0);
    const nysalt::word& word = method.letters();
    const auto fixed = make_stepper(watched, method, 0.1);
    const auto of_steps = [&](std::int64_t n, std::int64_t looks) {
      return word.evaluations_to_open + n * word.evaluations_per_step + looks * word.evaluations_to_observe;
    };
    BOOST_TEST_CONTEXT(method.name()) {
      watched.evaluations = 0;
      detail::lockstep<std::remove_const_t<decltype(fixed)>, double> run(fixed, x, 1);
      run.go_on(200);  // over three checks
      BOOST_TEST(watched.evaluations == of_steps(200, 0));
      run.synchronous();
      BOOST_TEST(watched.evaluations == of_steps(200, 1));
      BOOST_TEST(evaluations_of_run(pendulum(), method, 0.1, 5, x) == of_steps(5, 1));
      watched.evaluations = 0;
      auto y = x;
      fixed.step(y);
      BOOST_TEST(watched.evaluations == word.evaluations_of_plain_step);
    }
  }
}

// The error of n steps: terms of P that are odd in h do not cancel, and are not seen after one step where the
// kernel has such terms too.
BOOST_AUTO_TEST_CASE(processors_reach_their_order) {
  draws random;
  for (const auto& method : processed_methods(random)) {
    BOOST_TEST(taylor_order(method).quadratic_kinetic == method.order, method.name());
  }
  for (const auto& row : detail::processed_table) {
    auto method = detail::as_data(row);
    auto c = method.coefficients();
    std::fill(c.begin() + static_cast<std::ptrdiff_t>(method.letters().kernel_slots), c.end(), 0.0);
    BOOST_TEST(taylor_order(method.letters(), c).quadratic_kinetic == 2,
               method.name());  // of the kernel alone
    c = method.coefficients();
    c.back() += 1e-6;
    BOOST_TEST(taylor_order(method.letters(), c).quadratic_kinetic == 0, method.name());
  }
}

BOOST_AUTO_TEST_CASE(families_with_a_processor) {
  const auto family = processed(nysalt::family(fg4()), 3);
  BOOST_TEST(family.name == "fg4+p3");
  BOOST_TEST(family.letters.letters() == "ABAGABA|BABABA");
  BOOST_TEST(family.parameters() == 3 + 4);
  BOOST_TEST(family.starts.front().theta.size() == family.parameters());
  Eigen::VectorXd theta(7);
  theta << 0.1, 0.2, 0.01, 0.3, -0.4, 0.5, 0.25;
  const auto c = family.coefficients(theta);
  BOOST_TEST(c.size() == family.letters.slots);
  BOOST_TEST(std::abs(c[8] + c[10] + c[12]) <= 4e-16);  // three additions of numbers below one
  BOOST_TEST(std::abs(c[9] + c[11] + c[13]) <= 4e-16);
  const Eigen::MatrixXd slopes = family.jacobian(theta);
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    Eigen::VectorXd moved = theta;
    moved[k] += 0.125;  // exact: coefficients are linear
    const auto there = family.coefficients(moved);
    for (std::size_t i = 0; i < c.size(); ++i) {
      BOOST_TEST(std::abs((there[i] - c[i]) / 0.125 - slopes(static_cast<Eigen::Index>(i), k)) <= 1e-14);
    }
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_processed_is_refused) {
  const auto none = [](const auto& action, const char* what) { BOOST_TEST(refuses(action, {what}), what); };
  for (const auto& [letters, what] : {std::pair{"|BA", "one or more"},
                                      {"ABA|", "processor"},
                                      {"ABA|BBA", "in turn"},
                                      {"ABA|BGA", "in turn"},
                                      {"ABA|BA|BA", "in turn"},
                                      {"ABA|OA", "in turn"},
                                      {"BAOAB|BA", "temperature"},
                                      {"RSR|BA", "do not mix"}}) {
    none([&, letters = letters] { nysalt::word{letters}; }, what);
  }
  const nysalt::family family{fg4()};
  const auto with_three = processed(family, 3);
  none([&] { processed(family, 1); }, "from 2 to 8 pairs");
  none([&] { processed(family, 9); }, "from 2 to 8 pairs");
  none([&] { processed(nysalt::family(bab6_free()), 3); }, "must be symmetric");
  none([&] { processed(with_three, 3); }, "in turn");
  draws random;
  const auto method = processed_methods(random).front();
  for (const auto where : placements) {
    none([&] { thermostat(method, where); }, "temperature");
    none([&] { thermostatted(with_three, where); }, "bath");
  }
  none([&] { repeated(method, 2); }, "processor");
}
