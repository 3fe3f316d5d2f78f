// SPDX-License-Identifier: BSL-1.0
// Families are what the concept asks for, and their classical members are those methods.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "../laws/models.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <class... F>
constexpr bool are_families(std::tuple<F...>*) {
  return (Family<F> && ...) && (Method<member<F>> && ...);
}
static_assert(are_families(static_cast<all_families*>(nullptr)));

/// A family of one's own, all of it: six lines.
struct mine : composition<1> {
  using word = nysalt::word<kick, drift, kick>;
  static constexpr std::string_view name = "mine";
  static std::array<double, 1> start() { return {0.5}; }
  template <Scalar C>
  static std::array<C, 3> coefficients(const std::array<C, 1>& b) {
    return {b[0], C(1.0), C(1.0) - b[0]};
  }
};
static_assert(Family<mine>);

tabulated method_named(std::string_view name) {
  draws random;
  const auto all = methods_as_data(random);
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& m) { return m.name() == name; });
  BOOST_REQUIRE(found != all.end());
  return *found;
}

/// The letters of a word where its quadratic part is nothing.
std::string unsplit(std::string letters) {
  std::replace(letters.begin(), letters.end(), 'R', 'A');
  std::replace(letters.begin(), letters.end(), 'S', 'B');
  std::replace(letters.begin(), letters.end(), 'H', 'G');
  return letters;
}

/// Coefficients that follow from sums round once for each of them.
bool is_at(const auto& theta, const auto& family, const Method auto& method) {
  const auto ours = family.coefficients(theta);
  const auto theirs = method.coefficients();
  if (ours.size() != theirs.size()) return false;
  double size = 0.0;
  for (const double c : theirs) size += std::abs(c);
  for (std::size_t k = 0; k < ours.size(); ++k) {
    if (!(std::abs(ours[k] - theirs[k]) <= eps * size)) return false;
  }
  return unsplit(word_of(family).letters()) == unsplit(word_of(method).letters());
}

template <class... F>
using types = std::tuple<F...>;
using with_members = types<aba<2>, aba<3>, aba<4>, aba<5>, bab<2>, bab<3>, bab<4>, bab<5>, bab<6>, fg4, r_fg4,
                           r_aba<2>, r_aba<3>, r_aba<4>, r_aba<5>>;

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(classical_members_are_those_methods, F, with_members) {
  BOOST_TEST(!F::classical_members().empty());
  for (const auto& [name, theta] : F::classical_members()) {
    BOOST_TEST_CONTEXT(name << " in " << F::name) {
      BOOST_CHECK_NO_THROW(member<F>{theta});
      BOOST_TEST(is_at(theta, F{}, method_named(name)));
      auto off = theta;
      off[0] += 1e-12;
      BOOST_TEST(!is_at(off, F{}, method_named(name)));
    }
  }
}

BOOST_AUTO_TEST_CASE_TEMPLATE(searches_begin_at_consistent_members_within_the_ranges, F, all_families) {
  const member<F> first(F::start());
  const auto word = run_time_word(typename F::word{});
  const auto c = first.coefficients();
  for (const std::string kind : {"AR", "BDGSH"}) {
    double sum = 0.0;
    for (std::size_t i = 0; i < word.length; ++i) {
      if (kind.find(word.letters()[i]) != std::string::npos) sum += c[word.first_slot(i)];
    }
    BOOST_TEST(std::abs(sum - 1.0) <= static_cast<double>(c.size()) * eps);  // each term rounds once
  }
}

// That many equal steps, of drift-kick-drift or of kick-drift-kick.
BOOST_AUTO_TEST_CASE(compositions_begin_at_steps_of_verlet) {
  BOOST_TEST(is_at(bab<2>::start(), bab<2>{}, verlet_2x()));
  const auto three = aba3_free::coefficients(aba3_free::start());
  const std::array expected{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  for (std::size_t k = 0; k < three.size(); ++k) BOOST_TEST(std::abs(three[k] - expected[k]) <= 4.0 * eps);
}

BOOST_AUTO_TEST_CASE(gradient_families_hold_chins_method) {
  BOOST_TEST(is_at(fg_chin::start(), fg_chin{}, chin4a()));
  BOOST_TEST(!is_at(parameters_of<fg_chin>{1.0 / 6.0, 1.0 / 71.0}, fg_chin{}, chin4a()));
  // fg4 and r_fg4 hold it between two drifts of no length; 1 - 2/6 rounds.
  const auto chin = chin4a::coefficients();
  for (const auto& c : {fg4::coefficients(fg4::start()), r_fg4::coefficients(r_fg4::start())}) {
    BOOST_TEST(c.front() == 0.0);
    BOOST_TEST(c.back() == 0.0);
    for (std::size_t k = 0; k < chin.size(); ++k) BOOST_TEST(std::abs(c[k + 1] - chin[k]) <= eps);
  }
}

// At b = 0 the kicks outside are none: what is left is Takahashi and Imada's kernel.
BOOST_AUTO_TEST_CASE(fg_chin_holds_takahashi_and_imadas_method) {
  const auto c = fg_chin::coefficients(std::array{0.0, 1.0 / 24.0});
  const auto theirs = takahashi_imada::coefficients();
  BOOST_TEST(std::equal(theirs.begin(), theirs.end(), c.begin() + 1));
}
