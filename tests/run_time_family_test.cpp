// SPDX-License-Identifier: BSL-1.0
// A family as data is the family as a type, in a bath too.
#include "nysalt/run_time_family.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nysalt/families/aba.hpp"
#include "nysalt/families/fg4.hpp"
#include "nysalt/families/free_composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/thermostatted.hpp"
#include "nysalt/losses/squares.hpp"
#include "support/draws.hpp"
#include "support/refusal.hpp"
#include "support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;

template <Family F>
parameters_of<F> near_start(draws& random) {
  auto theta = F::start();
  for (double& x : theta) x += random.uniform(-0.05, 0.05);
  return theta;
}

/// The coefficients of the type over dual numbers.
template <Family F>
auto lifted_coefficients(const parameters_of<F>& theta) {
  std::array<theta_dual<F>, parameters_of<F>{}.size()> lifted;
  for (std::size_t k = 0; k < lifted.size(); ++k) {
    lifted[k] = theta_dual<F>::variable(theta[k], static_cast<int>(k));
  }
  return F::coefficients(lifted);
}

template <Family F>
void check_coefficients(const run_time_family& as_data) {
  draws random;
  for (int n = 0; n < 5; ++n) {
    const auto theta = near_start<F>(random);
    const auto expected = lifted_coefficients<F>(theta);
    const auto values = as_data.coefficients(column_of(theta));
    const auto slopes = as_data.jacobian(column_of(theta));
    BOOST_TEST_CONTEXT(as_data.name << " as " << as_data.letters.letters() << ", seed " << draws::seed) {
      BOOST_REQUIRE(values.size() == expected.size());
      BOOST_REQUIRE(slopes.rows() == std::ssize(expected));
      BOOST_REQUIRE(slopes.cols() == F::parameters);
      int differ = 0;
      int not_zero = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        differ += values[i] != expected[i].value;
        for (std::size_t k = 0; k < theta.size(); ++k) {
          const double slope = slopes(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
          differ += slope != expected[i].derivative[k];
          not_zero += slope != 0.0;
        }
      }
      BOOST_TEST(differ == 0);
      BOOST_TEST(not_zero >= 2 * F::parameters);  // each parameter moves more than one coefficient
    }
  }
}

template <Family F>
void check_type() {
  const run_time_family as_data{F()};
  BOOST_TEST(as_data.name == F::name);
  BOOST_TEST(as_data.parameters() == F::parameters);
  BOOST_TEST(as_data.order == F::order);
  BOOST_TEST(as_data.symmetric == F::symmetric);
  BOOST_TEST(as_data.requires_quadratic_kinetic == F::requires_quadratic_kinetic);
  BOOST_TEST(as_data.letters.letters() == F::word::letters());
  const auto ranges = F::ranges();
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    BOOST_TEST(as_data.parameter_names[k] == F::parameter_names[k]);
    BOOST_TEST(as_data.ranges[k].low == ranges[k].low);
    BOOST_TEST(as_data.ranges[k].high == ranges[k].high);
    BOOST_TEST(as_data.ranges[k].open == ranges[k].open);
  }
  BOOST_TEST(as_data.starts.front().name == "start");
  BOOST_TEST((as_data.starts.front().theta == column_of(F::start())));
  check_coefficients<F>(as_data);
}

template <Family F, placement P>
void check_thermostatted() {
  using in_bath = thermostatted_family<F, P>;
  const auto as_data = thermostatted(run_time_family(F()), P);
  BOOST_TEST(as_data.letters.letters() == in_bath::word::letters());
  BOOST_TEST(as_data.order == in_bath::order);
  BOOST_TEST(as_data.symmetric == in_bath::symmetric);
  check_coefficients<in_bath>(as_data);
  // What O covers of a step is none of the parameters' business.
  const auto slopes = as_data.jacobian(column_of(F::start()));
  for (std::size_t i = 0; i < as_data.letters.length; ++i) {
    const auto row = static_cast<Eigen::Index>(as_data.letters.first_slot(i));
    if (as_data.letters.letters()[i] == bath_letter) BOOST_TEST(slopes.row(row).norm() == 0.0);
  }
}

struct with_further_start : aba<4> {
  static std::vector<std::array<double, 3>> further_starts() { return {{0.2, 0.5, -0.2}}; }
};

/// Whether members of the family that `larger` contains are members of `larger`, the processor being nothing.
bool embeds(const run_time_family& larger) {
  draws random;
  const auto& [inner, slopes, origin] = *larger.contained;
  Eigen::VectorXd theta = inner.starts.front().theta;
  for (double& x : theta) x += random.uniform(-0.1, 0.1);
  const auto embedded = larger.coefficients(larger.contained->embed(theta));
  const auto expected = inner.coefficients(theta);
  double most = 0.0;
  for (std::size_t i = 0; i < embedded.size(); ++i) {
    most = std::max(most, std::abs(embedded[i] - (i < expected.size() ? expected[i] : 0.0)));
  }
  return most <= 8.0 * eps;  // sums of up to seven numbers below one
}

struct with_wrong_letters_first : free_composition<drift, kick, 3> {
  static constexpr std::string_view name = "wrong";
  using contained = bab<3>;
};

}  // namespace

BOOST_AUTO_TEST_CASE(members_of_a_contained_family_are_members) {
  for (const auto& family : {run_time_family(aba3_free()), run_time_family(aba6_free()),
                             run_time_family(bab6_free()), processed(run_time_family(fg4()), 3),
                             thermostatted(run_time_family(aba4_free()), placement::middle)}) {
    BOOST_TEST_CONTEXT(family.name) {
      BOOST_REQUIRE(family.contained);
      BOOST_TEST(family.contained->family.parameters() < family.parameters());
      BOOST_TEST(embeds(family));
    }
  }
  BOOST_TEST(!run_time_family(aba<4>()).contained);
  BOOST_TEST(refuses<std::logic_error>([] { run_time_family{with_wrong_letters_first()}; },
                                       {"wrong", "bab3", "ABABABA", "BABABAB"}));
}

BOOST_AUTO_TEST_CASE(it_knows_what_the_type_knows) {
  check_type<nystrom>();
  check_type<aba<2>>();
  check_type<aba<6>>();
  check_type<fg4>();
}

BOOST_AUTO_TEST_CASE(classical_members_and_points_without_a_name_are_starts_too) {
  const run_time_family four{with_further_start()};
  BOOST_REQUIRE(four.starts.size() == 3U);
  BOOST_TEST(four.starts[1].name == "pefrl");
  BOOST_TEST(four.starts[2].name == "further start");
  const auto found = four.coefficients(four.starts[1].theta);
  const auto expected = pefrl().coefficients();
  for (std::size_t i = 0; i < found.size(); ++i) {
    BOOST_TEST(std::abs(found[i] - expected[i]) <= 4.0 * eps);  // sums of four numbers below one
  }
  BOOST_TEST(run_time_family(nystrom()).starts.size() == 1U);
}

BOOST_AUTO_TEST_CASE(in_a_bath_it_is_the_thermostatted_type) {
  check_thermostatted<nystrom, placement::end>();
  check_thermostatted<nystrom, placement::symmetric>();
  check_thermostatted<nystrom, placement::middle>();
  check_thermostatted<aba<4>, placement::middle>();
  check_thermostatted<fg4, placement::symmetric>();
  check_thermostatted<fg4, placement::middle>();  // a letter of two slots is split
}

BOOST_AUTO_TEST_CASE(what_cannot_be_thermostatted_is_refused) {
  const auto once = thermostatted(run_time_family(nystrom()), placement::end);
  BOOST_TEST(
      refuses<wrong>([&] { thermostatted(once, placement::end); }, {"ABABAO", "must have no letters O"}));
  BOOST_TEST(
      refuses<wrong>([] { thermostatted(run_time_word("AB"), placement::middle); }, {"AB", "central"}));
}

BOOST_AUTO_TEST_CASE(it_is_defined_where_open_ranges_are) {
  const run_time_family family{nystrom()};  // b1 in (0, 1), beta1 in [0, 0.5]
  BOOST_TEST(family.is_defined(Eigen::Vector2d(0.5, 0.4)));
  BOOST_TEST(family.is_defined(Eigen::Vector2d(0.5, 0.5)));
  BOOST_TEST(family.is_defined(Eigen::Vector2d(0.5, 0.7)));  // beyond a bound that may be attained
  BOOST_TEST(!family.is_defined(Eigen::Vector2d(0.0, 0.4)));
  BOOST_TEST(!family.is_defined(Eigen::Vector2d(1.0, 0.4)));
  BOOST_TEST(!family.is_defined(Eigen::Vector2d(std::numeric_limits<double>::quiet_NaN(), 0.4)));
}

BOOST_AUTO_TEST_CASE(out_of_range_is_said_with_the_parameters_name) {
  const run_time_family family{nystrom()};
  const auto refused = [&](double b1, double beta1, std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { require_in_range(family, Eigen::Vector2d(b1, beta1)); }, words);
  };
  BOOST_TEST(!refused(0.5, 0.5, {}));
  BOOST_TEST(refused(1.0, 0.4, {"nystrom", "b1", "(0, 1)", "got 1"}));
  BOOST_TEST(refused(0.5, 0.6, {"nystrom", "beta1", "[0, 0.5]", "got 0.6"}));
}
