// SPDX-License-Identifier: BSL-1.0
// A local system: forces, kicks and energies in ranges are those of the whole system.
#include "nysalt/local_system.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <tuple>
#include <vector>

#include "../support/draws.hpp"
#include "../support/local_systems.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, Eigen::Dynamic>;

/// The values of sites first .. last - 1, images included, in columns; what is outside of these is not there.
template <class S>
std::vector<double> in_columns(const S& system, const Eigen::VectorXd& x, Eigen::Index first,
                               Eigen::Index last) {
  std::vector<double> result;
  for (Eigen::Index c = 0; c < S::components; ++c) {
    for (Eigen::Index i = first; i < last; ++i) {
      const Eigen::Index site = (i + system.sites()) % system.sites();
      result.push_back(x[S::components * site + c]);
    }
  }
  return result;
}

template <class S>
struct in_range {
  Eigen::Index first;
  Eigen::Index last;
  in_range(const S& system, Eigen::Index begin, Eigen::Index end)
      : first(begin - system.reach()), last(end + system.reach()) {
    if (system.is_periodic()) return;
    first = std::max<Eigen::Index>(first, 0);
    last = std::min(last, system.sites());
  }
  template <class T>
  site_columns<T> view(std::vector<std::remove_const_t<T>>& values) const {
    return {values.data(), first, last - first};
  }
};

/// How many coordinates of sites begin .. end - 1 have other bits in the range than in the whole system.
template <class S>
int other_bits(const S& system, const state& x, Eigen::Index begin, Eigen::Index end) {
  const in_range range(system, begin, end);
  auto q = in_columns(system, x.q, range.first, range.last);
  auto f = std::vector<double>(q.size(), 0.0);
  auto p = in_columns(system, x.p, range.first, range.last);
  const auto f_view = range.template view<double>(f);
  const auto p_view = range.template view<double>(p);
  system.template force_in_range<double>(range.template view<const double>(q), f_view, begin, end);
  Eigen::VectorXd whole(x.q.size());
  force<double>(system, x.q, whole);
  Eigen::VectorXd kicked = x.p;
  if constexpr (detail::HasKickInRange<S>) {
    system.template kick_in_range<double>(range.template view<const double>(q), p_view, 0.3, begin, end);
    if constexpr (HasKick<S, double>) {
      system.kick(x.q, kicked, 0.3);
    } else {
      for (Eigen::Index i = 0; i < kicked.size(); ++i) kicked[i] += whole[i] * 0.3;
    }
  }
  int result = 0;
  for (Eigen::Index i = begin; i < end; ++i) {
    for (Eigen::Index c = 0; c < S::components; ++c) {
      result += f_view(c, i) != whole[S::components * i + c];
      result += p_view(c, i) != kicked[S::components * i + c];
    }
  }
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(forces_and_kicks_in_ranges_have_the_bits_of_the_whole_system) {
  for_each_local_system([](const auto& system) {
    BOOST_TEST_CONTEXT(describe(system)) {
      draws random;
      const state x = random.state(system, 0.5);
      const Eigen::Index row = row_of(system);
      const Eigen::Index rows = system.sites() / row;
      for (Eigen::Index begin = 0; begin < rows; ++begin) {
        for (Eigen::Index end = begin; end <= rows; ++end) {
          if (other_bits(system, x, begin * row, end * row) > 0) {
            BOOST_ERROR("rows " << begin << " to " << end << " have other bits");
          }
        }
      }
    }
  });
}

BOOST_AUTO_TEST_CASE(energies_of_ranges_add_up_to_the_potential) {
  for_each_local_system([](const auto& system) {
    using S = std::decay_t<decltype(system)>;
    if constexpr (detail::HasPotentialInRange<S>) {
      BOOST_TEST_CONTEXT(describe(system)) {
        draws random;
        const state x = random.state(system, 0.5);
        const Eigen::Index row = row_of(system);
        const double whole = system.potential(x.q);
        double sum = 0.0;
        for (Eigen::Index begin = 0; begin < system.sites(); begin += row) {
          const in_range range(system, begin, begin + row);
          auto q = in_columns(system, x.q, range.first, range.last);
          sum += system.template potential_in_range<double>(range.template view<const double>(q), begin,
                                                            begin + row);
        }
        // Sums of n terms in two orders differ by n eps of their absolute values, here all about the sum
        // itself.
        const double n = static_cast<double>(4 * system.size());
        BOOST_TEST(std::abs(sum - whole) <= n * eps * absolute_potential(system, x.q));
      }
    }
  });
}

BOOST_AUTO_TEST_CASE(a_force_that_knows_where_a_range_begins_is_seen) {
  const deaf_to_the_left system(9);
  draws random;
  BOOST_TEST(other_bits(system, random.state(system, 0.5), 3, 6) > 0);
}

namespace {
/// A chain of another force, which inherits the ranges of the old one.
struct stronger : fpu_chain<> {
  using fpu_chain<>::fpu_chain;
  template <class T>
  void force(const vector<T, Eigen::Dynamic>& q, vector<T, Eigen::Dynamic>& f) const {
    fpu_chain<>::force(q, f);
    for (auto& entry : f) entry = entry * 2.0;
  }
};
static_assert(LocalSystem<fpu_chain<>> && LocalSystem<phi4_chain<>> && LocalSystem<phi4_lattice>);
static_assert(LocalSystem<far_springs> && !detail::HasKickInRange<far_springs>);
static_assert(!LocalSystem<stronger>);
static_assert(LocalSystem<deaf_to_the_left> && !detail::HasKickInRange<deaf_to_the_left>);
}  // namespace
