// SPDX-License-Identifier: BSL-1.0

#include "nysalt/losses/stationary_covariance.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "lyapunov.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/stepping/served_letters.hpp"

namespace nysalt {

namespace {

/// A mode of unit mass by itself, all of which is quadratic.
struct single_mode {
  static constexpr int dimension = 1;
  double omega;
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * (-omega * omega);
  }
  template <class T>
  void soft_force(const vector<T, 1>&, vector<T, 1>& f) const {
    f[0] = T(0.0);
  }
  normal_modes modes() const {
    return {Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Constant(1, omega)};
  }
};

/// The map of (x, y) by letters without O, as the stepper computes the map.
template <Scalar T>
detail::plane<T> map_of(const nysalt::word& turn, const T* c, double omega, double step) {
  const single_mode mode{omega};
  const stepper<single_mode, T> one(mode, turn, {c, c + turn.slots}, step);
  phase_point<T, 1> from_x{vector<T, 1>(T(1.0 / omega)), vector<T, 1>(T(0.0))};
  phase_point<T, 1> from_y{vector<T, 1>(T(0.0)), vector<T, 1>(T(1.0))};
  one.step(from_x);
  one.step(from_y);
  return detail::plane<T>{{from_x.q[0] * omega, from_y.q[0] * omega}, {from_x.p[0], from_y.p[0]}};
}

}  // namespace

stationary_covariance::stationary_covariance(const model& system, const nysalt::word& word, double step)
    : word_(word), step_(step), bath_(system.bath()) {
  if (!has_modes(system) || !bath_.acts()) {
    throw std::invalid_argument(fmt::format(
        "covariance loss: the system must be in a bath and declare modes(), got {}", describe(system)));
  }
  require_law();
  for (const double omega : system.modes().frequencies) {
    if (omega > 0.0) ++multiplicity_of_[omega];
  }
  if (multiplicity_of_.empty()) {
    throw std::invalid_argument(fmt::format(
        "covariance loss: {} must have a mode of a frequency above 0, got none", describe(system)));
  }
  require_served<model, double>(word, system);
  split_at_bath();
}

/// By the map M of the word and the excess R of the covariance 1 in a step, D = M D M^T + R.
template <Scalar T>
Eigen::Matrix<T, 2, 2> stationary_covariance::excess(double omega, const std::vector<T>& c) const {
  detail::plane<T> M = detail::plane<T>::Identity();
  detail::plane<T> R = detail::plane<T>::Zero();
  for (const auto& [first, turn] : pieces_) {
    if (turn) {
      const auto S = map_of(*turn, &c[first], omega, step_);
      R = detail::congruence(S, R) + detail::excess_of_turn(S);
      M = (S * M).eval();
    } else {  // O keeps the covariance 1: it makes no excess of its own
      if (c[first] < T(0.0)) return detail::no_covariance<T>();
      detail::plane<T> damping = detail::plane<T>::Identity();
      damping(1, 1) = bath_.decay(c[first] * step_);
      R = detail::congruence(damping, R);
      M = (damping * M).eval();
    }
  }
  return detail::discrete_lyapunov(M, R);
}

template <Scalar T>
std::vector<T> stationary_covariance::residuals(const std::vector<T>& coefficients) const {
  word_.require_one_for_each_slot(coefficients);
  std::vector<T> result;
  for (const auto& [omega, multiplicity] : multiplicity_of_) {
    const double weight = std::sqrt(static_cast<double>(multiplicity));
    const auto D = excess(omega, coefficients);
    result.push_back(D(0, 0) * weight);
    result.push_back(D(1, 0) * (weight * std::numbers::sqrt2));
    result.push_back(D(1, 1) * weight);
  }
  return result;
}
template std::vector<double> stationary_covariance::residuals(const std::vector<double>&) const;
template std::vector<detail::slopes> stationary_covariance::residuals(
    const std::vector<detail::slopes>&) const;

squares stationary_covariance::at(const std::vector<double>& coefficients,
                                  const Eigen::MatrixXd& jacobian) const {
  constexpr int width = detail::directions_at_a_time;
  const auto values = residuals(coefficients);
  const Eigen::VectorXd r = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  Eigen::MatrixXd J(r.size(), jacobian.cols());
  for (Eigen::Index first = 0; first < J.cols(); first += width) {
    const Eigen::Index end = std::min(first + width, J.cols());
    std::vector<detail::slopes> c(coefficients.begin(), coefficients.end());
    for (std::size_t i = 0; i < c.size(); ++i) {
      for (Eigen::Index k = first; k < end; ++k) {
        c[i].derivative[static_cast<std::size_t>(k - first)] = jacobian(static_cast<Eigen::Index>(i), k);
      }
    }
    const auto moving = residuals(c);
    for (std::size_t i = 0; i < moving.size(); ++i) {
      for (Eigen::Index k = first; k < end; ++k) {
        J(static_cast<Eigen::Index>(i), k) = moving[i].derivative[static_cast<std::size_t>(k - first)];
      }
    }
  }
  return {r.squaredNorm(), J.transpose() * r, J.transpose() * J};
}

void stationary_covariance::require_law() const {
  if (!(step_ > 0.0) || !std::isfinite(step_)) {
    throw std::invalid_argument(fmt::format("the step must be positive and finite, got {}", step_));
  }
  if (word_.stochastic_letters == 0) {
    throw std::invalid_argument(fmt::format(
        "covariance loss: the word must have a letter O, got {}; thermostat it", word_.letters()));
  }
  if (bath_.friction() == 0.0 || bath_.sigma() == 0.0) {
    throw std::invalid_argument(
        fmt::format("covariance loss: the bath must have friction and a temperature above 0, got a {}",
                    bath_.description()));
  }
}

void stationary_covariance::split_at_bath() {
  const std::string& letters = word_.letters();
  for (std::size_t i = 0; i < letters.size();) {
    pieces_.push_back({word_.first_slot(i), std::nullopt});
    const std::size_t length = std::min(letters.find(detail::bath_letter, i), letters.size()) - i;
    if (length > 0) pieces_.back().turn = nysalt::word(letters.substr(i, length));
    i += std::max<std::size_t>(length, 1);
  }
}

objective detail::objective_of(const stationary_covariance& loss, const family& family) {
  return [=](const Eigen::VectorXd& theta) {
    return loss.at(family.coefficients(theta), family.jacobian(theta));
  };
}

}  // namespace nysalt
