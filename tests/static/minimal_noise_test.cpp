// SPDX-License-Identifier: BSL-1.0
// The least bath and noise: what docs/concepts shows, and that they do their work.
#include <boost/test/unit_test.hpp>

#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "quartic_well.hpp"

using namespace nysalt::test;

namespace {

// [bath]
struct warm_well : quartic_well {
  nysalt::bath bath() const { return nysalt::bath::of_temperature(0.1, 1.0); }  // friction, kT
};
static_assert(nysalt::HasBath<warm_well>);
static_assert(nysalt::HasBath<nysalt::in_bath<quartic_well>>);  // the same, of any system
// [/bath]

// [noise]
/// The mirror image of another noise. Means over both paths of a pair err less than over two others.
struct antithetic {
  static constexpr bool is_memoryless = true;
  nysalt::counter_noise plain;

  template <class T, int N>
  void normals(const nysalt::noise_place& at, nysalt::vector<T, N>& xi) const {
    plain.normals(at, xi);
    for (T& x : xi) x = -x;
  }
  template <class T, int N>
  void halving(const nysalt::noise_place& at, nysalt::vector<T, N>& zeta) const {
    plain.halving(at, zeta);
    for (T& x : zeta) x = -x;
  }
};
static_assert(nysalt::NoiseSource<antithetic>);
// [/noise]

}  // namespace

BOOST_AUTO_TEST_CASE(mirrored_noise_makes_a_mirrored_path) {
  const warm_well system;
  const nysalt::counter_noise plain(1);
  const auto walk = [&](const auto& noise) {
    return nysalt::integrate(nysalt::make_stepper(system, nysalt::baoab(), 0.1, noise), at(0.0, 0.0), 100)
        .finish;
  };
  const auto x = walk(plain);
  const auto y = walk(antithetic{plain});
  BOOST_TEST(x.q[0] != 0.0);
  BOOST_TEST(x.q[0] == -y.q[0]);
  BOOST_TEST(x.p[0] == -y.p[0]);
}
