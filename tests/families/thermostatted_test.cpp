// SPDX-License-Identifier: BSL-1.0
// A family in a bath: the same parameters and ranges, a longer word.
#include "nysalt/families/thermostatted.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/families.hpp"
#include "../support/refusal.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/method.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <placement P>
using nystrom_in = thermostatted_family<nystrom, P>;
using at_end = nystrom_in<placement::end>;
using both_ends = nystrom_in<placement::symmetric>;
using inside = nystrom_in<placement::middle>;

template <class F>
constexpr bool costs(int to_open, int per_step, int plain) {
  using W = typename F::word;
  return W::evaluations_to_open == to_open && W::evaluations_per_step == per_step &&
         W::evaluations_of_plain_step == plain;
}

}  // namespace

static_assert(Family<at_end> && Family<both_ends> && Family<inside>);
static_assert(Family<thermostatted_family<aba2, placement::middle>>);
static_assert(at_end::name == "nystrom_end" && both_ends::name == "nystrom_symmetric" &&
              inside::name == "nystrom_middle");
static_assert(thermostatted_family<aba4, placement::symmetric>::name == "aba4_symmetric");
static_assert(at_end::order == 1 && both_ends::order == 2);
// The middle of what is not symmetric is no middle.
static_assert(inside::order == 1 && thermostatted_family<aba2, placement::middle>::order == 2);
static_assert(!at_end::symmetric && !both_ends::symmetric && !inside::symmetric);  // nor is every nystrom
static_assert(thermostatted_family<aba2, placement::middle>::symmetric &&
              !thermostatted_family<aba2, placement::end>::symmetric);
static_assert(at_end::parameters == 2 && at_end::parameter_names == nystrom::parameter_names);
static_assert(costs<at_end>(0, 2, 2) && costs<both_ends>(0, 2, 2) && costs<inside>(0, 2, 2));

BOOST_AUTO_TEST_CASE(parameters_are_those_of_the_family) {
  BOOST_TEST((at_end::start() == nystrom::start()));
  for (std::size_t k = 0; k < 2; ++k) {
    const auto ours = both_ends::ranges()[k];
    const auto theirs = nystrom::ranges()[k];
    BOOST_TEST((ours.low == theirs.low && ours.high == theirs.high && ours.open == theirs.open));
  }
  BOOST_TEST(refuses<std::invalid_argument>([] { member<inside>({1.5, 0.4}); }, {"nystrom_middle", "b1"}));
}

BOOST_AUTO_TEST_CASE(coefficients_are_those_of_the_family_with_the_bath_between) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const std::array theta{random.uniform(0.3, 0.7), random.uniform(0.3, 0.5)};
    const auto [a, b, c, d, e] = nystrom::coefficients(theta);
    BOOST_TEST((at_end::coefficients(theta) == std::array{a, b, c, d, e, 1.0}));
    BOOST_TEST((both_ends::coefficients(theta) == std::array{0.5, a, b, c, d, e, 0.5}));
    BOOST_TEST((inside::coefficients(theta) == std::array{a, b, c * 0.5, 1.0, c * 0.5, d, e}));
  }
}

BOOST_AUTO_TEST_CASE(derivatives_flow_through_it) {
  using D = dual<double, 2>;
  const std::array theta{D::variable(0.45, 0), D::variable(0.4, 1)};
  const auto plain = nystrom::coefficients(theta);
  const auto split = inside::coefficients(theta);
  BOOST_TEST((split[2].derivative[0] == plain[2].derivative[0] * 0.5));
  BOOST_TEST((split[3].value == 1.0 && split[3].derivative == std::array{0.0, 0.0}));
  BOOST_TEST((split[6].derivative == plain[4].derivative));
}

BOOST_AUTO_TEST_CASE(a_member_says_its_name) {
  const member<both_ends> method({0.5, 0.4});
  BOOST_TEST(method.name() == "nystrom_symmetric");
  BOOST_TEST(member<both_ends>::word::letters() == "OABABAO");
}
