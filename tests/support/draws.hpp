// SPDX-License-Identifier: BSL-1.0
// Random parameters for property tests, all from one seed that is shown.
#pragma once

#include <boost/test/unit_test.hpp>

#include <cstdint>
#include <random>

#include "nysalt/system.hpp"

namespace nysalt::test {

/// Where to draw states of systems that are not at home at the origin.
struct around {
  Eigen::VectorXd q;
  Eigen::VectorXd p;
  double reach;
};

/// mt19937_64 gives the same bits everywhere; the standard's distributions do not, so we scale ourselves.
class draws {
 public:
  static constexpr std::uint64_t seed = 20260721;

  draws() : draws(seed) {}
  explicit draws(std::uint64_t from) : bits_(from) { show_seed(from); }

  std::uint64_t bits() { return bits_(); }

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11U) * 0x1p-53);
  }

  /// A state whose coordinates are uniform in -reach..reach.
  template <System S>
  phase_point<double, S::dimension> state(const S& system, double reach) {
    phase_point<double, S::dimension> x{detail::make_vector<double>(system),
                                        detail::make_vector<double>(system)};
    for (auto& q : x.q) q = uniform(-reach, reach);
    for (auto& p : x.p) p = uniform(-reach, reach);
    return x;
  }

  /// The same, off a centre.
  template <System S>
  phase_point<double, S::dimension> state(const S& system, const around& centre) {
    auto x = state(system, centre.reach);
    x.q += centre.q;
    x.p += centre.p;
    return x;
  }

 private:
  /// Whatever fails in this test case from now on tells the seed, also when the draws are gone.
  static void show_seed(std::uint64_t from) {
    namespace framework = boost::unit_test::framework;
    static boost::unit_test::test_unit_id shown_in = boost::unit_test::INV_TEST_UNIT_ID;
    const auto here = framework::current_test_case_id();
    if (here == shown_in) return;
    shown_in = here;
    framework::add_context(BOOST_TEST_LAZY_MSG("random parameters from seed " << from), true);
  }

  std::mt19937_64 bits_;
};

}  // namespace nysalt::test
