// SPDX-License-Identifier: BSL-1.0
// A family as data.
#include "nysalt/run_time_family.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "nysalt/detail/sentence.hpp"

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

void run_time_family::contain(run_time_family inner) {
  const Eigen::VectorXd somewhere = inner.starts.front().theta;
  const Eigen::Index count = parameters();
  const bool is_smaller = inner.letters.letters() == letters.letters() && inner.parameters() < count &&
                          count <= std::ssize(inner.coefficients(somewhere));
  contained_family result{std::move(inner), {}, {}};
  const auto is_member = [&](const Eigen::VectorXd& theta) {
    constexpr double rounding = 1e-12;  // sums of some coefficients of order one
    const auto ours = coefficients(result.embed(theta));
    const auto theirs = result.family.coefficients(theta);
    return std::ranges::equal(ours, theirs, [](double x, double y) { return std::abs(x - y) <= rounding; });
  };
  if (is_smaller) {
    const auto all = result.family.coefficients(somewhere);
    result.slopes = result.family.jacobian(somewhere).topRows(count);
    result.origin = Eigen::Map<const Eigen::VectorXd>(all.data(), count) - result.slopes * somewhere;
  }
  constexpr double elsewhere = 0.9;
  if (!is_smaller || !is_member(somewhere) || !is_member(elsewhere * somewhere)) {
    throw std::logic_error(sentence(
        "{}: members of the contained family must be members, and the first coefficients of the word the "
        "parameters, got {} of the word {} in {}",
        name, result.family.name, result.family.letters.letters(), letters.letters()));
  }
  contained = std::make_shared<const contained_family>(std::move(result));
}

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
  if (plain.contained) {
    const auto& [inner, slopes, origin] = *plain.contained;
    result.contained = std::make_shared<const contained_family>(
        contained_family{thermostatted(inner, where), slopes, origin});
  }
  return result;
}

namespace {

/// Those of the processor from its parameters: of A and of B all but the last are parameters, in the order of
/// the word, and the last of each is what makes their sum zero.
void append_processor(std::vector<double>& coefficients, const Eigen::VectorXd& theta, Eigen::Index first,
                      int pairs) {
  double sum_of_a = 0.0;
  double sum_of_b = 0.0;
  for (int k = 0; k + 1 < pairs; ++k) {
    const double b = theta[first + 2 * k];
    const double a = theta[first + 2 * k + 1];
    coefficients.insert(coefficients.end(), {b, a});
    sum_of_b += b;
    sum_of_a += a;
  }
  coefficients.insert(coefficients.end(), {-sum_of_b, -sum_of_a});
}

Eigen::VectorXd with_identity(const Eigen::VectorXd& theta, Eigen::Index further) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(theta.size() + further);
  result.head(theta.size()) = theta;
  return result;
}

}  // namespace

run_time_family processed(const run_time_family& kernel, int pairs) {
  if (pairs < 2 || pairs > most_processor_pairs) {
    throw std::invalid_argument(sentence("{}: a processor must have from 2 to {} pairs of letters, got {}",
                                         kernel.name, most_processor_pairs, pairs));
  }
  if (!kernel.symmetric) {
    throw std::invalid_argument(
        sentence("{}: the kernel of a processed word must be symmetric, and {} is not; take another family",
                 kernel.name, kernel.letters.letters()));
  }
  run_time_family result = kernel;
  const Eigen::Index all = kernel.parameters() + 2 * (pairs - 1);
  result.contained = std::make_shared<const contained_family>(contained_family{
      kernel, Eigen::MatrixXd::Identity(all, kernel.parameters()), Eigen::VectorXd::Zero(all)});
  std::string letters = kernel.letters.letters() + run_time_word::processor_mark;
  for (int k = 0; k < pairs; ++k) letters += "BA";
  result.letters = run_time_word(letters);
  result.name += sentence("+p{}", pairs);
  result.order = 2;
  const Eigen::Index known = kernel.parameters();
  const Eigen::Index further = 2 * (pairs - 1);
  for (Eigen::Index k = 0; k < further; ++k) {
    result.parameter_names.push_back(sentence("p{}", k + 1));
    result.ranges.push_back({-1.0, 1.0, false});
  }
  for (auto& start : result.starts) start.theta = with_identity(start.theta, further);
  if (result.refuge) result.refuge = with_identity(*result.refuge, further);
  result.coefficients_ = [kernel, known, pairs](const Eigen::VectorXd& theta) {
    auto all = kernel.coefficients(theta.head(known));
    append_processor(all, theta, known, pairs);
    return all;
  };
  result.jacobian_ = [kernel, known, further](const Eigen::VectorXd& theta) {
    const Eigen::MatrixXd of_kernel = kernel.jacobian(theta.head(known));
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(of_kernel.rows() + further + 2, known + further);
    all.topLeftCorner(of_kernel.rows(), known) = of_kernel;
    for (Eigen::Index k = 0; k < further; ++k) {
      all(of_kernel.rows() + k, known + k) = 1.0;
      all(of_kernel.rows() + further + k % 2, known + k) = -1.0;
    }
    return all;
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
