// SPDX-License-Identifier: BSL-1.0
// The table of classical methods: what its rows are as types and as data.
#include "nysalt/methods/classical.hpp"

#include <boost/test/unit_test.hpp>

#include <set>
#include <string>
#include <string_view>

#include "../laws/models.hpp"
#include "nysalt/methods/classical_methods.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
struct any_letters {
  constexpr bool operator()(std::string_view) const { return true; }
};
}  // namespace

BOOST_AUTO_TEST_CASE(a_row_as_a_type_is_the_row_as_data) {
  std::size_t row = 0;
  for_each<rows<any_letters>>([&]<Method M>() {
    const tabulated as_type(M{});
    const tabulated data = as_data(classical_table[row++]);
    BOOST_TEST_CONTEXT(data.name()) {
      BOOST_TEST(as_type.name() == data.name());
      BOOST_TEST(as_type.letters().letters() == data.letters().letters());
      BOOST_TEST((as_type.coefficients() == data.coefficients()));
      BOOST_TEST(as_type.order == data.order);
      BOOST_TEST(as_type.symmetric == data.symmetric);
      BOOST_TEST(as_type.requires_quadratic_kinetic == data.requires_quadratic_kinetic);
    }
  });
  BOOST_TEST(row == std::size(classical_table));
}

BOOST_AUTO_TEST_CASE(names_are_unique_and_palindromes_are_symmetric) {
  std::set<std::string_view> names;
  for (const auto& row : classical_table) {
    BOOST_TEST(names.insert(row.name).second, row.name);
    BOOST_TEST(!row.source.empty(), row.name);
    const tabulated method = as_data(row);
    BOOST_TEST(is_palindrome(method.letters(), method.coefficients()) == row.symmetric, row.name);
  }
}

BOOST_AUTO_TEST_CASE(rivals_are_rows_without_a_bath_that_repeat_no_other) {
  std::set<std::string> names;
  for (const auto& method : nysalt::classical_methods()) names.insert(method.name());
  BOOST_TEST(names.contains("pefrl"));
  BOOST_TEST(names.contains("impulse"));
  BOOST_TEST(!names.contains("baoab"));
  BOOST_TEST(!names.contains("verlet_2x"));
}
