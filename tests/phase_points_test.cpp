// SPDX-License-Identifier: BSL-1.0
// A list of points holds copies, one after the other; its items are the points where they lie.
#include "nysalt/phase_points.hpp"

#include <boost/test/unit_test.hpp>

#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/scalars/dual.hpp"

using namespace nysalt;

namespace {

phase_point<double, 2> point(double number) { return {{number, number + 0.25}, {-number, number + 0.5}}; }
using dynamic_point = phase_point<double, Eigen::Dynamic>;

bool is_point(const auto& x, double number) { return x.q == point(number).q && x.p == point(number).p; }

phase_points three() { return std::vector{point(1.0), point(2.0), point(3.0)}; }

}  // namespace

BOOST_AUTO_TEST_CASE(points_of_any_dimension_become_a_list_and_come_out_of_it) {
  const phase_points fixed = three();
  BOOST_REQUIRE(fixed.size() == 3U);
  BOOST_TEST(fixed.dimension() == 2);
  BOOST_TEST(!fixed.empty());
  for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(is_point(fixed[i], static_cast<double>(i + 1)));
  std::vector<dynamic_point> copies;
  for (const double number : {1.0, 2.0, 3.0}) copies.push_back({point(number).q, point(number).p});
  BOOST_TEST((phase_points(copies) == fixed));
  copies[2].p[1] += 1e-15;
  BOOST_TEST((phase_points(copies) != fixed));
  const phase_point<double, 2> second = fixed[1];
  const dynamic_point also_second = fixed[1];
  BOOST_TEST(is_point(second, 2.0));
  BOOST_TEST(is_point(also_second, 2.0));
  const auto lifted = fixed[1].cast<dual<double, 1>>();
  BOOST_TEST(lifted.q[1].value == 2.25);
  BOOST_TEST(lifted.q[1].derivative[0] == 0.0);
  BOOST_TEST(fixed[1].size() == 2);
}

BOOST_AUTO_TEST_CASE(a_point_that_came_out_is_a_copy) {
  phase_points points = three();
  dynamic_point copy = points[0];
  copy.q[0] = 17.0;
  BOOST_TEST(is_point(points[0], 1.0));
}

BOOST_AUTO_TEST_CASE(q_lies_before_p_and_one_point_before_the_next) {
  const phase_points points = three();
  BOOST_TEST(points[0].p.data() == points[0].q.data() + 2);
  BOOST_TEST(points[1].q.data() == points[0].q.data() + 4);
  BOOST_TEST(points[2].p.data() == points[0].q.data() + 10);
}

BOOST_AUTO_TEST_CASE(what_is_written_to_an_item_is_in_the_list) {
  phase_points points = three();
  points[1].q[0] = 9.0;
  BOOST_TEST(std::as_const(points)[1].q[0] == 9.0);
  points[1].p *= 2.0;
  BOOST_TEST(std::as_const(points)[1].p[1] == 5.0);
  for (auto x : points) x.q[1] = -1.0;
  for (const auto& x : std::as_const(points)) BOOST_TEST(x.q[1] == -1.0);
  points.set(2, point(8.0));
  BOOST_TEST(is_point(points[2], 8.0));
  points.set(0, std::as_const(points)[2]);
  BOOST_TEST(is_point(points[0], 8.0));
  BOOST_TEST(points[1].q[0] == 9.0);
}

BOOST_AUTO_TEST_CASE(an_item_of_a_constant_list_cannot_be_written) {
  using constant = std::remove_reference_t<decltype(std::declval<const phase_points&>()[0].q[0])>;
  using changeable = std::remove_reference_t<decltype(std::declval<phase_points&>()[0].q[0])>;
  static_assert(!std::is_assignable_v<decltype((std::declval<const phase_points&>()[0].q[0])), double>);
  static_assert(std::is_assignable_v<decltype((std::declval<phase_points&>()[0].q[0])), double>);
  static_assert(std::is_const_v<constant> || !std::is_reference_v<constant>);
  static_assert(!std::is_const_v<changeable>);
  using item = decltype(std::declval<const vector_list&>()[0][0]);
  static_assert(!std::is_assignable_v<item, double>);
}

BOOST_AUTO_TEST_CASE(copies_of_a_list_are_lists_of_their_own) {
  const phase_points points = three();
  phase_points other = points;
  BOOST_TEST((other == points));
  other[0].q[0] = 4.0;
  BOOST_TEST(points[0].q[0] == 1.0);
  BOOST_TEST((other != points));
}

BOOST_AUTO_TEST_CASE(points_are_added_behind_those_that_there_are) {
  phase_points points;
  points.push_back(point(1.0));
  points.push_back(dynamic_point{point(2.0).q, point(2.0).p});
  points.push_back(three()[2]);
  BOOST_TEST((points == three()));
  points.append(three());
  BOOST_REQUIRE(points.size() == 6U);
  for (std::size_t i = 0; i < 6; ++i) BOOST_TEST(is_point(points[i], static_cast<double>(i % 3 + 1)));
  points.append(phase_points());
  BOOST_TEST(points.size() == 6U);
  phase_points none;
  none.append(three());
  BOOST_TEST((none == three()));
}

// Where a list is its own source it may move in memory.
BOOST_AUTO_TEST_CASE(a_list_takes_points_of_its_own) {
  phase_points points = three();
  for (int n = 0; n < 100; ++n) points.push_back(points[points.size() - 3]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    BOOST_TEST(is_point(points[i], static_cast<double>(i % 3 + 1)));
  }
  points = three();
  for (int n = 0; n < 6; ++n) points.append(points);
  BOOST_REQUIRE(points.size() == 192U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    BOOST_TEST(is_point(points[i], static_cast<double>(i % 3 + 1)));
  }
  vector_list vectors;
  vectors.push_back(Eigen::Vector2d(1.0, 2.0));
  for (int n = 0; n < 20; ++n) vectors.push_back(vectors[0]);
  vectors.append(vectors);
  for (const auto& x : std::as_const(vectors)) BOOST_TEST((x == Eigen::Vector2d(1.0, 2.0)));
}

BOOST_AUTO_TEST_CASE(points_that_are_there_stay_when_the_number_changes) {
  phase_points points = three();
  points.resize(5);
  BOOST_TEST(points.size() == 5U);
  BOOST_TEST(points.dimension() == 2);
  for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(is_point(points[i], static_cast<double>(i + 1)));
  points.resize(2);
  BOOST_TEST(points.size() == 2U);
  BOOST_TEST(is_point(points[1], 2.0));
  points.resize(4, 3);
  BOOST_TEST(points.dimension() == 3);
  BOOST_TEST(points[3].p.size() == 3);
  points.clear();
  BOOST_TEST(points.empty());
  BOOST_TEST(points.dimension() == 3);
}

BOOST_AUTO_TEST_CASE(an_empty_list_has_nothing) {
  const phase_points none;
  BOOST_TEST(none.empty());
  BOOST_TEST(none.size() == 0U);
  BOOST_TEST(none.dimension() == 0);
  BOOST_TEST((none.begin() == none.end()));
  BOOST_TEST((none == phase_points(std::vector<phase_point<double, 2>>())));
  BOOST_TEST((none == phase_points(0, 4)));
  BOOST_TEST((none != three()));
  const vector_list vectors;
  BOOST_TEST(vectors.size() == 0U);
  BOOST_TEST((vectors.begin() == vectors.end()));
}

BOOST_AUTO_TEST_CASE(a_list_is_gone_through_in_order) {
  double number = 0.0;
  for (const auto& x : three()) BOOST_TEST(is_point(x, number += 1.0));
  BOOST_TEST(number == 3.0);
  phase_points points = three();
  auto at = points.begin();
  at++;
  BOOST_TEST(is_point(*at, 2.0));
  BOOST_TEST(is_point(*++at, 3.0));
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_is_seen) {
  phase_points points = three();
  BOOST_TEST(is_finite(points[1]));
  points[1].p[0] = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(!is_finite(points[1]));
  BOOST_TEST(!is_finite(std::as_const(points)[1]));
  points[2].q[1] = std::numeric_limits<double>::infinity();
  BOOST_TEST(!is_finite(points[2]));
  BOOST_TEST(is_finite(points[0]));
}

BOOST_AUTO_TEST_CASE(vectors_stand_one_after_the_other) {
  vector_list vectors(2, 3);
  vectors[0] = Eigen::Vector3d(1.0, 2.0, 3.0);
  vectors[1] = Eigen::Vector3d(4.0, 5.0, 6.0);
  BOOST_TEST(vectors[1].data() == vectors[0].data() + 3);
  vectors.push_back(Eigen::Vector3d(7.0, 8.0, 9.0));
  BOOST_TEST(vectors.size() == 3U);
  vector_list twice = vectors;
  twice.append(vectors);
  BOOST_TEST(twice.size() == 6U);
  BOOST_TEST(twice[4][2] == 6.0);
  twice.clear();
  BOOST_TEST(twice.size() == 0U);
}
