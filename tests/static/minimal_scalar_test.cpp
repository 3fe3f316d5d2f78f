// SPDX-License-Identifier: BSL-1.0
// The least scalar: what docs/concepts shows, and that it does its work.
#include <boost/test/unit_test.hpp>

#include <cmath>

#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "quartic_well.hpp"

using namespace nysalt::test;

namespace {

// [scalar]
/// What does a step do where every operation rounds to 24 bits?
struct single {
  float value = 0.0F;

  single() = default;
  single(double x) : value(static_cast<float>(x)) {}

  friend single operator+(const single& a, const single& b) { return double(a.value + b.value); }
  friend single operator-(const single& a, const single& b) { return double(a.value - b.value); }
  friend single operator*(const single& a, const single& b) { return double(a.value * b.value); }
  friend single operator/(const single& a, const single& b) { return double(a.value / b.value); }
  friend single operator-(const single& a) { return double(-a.value); }
  single& operator+=(const single& b) { return *this = *this + b; }
  single& operator-=(const single& b) { return *this = *this - b; }
};
static_assert(nysalt::Scalar<single>);
// [/scalar]
static_assert(!nysalt::Scalar<float>);  // a double times it is a double
static_assert(nysalt::CoefficientOf<double, single> && !nysalt::CoefficientOf<single, double>);

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_in_single_precision_is_that_of_doubles_to_24_bits) {
  const quartic_well system;
  auto x = at(1.0, 0.5).cast<single>();
  auto y = at(1.0, 0.5);
  const auto stepper = nysalt::make_stepper(system, nysalt::verlet(), 0.1);
  stepper.step(x);
  stepper.step(y);
  const double error = std::abs(double(x.q[0].value) - y.q[0]) + std::abs(double(x.p[0].value) - y.p[0]);
  BOOST_TEST(error > 0.0);           // the digits are others
  BOOST_TEST(error < 16 * 0x1p-23);  // of eight operations on each coordinate, both below 1.1
}
