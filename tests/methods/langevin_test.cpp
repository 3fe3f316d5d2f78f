// SPDX-License-Identifier: BSL-1.0
// The splittings of a Langevin system, and methods and families that are thermostatted: what they say, and
// what they cost.
#include <boost/test/unit_test.hpp>

#include "../support/families.hpp"
#include "../support/refusal.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/thermostatted.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/thermostatted.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr auto end = placement::end;
constexpr auto symmetric = placement::symmetric;
constexpr auto middle = placement::middle;

/// Force evaluations of opening a run, of a step in it, and of a plain step.
template <class M>
constexpr bool costs(int to_open, int per_step, int plain) {
  using W = typename M::word;
  return W::evaluations_to_open == to_open && W::evaluations_per_step == per_step &&
         W::evaluations_of_plain_step == plain;
}

/// A, B and O each cover a whole step.
bool is_consistent(const std::string& letters, const std::vector<double>& c) {
  std::array sums{0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < c.size(); ++i) sums[std::string("ABO").find(letters[i])] += c[i];
  return sums == std::array{1.0, 1.0, 1.0};
}
template <Method M>
bool is_consistent(const M& method) {
  const auto c = method.coefficients();
  return is_consistent(M::word::letters(), {c.begin(), c.end()});
}

template <placement P, class M>
using in = thermostatted_method<P, M>;
using at_end = thermostatted_family<nystrom, end>;
using both_ends = thermostatted_family<nystrom, symmetric>;
using inside = thermostatted_family<nystrom, middle>;
using aba2_inside = thermostatted_family<aba2, middle>;

}  // namespace

static_assert(Method<baoab> && Method<obabo> && Method<aboba> && Method<baoab_2x>);
static_assert(Method<in<end, verlet>> && Method<in<symmetric, pefrl>> && Method<in<middle, verlet_aba>>);
static_assert(costs<baoab>(1, 1, 2) && costs<obabo>(1, 1, 2) && costs<aboba>(0, 1, 1));
static_assert(costs<baoab_2x>(1, 2, 3));
static_assert(costs<in<end, verlet>>(1, 1, 2) && costs<in<end, verlet_aba>>(0, 1, 1));

static_assert(baoab::word::merges && !baoab::word::merges_half_steps && baoab::word::stochastic_letters == 1);
static_assert(!obabo::word::merges && obabo::word::merges_half_steps && obabo::word::stochastic_letters == 2);
static_assert(baoab_2x::word::stochastic_letters == 2 && !baoab_2x::word::merges_half_steps);
static_assert(!in<end, verlet>::word::merges && !in<end, verlet>::word::merges_half_steps);

static_assert(baoab::order == 2 && baoab::symmetric);
static_assert(in<end, pefrl>::order == 1 && !in<end, pefrl>::symmetric);
static_assert(in<symmetric, pefrl>::order == 2 && in<symmetric, pefrl>::symmetric);
static_assert(in<middle, pefrl>::order == 2 && in<middle, pefrl>::symmetric);

static_assert(Family<at_end> && Family<both_ends> && Family<inside>);
static_assert(Family<aba2_inside>);
static_assert(at_end::name == "nystrom_end" && both_ends::name == "nystrom_symmetric" &&
              inside::name == "nystrom_middle");
static_assert(thermostatted_family<aba4, symmetric>::name == "aba4_symmetric");
static_assert(at_end::order == 1 && both_ends::order == 2);
// The middle of what is not symmetric is no middle.
static_assert(inside::order == 1 && aba2_inside::order == 2);
static_assert(!at_end::symmetric && !both_ends::symmetric && !inside::symmetric);  // nor is every nystrom
static_assert(aba2_inside::symmetric && !thermostatted_family<aba2, end>::symmetric);
static_assert(at_end::parameters == 2 && at_end::parameter_names == nystrom::parameter_names);
static_assert(costs<at_end>(0, 2, 2) && costs<both_ends>(0, 2, 2) && costs<inside>(0, 2, 2));

BOOST_AUTO_TEST_CASE(each_splitting_covers_a_step) {
  BOOST_TEST(is_consistent(baoab()));
  BOOST_TEST(is_consistent(obabo()));
  BOOST_TEST(is_consistent(aboba()));
  BOOST_TEST(is_consistent(baoab_2x()));
  BOOST_TEST(is_consistent(thermostat<end>(verlet())));
  BOOST_TEST(is_consistent(thermostat<symmetric>(verlet_2x())));
  BOOST_TEST(is_consistent(thermostat<middle>(verlet_aba())));
  BOOST_TEST(!is_consistent("BAOAB", {0.5, 0.5, 0.5, 0.5, 0.5}));
}

BOOST_AUTO_TEST_CASE(the_splittings_are_thermostatted_verlet) {
  const auto same = [](const auto& a, const auto& b) {
    const tabulated one(a);
    const tabulated other(b);
    return one.letters().letters() == other.letters().letters() && one.coefficients() == other.coefficients();
  };
  BOOST_TEST(same(thermostat<middle>(verlet()), baoab()));
  BOOST_TEST(same(thermostat<symmetric>(verlet()), obabo()));
  BOOST_TEST(same(thermostat<middle>(verlet_aba()), aboba()));
  BOOST_TEST(!same(thermostat<end>(verlet()), baoab()));
}

BOOST_AUTO_TEST_CASE(names_tell_the_placement) {
  BOOST_TEST(baoab::name() == "baoab");
  BOOST_TEST(thermostat<end>(verlet()).name() == "verlet_end");
  BOOST_TEST(thermostat<symmetric>(verlet()).name() == "verlet_symmetric");
  BOOST_TEST(thermostat<middle>(verlet()).name() == "verlet_middle");
  BOOST_TEST(member<both_ends>({0.5, 0.4}).name() == "nystrom_symmetric");
  BOOST_TEST(member<both_ends>::word::letters() == "OABABAO");
}

BOOST_AUTO_TEST_CASE(a_table_is_thermostatted_likewise) {
  const tabulated table(pefrl{});
  const auto check = [&](placement where, const auto& by_type) {
    const tabulated expected(by_type);
    const auto ours = thermostat(table, where);
    const bool same = ours.letters().letters() == expected.letters().letters() &&
                      ours.coefficients() == expected.coefficients() && ours.order == expected.order &&
                      ours.symmetric == expected.symmetric &&
                      ours.requires_quadratic_kinetic == expected.requires_quadratic_kinetic;
    BOOST_TEST(same, to_string(where));
  };
  check(end, thermostat<end>(pefrl()));
  check(symmetric, thermostat<symmetric>(pefrl()));
  check(middle, thermostat<middle>(pefrl()));
  const tabulated euler("euler", run_time_word("BA"), {1.0, 1.0}, {1, false, false});
  BOOST_TEST(thermostat(euler, symmetric).order == 1);
  BOOST_TEST(!thermostat(euler, symmetric).symmetric);
  BOOST_TEST(refuses<std::invalid_argument>([&] { thermostat(euler, middle); }, {"central letter"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { thermostat(tabulated(baoab{}), end); },
                                            {"must have no letters O"}));
}

BOOST_AUTO_TEST_CASE(parameters_of_a_thermostatted_family_are_those_of_the_family) {
  BOOST_TEST((at_end::start() == nystrom::start()));
  for (std::size_t k = 0; k < 2; ++k) {
    const auto ours = both_ends::ranges()[k];
    const auto theirs = nystrom::ranges()[k];
    BOOST_TEST((ours.low == theirs.low && ours.high == theirs.high && ours.open == theirs.open));
  }
  BOOST_TEST(refuses<std::invalid_argument>([] { member<inside>({1.5, 0.4}); }, {"nystrom_middle", "b1"}));
}

BOOST_AUTO_TEST_CASE(coefficients_are_those_of_the_family_with_the_bath_between) {
  for (const auto& theta : {std::array{0.4, 0.35}, {0.63, 0.48}}) {
    const auto [a, b, c, d, e] = nystrom::coefficients(theta);
    BOOST_TEST((at_end::coefficients(theta) == std::array{a, b, c, d, e, 1.0}));
    BOOST_TEST((both_ends::coefficients(theta) == std::array{0.5, a, b, c, d, e, 0.5}));
    BOOST_TEST((inside::coefficients(theta) == std::array{a, b, c * 0.5, 1.0, c * 0.5, d, e}));
  }
}

BOOST_AUTO_TEST_CASE(derivatives_flow_through_a_thermostatted_family) {
  using D = dual<double, 2>;
  const std::array theta{D::variable(0.45, 0), D::variable(0.4, 1)};
  const auto plain = nystrom::coefficients(theta);
  const auto split = inside::coefficients(theta);
  BOOST_TEST((split[2].derivative[0] == plain[2].derivative[0] * 0.5));
  BOOST_TEST((split[3].value == 1.0 && split[3].derivative == std::array{0.0, 0.0}));
  BOOST_TEST((split[6].derivative == plain[4].derivative));
}
