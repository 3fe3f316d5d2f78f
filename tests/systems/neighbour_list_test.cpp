// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 0.9 s at -O0, 0.1 s at -O1.
// Sums that know no order, and lists that hold for as long as they say.
#include "../../src/nysalt/systems/neighbour_list.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "../support/draws.hpp"

using namespace nysalt;
using namespace nysalt::detail;
using namespace nysalt::test;

namespace {

double sum_of(const std::vector<double>& x) {
  exact_sum sum;
  for (std::size_t n = 0; n < x.size(); n += pairs_at_a_time) {
    reals some{};
    for (std::size_t k = 0; k < pairs_at_a_time && n + k < x.size(); ++k) some[k] = x[n + k];
    sum.add(some);
  }
  return sum.total();
}

constexpr double side = 8.0;

/// Pairs of atoms that are nearer than that, by the list or by all pairs.
using pairs = std::set<std::pair<std::int64_t, std::int64_t>>;
double distance_of(const Eigen::VectorXd& q, std::int64_t i, std::int64_t j) {
  Eigen::Vector3d d = q.segment<3>(3 * i) - q.segment<3>(3 * j);
  for (double& along : d) along -= side * std::nearbyint(along / side);
  return d.norm();
}
pairs near(const Eigen::VectorXd& q, double reach) {
  pairs result;
  for (std::int64_t i = 0; i < q.size() / 3; ++i) {
    for (std::int64_t j = 0; j < q.size() / 3; ++j) {
      if (i != j && distance_of(q, i, j) < reach) result.insert({i, j});
    }
  }
  return result;
}
pairs listed(const neighbour_list& list, std::int64_t atoms) {
  pairs result;
  for (std::int64_t slot = 0; slot < atoms; ++slot) {
    for (const std::int32_t other : list.row(slot)) {
      if (other < atoms) {
        BOOST_TEST_REQUIRE(result.insert({list.atom(slot), list.atom(other)}).second);
      }
    }
  }
  return result;
}
bool has_all(const pairs& some, const pairs& wanted) {
  return std::includes(some.begin(), some.end(), wanted.begin(), wanted.end());
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_order_changes_a_bit_of_a_sum) {
  draws random;
  std::vector<double> x;
  for (int n = 0; n < 300; ++n) {  // from 2^-40 to 2^20, and ties: halves of 2^-19 and of 2^-60
    const double scale = std::ldexp(1.0, static_cast<int>(random.uniform(-40.0, 20.0)));
    x.push_back(random.uniform(-scale, scale));
    x.push_back(std::ldexp(std::floor(random.uniform(-9.0, 9.0)) + 0.5, n % 2 == 0 ? -19 : -60));
  }
  const double first = sum_of(x);
  long double expected = 0.0;
  for (const double summand : x) expected += summand;
  // 2^-61 each, one rounding, and 64 bits of what is compared with.
  const double allowed = 600.0 * 0x1p-61 + std::abs(first) * 0x1p-53 + 600.0 * 0x1p20 * 0x1p-64;
  BOOST_TEST(std::abs(static_cast<double>(first - expected)) <= allowed);
  const auto plain = [&] {
    double sum = 0.0;
    for (const double summand : x) sum += summand;
    return sum;
  };
  const double in_order = plain();
  bool order_matters_to_others = false;
  for (int n = 0; n < 200; ++n) {
    for (std::size_t k = x.size(); k-- > 1;) std::swap(x[k], x[random.bits() % (k + 1)]);
    BOOST_TEST_REQUIRE(sum_of(x) == first);
    order_matters_to_others = order_matters_to_others || plain() != in_order;
  }
  BOOST_TEST(order_matters_to_others);
}

BOOST_AUTO_TEST_CASE(a_list_holds_until_an_atom_has_moved_by_half_the_skin) {
  constexpr std::int64_t atoms = 300;
  constexpr double reach = 1.5;
  constexpr double skin = 0.4;
  draws random;
  Eigen::VectorXd q(3 * atoms);
  for (double& x : q) x = random.uniform(-2.0 * side, 3.0 * side);
  neighbour_list list(atoms, side, reach, skin, 1);
  BOOST_TEST(list.update(q));
  BOOST_TEST((listed(list, atoms) == near(q, reach + skin)));

  const auto moved_by = [&](double way) {
    Eigen::VectorXd result = q;
    for (std::int64_t i = 0; i < atoms; ++i) {
      const Eigen::Vector3d d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                              random.uniform(-1.0, 1.0));
      result.segment<3>(3 * i) += d.normalized() * way;
    }
    return result;
  };
  for (int n = 0; n < 10; ++n) {
    const Eigen::VectorXd little = moved_by(0.499 * skin);
    BOOST_TEST(list.update(little));
    BOOST_TEST(list.made() == 1);
    BOOST_TEST(has_all(listed(list, atoms), near(little, reach)));
  }
  // Without a look at how far atoms went, pairs would be missed.
  const Eigen::VectorXd far = moved_by(2.0 * skin);
  BOOST_TEST((list.take(far) == neighbour_list::state::outdated));
  BOOST_TEST(!has_all(listed(list, atoms), near(far, reach)));
  BOOST_TEST(list.update(far));
  BOOST_TEST(list.made() == 2);
  BOOST_TEST((listed(list, atoms) == near(far, reach + skin)));
  // By one atom, round the whole box.
  Eigen::VectorXd round = far;
  round[7] += side;
  BOOST_TEST(list.update(round));
  BOOST_TEST(list.made() == 3);
}
