// SPDX-License-Identifier: BSL-1.0

#include "nysalt/ensembles/distributions.hpp"

#include <fmt/format.h>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "nysalt/core/fingerprint.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

thermal_positions::thermal_positions(const model& system, std::vector<Eigen::VectorXd> positions,
                                     double temperature) {
  if (!(temperature > 0.0) || !std::isfinite(temperature)) {
    throw std::invalid_argument(
        fmt::format("thermal_positions: kT must be positive and finite, got {}", temperature));
  }
  if (positions.empty()) throw std::invalid_argument("thermal_positions: there must be a position, got none");
  for (std::size_t n = 0; n < positions.size(); ++n) {
    if (positions[n].size() == system.size() && positions[n].allFinite()) continue;
    throw std::invalid_argument(
        fmt::format("thermal_positions: position {} must be {} finite numbers", n + 1, system.size()));
  }
  for (Eigen::Index i = 0; i < system.size(); ++i) {
    deviations_.push_back(std::sqrt(1.0 / system.inverse_mass(i) * temperature));
  }
  detail::fingerprint sum;
  for (const auto& q : positions) sum.add_all(q);
  description_ = fmt::format("thermal_positions({} positions, temperature={}, fingerprint={})",
                             positions.size(), detail::in_digits(temperature, 6), sum.text());
  positions_ = std::make_shared<const std::vector<Eigen::VectorXd>>(std::move(positions));
}

phase_point<double, Eigen::Dynamic> thermal_positions::operator()(std::uint64_t seed, std::uint64_t n) const {
  const auto size = static_cast<Eigen::Index>(deviations_.size());
  Eigen::VectorXd normals(size + 1);
  standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normals);
  phase_point<double, Eigen::Dynamic> x{
      (*positions_)[detail::index_by_normal(normals[size], positions_->size())], Eigen::VectorXd(size)};
  for (Eigen::Index i = 0; i < size; ++i) x.p[i] = normals[i] * deviations_[static_cast<std::size_t>(i)];
  return x;
}

namespace detail {

fpu_starts::fpu_starts(Eigen::Index pairs, double omega, double spread, const soft_motion& soft)
    : pairs_(pairs), omega_(omega), spread_(spread), soft_(soft) {
  const bool finite =
      std::isfinite(spread) && std::isfinite(soft.displacement) && std::isfinite(soft.velocity);
  if (spread >= 0.0 && finite) return;
  throw std::invalid_argument(
      fmt::format("fpu_law: the spread must be finite and not negative, and the soft motion finite, got {}, "
                  "{} and {}",
                  spread, soft.displacement, soft.velocity));
}

phase_point<double, Eigen::Dynamic> fpu_starts::start(std::uint64_t seed, std::uint64_t n) const {
  phase_point<double, Eigen::Dynamic> start{Eigen::VectorXd(2 * pairs_), Eigen::VectorXd(2 * pairs_)};
  Eigen::VectorXd normals(2 * pairs_);
  standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normals);
  const double half = std::sqrt(0.5);
  for (Eigen::Index i = 0; i < pairs_; ++i) {
    const double x1 = (1.0 + spread_ * normals[2 * i]) / omega_;
    const double y1 = 1.0 + spread_ * normals[2 * i + 1] / omega_;
    start.q[2 * i] = (soft_.displacement - x1) * half;
    start.q[2 * i + 1] = (soft_.displacement + x1) * half;
    start.p[2 * i] = (soft_.velocity - y1) * half;
    start.p[2 * i + 1] = (soft_.velocity + y1) * half;
  }
  return start;
}

std::string fpu_starts::description() const {
  std::string text = fmt::format("fpu_law(omega={}", omega_);
  if (spread_ != 1.0) text += fmt::format(", spread={}", spread_);
  if (soft_.displacement != 1.0 || soft_.velocity != 1.0) {
    text += fmt::format(", x_0={}, y_0={}", soft_.displacement, soft_.velocity);
  }
  return text + ")";
}

namespace {

double product(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}
void remove(const Eigen::VectorXd& unit, Eigen::VectorXd& from) {
  const double along = product(unit, from);
  for (Eigen::Index i = 0; i < from.size(); ++i) from[i] -= along * unit[i];
}

}  // namespace

/// By Gram and Schmidt. Atoms on a line have a turn less.
struck_cluster::struck_cluster(Eigen::VectorXd rest, Eigen::Index space, double temperature)
    : rest_(std::move(rest)), temperature_(temperature) {
  if (!(temperature >= 0.0) || !std::isfinite(temperature)) {
    throw std::invalid_argument(fmt::format(
        "lennard_jones_law: the temperature must be finite and not negative, got {}", temperature));
  }
  const auto add = [&](Eigen::VectorXd motion) {
    for (const Eigen::VectorXd& other : rigid_motions_) remove(other, motion);
    const double length = std::sqrt(product(motion, motion));
    constexpr double rounding = 1e-9;
    if (length > rounding) rigid_motions_.push_back(motion / length);
  };
  for (Eigen::Index axis = 0; axis < space; ++axis) {
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(rest_.size());
    for (Eigen::Index i = axis; i < shift.size(); i += space) shift[i] = 1.0;
    add(shift);
  }
  for (Eigen::Index a = 0; a < space; ++a) {
    for (Eigen::Index b = a + 1; b < space; ++b) {
      Eigen::VectorXd turn = Eigen::VectorXd::Zero(rest_.size());
      for (Eigen::Index i = 0; i < turn.size(); i += space) {
        turn[i + a] = -rest_[i + b];
        turn[i + b] = rest_[i + a];
      }
      add(turn);
    }
  }
}

phase_point<double, Eigen::Dynamic> struck_cluster::start(std::uint64_t seed, std::uint64_t n) const {
  Eigen::VectorXd p(rest_.size());
  standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, p);
  for (Eigen::Index i = 0; i < p.size(); ++i) p[i] *= std::sqrt(temperature_);
  for (const auto& motion : rigid_motions_) remove(motion, p);
  return {rest_, p};
}

std::string struck_cluster::description() const {
  return fmt::format("lennard_jones_law(temperature={})", in_digits(temperature_, 6));
}

}  // namespace detail

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

lennard_jones_liquid_law::lennard_jones_liquid_law(const lennard_jones_liquid& system, double temperature)
    : atoms_(system.atoms()), side_(system.side()), temperature_(temperature) {
  if (!(temperature >= 0.0) || !std::isfinite(temperature)) {
    throw std::invalid_argument(fmt::format(
        "lennard_jones_liquid_law: the temperature must be finite and not negative, got {}", temperature));
  }
  while (4 * cells_ * cells_ * cells_ < atoms_) ++cells_;
}

phase_point<double, Eigen::Dynamic> lennard_jones_liquid_law::operator()(std::uint64_t seed,
                                                                         std::uint64_t n) const {
  phase_point<double, Eigen::Dynamic> start{Eigen::VectorXd(3 * atoms_), Eigen::VectorXd(3 * atoms_)};
  const Eigen::Index sites = 4 * cells_ * cells_ * cells_;
  for (Eigen::Index i = 0; i < atoms_; ++i) {
    // The largest site with site atoms <= i sites, in two parts, as the product of both may not fit.
    const Eigen::Index site = i * (sites / atoms_) + i * (sites % atoms_) / atoms_;
    for (Eigen::Index axis = 0; axis < 3; ++axis) start.q[3 * i + axis] = site_on_axis(site, axis);
  }
  standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, start.p);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double sum = 0.0;
    for (Eigen::Index i = axis; i < start.p.size(); i += 3) sum += start.p[i];
    const double mean = sum / static_cast<double>(atoms_);
    for (Eigen::Index i = axis; i < start.p.size(); i += 3) {
      start.p[i] = (start.p[i] - mean) * std::sqrt(temperature_);
    }
  }
  return start;
}

std::string lennard_jones_liquid_law::description() const {
  return fmt::format("lennard_jones_liquid_law(temperature={})", detail::in_digits(temperature_, 6));
}

/// Four sites a cell: a corner, and the middles of the three faces that meet there.
double lennard_jones_liquid_law::site_on_axis(Eigen::Index site, Eigen::Index axis) const {
  const Eigen::Index of_cell = site % 4;
  const Eigen::Index cell = site / 4;
  const Eigen::Index place = axis == 0   ? cell % cells_
                             : axis == 1 ? cell / cells_ % cells_
                                         : cell / (cells_ * cells_);
  const bool is_moved = of_cell != 0 && of_cell != axis + 1;
  return side_ * (static_cast<double>(place) + (is_moved ? 0.5 : 0.0)) / static_cast<double>(cells_);
}

}  // namespace nysalt
