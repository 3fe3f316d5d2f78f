// SPDX-License-Identifier: BSL-1.0
// A learned method knows where it is valid.
#include <boost/test/unit_test.hpp>

#include "laws/models.hpp"
#include "nysalt/integrate.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
const fpu_chain<3> learned_for(50.0);
const tuned_method<nystrom> tuned(member<nystrom>({0.5, 0.41}), 0.02, describe(learned_for));

}  // namespace

namespace {

/// Two drifts around a kick, whose word is told when the family is made: with the bath in the middle or not.
struct told_at_run_time {
  using word = run_time_word;
  static constexpr std::string_view name = "told_at_run_time";
  static constexpr int parameters = 1;
  static constexpr std::array<std::string_view, 1> parameter_names{"a"};
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::array<parameter_range, 1> ranges() { return {{{0.0, 1.0, false}}}; }
  static std::array<double, 1> start() { return {0.5}; }

  run_time_word letters() const { return run_time_word(in_bath ? "ABOA" : "ABA"); }
  template <Scalar C>
  std::vector<C> coefficients(const std::array<C, 1>& a) const {
    std::vector<C> all{a[0], C(1.0), C(1.0) - a[0]};
    if (in_bath) all.insert(all.begin() + 2, C(1.0));
    return all;
  }

  bool in_bath = false;
};
static_assert(Family<told_at_run_time> && Method<member<told_at_run_time>> &&
              Method<tuned_method<told_at_run_time>>);

struct without_letters : told_at_run_time {
  void letters() const = delete;
};
static_assert(!Family<without_letters>);

}  // namespace

BOOST_AUTO_TEST_CASE(a_family_may_be_told_its_word_at_run_time) {
  const member<told_at_run_time> plain({0.3});
  const member<told_at_run_time> thermostatted({0.3}, told_at_run_time{true});
  BOOST_TEST(plain.letters().letters() == "ABA");
  BOOST_TEST(thermostatted.letters().letters() == "ABOA");
  BOOST_TEST((thermostatted.coefficients() == std::vector{0.3, 1.0, 1.0, 1.0 - 0.3}));
  BOOST_TEST(refuses<wrong>([] { member<told_at_run_time>({1.5}); }, {"told_at_run_time", "a must lie"}));
  const tuned_method<told_at_run_time> learned(thermostatted, 0.02, describe(learned_for));
  BOOST_TEST(learned.letters().letters() == "ABOA");
  BOOST_TEST((learned.coefficients() == thermostatted.coefficients()));

  // Its run is that of the same word as a type.
  const pendulum system;
  const phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.5)};
  const auto ours = integrate(system, plain, 0.1, x, 20).finish;
  const stepper<pendulum, word<drift, kick, drift>> by_type(system, {0.3, 1.0, 1.0 - 0.3}, 0.1);
  const auto expected = integrate(by_type, x, 20).finish;
  BOOST_TEST((ours.q == expected.q && ours.p == expected.p));
}

BOOST_AUTO_TEST_CASE(a_tuned_method_runs_where_it_was_learned) {
  BOOST_CHECK_NO_THROW(make_stepper(learned_for, tuned, 0.02));
  BOOST_CHECK_NO_THROW(make_stepper(learned_for, tuned, 0.1 * 0.2));  // as typed, not to the bit
  const fpu_chain<> same_of_another_type(3, 50.0);
  BOOST_CHECK_NO_THROW(make_stepper(same_of_another_type, tuned, 0.02));
  BOOST_TEST(tuned.name() == "learned:nystrom");
  BOOST_TEST(tuned.step() == 0.02);
  BOOST_TEST(tuned.system() == describe(learned_for));
  BOOST_TEST((tuned.parameters() == std::array{0.5, 0.41}));
}

BOOST_AUTO_TEST_CASE(it_knows_the_energies_that_it_has_seen) {
  const pendulum system;  // H = p^2/2 - cos q
  const auto at = [](double p) {
    return phase_point<double, 1>{vector<double, 1>(0.0), vector<double, 1>(p)};
  };
  const tuned_method<nystrom> learned(member<nystrom>({0.5, 0.41}), 0.02, describe(system),
                                      energy_range{-0.9, 1.0});
  BOOST_TEST(learned.has_seen(system, at(1.0)));
  BOOST_TEST(learned.has_seen(system, at(2.0 + 1e-7)));  // as far outside as references err
  BOOST_TEST(!learned.has_seen(system, at(2.01)));
  BOOST_TEST(!learned.has_seen(system, at(0.0)));
  BOOST_TEST(learned.energies()->high == 1.0);
  BOOST_TEST(!tuned.energies().has_value());
  const tuned_method<nystrom> untold(member<nystrom>({0.5, 0.41}), 0.02, describe(system));
  BOOST_TEST(untold.has_seen(system, at(100.0)));  // nothing else is known
}

BOOST_AUTO_TEST_CASE(it_refuses_a_foreign_step) {
  for (const double step : {0.01, 0.0200001, -0.02}) {
    BOOST_TEST(refuses<wrong>([&] { make_stepper(learned_for, tuned, step); },
                              {"learned:nystrom", "must run at the step 0.02", "anywhere()"}));
  }
  BOOST_CHECK_THROW(make_stepper(learned_for, tuned, std::numeric_limits<double>::quiet_NaN()), wrong);
}

BOOST_AUTO_TEST_CASE(it_refuses_a_foreign_system) {
  const fpu_chain<3> stiffer(51.0);
  const fpu_chain<> longer(4, 50.0);
  const pendulum other;
  const auto refused = [](const auto& system) {
    return refuses<wrong>([&] { make_stepper(system, tuned, 0.02); },
                          {"must run on fpu_chain(pairs=3, omega=50)", describe(system), "anywhere()"});
  };
  BOOST_TEST(refused(stiffer));
  BOOST_TEST(refused(longer));
  BOOST_TEST(refused(other));
}

BOOST_AUTO_TEST_CASE(the_refusal_reaches_those_who_integrate) {
  const pendulum other;
  const phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  BOOST_TEST(refuses<wrong>([&] { integrate(other, tuned, 0.02, x, 10); }, {"anywhere()"}));
}

BOOST_AUTO_TEST_CASE(anywhere_is_for_those_who_ask) {
  const pendulum other;
  BOOST_CHECK_NO_THROW(make_stepper(other, tuned.anywhere(), 0.5));
  BOOST_TEST((tuned.anywhere().coefficients() == tuned.coefficients()));
}
