// SPDX-License-Identifier: BSL-1.0

#include "starts_of_fit.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "minimise.hpp"
#include "nysalt/methods/phase_fitted.hpp"

namespace nysalt::detail {

namespace {

/// What defects of z^2 are multiplied with to be those of the matrix itself, its four entries counted. Of a
/// kernel only the phase counts, which is the first: a processor does the rest.
Eigen::VectorXd weights_of_defects(Eigen::Index count, double z, bool is_kernel) {
  const double root = std::numbers::sqrt2;  // the half trace is of two entries, and so does the difference
  Eigen::VectorXd weights(4);
  weights << root * std::pow(z, 4), std::pow(z, 3), std::pow(z, 3), root * z * z;
  if (is_kernel) weights.tail(3).setZero();
  return weights.head(count);
}

}  // namespace

objective oscillator_loss(const family& family, const std::vector<frequency_band>& bands, double step) {
  constexpr int points_of_band = 4;
  std::vector<double> angles;
  for (const auto& [low, high] : bands) {
    for (int k = 0; k < points_of_band; ++k) {
      const double z = step * (low + (high - low) * (k + 1.0) / points_of_band);
      if (z > 0.0 && std::isfinite(z)) angles.push_back(z);
    }
  }
  if (angles.empty() || family.letters.rotates()) return {};
  std::vector<double> squared_angles;
  for (const double z : angles) squared_angles.push_back(z * z);
  return [family, angles, squared_angles](const Eigen::VectorXd& theta) {
    const Eigen::Index count = theta.size();
    squares sum{0.0, Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
    const auto defects = defects_of_rotation(family, theta, squared_angles);
    for (std::size_t n = 0; n < angles.size(); ++n) {
      const Eigen::VectorXd weights =
          weights_of_defects(defects[n].values.size(), angles[n], family.letters.is_processed());
      const Eigen::VectorXd r = defects[n].values.cwiseProduct(weights);
      const Eigen::MatrixXd slopes = weights.asDiagonal() * defects[n].jacobian;
      sum.value += r.squaredNorm();
      sum.half_gradient += slopes.transpose() * r;
      sum.normal_matrix += slopes.transpose() * slopes;
    }
    const double share = 1.0 / static_cast<double>(angles.size());
    return squares{share * sum.value, share * sum.half_gradient, share * sum.normal_matrix};
  };
}

void fix(const fit_options& options, Eigen::VectorXd& theta) {
  for (std::size_t k = 0; k < options.fixed.size(); ++k) {
    if (options.fixed[k]) theta[static_cast<Eigen::Index>(k)] = *options.fixed[k];
  }
}

std::vector<Eigen::Index> free_parameters(const family& family, const fit_options& options) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < family.parameters(); ++k) {
    if (options.fixed.empty() || !options.fixed[static_cast<std::size_t>(k)]) free.push_back(k);
  }
  return free;
}

namespace {

/// The number of the effort where a search goes in stages, else none; of a black box, whose cost is not
/// known, few.
int usual_random_starts(const learning_problem& problem, effort how_much, std::size_t free) {
  if (problem.stages.empty()) return 0;
  if (is_black_box(problem.system)) return 4;
  const int all = how_much == effort::quick ? 40 : how_much == effort::normal ? 120 : 400;
  return free <= 2 ? all / 5 : all;
}

}  // namespace

std::vector<named_parameters> starts_of(const family& family, const fit_options& options,
                                        const learning_problem& problem,
                                        const std::vector<Eigen::Index>& free) {
  std::vector<named_parameters> starts = family.starts;
  if (options.start) starts = {{"start", *options.start}};
  starts.insert(starts.end(), options.further_starts.begin(), options.further_starts.end());
  for (auto& start : starts) fix(options, start.theta);
  const std::size_t known = starts.size();
  const objective on_oscillators =
      problem.stages.empty() || family.letters.has_own_letters()
          ? objective()
          : oscillator_loss(family, problem.guard.frequencies(met::often), problem.facts.step);
  const auto is_defined = [&](const Eigen::VectorXd& theta) { return family.is_defined(theta); };
  const int random_starts =
      options.random_starts.value_or(usual_random_starts(problem, options.effort, free.size()));
  for (int n = 0; n < random_starts; ++n) {
    const auto number = static_cast<std::uint64_t>(n);
    const auto& around = starts[static_cast<std::size_t>(n) / 4 % known];  // each with all deviations
    named_parameters start{fmt::format("random {}", n + 1),
                           random_start(family, around.theta, free, options.seed, number)};
    if (on_oscillators && n % 2 == 1) {
      start.name += " on oscillators";
      start.theta = inside(family, descend_roughly(on_oscillators, is_defined, start.theta, free).first);
    }
    starts.push_back(std::move(start));
  }
  return starts;
}

std::optional<fit_options> options_within(const contained_family& inner, const fit_options& options) {
  constexpr int few = 40;
  fit_options result = options;
  result.further_starts.clear();
  result.effort = effort::quick;
  if (result.random_starts) result.random_starts = std::min(*result.random_starts, few);
  result.fixed.assign(static_cast<std::size_t>(inner.family.parameters()), std::nullopt);
  for (std::size_t k = 0; k < options.fixed.size(); ++k) {
    if (!options.fixed[k]) continue;
    const auto row = inner.slopes.row(static_cast<Eigen::Index>(k));
    const double rest = *options.fixed[k] - inner.origin[static_cast<Eigen::Index>(k)];
    Eigen::Index only = 0;  // parameter that it follows from
    const double slope = row.cwiseAbs().maxCoeff(&only);
    if (slope == 0.0 && rest == 0.0) continue;
    if (slope == 0.0 || (row.array() != 0.0).count() != 1) return std::nullopt;
    result.fixed[static_cast<std::size_t>(only)] = rest / row[only];
  }
  return result;
}

search_task within(const contained_family& inner, search_task task) {
  const auto loss_of = [&](const objective& loss) -> objective {
    if (!loss) return loss;
    return [inner, loss](const Eigen::VectorXd& theta) {
      squares result = loss(inner.embed(theta));
      result.half_gradient = inner.slopes.transpose() * result.half_gradient;
      result.normal_matrix = inner.slopes.transpose() * result.normal_matrix * inner.slopes;
      return result;
    };
  };
  const auto of = [&](const auto& function) -> std::remove_cvref_t<decltype(function)> {
    if (!function) return function;
    return [inner, function](const Eigen::VectorXd& theta) { return function(inner.embed(theta)); };
  };
  task.family = &inner.family;
  task.loss = loss_of(task.loss);
  for (auto& stage : task.stages) stage.loss = loss_of(stage.loss);
  task.one_step_loss = loss_of(task.one_step_loss);
  task.judge = of(task.judge);
  task.admits = of(task.admits);
  task.withstands = of(task.withstands);
  task.admits_at_edge = of(task.admits_at_edge);
  return task;
}

void require_same(const communicator& ranks, const Eigen::VectorXd& theta) {
  if (ranks.is_single()) return;
  Eigen::VectorXd of_first = theta;
  ranks.broadcast(std::as_writable_bytes(std::span(of_first.data(), static_cast<std::size_t>(theta.size()))),
                  0);
  collectively(ranks, [&] {
    if (theta == of_first) return;
    throw std::runtime_error(
        fmt::format("learn: ranks must come to the same parameters, got others on rank {} than on rank 0; "
                    "run all ranks on processors of one kind",
                    ranks.rank()));
  });
}

void require_sound(const family& family, const fit_options& options) {
  if (options.planned_steps < 1) {
    throw std::invalid_argument(
        fmt::format("learn: planned_steps must be at least 1, got {}", options.planned_steps));
  }
  if (options.max_iterations < 0 || options.random_starts.value_or(0) < 0) {
    throw std::invalid_argument(
        fmt::format("learn: max_iterations and random_starts must not be negative, got {} and {}",
                    options.max_iterations, options.random_starts.value_or(0)));
  }
  const auto count = static_cast<std::size_t>(family.parameters());
  if ((options.start && options.start->size() != family.parameters()) ||
      (!options.fixed.empty() && options.fixed.size() != count)) {
    throw std::invalid_argument(fmt::format(
        "learn: start and fixed values must be {}, one for each parameter of {}", count, family.name));
  }
  for (const auto& start : options.further_starts) {
    if (start.theta.size() == family.parameters() && !start.theta.allFinite()) {
      throw std::invalid_argument(fmt::format("learn: starts must be finite, got '{}'", start.name));
    }
    if (start.theta.size() == family.parameters()) continue;
    throw std::invalid_argument(
        fmt::format("learn: the start '{}' must have {} parameters, as {} has, got {}", start.name,
                    family.parameters(), family.name, start.theta.size()));
  }
  if (options.contained &&
      (!family.contained || options.contained->size() != family.contained->family.parameters() ||
       !options.contained->allFinite())) {
    throw std::invalid_argument(
        fmt::format("learn: contained must be finite parameters of the family that {} contains, got {} "
                    "numbers; leave contained out",
                    family.name, options.contained->size()));
  }
  Eigen::VectorXd first = options.start.value_or(family.starts.front().theta);
  fix(options, first);
  require_in_range(family, first);
}

}  // namespace nysalt::detail
