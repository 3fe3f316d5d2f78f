// SPDX-License-Identifier: BSL-1.0
// The coefficient with the least energy error on oscillators.
#include "nysalt/methods/s_aia.hpp"

#include <boost/math/tools/minima.hpp>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "nysalt/core/sentence.hpp"

namespace nysalt {

namespace {

/// rho = x^2 (constant + slope x)^2/(weight product), in which all but x depend on the coefficient; infinite
/// where a factor of the product is not positive.
struct closed_form {
  double constant;
  double slope;
};

double squared_over(double x, const closed_form& defect, double weight, double product) {
  if (!(product > 0.0)) return std::numeric_limits<double>::infinity();
  const double root = x * (defect.constant + defect.slope * x);
  return root * root / (weight * product);
}

closed_form defect_of_two_stages(double a) { return {4.0 * a * a - 6.0 * a + 1.0, 2.0 * a * a * (0.5 - a)}; }

/// From (B + C)/z and 1 - A^2 as polynomials in x, with a = (1 - 2b)/(4 - 12b): the square of
/// (1 - 2b)^2 x - 8 (1 - 3b), whose zero is where windows meet, divides both.
closed_form defect_of_three_stages(double b) {
  const double narrow = 1.0 - 2.0 * b;
  return {1.0 + b * (-16.0 + b * (76.0 + b * (-128.0 + b * 48.0))),
          b * b * (1.0 - 4.0 * b) * narrow * narrow};
}

}  // namespace

double detail::energy_error_of_two_stages(double a, double x) {
  const double rest = 0.5 - a;
  const double rotation = (2.0 - a * x) * (2.0 - rest * x) * (1.0 - a * rest * x);
  return squared_over(x, defect_of_two_stages(a), 8.0, rotation);
}

double detail::energy_error_of_three_stages(double b, double x) {
  const double third = 1.0 - 3.0 * b;
  const double fourth = 1.0 - 4.0 * b;
  const double half = (1.0 - 2.0 * b) * (1.0 - 2.0 * b);
  const double first = 4.0 * third - b * fourth * x;
  const double second = 4.0 * third - b * half * x;
  const double last = 16.0 * third * third - fourth * half * x;
  const bool is_stable = first > 0.0 && second > 0.0 && last > 0.0;
  return squared_over(x, defect_of_three_stages(b), 2.0, is_stable ? first * second * last : 0.0);
}

namespace {

/// Whether, up to x, the hump of rho is the worst. As a function of x rho rises from 0 to a hump, returns to
/// 0 where its defect does, and then rises to infinity.
bool hump_is_worst(const closed_form& defect, const auto& rho, double x) {
  const double zero = -defect.constant / defect.slope;
  if (zero >= x) return true;
  constexpr int half_the_digits = 26;  // of the place, so that the height has them all
  const auto below = [&](double part) { return -rho(part * zero); };
  const double hump = -boost::math::tools::brent_find_minima(below, 0.0, 1.0, half_the_digits).second;
  return hump > rho(x);
}

/// argmin_c max_{0 < x' <= x} rho(c, x') between the coefficient of no hump and that of equal steps. While c
/// grows from `low` the hump grows and the end falls; the worst is least where they are equal.
double least_worst(double low, double high, double x, const auto& defect_of, const auto& rho) {
  for (double c = std::midpoint(low, high); c != low && c != high; c = std::midpoint(low, high)) {
    const auto at = [&](double y) { return rho(c, y); };
    (hump_is_worst(defect_of(c), at, x) ? high : low) = c;
  }
  return low;
}

void require_z(const char* method, const char* stages, double highest_z, double most) {
  if (!(highest_z > 0.0) || !std::isfinite(highest_z)) {
    throw std::invalid_argument(
        sentence("{}: z = step * highest frequency must be positive and finite, got {}", method, highest_z));
  }
  if (highest_z >= most) {
    throw std::invalid_argument(
        sentence("{}: z = step * highest frequency must be one up to which a method of {} stages is stable, "
                 "got {}; take a smaller step, such that z < {}",
                 method, stages, highest_z, most));
  }
}

}  // namespace

namespace {

/// 4a^2 - 6a + 1 = 0 where z -> 0; 1/4 from z = sqrt 8 on, before which rho of any other a is infinite.
double coefficient_of_two_stages(double highest_z) {
  require_z("s_aia2", "two", highest_z, 4.0);
  const double x = highest_z * highest_z;
  if (x >= 8.0) return 0.25;
  const double without_hump = (3.0 - std::sqrt(5.0)) / 4.0;
  return least_worst(without_hump, 0.25, x, defect_of_two_stages, detail::energy_error_of_two_stages);
}

/// Where z -> 0 the root of 48b^4 - 128b^3 + 76b^2 - 16b + 1 below 1/6, b of predescu3
/// [predescu_and_others_2012, equation (26)]; 1/6 from z = sqrt 27 on, before which rho of any other b is
/// infinite.
double coefficient_of_three_stages(double highest_z) {
  require_z("s_aia3", "three", highest_z, 6.0);
  const double x = highest_z * highest_z;
  if (x >= 27.0) return 1.0 / 6.0;
  constexpr double without_hump = 0.10899142540342532;
  return least_worst(without_hump, 1.0 / 6.0, x, defect_of_three_stages,
                     detail::energy_error_of_three_stages);
}

std::vector<double> of_two_stages(double a) {
  const auto all = detail::palindrome<5>({a});
  return {all.begin(), all.end()};
}
std::vector<double> of_three_stages(double b) {
  const auto all = detail::palindrome<7>({b, (1.0 - 2.0 * b) / (4.0 - 12.0 * b)});
  return {all.begin(), all.end()};
}

}  // namespace

s_aia2::s_aia2(double highest_z)
    : method("s_aia2", letters_of_all, of_two_stages(coefficient_of_two_stages(highest_z)), promises),
      highest_z_(highest_z) {}

s_aia3::s_aia3(double highest_z)
    : method("s_aia3", letters_of_all, of_three_stages(coefficient_of_three_stages(highest_z)), promises),
      highest_z_(highest_z) {}

s_aia2 s_aia2_for(const model& system, double step) {
  return s_aia2(std::abs(step) * highest_frequency(system.frequency_bands()));
}

}  // namespace nysalt
