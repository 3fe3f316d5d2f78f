// SPDX-License-Identifier: BSL-1.0
// A family as data.
#include "nysalt/run_time_family.hpp"

#include <utility>

namespace nysalt {

namespace {

Eigen::MatrixXd thermostatted_jacobian(const run_time_family& plain, placement where,
                                       const Eigen::VectorXd& theta) {
  using D = dual<double, 1>;
  const auto c = plain.coefficients(theta);
  const Eigen::MatrixXd slopes = plain.jacobian(theta);
  Eigen::MatrixXd result;
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) {
    std::vector<D> lifted(c.begin(), c.end());
    for (std::size_t i = 0; i < c.size(); ++i) {
      lifted[i].derivative[0] = slopes(static_cast<Eigen::Index>(i), k);
    }
    const auto placed = thermostatted_coefficients(plain.letters, where, lifted);
    result.conservativeResize(static_cast<Eigen::Index>(placed.size()), slopes.cols());
    for (std::size_t i = 0; i < placed.size(); ++i) {
      result(static_cast<Eigen::Index>(i), k) = placed[i].derivative[0];
    }
  }
  return result;
}

}  // namespace

run_time_family::run_time_family(std::string method_name, run_time_word word,
                                 std::vector<double> coefficients)
    : name(std::move(method_name)),
      starts({{name, Eigen::VectorXd()}}),
      order(0),
      symmetric(false),
      requires_quadratic_kinetic(false),
      letters(std::move(word)),
      coefficients_([coefficients](const Eigen::VectorXd&) { return coefficients; }),
      jacobian_([count = static_cast<Eigen::Index>(coefficients.size())](const Eigen::VectorXd&) {
        return Eigen::MatrixXd(count, 0);
      }) {}

bool run_time_family::is_defined(const Eigen::VectorXd& theta) const {
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (ranges[k].open && !ranges[k].contains(theta[static_cast<Eigen::Index>(k)])) return false;
  }
  return true;
}

bool run_time_family::is_in_range(const Eigen::VectorXd& theta) const {
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (!ranges[k].contains(theta[static_cast<Eigen::Index>(k)])) return false;
  }
  return true;
}

run_time_family thermostatted(const run_time_family& plain, placement where) {
  run_time_family result = plain;
  result.letters = thermostatted(plain.letters, where);
  result.order = thermostatted_order(where, plain.order, plain.symmetric);
  result.symmetric = where != placement::end && plain.symmetric;
  result.coefficients_ = [plain, where](const Eigen::VectorXd& theta) {
    return thermostatted_coefficients(plain.letters, where, plain.coefficients(theta));
  };
  result.jacobian_ = [plain, where](const Eigen::VectorXd& theta) {
    return thermostatted_jacobian(plain, where, theta);
  };
  return result;
}

void require_in_range(const run_time_family& family, const Eigen::VectorXd& theta) {
  for (std::size_t k = 0; k < family.ranges.size(); ++k) {
    detail::require_in_range(family.name, family.parameter_names[k], family.ranges[k],
                             theta[static_cast<Eigen::Index>(k)]);
  }
}

}  // namespace nysalt
