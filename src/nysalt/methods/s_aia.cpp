// SPDX-License-Identifier: BSL-1.0
// The coefficient with the least energy error on oscillators.
#include "nysalt/methods/s_aia.hpp"

#include <boost/math/tools/minima.hpp>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "nysalt/detail/sentence.hpp"

namespace nysalt {

double detail::energy_error_on_oscillator(double a, double x) {
  const double rest = 0.5 - a;
  const double defect = 2.0 * a * a * rest * x + 4.0 * a * a - 6.0 * a + 1.0;
  const double rotation = (2.0 - a * x) * (2.0 - rest * x) * (1.0 - a * rest * x);
  if (!(rotation > 0.0)) return std::numeric_limits<double>::infinity();
  return x * x * defect * defect / (8.0 * rotation);
}

namespace {

/// As a function of x rho rises from 0 to a hump, returns to 0 at `zero`, and then rises to infinity.
/// Whether, up to x, the hump is the worst.
bool hump_is_worst(double a, double x) {
  const double zero = -(4.0 * a * a - 6.0 * a + 1.0) / (2.0 * a * a * (0.5 - a));
  if (zero >= x) return true;
  constexpr int half_the_digits = 26;  // of the place, so that the height has them all
  const auto below = [&](double part) { return -detail::energy_error_on_oscillator(a, part * zero); };
  const double hump = -boost::math::tools::brent_find_minima(below, 0.0, 1.0, half_the_digits).second;
  return hump > detail::energy_error_on_oscillator(a, x);
}

/// argmin_a max_{0 < z <= highest_z} rho. While a grows from (3 - sqrt 5)/4, where there is no hump, the hump
/// grows and the end falls; the worst is least where they are equal.
double s_aia_coefficient(double highest_z) {
  const double x = highest_z * highest_z;
  double low = (3.0 - std::sqrt(5.0)) / 4.0;  // 4a^2 - 6a + 1 = 0: the best for z -> 0
  double high = 0.25;
  if (x >= 8.0) return high;  // for any other a, rho is infinite before z = sqrt 8
  for (double a = std::midpoint(low, high); a != low && a != high; a = std::midpoint(low, high)) {
    (hump_is_worst(a, x) ? high : low) = a;
  }
  return low;
}

}  // namespace

s_aia2::s_aia2(double highest_z) : highest_z_(highest_z) {
  if (!(highest_z > 0.0) || !std::isfinite(highest_z)) {
    throw std::invalid_argument(
        sentence("s_aia2: z = step * highest frequency must be positive and finite, got {}", highest_z));
  }
  if (highest_z >= 4.0) {
    throw std::invalid_argument(sentence(
        "s_aia2: no method of two stages is stable up to z = step * highest frequency = {}; take a smaller "
        "step, such that z < 4",
        highest_z));
  }
  coefficient_ = s_aia_coefficient(highest_z);
}

}  // namespace nysalt
