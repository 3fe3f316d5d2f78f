// SPDX-License-Identifier: BSL-1.0
// The distance of the stationary distribution of a thermostatted word from the Gibbs distribution.
#include "nysalt/losses/stationary_covariance.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace nysalt {

squares stationary_covariance::at(const std::vector<double>& coefficients,
                                  const Eigen::MatrixXd& jacobian) const {
  constexpr int width = 2;  // columns at a time, as their number is known at run time only
  const auto values = residuals(coefficients);
  const Eigen::VectorXd r = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  Eigen::MatrixXd J(r.size(), jacobian.cols());
  for (Eigen::Index first = 0; first < J.cols(); first += width) {
    const Eigen::Index end = std::min(first + width, J.cols());
    std::vector<dual<double, width>> c(coefficients.begin(), coefficients.end());
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
    const std::size_t length = std::min(letters.find(bath_letter, i), letters.size()) - i;
    if (length > 0) pieces_.back().turn = run_time_word(letters.substr(i, length));
    i += std::max<std::size_t>(length, 1);
  }
}

objective objective_of(const stationary_covariance& loss, const run_time_family& family) {
  return [=](const Eigen::VectorXd& theta) {
    return loss.at(family.coefficients(theta), family.jacobian(theta));
  };
}

}  // namespace nysalt
