// SPDX-License-Identifier: BSL-1.0
// What is left of a word and its coefficients without the letters O.
#include "nysalt/detail/conservative_part.hpp"

#include <boost/test/unit_test.hpp>

#include "nysalt/methods/classical.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
using O = ornstein_uhlenbeck;
}

static_assert(std::is_same_v<conservative_word<baoab::word>, word<kick, drift, drift, kick>>);
static_assert(std::is_same_v<conservative_word<obabo::word>, word<kick, drift, kick>>);
static_assert(std::is_same_v<conservative_word<word<O, O, drift, O, kick>>, word<drift, kick>>);
static_assert(std::is_same_v<conservative_word<word<drift, kick>>, word<drift, kick>>);
static_assert(std::is_same_v<conservative_word<run_time_word>, run_time_word>);

BOOST_AUTO_TEST_CASE(letters_and_coefficients_are_kept_in_their_order) {
  const std::array c{0.1, 0.2, 0.3, 0.4, 0.5};
  BOOST_TEST((conservative_part(baoab::word{}, c) == std::array{0.1, 0.2, 0.4, 0.5}));
  BOOST_TEST((conservative_part(obabo::word{}, c) == std::array{0.2, 0.3, 0.4}));
  BOOST_TEST((conservative_part(word<drift, kick>{}, std::array{0.1, 0.2}) == std::array{0.1, 0.2}));
}

BOOST_AUTO_TEST_CASE(also_as_data) {
  const std::vector<double> c{0.1, 0.2, 0.3, 0.4, 0.5};
  BOOST_TEST(conservative_part(run_time_word("BAOAB")).letters() == "BAAB");
  BOOST_TEST(conservative_part(run_time_word("OBABO")).letters() == "BAB");
  BOOST_TEST((conservative_part(run_time_word("BAOAB"), c) == std::vector{0.1, 0.2, 0.4, 0.5}));
  BOOST_TEST((conservative_part(run_time_word("OBABO"), c) == std::vector{0.2, 0.3, 0.4}));
}

// A coefficient too many or too few must not be lost with the letters.
BOOST_AUTO_TEST_CASE(coefficients_that_do_not_fit_are_refused) {
  const auto of = [](const char* letters, std::size_t count) {
    return [=] { conservative_part(run_time_word(letters), std::vector<double>(count, 0.5)); };
  };
  using wrong = std::invalid_argument;
  BOOST_TEST(refuses<wrong>(of("BAB", 4), {"BAB", "3 letters", "4 coefficients"}));
  BOOST_TEST(refuses<wrong>(of("OBABO", 4), {"OBABO", "5 letters", "4 coefficients"}));
  BOOST_TEST(refuses<wrong>(of("BAB", 0), {"0 coefficients"}));
  BOOST_TEST(!refuses<wrong>(of("OBABO", 5), {}));
}
