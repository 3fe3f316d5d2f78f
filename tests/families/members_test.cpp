// SPDX-License-Identifier: BSL-1.0
// Families are what the concept asks for, their classical members are those methods, of every family that can
// turn the oscillator exactly there is a member that does, and the two-stage family is the tableau of its
// paper.
#include <map>

#include "../../examples/systems/bonded_chain.hpp"
#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/families/multiple_time_steps.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/phase_fitted.hpp"

using namespace nysalt;
using namespace examples;
using namespace nysalt::test;

namespace {

template <class... F>
constexpr bool are_families(std::tuple<F...>*) {
  return (Family<F> && ...);
}
static_assert(are_families(static_cast<all_families*>(nullptr)));

/// The letters of a word where its quadratic part is nothing.
std::string unsplit(std::string letters) {
  std::replace(letters.begin(), letters.end(), 'R', 'A');
  std::replace(letters.begin(), letters.end(), 'S', 'B');
  std::replace(letters.begin(), letters.end(), 'H', 'G');
  return letters;
}

/// Coefficients that follow from sums round once for each of them.
bool is_at(const Eigen::VectorXd& theta, const family& family, const method& method) {
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

double largest_defect(const family& family, const Eigen::VectorXd& theta, double z) {
  return detail::defects_of_rotation(family, theta, {z * z}).front().values.lpNorm<Eigen::Infinity>();
}

/// The tableau of an explicit two-stage Nystrom method for unit masses, which shares no code with the library
/// [li_lu_tao_ye_2023, equation (2.5)].
struct tableau {
  double c1, c2, a21, beta1, beta2, b1, b2;

  /// The symplectic ones [li_lu_tao_ye_2023, equation (2.11)].
  static tableau symplectic(double b1, double beta1) {
    tableau t{};
    t.b1 = b1;
    t.b2 = 1.0 - b1;
    t.beta1 = beta1;
    t.beta2 = 0.5 - beta1;
    t.c1 = 1.0 - t.beta1 / t.b1;
    t.c2 = 1.0 - t.beta2 / t.b2;
    t.a21 = t.b1 * (t.c2 - t.c1);
    return t;
  }

  template <System S, Scalar T>
  void step(const S& system, phase_point<T, S::dimension>& x, double h) const {
    auto stage = x.q;
    auto l1 = x.q;
    auto l2 = x.q;
    for (Eigen::Index i = 0; i < x.size(); ++i) stage[i] = x.q[i] + x.p[i] * (c1 * h);
    force<T>(system, stage, l1);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      stage[i] = x.q[i] + x.p[i] * (c2 * h) + l1[i] * (a21 * h * h);
    }
    force<T>(system, stage, l2);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x.q[i] += x.p[i] * h + (l1[i] * beta1 + l2[i] * beta2) * (h * h);
      x.p[i] += (l1[i] * b1 + l2[i] * b2) * h;
    }
  }
};

/// Two kicks cannot: trace/2 = 1 - x/2 + K x^2 with x = z^2 and K <= 1/32, where cos z has x^2/24.
bool can_turn(const family& family) {
  return family.letters.reads == field::whole && family.parameters() >= (family.symmetric ? 2 : 3);
}

const bonded_chain<3> chain(stiff_bonds<3>(5.0), soft_charges<3>(1.0));
/// A word that holds the letters 0, 1 and k.
constexpr word of_parts = word_of<kick_of_part<0>, drift, kick_of_part<1>, kick_of_parts<0, 1>>();

/// The part of H for each coefficient.
std::string times_of(const std::string& letters) {
  std::string times;
  for (const char letter : letters) times += letter == 'k' ? "01" : std::string(1, letter);
  return times;
}
family family_of(const std::string& letters) {
  return symmetric_word("tried", of_parts.with_letters(letters), times_of(letters));
}
std::vector<double> start_of(const family& family) {
  return family.coefficients(family.starts.front().theta);
}

/// A palindrome of 3 to 15 letters without equal neighbours.
std::string random_word(std::mt19937& random) {
  const std::string letters = "A01k";
  std::string half;
  const std::size_t length = 2 + random() % 7;
  while (half.size() < length) {
    const char next = letters[random() % letters.size()];
    if (half.empty() || half.back() != next) half += next;
  }
  return half + std::string(half.rbegin() + 1, half.rend());
}

void close(const std::vector<double>& found, const std::vector<double>& expected) {
  BOOST_TEST_REQUIRE(found.size() == expected.size());
  // Sums of at most 15 numbers below 4: some roundings of them.
  for (std::size_t k = 0; k < found.size(); ++k) BOOST_TEST(std::abs(found[k] - expected[k]) < 1e-14);
}

}  // namespace

// That coefficients of all members add up: methods/laws_test.cpp.
BOOST_AUTO_TEST_CASE(starts_are_in_range_and_classical_members_are_those_methods) {
  int tried = 0;
  for (const auto& family : families_as_data()) {
    for (const auto& [name, theta] : family.starts) {
      BOOST_TEST(family.is_in_range(theta), name << " of " << family.name);
      const auto row = std::find_if(std::begin(detail::classical_table), std::end(detail::classical_table),
                                    [&, &called = name](const auto& each) { return each.name == called; });
      if (row == std::end(detail::classical_table)) continue;
      ++tried;
      BOOST_TEST_CONTEXT(name << " in " << family.name) {
        BOOST_TEST(is_at(theta, family, detail::as_data(*row)));
        auto off = theta;
        off[0] += 1e-12;
        BOOST_TEST(!is_at(off, family, detail::as_data(*row)));
      }
    }
  }
  BOOST_TEST(tried >= 15);
}

// That many equal steps, of drift-kick-drift or of kick-drift-kick.
BOOST_AUTO_TEST_CASE(compositions_begin_at_steps_of_verlet) {
  BOOST_TEST(is_at(column_of(bab<2>::start()), family(bab<2>()), method(verlet_2x())));
  const auto three = aba3_free::coefficients(aba3_free::start());
  const std::array expected{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  for (std::size_t k = 0; k < three.size(); ++k) BOOST_TEST(std::abs(three[k] - expected[k]) <= 4.0 * eps);
}

BOOST_AUTO_TEST_CASE(gradient_families_hold_the_methods_of_chin_and_of_takahashi_and_imada) {
  BOOST_TEST(is_at(column_of(fg_chin::start()), family(fg_chin()), method(chin4a())));
  // fg4 and r_fg4 hold it between two drifts of no length; 1 - 2/6 rounds.
  const auto chin = chin4a().coefficients();
  for (const auto& c : {fg4::coefficients(fg4::start()), r_fg4::coefficients(r_fg4::start())}) {
    BOOST_TEST(c.front() == 0.0);
    BOOST_TEST(c.back() == 0.0);
    for (std::size_t k = 0; k < chin.size(); ++k) BOOST_TEST(std::abs(c[k + 1] - chin[k]) <= eps);
  }
  // At b = 0 the kicks outside are none: what is left is Takahashi and Imada's kernel.
  const auto c = fg_chin::coefficients(std::array{0.0, 1.0 / 24.0});
  const auto theirs = takahashi_imada().coefficients();
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
  const auto found = phase_fitted_start(family(aba<5>{}), 2.0);
  BOOST_REQUIRE(found);
  BOOST_TEST((found->theta == column_of(aba<5>::of(fitted<aba<5>, mclachlan5>::at(2.0)))));
  // Letters of the bath count for nothing.
  const family plain(fg4{});
  const auto expected = phase_fitted_start(plain, 2.0);
  const auto in_bath = phase_fitted_start(thermostatted(plain, placement::symmetric), 2.0);
  BOOST_REQUIRE((expected && in_bath));
  BOOST_TEST((in_bath->theta == expected->theta));
}

BOOST_AUTO_TEST_CASE(impossible_z_are_refused) {
  for (const double z : {0.0, -1.0, not_a_number}) {
    BOOST_TEST(refuses([&] { phase_fitted_start(family(fg4{}), z); },
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
    const family family(fg4{});
    // The two conditions of order four are the two of the oscillator: its defects at z = 0.
    BOOST_TEST(largest_defect(family, column_of(theta), 0.0) <= 8.0 * eps);
    theta[2] += 1e-10;
    BOOST_TEST(largest_defect(family, column_of(theta), 0.0) > 8.0 * eps);
  }
  BOOST_TEST(refuses([] { fg4::of_order_four(0.5); }, {"of_order_four", "0.5"}));
}

// On a fixed and a dynamic system, and on a black box; all of unit masses. Both forms take some 12 operations
// per coordinate, on terms no larger than the magnified state.
BOOST_AUTO_TEST_CASE(the_word_of_nystrom_is_the_tableau_of_its_paper) {
  draws random;
  const auto check = [&](const auto& system, double reach) {
    for (int n = 0; n < 20; ++n) {
      const auto [b1, beta1] = random_theta<nystrom>(random);
      const nysalt::method method = member(nystrom(), {b1, beta1});
      const auto off = [&](const tableau& oracle) {
        const auto x = random.state(system, reach);
        const auto at = shears_at(system, {x.q, x.p});
        const double h = 0.5 / at.frequency();
        auto ours = x;
        auto theirs = x;
        detail::step_map(system, method, h)(ours);
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

// Families of words: any palindrome of letters, symmetric, with coefficients that add up to one for each part
// of H, and equal steps to begin with.

BOOST_AUTO_TEST_CASE(members_of_any_word_are_palindromes_that_add_up_to_one) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 200; ++n) {
    const std::string letters = random_word(random);
    const std::string times = times_of(letters);
    const auto family = family_of(letters);
    BOOST_TEST_CONTEXT(letters) {
      Eigen::VectorXd theta = family.starts.front().theta;
      for (int member = 0; member < 2; ++member) {
        const auto c = family.coefficients(theta);
        BOOST_TEST(is_palindrome(family.letters, c));
        std::map<char, double> sums;
        for (std::size_t k = 0; k < c.size(); ++k) sums[times[k]] += c[k];
        for (const auto& [part, sum] : sums) BOOST_TEST(std::abs(sum - 1.0) < 1e-13);
        // Coefficients are affine in theta, so that a difference is exact but for rounding.
        const Eigen::MatrixXd slopes = family.jacobian(theta);
        for (Eigen::Index k = 0; k < theta.size(); ++k) {
          Eigen::VectorXd moved = theta;
          moved[k] += 1.0;
          const auto there = family.coefficients(moved);
          for (std::size_t i = 0; i < c.size(); ++i) {
            BOOST_TEST(std::abs(there[i] - c[i] - slopes(static_cast<Eigen::Index>(i), k)) < 1e-13);
          }
        }
        for (double& x : theta) x += normal(random);
      }
      BOOST_TEST((theta.size() == 0 || start_of(family) != family.coefficients(theta)));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_start_is_made_of_equal_steps) {
  const auto listed = [](const auto& c) { return std::vector<double>(c.begin(), c.end()); };
  const auto start_of_known = [](const std::string& letters) {
    return start_of(symmetric_word("tried", word(letters), letters));
  };
  close(start_of_known("ABA"), {0.5, 1.0, 0.5});
  close(start_of_known("ABABABABA"), listed(aba<4>::coefficients(aba<4>::start())));
  close(start_of_known("BABABABABAB"), listed(bab<5>::coefficients(bab<5>::start())));
  close(start_of(family_of("kA0Ak")), listed(r_respa<0, 1, 2>().coefficients()));
  close(start_of(family_of("kA0A0A0A0Ak")), listed(r_respa<0, 1, 5>().coefficients()));
  const auto nested = nested_kicks<0, 1, 3, 2>();
  close(start_of(family_of("kA0A0AkA0A0Ak")), listed(nested.coefficients(nested.start())));
  // With the kicks of a whole step apart, and slow kicks around the others.
  close(start_of(family_of("10A0A01")), {0.5, 0.25, 0.5, 0.5, 0.5, 0.25, 0.5});
  BOOST_TEST(family_of("kA0Ak").parameters() == 1);
  BOOST_TEST(family_of("kA0A0A0Ak").parameter_names == (std::vector<std::string>{"01", "A1", "02"}),
             per_element());
}

BOOST_AUTO_TEST_CASE(other_words_are_refused) {
  const auto refused = [](const std::string& letters, const std::string& times, const char* why) {
    BOOST_TEST(
        refuses([&] { symmetric_word("tried", of_parts.with_letters(letters), times); }, {"tried", why}),
        letters);
  };
  refused("A0A1", "A0A1", "must read the same from both ends");
  refused("A00A", "A00A", "must not have two equal neighbours");
  refused("A0A", "A0", "must have a part of H for each coefficient");
  refused("kAk", "kAk", "must have a part of H for each coefficient");
  refused("ABA|BABA", "ABABABA", "must have no processor");
}
