// expect: nysalt: frequency_bands is not of the form `std::vector<nysalt::frequency_band> frequency_bands()
//   const`
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"

struct misdeclared {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
#ifdef NYSALT_CONTROL
  std::vector<nysalt::frequency_band> frequency_bands() const { return {{1.0, 1.0}}; }
#else
  // [mistake]
  std::vector<double> frequency_bands() const { return {1.0}; }
  // [/mistake]
#endif
};

int main() {
  const misdeclared system;
  nysalt::make_stepper(system, nysalt::verlet(), 0.1);
}
