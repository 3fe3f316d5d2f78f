// SPDX-License-Identifier: BSL-1.0
// A learned method knows where it is valid; a family has the names, coefficients and derivatives of the
// struct that describes it, in a bath too.
#include <map>

#include "../support/draws.hpp"
#include "../support/parameters.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/core.hpp"
#include "nysalt/family.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const fpu_chain<3> learned_for(50.0);

/// The member of nystrom at one theta, valid at a step of 0.02 for a system.
method learned_on(const std::string& system, std::optional<energy_range> energies = {}) {
  const method plain = member(nystrom(), {0.5, 0.41});
  return {plain.name(), plain.letters(), plain.coefficients(), plain,
          method_validity{0.02, system, "", energies}};
}
const method tuned = learned_on(describe(learned_for));

bool refused(const model& system, const method& method, double step, said words) {
  return refuses([&] { make_stepper(system, method, step); }, words);
}

/// Two drifts around a kick, whose word is told when the family is made: with the bath in the middle or not.
struct told_at_run_time {
  static constexpr std::string_view name = "told_at_run_time";
  static constexpr int parameters = 1;
  static constexpr std::array<std::string_view, 1> parameter_names{"a"};
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::array<parameter_range, 1> ranges() { return {{{0.0, 1.0, false}}}; }
  static std::array<double, 1> start() { return {0.5}; }

  template <Scalar C>
  std::vector<C> coefficients(const std::array<C, 1>& a) const {
    std::vector<C> all{a[0], C(1.0), C(1.0) - a[0]};
    if (letters.stochastic_letters > 0) all.insert(all.begin() + 2, C(1.0));
    return all;
  }

  word letters{"ABA"};
};
static_assert(Family<told_at_run_time>);

struct without_letters : told_at_run_time {
  void letters() const = delete;
};
static_assert(!Family<without_letters>);

struct with_too_few_coefficients : nystrom {
  template <Scalar C>
  static std::array<C, 4> coefficients(const std::array<C, 2>&) {
    return {};
  }
};

/// The coefficients of a struct over dual numbers, in a bath with those of its letters O, are those of the
/// family, and their derivatives.
template <Family F>
void check_coefficients(const family& family, std::optional<placement> where = {}) {
  draws random;
  for (int n = 0; n < 5; ++n) {
    auto theta = F::start();
    for (double& x : theta) x += random.uniform(-0.05, 0.05);
    std::array<detail::theta_dual<F>, detail::parameters_of<F>{}.size()> lifted;
    for (std::size_t k = 0; k < lifted.size(); ++k) {
      lifted[k] = detail::theta_dual<F>::variable(theta[k], static_cast<int>(k));
    }
    const auto plain = F::coefficients(lifted);
    std::vector<detail::theta_dual<F>> expected(plain.begin(), plain.end());
    if (where) expected = detail::thermostatted_coefficients(F::letters, *where, expected);
    const auto values = family.coefficients(column_of(theta));
    const auto slopes = family.jacobian(column_of(theta));
    BOOST_TEST_CONTEXT(family.name << " as " << family.letters.letters()) {
      BOOST_REQUIRE(values.size() == expected.size());
      BOOST_REQUIRE((slopes.rows() == std::ssize(expected) && slopes.cols() == F::parameters));
      int not_zero = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        BOOST_TEST(values[i] == expected[i].value);
        for (std::size_t k = 0; k < theta.size(); ++k) {
          const double slope = slopes(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
          BOOST_TEST(slope == expected[i].derivative[k]);
          not_zero += slope != 0.0;
        }
      }
      BOOST_TEST(not_zero >= 2 * F::parameters);  // each parameter moves more than one coefficient
    }
  }
}

template <Family F>
void check_struct() {
  const nysalt::family family{F()};
  BOOST_TEST(family.name == F::name);
  BOOST_TEST(family.parameters() == F::parameters);
  BOOST_TEST(family.order == F::order);
  BOOST_TEST(family.symmetric == F::symmetric);
  BOOST_TEST(family.requires_quadratic_kinetic == F::requires_quadratic_kinetic);
  BOOST_TEST((family.letters == F::letters));
  BOOST_TEST(std::ranges::equal(family.parameter_names, F::parameter_names));
  BOOST_TEST(std::ranges::equal(family.ranges, F::ranges(), [](const auto& x, const auto& y) {
    return x.low == y.low && x.high == y.high && x.open == y.open;
  }));
  BOOST_TEST(family.starts.front().name == "start");
  BOOST_TEST((family.starts.front().theta == column_of(F::start())));
  check_coefficients<F>(family);
}

template <Family F>
void check_thermostatted(placement where, const char* letters, int order) {
  const auto family = thermostatted(nysalt::family(F()), where);
  BOOST_TEST(family.letters.letters() == letters);
  BOOST_TEST(family.order == order);
  BOOST_TEST(family.symmetric == (F::symmetric && where != placement::end));
  check_coefficients<F>(family, where);
  // What O covers of a step is none of the parameters' business.
  const auto slopes = family.jacobian(column_of(F::start()));
  for (std::size_t i = 0; i < family.letters.length; ++i) {
    const auto row = static_cast<Eigen::Index>(family.letters.first_slot(i));
    if (family.letters.letter(i) == detail::bath_letter) BOOST_TEST(slopes.row(row).norm() == 0.0);
  }
}

/// Whether members of the family that `larger` contains are members of `larger`, the processor being nothing.
bool embeds(const family& larger) {
  draws random;
  const auto& [inner, slopes, origin] = *larger.contained;
  Eigen::VectorXd theta = inner.starts.front().theta;
  for (double& x : theta) x += random.uniform(-0.1, 0.1);
  const auto embedded = larger.coefficients(larger.contained->embed(theta));
  auto expected = inner.coefficients(theta);
  expected.resize(embedded.size(), 0.0);
  return std::ranges::equal(embedded, expected, [](double a, double b) {
    return std::abs(a - b) <= 8.0 * eps;  // sums of up to seven numbers below one
  });
}

struct with_further_start : aba<4> {
  static std::vector<std::array<double, 3>> further_starts() { return {{0.2, 0.5, -0.2}}; }
};
struct with_wrong_letters_first : detail::free_composition<drift, kick, 3> {
  static constexpr std::string_view name = "wrong";
  using contained = bab<3>;
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_family_may_be_told_its_word_at_run_time) {
  const method plain = member(told_at_run_time{}, {0.3});
  const method with_o = member(told_at_run_time{word("ABOA")}, {0.3});
  BOOST_TEST(plain.letters().letters() == "ABA");
  BOOST_TEST(with_o.letters().letters() == "ABOA");
  BOOST_TEST((with_o.coefficients() == std::vector{0.3, 1.0, 1.0, 1.0 - 0.3}));
  BOOST_TEST(refuses([] { member(told_at_run_time{}, {1.5}); }, {"told_at_run_time", "a must lie"}));
  BOOST_TEST(refuses([] { member(told_at_run_time{}, {0.3, 0.4}); }, {"told_at_run_time", "got 2"}));
  BOOST_TEST(refuses(
      [] {
        member(with_too_few_coefficients(), {0.5, 0.4});
      },
      {"4 coefficients for the 5 letters ABABA"}));
}

BOOST_AUTO_TEST_CASE(a_tuned_method_runs_where_it_was_learned_and_anywhere_for_those_who_ask) {
  const model same_of_another_type = fpu_chain<>(3, 50.0);
  BOOST_CHECK_NO_THROW(make_stepper(learned_for, tuned, 0.02));
  BOOST_CHECK_NO_THROW(make_stepper(learned_for, tuned, 0.1 * 0.2));  // as typed, not to the bit
  BOOST_CHECK_NO_THROW(make_stepper(same_of_another_type, tuned, 0.02));
  BOOST_TEST(tuned.name() == "nystrom");
  for (const double step : {0.01, 0.0200001, -0.02}) {
    BOOST_TEST(
        refused(learned_for, tuned, step, {"learned:nystrom", "must run at the step 0.02", "anywhere()"}));
  }
  BOOST_TEST(refused(learned_for, tuned, not_a_number, {}));
  for (const model& other : {model(fpu_chain<3>(51.0)), model(fpu_chain<>(4, 50.0)), model(pendulum())}) {
    BOOST_TEST(refused(other, tuned, 0.02,
                       {"must run on fpu_chain(pairs=3, omega=50)", describe(other), "anywhere()"}));
  }
  const pendulum other;
  const phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  BOOST_TEST(refuses([&] { integrate(other, tuned, 0.02, x, 10); }, {"anywhere()"}));
  BOOST_CHECK_NO_THROW(make_stepper(other, tuned.anywhere(), 0.5));
  BOOST_TEST((tuned.anywhere().coefficients() == tuned.coefficients()));
}

BOOST_AUTO_TEST_CASE(it_knows_the_energies_that_it_has_seen) {
  const pendulum system;  // H = p^2/2 - cos q
  const auto at = [](double p) {
    return phase_point<double, 1>{vector<double, 1>(0.0), vector<double, 1>(p)};
  };
  const method learned = learned_on(describe(system), energy_range{-0.9, 1.0});
  BOOST_TEST(learned.has_seen(system, at(1.0)));
  BOOST_TEST(learned.has_seen(system, at(2.0 + 1e-7)));  // as far outside as references err
  BOOST_TEST(!learned.has_seen(system, at(2.01)));
  BOOST_TEST(!learned.has_seen(system, at(0.0)));
  BOOST_TEST(tuned.has_seen(system, at(100.0)));  // nothing else is known
}

BOOST_AUTO_TEST_CASE(a_family_knows_what_its_struct_says) {
  check_struct<nystrom>();
  check_struct<aba<6>>();
  check_struct<fg4>();
  check_thermostatted<nystrom>(placement::end, "ABABAO", 1);
  check_thermostatted<nystrom>(placement::symmetric, "OABABAO", 2);
  check_thermostatted<fg4>(placement::middle, "ABAGOGABA", 2);  // a letter of two slots is split
  const auto once = thermostatted(family(nystrom()), placement::end);
  BOOST_TEST(refuses([&] { thermostatted(once, placement::end); }, {"ABABAO", "must have no letters O"}));
}

BOOST_AUTO_TEST_CASE(members_of_a_contained_family_are_members) {
  for (const auto& family :
       {nysalt::family(aba3_free()), nysalt::family(bab6_free()), processed(nysalt::family(fg4()), 3),
        thermostatted(nysalt::family(aba4_free()), placement::middle)}) {
    BOOST_REQUIRE_MESSAGE(family.contained, family.name);
    BOOST_TEST(family.contained->family.parameters() < family.parameters(), family.name);
    BOOST_TEST(embeds(family), family.name);
  }
  BOOST_TEST(!nysalt::family(aba<4>()).contained);
  BOOST_TEST(refuses<std::logic_error>([] { nysalt::family{with_wrong_letters_first()}; },
                                       {"wrong", "bab3", "ABABABA", "BABABAB"}));
}

BOOST_AUTO_TEST_CASE(classical_members_and_points_without_a_name_are_starts_too) {
  const family four{with_further_start()};
  BOOST_REQUIRE(four.starts.size() == 3U);
  BOOST_TEST(four.starts[1].name == "pefrl");
  BOOST_TEST(four.starts[2].name == "further start");
  const auto found = four.coefficients(four.starts[1].theta);
  const auto expected = pefrl().coefficients();
  for (std::size_t i = 0; i < found.size(); ++i) {
    BOOST_TEST(std::abs(found[i] - expected[i]) <= 4.0 * eps);  // sums of four numbers below one
  }
  BOOST_TEST(family(nystrom()).starts.size() == 1U);
}

BOOST_AUTO_TEST_CASE(parameters_have_ranges_of_which_some_are_open) {
  const nysalt::family family{nystrom()};  // b1 in (0, 1), beta1 in [0, 0.5]
  const auto is_defined = [&](double b1, double beta1) {
    return family.is_defined(Eigen::Vector2d(b1, beta1));
  };
  BOOST_TEST(is_defined(0.5, 0.5));
  BOOST_TEST(is_defined(0.5, 0.7));  // beyond a bound that may be attained
  for (const double outside : {0.0, 1.0, std::nan("")}) BOOST_TEST(!is_defined(outside, 0.4));
  const std::string of_b1 = "nystrom: the parameter b1 must lie in (0, 1), got ";
  const std::string of_beta1 = "nystrom: the parameter beta1 must lie in [0, 0.5], got ";
  const std::map<std::array<double, 2>, std::string> refused{{{0.0, 0.4}, of_b1 + "0"},
                                                             {{1.0, 0.4}, of_b1 + "1"},
                                                             {{-0.5, 0.4}, of_b1 + "-0.5"},
                                                             {{0.5, -1e-9}, of_beta1 + "-1e-09"},
                                                             {{0.5, 0.6}, of_beta1 + "0.6"},
                                                             {{0.5, 0.0}, ""},
                                                             {{0.5, 0.5}, ""}};
  for (const auto& [theta, words] : refused) {  // the ends of beta1 may be attained
    BOOST_TEST(refusal_of([&, &at = theta] { detail::require_in_range(family, column_of(at)); }) == words);
    BOOST_TEST(refusal_of([&, &at = theta] { member(nystrom(), {at[0], at[1]}); }) == words);
  }
  BOOST_TEST(refusal_of([&] { member(nystrom(), {not_a_number, 0.4}); }) == of_b1 + "nan");
  BOOST_TEST(refusal_of([&] { member(nystrom(), {0.5, not_a_number}); }) == of_beta1 + "nan");
}
