// SPDX-License-Identifier: BSL-1.0
// Families of words as data: of any palindrome of letters, symmetric, with coefficients that add up to one
// for each part of H, and equal steps to begin with.
#include <map>

#include "../support/refusal.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/bab.hpp"
#include "nysalt/methods/r_respa.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/run_time_family.hpp"
#include "nysalt/systems/bonded_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const bonded_chain<3> chain(stiff_bonds<3>(5.0), soft_charges<3>(1.0));
/// A word that holds the letters 0, 1 and k.
const run_time_word of_parts(word<kick_of_part<0>, drift, kick_of_part<1>, kick_of_parts<0, 1>>{}, chain);

/// The part of H for each coefficient.
std::string times_of(const std::string& letters) {
  std::string times;
  for (const char letter : letters) times += letter == 'k' ? "01" : std::string(1, letter);
  return times;
}
run_time_family family_of(const std::string& letters) {
  return symmetric_word("tried", of_parts.with_letters(letters), times_of(letters));
}
std::vector<double> start_of(const run_time_family& family) {
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
    return start_of(symmetric_word("tried", run_time_word(letters), letters));
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
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(other_words_are_refused) {
  const auto refused = [](const std::string& letters, const std::string& times, const char* why) {
    BOOST_TEST(refuses<std::invalid_argument>(
                   [&] { symmetric_word("tried", of_parts.with_letters(letters), times); }, {"tried", why}),
               letters);
  };
  refused("A0A1", "A0A1", "must read the same from both ends");
  refused("A00A", "A00A", "must not have two equal neighbours");
  refused("A0A", "A0", "must have a part of H for each coefficient");
  refused("kAk", "kAk", "must have a part of H for each coefficient");
  refused("ABA|BABA", "ABABABA", "must have no processor");
}
