// SPDX-License-Identifier: BSL-1.0
// Families are what the concept asks for, their classical members are those methods, of every family that can
// turn the oscillator exactly there is a member that does, and the two-stage family is the tableau of its
// paper.
#include "../laws/laws.hpp"
#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "../support/tableau.hpp"
#include "nysalt/derivatives/jacobian.hpp"
#include "nysalt/families/phase_fitted_start.hpp"
#include "nysalt/families/thermostatted.hpp"
#include "nysalt/methods/classical_methods.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <class... F>
constexpr bool are_families(std::tuple<F...>*) {
  return (Family<F> && ...) && (Method<member<F>> && ...);
}
static_assert(are_families(static_cast<all_families*>(nullptr)));

/// A family of one's own, all of it.
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

/// The letters of a word where its quadratic part is nothing.
std::string unsplit(std::string letters) {
  std::replace(letters.begin(), letters.end(), 'R', 'A');
  std::replace(letters.begin(), letters.end(), 'S', 'B');
  std::replace(letters.begin(), letters.end(), 'H', 'G');
  return letters;
}

/// Coefficients that follow from sums round once for each of them.
bool is_at(const Eigen::VectorXd& theta, const run_time_family& family, const tabulated& method) {
  const auto ours = family.coefficients(theta);
  const auto theirs = method.coefficients();
  if (ours.size() != theirs.size()) return false;
  double size = 0.0;
  for (const double c : theirs) size += std::abs(c);
  for (std::size_t k = 0; k < ours.size(); ++k) {
    if (!(std::abs(ours[k] - theirs[k]) <= eps * size)) return false;
  }
  return unsplit(family.letters.letters()) == unsplit(method.letters().letters());
}

double largest_defect(const run_time_family& family, const Eigen::VectorXd& theta, double z) {
  return detail::defect_of_rotation(family.letters, family.coefficients(theta), family.symmetric, z * z)
      .lpNorm<Eigen::Infinity>();
}

/// Two kicks cannot: trace/2 = 1 - x/2 + K x^2 with x = z^2 and K <= 1/32, where cos z has x^2/24.
bool can_turn(const run_time_family& family) {
  return family.letters.reads == field::whole && family.parameters() >= (family.symmetric ? 2 : 3);
}

}  // namespace

BOOST_AUTO_TEST_CASE(classical_members_are_those_methods) {
  int tried = 0;
  for (const auto& family : families_as_data()) {
    for (const auto& [name, theta] : family.starts) {
      const auto row = std::find_if(std::begin(classical_table), std::end(classical_table),
                                    [&, &called = name](const auto& each) { return each.name == called; });
      if (row == std::end(classical_table)) continue;
      ++tried;
      BOOST_TEST_CONTEXT(name << " in " << family.name) {
        BOOST_TEST(family.is_in_range(theta));
        BOOST_TEST(is_at(theta, family, as_data(*row)));
        auto off = theta;
        off[0] += 1e-12;
        BOOST_TEST(!is_at(off, family, as_data(*row)));
      }
    }
  }
  BOOST_TEST(tried >= 15);
}

BOOST_AUTO_TEST_CASE(searches_begin_at_consistent_members_within_the_ranges) {
  for (const auto& family : families_as_data()) {
    const auto& first = family.starts.front().theta;
    BOOST_TEST(family.is_in_range(first), family.name);
    const auto c = family.coefficients(first);
    for (const std::string kind : {"AR", "BDGSH"}) {
      double sum = 0.0;
      for (std::size_t i = 0; i < family.letters.length; ++i) {
        if (kind.find(family.letters.letters()[i]) != std::string::npos)
          sum += c[family.letters.first_slot(i)];
      }
      // Each term rounds once.
      BOOST_TEST(std::abs(sum - 1.0) <= static_cast<double>(c.size()) * eps, family.name);
    }
  }
}

// That many equal steps, of drift-kick-drift or of kick-drift-kick.
BOOST_AUTO_TEST_CASE(compositions_begin_at_steps_of_verlet) {
  BOOST_TEST(is_at(column_of(bab<2>::start()), run_time_family(bab<2>()), tabulated(verlet_2x())));
  const auto three = aba3_free::coefficients(aba3_free::start());
  const std::array expected{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  for (std::size_t k = 0; k < three.size(); ++k) BOOST_TEST(std::abs(three[k] - expected[k]) <= 4.0 * eps);
}

BOOST_AUTO_TEST_CASE(gradient_families_hold_the_methods_of_chin_and_of_takahashi_and_imada) {
  BOOST_TEST(is_at(column_of(fg_chin::start()), run_time_family(fg_chin()), tabulated(chin4a())));
  // fg4 and r_fg4 hold it between two drifts of no length; 1 - 2/6 rounds.
  const auto chin = chin4a::coefficients();
  for (const auto& c : {fg4::coefficients(fg4::start()), r_fg4::coefficients(r_fg4::start())}) {
    BOOST_TEST(c.front() == 0.0);
    BOOST_TEST(c.back() == 0.0);
    for (std::size_t k = 0; k < chin.size(); ++k) BOOST_TEST(std::abs(c[k + 1] - chin[k]) <= eps);
  }
  // At b = 0 the kicks outside are none: what is left is Takahashi and Imada's kernel.
  const auto c = fg_chin::coefficients(std::array{0.0, 1.0 / 24.0});
  const auto theirs = takahashi_imada::coefficients();
  BOOST_TEST(std::equal(theirs.begin(), theirs.end(), c.begin() + 1));
}

// The defects are of order 1 for a member that is not fitted, and computed by polynomials with coefficients
// of order 1 in z^2 <= 6.25, of degree 6 at most: 6.25^4 eps is 4e-13, and the solution is that far off
// again.
BOOST_AUTO_TEST_CASE(what_can_turn_the_oscillator_does) {
  for (const auto& family : families_as_data()) {
    for (const double z : {1e-6, 0.4, 1.0, 2.5}) {
      const auto found = phase_fitted_start(family, z);
      BOOST_TEST_CONTEXT(family.name << " at " << z) {
        if (found) {
          BOOST_TEST(can_turn(family));
          BOOST_TEST(found->name == "phase_fitted");
          BOOST_TEST(family.is_in_range(found->theta));
          BOOST_TEST(largest_defect(family, found->theta, z) <= 1e-12);
          BOOST_TEST(largest_defect(family, found->theta, z + 0.01) > 1e-10);
        } else if (can_turn(family)) {  // there is no continuation from equal steps; nor of bab<3> so far
          const bool has_classical = family.starts.size() > 1;
          BOOST_TEST((!has_classical || (family.name == "bab3" && z == 2.5)));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(it_is_the_phase_fitted_method_of_the_first_classical_member) {
  const auto found = phase_fitted_start(run_time_family(aba<5>{}), 2.0);
  BOOST_REQUIRE(found);
  BOOST_TEST((found->theta == column_of(phase_fitted<aba<5>, mclachlan5>(2.0).parameters())));
}

BOOST_AUTO_TEST_CASE(letters_of_the_bath_count_for_nothing) {
  const run_time_family plain(fg4{});
  const auto expected = phase_fitted_start(plain, 2.0);
  const auto found = phase_fitted_start(thermostatted(plain, placement::symmetric), 2.0);
  BOOST_REQUIRE((expected && found));
  BOOST_TEST((found->theta == expected->theta));
}

BOOST_AUTO_TEST_CASE(impossible_z_are_refused) {
  for (const double z : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { phase_fitted_start(run_time_family(fg4{}), z); },
                                              {"phase_fitted_start", "positive and finite"}));
  }
}

// Order four along the whole branch; tried where a = 0 is Chin's and at Omelyan's own a.
BOOST_AUTO_TEST_CASE(members_of_order_four_of_the_word_of_fg4) {
  const auto omelyan = fg4::of(omelyan_fg4());
  const auto ours = fg4::of_order_four(omelyan[0]);
  for (std::size_t k = 0; k < 3; ++k) BOOST_TEST(std::abs(ours[k] - omelyan[k]) <= 4.0 * eps);
  for (const double a : {-0.2, 0.0, 0.1, 0.14, 0.3}) {
    auto theta = fg4::of_order_four(a);
    const run_time_family family(fg4{});
    // The two conditions of order four are the two of the oscillator: its defects at z = 0.
    BOOST_TEST(largest_defect(family, column_of(theta), 0.0) <= 8.0 * eps);
    theta[2] += 1e-10;
    BOOST_TEST(largest_defect(family, column_of(theta), 0.0) > 8.0 * eps);
  }
  BOOST_TEST(refuses<std::invalid_argument>([] { fg4::of_order_four(0.5); }, {"of_order_four", "0.5"}));
}

// On a fixed and a dynamic system, and on a black box; all of unit masses. Both forms take some 12 operations
// per coordinate, on terms no larger than the magnified state.
BOOST_AUTO_TEST_CASE(the_word_of_nystrom_is_the_tableau_of_its_paper) {
  draws random;
  const auto check = [&](const auto& system, double reach) {
    for (int n = 0; n < 20; ++n) {
      const auto [b1, beta1] = random_theta<nystrom>(random);
      const member<nystrom> method({b1, beta1});
      const auto off = [&](const tableau& oracle) {
        const auto x = random.state(system, reach);
        const auto at = shears_at(system, {x.q, x.p});
        const double h = 0.5 / at.frequency();
        auto ours = x;
        auto theirs = x;
        step_map(system, method, h)(ours);
        oracle.step(system, theirs, h);
        return distance(ours, theirs) / (12.0 * eps * size_of(x) * transient_growth(method, h, at));
      };
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", b1 = " << b1 << ", beta1 = " << beta1) {
        auto oracle = tableau::symplectic(b1, beta1);
        BOOST_TEST(off(oracle) <= 1.0);
        oracle.beta2 = 1.0 - beta1 - 0.5 * b1;  // not a slip of the paper, but one as good
        BOOST_TEST(off(oracle) > 1e3);
      }
    }
  };
  check(henon_heiles(), 0.25);
  check(fpu_chain<>(2, 7.0), 0.5);
  check(black_box(), 1.0);
}

BOOST_AUTO_TEST_CASE(out_of_range_is_said_with_the_parameters_name) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](double b1, double beta1, auto... words) {
    return refuses<std::invalid_argument>([&] { member<nystrom>({b1, beta1}); }, {"nystrom", words...});
  };
  BOOST_TEST(refused(0.0, 0.4, "b1", "(0, 1)", "got 0"));
  BOOST_TEST(refused(1.0, 0.4, "b1", "(0, 1)", "got 1"));
  BOOST_TEST(refused(-0.5, 0.4, "b1", "got -0.5"));
  BOOST_TEST(refused(nan, 0.4, "b1", "nan"));
  BOOST_TEST(refused(0.5, -1e-9, "beta1", "[0, 0.5]", "got -1e-09"));
  BOOST_TEST(refused(0.5, 0.51, "beta1", "[0, 0.5]"));
  BOOST_TEST(refused(0.5, nan, "beta1", "nan"));
  for (const double end : {0.0, 0.5}) {  // the ends of beta1 may be attained
    for (const double c : member<nystrom>({0.5, end}).coefficients()) BOOST_TEST(std::isfinite(c));
  }
}
