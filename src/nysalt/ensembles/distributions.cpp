// SPDX-License-Identifier: BSL-1.0

#include "nysalt/ensembles/distributions.hpp"

#include <fmt/format.h>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace nysalt {

kepler_law::kepler_law(double eccentricity) : eccentricity_(eccentricity) {
  if (eccentricity >= 0.0 && eccentricity < 1.0) return;
  throw std::invalid_argument(
      fmt::format("kepler_law: the eccentricity must be at least 0 and below 1, got {}", eccentricity));
}

phase_point<double, 2> kepler_law::operator()(std::uint64_t seed, std::uint64_t n) const {
  vector<double, 4> normals;  // two pairs, each of uniform direction
  standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normals);
  const double anomaly = eccentric_anomaly(std::atan2(normals[1], normals[0]));
  const double c = std::cos(anomaly);
  const double s = std::sin(anomaly);
  const double b = std::sqrt(1.0 - eccentricity_ * eccentricity_);
  const double rate = 1.0 / (1.0 - eccentricity_ * c);
  const vector<double, 2> axis = vector<double, 2>(normals[2], normals[3]).normalized();
  const auto turned = [&](double x, double y) {
    return vector<double, 2>(axis[0] * x - axis[1] * y, axis[1] * x + axis[0] * y);
  };
  return {turned(c - eccentricity_, b * s), turned(-s * rate, b * c * rate)};
}

std::string kepler_law::description() const {
  return fmt::format("kepler_law(eccentricity={})", eccentricity_);
}

double kepler_law::eccentric_anomaly(double mean) const {
  double anomaly = std::copysign(std::acos(-1.0), mean);
  for (double last = 2.0 * anomaly; std::abs(anomaly) < std::abs(last);) {
    last = anomaly;
    anomaly -=
        (anomaly - eccentricity_ * std::sin(anomaly) - mean) / (1.0 - eccentricity_ * std::cos(anomaly));
  }
  return anomaly;
}

}  // namespace nysalt
