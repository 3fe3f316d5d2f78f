// SPDX-License-Identifier: BSL-1.0
// A sentence's numbers, against fmt's.
#include "nysalt/detail/sentence.hpp"

#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <vector>

using namespace nysalt;

namespace {

/// As fmt writes it, and such that it is read back to the bit.
void require_same(double x) {
  const std::string written = sentence("{}", x);
  if (written != fmt::format("{}", x)) BOOST_ERROR(written + " is " + fmt::format("{}", x) + " for fmt");
  if (!std::isnan(x) && std::bit_cast<std::uint64_t>(std::strtod(written.c_str(), nullptr)) !=
                            std::bit_cast<std::uint64_t>(x)) {
    BOOST_ERROR(written + " is read back as another number");
  }
}

template <class I>
void require_same_at_ends() {
  for (const I x : {std::numeric_limits<I>::min(), std::numeric_limits<I>::max(), I{0}, I{1}}) {
    BOOST_TEST(sentence("{}", x) == fmt::format("{}", x));
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(pieces_come_in_order) {
  const std::string text = "text";
  const std::string_view view = text;
  BOOST_TEST(sentence("nothing") == "nothing");
  BOOST_TEST(sentence("{}{} of {}, {}; {}", 'a', "b", text, view, true) == "ab of text, text; true");
  BOOST_TEST(sentence("{}", "{}") == "{}");  // a piece has no holes
  BOOST_TEST(sentence("{} x {}", 3U, -4L) == "3 x -4");
}

BOOST_AUTO_TEST_CASE(integers_are_written_as_by_fmt) {
  require_same_at_ends<short>();
  require_same_at_ends<int>();
  require_same_at_ends<unsigned>();
  require_same_at_ends<std::int64_t>();
  require_same_at_ends<std::uint64_t>();
}

BOOST_AUTO_TEST_CASE(doubles_are_written_as_by_fmt) {
  using limits = std::numeric_limits<double>;
  std::vector<double> special{
      0.0,    1.0,           0.1,           1.0 / 3.0,         1e15,   123456789012345678.0,
      5e-324, limits::min(), limits::max(), limits::epsilon(), 0x1p53, 1e22,
      1e23,   100.0};
  for (const double edge : {1e-4, 1e-5, 1e16, 1e17, limits::min()}) {  // where the form may change
    special.insert(special.end(), {edge, std::nextafter(edge, 0.0), std::nextafter(edge, 1e300)});
  }
  for (const double x : special) {
    require_same(x);
    require_same(-x);
  }
  for (const double x : {limits::infinity(), limits::quiet_NaN()}) {
    BOOST_TEST(sentence("{}", x) == fmt::format("{}", x));
    BOOST_TEST(sentence("{}", -x) == fmt::format("{}", -x));
  }
  std::mt19937_64 draw(1);
  for (int k = 0; k < 200000; ++k) {
    const auto any = std::bit_cast<double>(draw());  // of every exponent alike
    if (std::isfinite(any)) require_same(any);
    // The same digits where numbers are written without an exponent, or nearly.
    const double near_one =
        std::ldexp(static_cast<double>(draw() >> 11), -80 + static_cast<int>(draw() % 96));
    require_same(near_one);
  }
}

BOOST_AUTO_TEST_CASE(another_form_would_be_seen) {
  BOOST_TEST(std::to_string(0.1) != fmt::format("{}", 0.1));
  BOOST_TEST(sentence("{}", 1e16) == "1e+16");
  BOOST_TEST(sentence("{}", 9999999999999998.0) == "9999999999999998");
  BOOST_TEST(sentence("{}", 1e-4) == "0.0001");
  BOOST_TEST(sentence("{}", std::nextafter(1e-4, 0.0)) == "9.999999999999999e-05");
}
