// SPDX-License-Identifier: BSL-1.0
// Lists of points hold copies, one after the other, and items are the points where they lie. Numbers in
// sentences are written as fmt writes them.
#include <cmath>
#include <random>
#include <string>

#include "nysalt/core.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/core/steps_in.hpp"
#include "nysalt/phase_point.hpp"

using namespace nysalt;

namespace {

using limits = std::numeric_limits<double>;
using dynamic_point = phase_point<double, Eigen::Dynamic>;
phase_point<double, 2> point(double number) { return {{number, number + 0.25}, {-number, number + 0.5}}; }
bool is_point(const auto& x, double number) { return x.q == point(number).q && x.p == point(number).p; }
phase_points three() { return std::vector{point(1.0), point(2.0), point(3.0)}; }
/// Whether the list holds points 1, 2, 3, 1, 2, 3, ...
bool repeats(const phase_points& points, std::size_t count) {
  bool all = points.size() == count;
  for (std::size_t i = 0; all && i < count; ++i) all = is_point(points[i], static_cast<double>(i % 3 + 1));
  return all;
}

/// As fmt writes it, and such that it is read back to the bit.
void require_same(double x) {
  const std::string written = sentence("{}", x);
  if (written != fmt::format("{}", x)) BOOST_ERROR(written + " is " + fmt::format("{}", x) + " for fmt");
  const double back = std::strtod(written.c_str(), nullptr);
  if (!std::isnan(x) && std::bit_cast<std::uint64_t>(back) != std::bit_cast<std::uint64_t>(x)) {
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

BOOST_AUTO_TEST_CASE(points_of_any_dimension_become_a_list_and_come_out_of_it) {
  const phase_points fixed = three();
  BOOST_TEST(repeats(fixed, 3));
  BOOST_TEST(fixed.dimension() == 2);
  BOOST_TEST(!fixed.empty());
  std::vector<dynamic_point> copies;
  for (const double number : {1.0, 2.0, 3.0}) copies.push_back({point(number).q, point(number).p});
  BOOST_TEST((phase_points(copies) == fixed));
  copies[2].p[1] += 1e-15;
  BOOST_TEST((phase_points(copies) != fixed));
  const phase_point<double, 2> second = fixed[1];
  dynamic_point also_second = fixed[1];
  BOOST_TEST((is_point(second, 2.0) && is_point(also_second, 2.0)));
  also_second.q[0] = 17.0;  // a copy
  BOOST_TEST(is_point(fixed[1], 2.0));
  BOOST_TEST((fixed[1].cast<dual<double, 1>>().q[1].value == 2.25));
  // q lies before p, and one point before the next.
  BOOST_TEST(fixed[0].p.data() == fixed[0].q.data() + 2);
  BOOST_TEST(fixed[2].p.data() == fixed[0].q.data() + 10);
  double number = 0.0;
  for (const auto& x : fixed) BOOST_TEST(is_point(x, number += 1.0));
  auto at = fixed.begin();
  at++;
  BOOST_TEST((is_point(*at, 2.0) && is_point(*++at, 3.0)));
}

BOOST_AUTO_TEST_CASE(what_is_written_to_an_item_is_in_the_list) {
  phase_points points = three();
  const phase_points before = points;
  points[1].q[0] = 9.0;
  BOOST_TEST(std::as_const(points)[1].q[0] == 9.0);
  BOOST_TEST((before == three() && before != points));  // copies are lists of their own
  points[1].p *= 2.0;
  BOOST_TEST(std::as_const(points)[1].p[1] == 5.0);
  points[0].p[1] = limits::quiet_NaN();
  points[2].q[0] = limits::infinity();
  for (const std::size_t i : {0U, 1U, 2U}) BOOST_TEST(is_finite(std::as_const(points)[i]) == (i == 1));
  for (auto x : points) x.q[1] = -1.0;
  for (const auto& x : std::as_const(points)) BOOST_TEST(x.q[1] == -1.0);
  points.set(2, point(8.0));
  points.set(0, std::as_const(points)[2]);
  BOOST_TEST((is_point(points[0], 8.0) && is_point(points[2], 8.0)));
  static_assert(!std::is_assignable_v<decltype((std::declval<const phase_points&>()[0].q[0])), double>);
  static_assert(std::is_assignable_v<decltype((std::declval<phase_points&>()[0].q[0])), double>);
  static_assert(!std::is_assignable_v<decltype(std::declval<const detail::vector_list&>()[0][0]), double>);
}

// Where a list takes points of its own it may move in memory.
BOOST_AUTO_TEST_CASE(points_are_added_behind_those_that_there_are) {
  phase_points points;
  points.push_back(point(1.0));
  points.push_back(dynamic_point{point(2.0).q, point(2.0).p});
  points.push_back(three()[2]);
  points.append(three());
  points.append(phase_points());
  BOOST_TEST(repeats(points, 6));
  for (int n = 0; n < 99; ++n) points.push_back(points[points.size() - 3]);
  BOOST_TEST(repeats(points, 105));
  points.append(points);
  BOOST_TEST(repeats(points, 210));
}

BOOST_AUTO_TEST_CASE(points_that_are_there_stay_when_the_number_changes) {
  phase_points points = three();
  points.resize(5);
  BOOST_TEST((points.size() == 5U && points.dimension() == 2));
  for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(is_point(points[i], static_cast<double>(i + 1)));
  points.resize(2);
  BOOST_TEST(repeats(points, 2));
  points.resize(4, 3);
  BOOST_TEST((points.dimension() == 3 && points[3].p.size() == 3));
  points.clear();
  BOOST_TEST((points.empty() && points.dimension() == 3));
  const phase_points none;
  BOOST_TEST(none.dimension() == 0);
  BOOST_TEST((none.empty() && none.begin() == none.end() && none != three()));
  BOOST_TEST((none == phase_points(std::vector<phase_point<double, 2>>()) && none == phase_points(0, 4)));
}

BOOST_AUTO_TEST_CASE(vectors_stand_one_after_the_other) {
  detail::vector_list vectors(2, 3);
  for (int i = 0; i < 2; ++i) vectors[static_cast<std::size_t>(i)].setConstant(i);
  BOOST_TEST(vectors[1].data() == vectors[0].data() + 3);
  vectors.push_back(vectors[0]);
  vectors.append(vectors);
  BOOST_TEST(vectors.size() == 6U);
  BOOST_TEST((vectors[2][1] == 0.0 && vectors[4][2] == 1.0));
  vectors.clear();
  BOOST_TEST((vectors.size() == 0U && vectors.begin() == vectors.end()));
}

BOOST_AUTO_TEST_CASE(pieces_of_a_sentence_come_in_order_and_numbers_are_cut_to_their_first_digits) {
  const std::string text = "text";
  BOOST_TEST(sentence("nothing") == "nothing");
  BOOST_TEST(sentence("{}{} of {}, {}; {}", 'a', "b", text, std::string_view(text), true) ==
             "ab of text, text; true");
  BOOST_TEST(sentence("{}", "{}") == "{}");  // a piece has no holes
  BOOST_TEST(sentence("{} x {}", 3U, -4L) == "3 x -4");
  BOOST_TEST(detail::in_digits(0.125, 2) == "0.12");
  BOOST_TEST(detail::in_digits(2.0 / 3.0, 6) == "0.666667");
  BOOST_TEST(detail::in_digits(1234567.0, 6) == "1.23457e+06");
  BOOST_TEST(detail::in_digits(100.0, 4) == "100");
  BOOST_TEST(detail::in_digits(0.005, 12) == "0.005");
  BOOST_TEST(detail::in_digits(-limits::infinity(), 6) == "-inf");
}

BOOST_AUTO_TEST_CASE(numbers_are_written_as_by_fmt) {
  require_same_at_ends<short>();
  require_same_at_ends<unsigned>();
  require_same_at_ends<std::int64_t>();
  require_same_at_ends<std::uint64_t>();
  std::vector<double> special{0.0, 1.0, 0.1, 1e15, 100.0, 1.0 / 3.0};
  special.insert(special.end(), {5e-324, 0x1p53, 1e22, 1e23, 123456789012345678.0});
  special.insert(special.end(), {limits::max(), limits::epsilon(), limits::infinity(), limits::quiet_NaN()});
  for (const double edge : {1e-4, 1e-5, 1e16, 1e17, limits::min()}) {  // where the form may change
    special.insert(special.end(), {edge, std::nextafter(edge, 0.0), std::nextafter(edge, 1e300)});
  }
  for (const double x : special) {
    require_same(x);
    require_same(-x);
  }
  std::mt19937_64 draw(1);
  for (int k = 0; k < 50000; ++k) {
    const auto any = std::bit_cast<double>(draw());  // of every exponent alike
    if (std::isfinite(any)) require_same(any);
    // The same digits where numbers are written without an exponent, or nearly.
    require_same(std::ldexp(static_cast<double>(draw() >> 11), -80 + static_cast<int>(draw() % 96)));
  }
  BOOST_TEST(std::to_string(0.1) != fmt::format("{}", 0.1));  // another form would be seen
}

// The horizon is N steps as a decimal number, and as a product of doubles, up to 2^40 steps.
BOOST_AUTO_TEST_CASE(steps_are_counted_to_rounding_however_many_there_are) {
  std::mt19937_64 random(1);
  const auto below = [&](std::uint64_t n) { return static_cast<std::int64_t>(random() % n); };
  int missed = 0;  // by a tolerance that does not grow with N
  for (int pair = 0; pair < 2000; ++pair) {
    const std::int64_t digits = 1 + below(999);
    const auto exponent = static_cast<int>(below(6));
    const std::int64_t steps = 1 + below(std::uint64_t{1} << (1 + below(40)));
    const double step = std::stod(std::to_string(digits) + "e-" + std::to_string(exponent));
    const double horizon = std::stod(std::to_string(digits * steps) + "e-" + std::to_string(exponent));
    const auto expected = static_cast<double>(steps);
    BOOST_TEST(detail::steps_in(horizon, step) == expected);
    BOOST_TEST(detail::steps_in(expected * step, step) == expected);
    BOOST_TEST(detail::steps_in((expected - 0.25) * step, step) == expected - 1.0);
    if (std::floor(horizon / step + 1e-9) != expected) ++missed;
  }
  BOOST_TEST(missed > 0);
}
