// SPDX-License-Identifier: BSL-1.0
// Where the letters O go in a word, as types and as data.
#include "nysalt/langevin.hpp"

#include <boost/test/unit_test.hpp>

#include <vector>

#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using A = drift;
using B = kick;
using O = ornstein_uhlenbeck;

using bab = word<B, A, B>;
using aba = word<A, B, A>;
using ababa = word<A, B, A, B, A>;
using ba = word<B, A>;

constexpr auto end = placement::end;
constexpr auto symmetric = placement::symmetric;
constexpr auto middle = placement::middle;

using numbers = std::vector<double>;

struct letters_and_coefficients {
  std::string letters;
  numbers coefficients;
  friend bool operator==(const letters_and_coefficients&, const letters_and_coefficients&) = default;
};

template <TypeLevelWord W, placement P>
letters_and_coefficients by_type(const std::array<double, W::length>& plain) {
  using T = thermostatted_word<W, P>;
  const auto c = thermostatted_coefficients<T>(P, plain);
  return {T::letters(), numbers(c.begin(), c.end())};
}

letters_and_coefficients as_data(const std::string& plain_letters, placement where, const numbers& plain) {
  const auto word = thermostatted(run_time_word(plain_letters), where);
  return {word.letters(), thermostatted_coefficients(run_time_word(plain_letters), where, plain)};
}

template <TypeLevelWord W, placement P>
void must_be(const std::string& letters, const numbers& coefficients,
             const std::array<double, W::length>& plain) {
  const letters_and_coefficients expected{letters, coefficients};
  const bool same = by_type<W, P>(plain) == expected;
  const bool same_as_data = as_data(W::letters(), P, numbers(plain.begin(), plain.end())) == expected;
  BOOST_TEST(same, letters);
  BOOST_TEST(same_as_data, letters << " as data");
}

}  // namespace

static_assert(std::is_same_v<thermostatted_word<ababa, end>, word<A, B, A, B, A, O>>);
static_assert(std::is_same_v<thermostatted_word<ababa, symmetric>, word<O, A, B, A, B, A, O>>);
static_assert(std::is_same_v<thermostatted_word<ababa, middle>, word<A, B, A, O, A, B, A>>);
static_assert(std::is_same_v<thermostatted_word<ba, end>, word<B, A, O>>);
static_assert(to_string(end) == "end" && to_string(symmetric) == "symmetric" &&
              to_string(middle) == "middle");
static_assert(placements == std::array{end, symmetric, middle});

BOOST_AUTO_TEST_CASE(letters_and_coefficients_are_where_they_belong) {
  must_be<bab, end>("BABO", {.25, 1., .75, 1.}, {.25, 1., .75});
  must_be<bab, symmetric>("OBABO", {.5, .25, 1., .75, .5}, {.25, 1., .75});
  must_be<bab, middle>("BAOAB", {.25, .5, 1., .5, .75}, {.25, 1., .75});
  must_be<aba, end>("ABAO", {.25, 1., .75, 1.}, {.25, 1., .75});
  must_be<aba, symmetric>("OABAO", {.5, .25, 1., .75, .5}, {.25, 1., .75});
  must_be<aba, middle>("ABOBA", {.25, .5, 1., .5, .75}, {.25, 1., .75});
  must_be<ababa, end>("ABABAO", {.1, .2, .5, .3, .4, 1.}, {.1, .2, .5, .3, .4});
  must_be<ababa, symmetric>("OABABAO", {.5, .1, .2, .5, .3, .4, .5}, {.1, .2, .5, .3, .4});
  must_be<ababa, middle>("ABAOABA", {.1, .2, .25, 1., .25, .3, .4}, {.1, .2, .5, .3, .4});
  must_be<ba, end>("BAO", {1., 1., 1.}, {1., 1.});
  must_be<ba, symmetric>("OBAO", {.5, 1., 1., .5}, {1., 1.});
}

BOOST_AUTO_TEST_CASE(a_word_of_one_letter_has_a_middle) {
  must_be<word<A>, middle>("AOA", {.5, 1., .5}, {1.});
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  using wrong = std::invalid_argument;
  BOOST_TEST(refuses<wrong>([] { thermostatted(run_time_word("BA"), middle); },
                            {"BA", "a central letter", "end", "symmetric"}));
  for (const placement where : placements) {
    BOOST_TEST(
        refuses<wrong>([&] { thermostatted(run_time_word("BAOAB"), where); }, {"BAOAB", "no letters O"}));
  }
  BOOST_TEST(!refuses<wrong>([] { thermostatted(run_time_word("BA"), end); }, {}));
}
