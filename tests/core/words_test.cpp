// SPDX-License-Identifier: BSL-1.0
// What a word knows of itself: its costs, where it evaluates forces, where its letters O are, and who serves
// it.
#include "../support/refusal.hpp"
#include "nysalt/core.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using numbers = std::vector<double>;
using O = ornstein_uhlenbeck;

/// Like a kick, but not to be merged.
struct lonely_kick : kick {
  static constexpr char letter = 'b';
  static constexpr bool additive = false;
};

/// A letter for each letter of the word: s, the force is evaluated and kept for a later letter; u, for this
/// one alone; -, not at all.
std::string as_text(const auto& evaluations, std::size_t length) {
  std::string text;
  for (std::size_t i = 0; i < length; ++i) {
    const detail::evaluation one = evaluations[i];
    text += one == detail::evaluation::shared ? 's' : one == detail::evaluation::unshared ? 'u' : '-';
  }
  return text;
}

struct facts {
  std::string letters;
  int to_open, per_step, of_plain_step;
  std::string in_step, in_loop, in_last;  // where forces are evaluated
  bool merges = false;
  bool merges_half_steps = false;
};
// clang-format off
const std::vector<facts> known{
    {"BAB", 1, 1, 2, "u-u", "--u", "--s", true},  // Verlet: the last force is the next first, or taken back
    {"ABA", 0, 1, 1, "-u-", "-u-", "-u-", true},
    {"BABAB", 1, 2, 3, "u-u-u", "--u-u", "--u-s", true},
    {"ABABA", 0, 2, 2, "-u-u-", "-u-u-", "-u-u-", true},
    {"BA", 0, 1, 1, "u-", "u-", "u-"},  // symplectic Euler
    {"AB", 0, 1, 1, "-u", "-u", "-u"},
    {"A", 0, 0, 0, "-", "-", "-"},
    {"B", 1, 0, 1, "u", "-", "-"},               // q never moves
    {"BBA", 0, 1, 1, "s--", "s--", "s--"},       // one force serves both
    {"BAOAB", 1, 1, 2, "u---u", "----u", "----s", true},
    {"OBABO", 1, 1, 2, "-u-u-", "---s-", "---s-", false, true},  // the bath prevents merging, not reuse
    {"ABOBA", 0, 1, 1, "-s---", "-s---", "-s---", true},
    {"BABO", 1, 1, 2, "u-u-", "--s-", "--s-"},
    {"BOBA", 0, 1, 1, "s---", "s---", "s---"},
    {"OAO", 0, 0, 0, "---", "---", "---", false, true},
    {"OAB", 0, 1, 1, "--u", "--u", "--u"},
};
// clang-format on

using enum placement;

void has_letters_o(const char* plain, placement where, const char* letters, const numbers& expected,
                   const numbers& coefficients) {
  BOOST_TEST(thermostatted(word(plain), where).letters() == letters);
  const numbers found = detail::thermostatted_coefficients(word(plain), where, coefficients);
  BOOST_TEST(found == expected, boost::test_tools::per_element());
}

static_assert(placements == std::array{end, symmetric, middle});
static_assert(to_string(end) == "end" && to_string(symmetric) == "symmetric" &&
              to_string(middle) == "middle");

}  // namespace

BOOST_AUTO_TEST_CASE(costs_and_places_of_evaluations_follow_from_the_letters) {
  for (const facts& expected : known) {
    const word word(expected.letters);
    BOOST_TEST_CONTEXT(expected.letters) {
      BOOST_TEST(word.evaluations_to_open == expected.to_open);
      BOOST_TEST(word.evaluations_per_step == expected.per_step);
      BOOST_TEST(word.evaluations_of_plain_step == expected.of_plain_step);
      BOOST_TEST(as_text(word.plan().in_step, word.length) == expected.in_step);
      BOOST_TEST(as_text(word.plan().in_loop, word.length) == expected.in_loop);
      BOOST_TEST(as_text(word.plan().in_last, word.length) == expected.in_last);
      BOOST_TEST(word.merges == expected.merges);
      BOOST_TEST(word.merges_half_steps == expected.merges_half_steps);
      BOOST_TEST(word.first_in_loop() == (expected.merges ? 1U : 0U));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_word_of_flows_is_the_word_of_their_names) {
  static_assert(word_of<kick, drift, kick>() == word("BAB"));
  static_assert(word_of<O, kick, drift, gradient_kick, drift, kick, O>() == word("OBAGABO"));
  static_assert(word_of<rotation, soft_kick, soft_gradient_kick>() == word("RSH"));
  static_assert(alternating_word<kick, drift, 5>() == word("BABAB"));
  // What is not additive is not merged, yet the force is reused.
  constexpr word lonely = word_of<lonely_kick, drift, lonely_kick>();
  static_assert(!lonely.merges && lonely.evaluations_to_open == 1 && lonely.evaluations_per_step == 1);
  BOOST_TEST(as_text(lonely.plan().in_loop, 3) == "--s");
  BOOST_TEST(as_text(word_of<drift, kick, lonely_kick>().plan().in_step, 3) == "-s-");
}

BOOST_AUTO_TEST_CASE(a_palindrome_follows_from_its_first_coefficients) {
  BOOST_TEST((detail::palindrome<3>({}) == std::array{0.5, 1.0, 0.5}));
  BOOST_TEST((detail::palindrome<5>({0.25}) == std::array{0.25, 0.5, 0.5, 0.5, 0.25}));
  BOOST_TEST(
      (detail::palindrome<7>({0.125, 0.25}) == std::array{0.125, 0.25, 0.375, 0.5, 0.375, 0.25, 0.125}));
}

BOOST_AUTO_TEST_CASE(letters_and_words_that_cannot_be_are_refused) {
  const auto refused = [](const char* letters, said words) { return refuses([&] { word{letters}; }, words); };
  for (const char* mixed : {"BAS", "SRB", "BAH", "GRS", "SRHRG", "RBR", "ASA", "RAS"}) {
    BOOST_TEST(refused(mixed, {mixed, "A, B, G", "R, S, H"}));
  }
  BOOST_TEST(refused("", {"one or more"}));
  BOOST_TEST(refused("AXB", {"letter X", "A, B, G, D, R, S, H, O"}));
  for (const char* bath_alone : {"O", "OO"})
    BOOST_TEST(refused(bath_alone, {bath_alone, "a letter other than O"}));
  for (const char* right : {"BAG", "SRH", "RSR", "AB", "OA"}) BOOST_TEST(!refused(right, {}));
}

BOOST_AUTO_TEST_CASE(letters_o_are_added_where_they_are_placed) {
  has_letters_o("BAB", end, "BABO", {.25, 1., .75, 1.}, {.25, 1., .75});
  has_letters_o("BAB", symmetric, "OBABO", {.5, .25, 1., .75, .5}, {.25, 1., .75});
  has_letters_o("BAB", middle, "BAOAB", {.25, .5, 1., .5, .75}, {.25, 1., .75});
  has_letters_o("ABABA", middle, "ABAOABA", {.1, .2, .25, 1., .25, .3, .4}, {.1, .2, .5, .3, .4});
  has_letters_o("BA", end, "BAO", {1., 1., 1.}, {1., 1.});
  has_letters_o("BA", symmetric, "OBAO", {.5, 1., 1., .5}, {1., 1.});
  has_letters_o("A", middle, "AOA", {.5, 1., .5}, {1.});
  BOOST_TEST(
      refuses([] { thermostatted(word("BA"), middle); }, {"BA", "a central letter", "end", "symmetric"}));
  for (const placement where : placements) {
    BOOST_TEST(refuses([&] { thermostatted(word("BAOAB"), where); }, {"BAOAB", "no letters O"}));
  }
}

BOOST_AUTO_TEST_CASE(without_letters_o_the_conservative_part_is_left) {
  const numbers c{0.1, 0.2, 0.3, 0.4, 0.5};
  BOOST_TEST(conservative_part(word("BAOAB")).letters() == "BAAB");
  BOOST_TEST((conservative_part(word("BAOAB"), c) == numbers{0.1, 0.2, 0.4, 0.5}));
  BOOST_TEST((conservative_part(word("OBABO"), c) == numbers{0.2, 0.3, 0.4}));
  BOOST_TEST(conservative_part(word("OOAOB")).letters() == "AB");
  // A coefficient too many or too few must not be lost with the letters.
  const auto refused = [](const char* letters, std::size_t count, said words) {
    return refuses([&] { conservative_part(word(letters), numbers(count, 0.5)); }, words);
  };
  BOOST_TEST(refused("BAB", 4, {"BAB", "3 letters", "4 coefficients"}));
  BOOST_TEST(refused("OBABO", 4, {"OBABO", "5 letters", "4 coefficients"}));
  BOOST_TEST(refused("BAB", 0, {"0 coefficients"}));
  BOOST_TEST(!refused("OBABO", 5, {}));
}

BOOST_AUTO_TEST_CASE(letters_o_share_a_step_in_their_order_each_by_its_coefficient) {
  using intervals = std::vector<detail::noise_interval>;
  const auto of_letters = [](const numbers& c) {
    return detail::intervals_of_noise(std::string(c.size(), 'O'), c);
  };
  const auto shared = [](const detail::noise_intervals& found, int parts, const intervals& expected) {
    return found.parts == parts && found.of_letters == expected;
  };
  BOOST_TEST(shared(of_letters({1.0}), 1, {{0, 1}}));
  BOOST_TEST(shared(of_letters({0.5, 0.5}), 2, {{0, 1}, {1, 2}}));
  BOOST_TEST(!shared(of_letters({0.5, 0.5}), 2, {{1, 2}, {0, 1}}));
  BOOST_TEST(shared(of_letters({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}), 3, {{0, 1}, {1, 2}, {2, 3}}));
  BOOST_TEST(shared(of_letters({0.3333333333, 0.3333333333, 0.3333333334}), 3, {{0, 1}, {1, 2}, {2, 3}}));
  BOOST_TEST(shared(of_letters({0.25, 0.5, 0.25}), 4, {{0, 1}, {1, 3}, {3, 4}}));
  BOOST_TEST(shared(of_letters({0.5, 1.0 / 3.0, 1.0 / 6.0}), 6, {{0, 3}, {3, 5}, {5, 6}}));
  BOOST_TEST(shared(of_letters({59.0 / 60.0, 1.0 / 60.0}), 60, {{0, 59}, {59, 60}}));
  BOOST_TEST(shared(of_letters({0.1, 0.9}), 10, {{0, 1}, {1, 10}}));  // ten times .1 is 1 to rounding
  BOOST_TEST(shared(of_letters({0.0, 1.0}), 1, {{0, 0}, {0, 1}}));    // one that does nothing
  BOOST_TEST(shared(of_letters({0.5, 0.5}).in_parts(6), 6, {{0, 3}, {3, 6}}));
  const auto of_word = detail::intervals_of_noise(obabo().letters(), obabo().coefficients());
  BOOST_TEST(shared(of_word, 2, {{0, 1}, {1, 2}}));
  BOOST_TEST(
      shared(detail::intervals_of_noise(verlet().letters(), verlet().coefficients()).in_parts(6), 6, {}));

  const auto refused = [&](const numbers& c, said words) { return refuses([&] { of_letters(c); }, words); };
  BOOST_TEST(refused({0.5}, {"letters O of O", "cover one step", "got 0.5"}));
  BOOST_TEST(refused({0.5, 0.6}, {"OO", "cover one step", "got 1.1"}));
  BOOST_TEST(refused({0.5, 0.5 + 2e-9}, {"got 1.000000002"}));
  BOOST_TEST(!refused({0.5, 0.5 + 0.5e-9}, {}));  // as rounded to ten digits
  BOOST_TEST(refused({std::numeric_limits<double>::quiet_NaN()}, {"got nan"}));
  BOOST_TEST(refused({0.2928932188, 0.7071067812}, {"equal parts", "60 at most"}));
  BOOST_TEST(refused({60.0 / 61.0, 1.0 / 61.0}, {"equal parts", "60 at most"}));
  BOOST_TEST(refused({1.5, -0.5}, {"forward in time", "-0.5"}));
  BOOST_TEST(refused({-0.5, 1.5}, {"forward in time", "-0.5"}));
}

BOOST_AUTO_TEST_CASE(a_system_that_does_not_serve_a_letter_refuses_the_word) {
  const auto refused = [](const char* letters, const model& system, said words = {}) {
    const bool over_double = refuses([&] { require_served<model, double>(word(letters), system); }, words);
    const bool over_slopes =
        refuses([&] { require_served<model, detail::slopes>(word(letters), system); }, words);
    return over_double || over_slopes;
  };
  const with_quadratic_part split(two_masses(), Eigen::MatrixXd::Identity(2, 2));
  for (const char* letters : {"ABA", "BAB", "BAGAB", "AGA", "OABAO"})
    BOOST_TEST(!refused(letters, two_masses()));
  for (const char* letters : {"ABA", "OABAO"}) BOOST_TEST(!refused(letters, black_box()));
  for (const char* letters : {"RSR", "SRHRS", "ROSOR", "HR"}) {
    BOOST_TEST(!refused(letters, split));
    BOOST_TEST(!refused(letters, linear_chain::between_walls(3, 1.0)));
    BOOST_TEST(!refused(letters, in_bath(split, bath::of_sigma(1.0, 0.1))));
    BOOST_TEST(refused(letters, two_masses(),
                       {letters, "two_masses", "quadratic part", "soft_force", "with_quadratic_part"}));
    BOOST_TEST(refused(letters, black_box(), {letters, "quadratic part"}));
  }
  for (const char* letters : {"BAGAB", "GA", "BDB"}) {
    BOOST_TEST(refused(letters, relativistic(), {letters, "relativistic", "quadratic kinetic energy"}));
  }
  BOOST_TEST(!refused("ABABA", relativistic()));
  // The stepper refuses too; and it says that G has two coefficients.
  const auto stepped = [](const model& system, const char* letters, const numbers& c, said words) {
    return refuses([&] { stepper(system, word(letters), c, 0.1); }, words);
  };
  BOOST_TEST(stepped(two_masses(), "RSR", {0.5, 1.0, 0.5}, {"RSR", "quadratic part"}));
  BOOST_TEST(!stepped(split, "RSR", {0.5, 1.0, 0.5}, {}));
  BOOST_TEST(stepped(relativistic(), "AGA", {0.5, 1.0, 0.01, 0.5}, {"AGA", "quadratic kinetic"}));
  BOOST_TEST(stepped(two_masses(), "AGA", {0.5, 1.0, 0.5},
                     {"AGA", "3 letters and 4 coefficients", "3 coefficients"}));
}
