// SPDX-License-Identifier: BSL-1.0
// The search for minima: compressed residuals, curvature, descents from many starts.

#include "nysalt/learning/search.hpp"

#include <ceres/cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "data_of_problem.hpp"
#include "describe.hpp"
#include "minimise.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/learning/curvature.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "starts_of_fit.hpp"

namespace nysalt {

compressed_cost::compressed_cost(objective loss, std::function<bool(const Eigen::VectorXd&)> defined,
                                 int parameters)
    : loss_(std::move(loss)), defined_(std::move(defined)), parameters_(parameters) {}

bool compressed_cost::is_usable_at(const Eigen::VectorXd& theta) const {
  if (!defined_(theta)) return false;
  if (theta_.size() == 0 || theta != theta_) {
    at_theta_ = loss_(theta);
    theta_ = theta;
    compress();
  }
  return at_theta_.is_finite() && residuals_.allFinite() && jacobian_.allFinite();
}

bool compressed_cost::Evaluate(double const* const* blocks, double* residuals, double** jacobians) const {
  const Eigen::Index count = parameters_;
  if (!is_usable_at(Eigen::Map<const Eigen::VectorXd>(blocks[0], count))) return false;
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    std::copy_n(residuals_.data(), count + 1, residuals);
    std::copy_n(jacobian_.data(), (count + 1) * count, jacobians[0]);
  } else {
    std::fill(residuals, residuals + count, 0.0);
    residuals[count] = std::sqrt(at_theta_.value);
  }
  return true;
}

void compressed_cost::compress() const {
  const Eigen::Index count = theta_.size();
  residuals_ = Eigen::VectorXd::Zero(count + 1);
  jacobian_ = rows::Zero(count + 1, count);
  if (!at_theta_.is_finite()) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(at_theta_.normal_matrix);
  const double least = 1e-13 * solver.eigenvalues()[count - 1];
  double rest = at_theta_.value;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double root = std::sqrt(solver.eigenvalues()[k]);
    if (!(root * root > least)) continue;
    const auto direction = solver.eigenvectors().col(k);
    residuals_[k] = direction.dot(at_theta_.half_gradient) / root;
    jacobian_.row(k) = root * direction;
    rest -= residuals_[k] * residuals_[k];
  }
  residuals_[count] = std::sqrt(std::max(0.0, rest));  // negative by rounding, where all is explained
}

// The Hessian of a loss, and the uncertainty of a minimum that follows from it.

namespace {

/// By how much Gauss-Newton's curvatures differ at two points, relative to their sum; infinite where one is
/// not finite. Each is of one parameter, so that no unit matters.
double relative_difference(const squares& a, const squares& b) {
  double largest = 0.0;
  for (Eigen::Index k = 0; k < a.normal_matrix.rows(); ++k) {
    const double sum = a.normal_matrix(k, k) + b.normal_matrix(k, k);
    const double difference = std::abs(a.normal_matrix(k, k) - b.normal_matrix(k, k));
    if (sum > 0.0) largest = std::max(largest, difference / sum);
  }
  return a.is_finite() && b.is_finite() ? largest : std::numeric_limits<double>::infinity();
}

}  // namespace

Eigen::MatrixXd hessian(const objective& loss, const Eigen::VectorXd& theta) {
  constexpr double much = 1e-3;    // a step s is then 1e-3 of the length over which the loss changes its form
  constexpr double wanted = 1e-4;  // as 1e-5 is of a coefficient, which is of order one
  constexpr int most = 20;         // a step 1e-20 times as long is lost in theta
  Eigen::MatrixXd result(theta.size(), theta.size());
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    double s = 1e-5 * std::max(1.0, std::abs(theta[k]));
    for (int n = 0; n < most; ++n) {
      Eigen::VectorXd ahead = theta;
      Eigen::VectorXd behind = theta;
      ahead[k] += s;
      behind[k] -= s;
      const squares there = loss(ahead);
      const squares back = loss(behind);
      result.col(k) = (there.gradient() - back.gradient()) / (ahead[k] - behind[k]);
      const double changes = relative_difference(there, back);
      if (changes <= much) break;
      s *= std::max(0.01, wanted / changes);
    }
  }
  return 0.5 * (result + result.transpose());
}

curvature::curvature(const Eigen::MatrixXd& hessian, std::vector<Eigen::Index> free)
    : size_(hessian.rows()), free_(std::move(free)) {
  if (free_.empty()) return;
  const Eigen::MatrixXd of_free = hessian(free_, free_);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(of_free);
  eigenvalues_ = solver.eigenvalues();
  eigenvectors_ = solver.eigenvectors();
}

std::vector<Eigen::VectorXd> curvature::flat_directions() const {
  std::vector<Eigen::VectorXd> result;
  for (Eigen::Index k = 0; k < count(); ++k) {
    if (is_flat(k)) result.push_back(direction(k));
  }
  return result;
}

double curvature::condition() const {
  for (Eigen::Index k = 0; k < count(); ++k) {
    if (!is_flat(k)) return largest() / eigenvalues_[k];
  }
  return 1.0;
}

bool curvature::is_minimum() const { return count() == 0 || eigenvalues_[0] > -flat_below * largest(); }

Eigen::VectorXd curvature::solve(const Eigen::VectorXd& v) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
  for (Eigen::Index k = 0; k < count(); ++k) {
    if (!is_flat(k)) result += direction(k) * (direction(k).dot(v) / eigenvalues_[k]);
  }
  return result;
}

double curvature::expected_excess(const trajectory_scores& scores) const {
  const double blocks = scores.blocks();
  if (blocks < 2.0) return std::numeric_limits<double>::quiet_NaN();
  return scores.share.sum(excesses(scores)) * (blocks / (blocks - 1.0));
}

double curvature::deciding_blocks(const trajectory_scores& scores) const {
  auto terms = excesses(scores);
  const double sum = scores.share.sum(terms);
  for (double& e : terms) e *= e;
  const double squares = scores.share.sum(terms);
  return squares > 0.0 ? sum * sum / squares : scores.blocks();
}

spread_of_minimum curvature::spread(const trajectory_scores& scores, const trajectory_scores& others) const {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size_);
  const double blocks = scores.blocks();
  const double further = others.blocks();
  Eigen::VectorXd squares = zero;
  Eigen::VectorXd fourths = zero;
  const auto add = [&](const trajectory_scores& some, const Eigen::VectorXd& mean, double factor) {
    std::vector<Eigen::VectorXd> powers;
    for (const auto& score : some.of_each) powers.push_back((solve(score - mean) * factor).cwiseAbs2());
    squares += some.share.sum(powers, zero);
    for (auto& power : powers) power = power.cwiseAbs2().eval();
    fourths += some.share.sum(powers, zero);
  };
  add(scores, zero, 1.0);  // at the minimum they sum to zero
  double freedom = blocks - 1.0;
  if (further >= 2.0) {  // a score is of the mean over all of its data: B'/B of it is one among B
    add(others, others.share.sum(others.of_each, zero) / further, further / blocks);
    freedom += further - 1.0;
  }
  spread_of_minimum result{(squares * (blocks / freedom)).cwiseSqrt(), zero};
  for (Eigen::Index i = 0; i < size_; ++i) {
    result.deciding[i] = fourths[i] > 0.0 ? squares[i] * squares[i] / fourths[i] : freedom;
  }
  if (blocks < 2.0) result.standard_errors.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (const auto& flat : flat_directions()) {
    for (Eigen::Index i = 0; i < size_; ++i) {
      if (std::abs(flat[i]) > 1e-6) result.standard_errors[i] = std::numeric_limits<double>::infinity();
    }
  }
  return result;
}

std::vector<double> curvature::excesses(const trajectory_scores& scores) const {
  std::vector<double> result;
  for (const auto& score : scores.of_each) result.push_back(0.5 * score.dot(solve(score)));
  return result;
}

double curvature::largest() const { return eigenvalues_[count() - 1]; }

bool curvature::is_flat(Eigen::Index k) const { return !(eigenvalues_[k] > flat_below * largest()); }

Eigen::VectorXd curvature::direction(Eigen::Index k) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
  result(free_) = eigenvectors_.col(k);
  return result;
}

// The minimum of a loss: Ceres, then Newton's method for the last digits.

namespace {

/// A compressed cost as Ceres takes it.
class cost_of_ceres final : public ceres::CostFunction {
 public:
  cost_of_ceres(objective loss, std::function<bool(const Eigen::VectorXd&)> defined, int parameters)
      : cost_(std::move(loss), std::move(defined), parameters) {
    set_num_residuals(parameters + 1);
    mutable_parameter_block_sizes()->push_back(parameters);
  }

  bool is_usable_at(const Eigen::VectorXd& theta) const { return cost_.is_usable_at(theta); }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    return cost_.Evaluate(blocks, residuals, jacobians);
  }

 private:
  compressed_cost cost_;
};

}  // namespace

namespace detail {

void descend(ceres::Problem& problem, const std::vector<Eigen::Index>& free, int max_iterations,
             minimum& found, double function_tolerance, bool may_climb) {
  Eigen::VectorXd& theta = found.theta;
  std::vector<int> fixed;
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    if (std::find(free.begin(), free.end(), k) == free.end()) fixed.push_back(static_cast<int>(k));
  }
  if (!fixed.empty()) {
    problem.SetManifold(theta.data(), new ceres::SubsetManifold(static_cast<int>(theta.size()), fixed));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = function_tolerance;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 1e-8;
  options.use_nonmonotonic_steps = may_climb;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  found.iterations = static_cast<int>(summary.iterations.size());
  found.has_ended = summary.termination_type == ceres::CONVERGENCE;
  const auto& steps = summary.iterations;
  constexpr double hardly = 2.0;  // errors by a factor 1.4, as much as one search and another differ
  constexpr std::size_t enough = 50;
  found.in_valley = summary.termination_type == ceres::NO_CONVERGENCE && steps.size() > enough &&
                    steps[steps.size() * 3 / 4].cost <= hardly * summary.final_cost;
}

void polish(const objective& loss, const std::function<bool(const Eigen::VectorXd&)>& defined,
            const std::vector<Eigen::Index>& free, minimum& found) {
  const Eigen::VectorXd began = found.theta;
  found.hessian = hessian(loss, began);
  const curvature bend(found.hessian, free);
  squares here = loss(began);
  found.loss = here.value;
  if (!bend.is_minimum()) return;
  const auto decrease_of = [&](const squares& at) {  // by the next step
    const Eigen::VectorXd gradient = at.gradient();
    return 0.5 * gradient.dot(bend.solve(gradient));
  };
  double decrease = decrease_of(here);
  for (int n = 0; n < 8 && decrease > 0.0; ++n) {
    const Eigen::VectorXd next = found.theta - bend.solve(here.gradient());
    if (!defined(next)) break;
    const squares there = loss(next);
    const double next_decrease = decrease_of(there);
    if (!(next_decrease < decrease)) break;
    found.theta = next;
    here = there;
    decrease = next_decrease;
    ++found.iterations;
  }
  found.loss = here.value;
  if ((found.theta - began).norm() > 1e-6) found.hessian = hessian(loss, found.theta);
  // 1e-24: errors of 1e-12 of an increment, which exact recovery cannot get below.
  found.converged = decrease <= 1e-6 * found.loss + 1e-24;
  constexpr double hardly = 0.005;  // so that the loss is within a hundredth of the least
  found.in_valley =
      !found.converged && (found.in_valley || (found.has_ended && decrease <= hardly * found.loss));
}

}  // namespace detail

std::pair<Eigen::VectorXd, double> descend_roughly(const objective& loss,
                                                   const std::function<bool(const Eigen::VectorXd&)>& defined,
                                                   const Eigen::VectorXd& start,
                                                   const std::vector<Eigen::Index>& free, bool may_climb) {
  constexpr int most_iterations = 40;
  constexpr double hardly = 0.01;
  minimum found{start};
  auto cost = std::make_unique<cost_of_ceres>(loss, defined, static_cast<int>(start.size()));
  if (!cost->is_usable_at(start)) return {start, std::numeric_limits<double>::infinity()};
  if (!free.empty()) {
    ceres::Problem problem;
    problem.AddResidualBlock(cost.release(), nullptr, found.theta.data());
    detail::descend(problem, free, most_iterations, found, hardly, may_climb);
  }
  return {found.theta, loss(found.theta).value};
}

minimum minimise(const objective& loss, const std::function<bool(const Eigen::VectorXd&)>& defined,
                 const Eigen::VectorXd& start, const std::vector<Eigen::Index>& free, int max_iterations) {
  minimum found{start};
  if (free.empty()) {
    found.loss = loss(start).value;
    found.hessian = Eigen::MatrixXd::Zero(start.size(), start.size());  // the direction is not needed
    found.converged = true;
    return found;
  }
  auto cost = std::make_unique<cost_of_ceres>(loss, defined, static_cast<int>(start.size()));
  if (!cost->is_usable_at(start)) {
    found.loss = std::numeric_limits<double>::infinity();
    found.hessian = Eigen::MatrixXd::Zero(start.size(), start.size());
    return found;
  }
  ceres::Problem problem;
  problem.AddResidualBlock(cost.release(), nullptr, found.theta.data());
  detail::descend(problem, free, max_iterations, found);
  detail::polish(loss, defined, free, found);
  return found;
}

}  // namespace nysalt

namespace nysalt::detail {

void fix(const fit_options& options, Eigen::VectorXd& theta) {
  for (std::size_t k = 0; k < options.fixed.size(); ++k) {
    if (options.fixed[k]) theta[static_cast<Eigen::Index>(k)] = *options.fixed[k];
  }
}

namespace {

/// Those of the effort where a search goes in stages, else none; of a black box, whose cost is not known,
/// few.
int usual_random_starts(const learning_problem& problem, effort how_much, std::size_t free) {
  if (problem.stages.empty()) return 0;
  if (problem.is_of_black_box) return 4;
  const int all = how_much == effort::quick ? 40 : how_much == effort::normal ? 120 : 400;
  return free <= 2 ? all / 5 : all;
}

}  // namespace

std::vector<named_parameters> starts_of(const run_time_family& family, const fit_options& options,
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
          : oscillator_loss(family, problem.guard.frequencies(met::often), problem.step);
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

void require_sound(const run_time_family& family, const fit_options& options) {
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
  Eigen::VectorXd first = options.start.value_or(family.starts.front().theta);
  fix(options, first);
  require_in_range(family, first);
}

}  // namespace nysalt::detail

// From several starts to the best minimum that may be used.

namespace nysalt {

namespace {

/// Minimises where `defined`; bounds that may be attained are left aside, and where the search ends beyond
/// one that parameter is held there and the others are fitted again.
candidate descend(const search_task& task, const std::function<bool(const Eigen::VectorXd&)>& defined,
                  const named_parameters& start) {
  candidate found{.from = start.name, .theta = start.theta, .hessian = {}, .free = task.free};
  for (bool inside = false; !inside;) {
    const auto end = minimise(task.loss, defined, found.theta, found.free, task.max_iterations);
    found.theta = end.theta;
    found.hessian = end.hessian;
    found.loss = end.loss;
    found.converged = end.converged;
    found.in_valley = end.in_valley;
    found.iterations += end.iterations;
    inside = 0 == std::erase_if(found.free, [&](Eigen::Index k) {
               constexpr double met = 1e-12;  // a bound is met to rounding: exact recovery of Verlet
               const auto& [low, high, open] = task.family->ranges[static_cast<std::size_t>(k)];
               double& theta = found.theta[k];
               if (open || (low + met < theta && theta < high - met)) return false;
               theta = theta - low < high - theta ? low : high;
               return true;
             });
  }
  found.judged =
      std::isfinite(found.loss) ? task.judge(found.theta) : std::numeric_limits<double>::infinity();
  found.admitted = task.admits(found.theta);
  return found;
}

/// A parameter is held at the end of all ranges: the data do not determine it, and such a fit is not usable.
bool has_run_away(const candidate& one, const std::vector<Eigen::Index>& free) {
  return std::ranges::any_of(free, [&](Eigen::Index k) {
    return std::ranges::find(one.free, k) == one.free.end() && std::abs(one.theta[k]) == farthest_parameter;
  });
}

/// Those that the judge can judge, from the one that it likes best on; of equals the first comes first. Those
/// that have run away come last.
std::vector<candidate> by_judgement(std::vector<candidate> all, const std::vector<Eigen::Index>& free) {
  std::erase_if(all, [](const candidate& one) { return !std::isfinite(one.judged); });
  std::ranges::stable_sort(all, {}, &candidate::judged);
  // Not std::ranges::stable_partition: clang++ 14 does not compile what it returns.
  std::stable_partition(all.begin(), all.end(),
                        [&](const candidate& one) { return !has_run_away(one, free); });
  return all;
}

/// The first that is admitted and withstands a trial run; nothing if none of the first few different ones
/// does.
std::optional<candidate> first_to_withstand(const search_task& task, const std::vector<candidate>& in_order) {
  constexpr int most_trials = 4;
  constexpr double same = 1e-6;  // of coefficients of order one
  std::vector<Eigen::VectorXd> failed;
  for (const candidate& one : in_order) {
    if (!one.admitted) continue;
    if (!task.withstands) return one;
    const bool has_failed = std::ranges::any_of(
        failed, [&](const Eigen::VectorXd& theta) { return (theta - one.theta).norm() <= same; });
    if (has_failed) continue;
    if (task.withstands(one.theta)) return one;
    failed.push_back(one.theta);
    if (std::ssize(failed) == most_trials) break;
  }
  return std::nullopt;
}

}  // namespace

Eigen::VectorXd random_start(const run_time_family& family, Eigen::VectorXd theta,
                             const std::vector<Eigen::Index>& free, std::uint64_t seed, std::uint64_t n) {
  const double deviation = 0.6 * std::exp2(-static_cast<double>(n % 4));
  Eigen::VectorXd normals(theta.size());
  standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::search}, normals);
  const Eigen::VectorXd around = theta;
  for (const Eigen::Index k : free) theta[k] += deviation * normals[k];
  const Eigen::VectorXd moved = inside(family, theta);
  theta = around;
  for (const Eigen::Index k : free) theta[k] = moved[k];
  return theta;
}

Eigen::VectorXd inside(const run_time_family& family, Eigen::VectorXd theta) {
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    const auto& [low, high, open] = family.ranges[static_cast<std::size_t>(k)];
    const double inset = open ? 1e-3 * (high - low) : 0.0;
    theta[k] = std::clamp(theta[k], low + inset, high - inset);
  }
  return theta;
}

namespace {

/// The best minima of an earlier loss that differ, those first that the guard admits. Every other two of the
/// searches may climb: they cross the bends of narrow valleys, and the others stay where they begin, so that
/// either find minima that the others miss. And the least loss that was found.
std::pair<std::vector<named_parameters>, double> most_promising(const search_task& task,
                                                                const objective& loss,
                                                                const std::vector<named_parameters>& starts,
                                                                std::size_t most) {
  constexpr double far_apart = 0.05;  // of coefficients of order one
  struct found {
    named_parameters at;
    double loss;
  };
  const auto is_defined = [&](const Eigen::VectorXd& theta) { return task.family->is_defined(theta); };
  std::vector<found> all;
  for (std::size_t n = 0; n < starts.size(); ++n) {
    const auto& start = starts[n];
    auto [theta, value] = descend_roughly(loss, is_defined, start.theta, task.free, n / 2 % 2 == 1);
    if (!task.family->is_in_range(theta)) {
      theta = inside(*task.family, std::move(theta));
      value = is_defined(theta) ? loss(theta).value : std::numeric_limits<double>::infinity();
    }
    if (std::isfinite(value)) all.push_back({{start.name, std::move(theta)}, value});
  }
  std::ranges::stable_sort(all, {}, &found::loss);
  std::vector<named_parameters> admitted;
  std::vector<named_parameters> others;
  for (const auto& one : all) {
    const named_parameters& at = one.at;
    if (admitted.size() == most) break;
    const auto is_near = [&](const named_parameters& known) {
      return (known.theta - at.theta).norm() <= far_apart;
    };
    if (std::ranges::any_of(admitted, is_near) || std::ranges::any_of(others, is_near)) continue;
    (task.admits(at.theta) ? admitted : others).push_back(at);
  }
  for (const auto& at : others) {
    if (admitted.size() == most) break;
    admitted.push_back(at);
  }
  return {admitted, all.empty() ? std::numeric_limits<double>::infinity() : all.front().loss};
}

/// Of the minima of the one-step loss that the first few starts lead to, the least, and that of the least
/// loss: where errors are tiny one step distinguishes several minima that trajectories see as one narrow
/// valley.
std::vector<named_parameters> one_step_minima(const search_task& task,
                                              const std::vector<named_parameters>& starts) {
  constexpr std::size_t most = 12;
  const auto is_defined = [&](const Eigen::VectorXd& theta) { return task.family->is_defined(theta); };
  struct found {
    named_parameters at;
    double of_one_step = std::numeric_limits<double>::infinity();
    double loss = std::numeric_limits<double>::infinity();
  };
  std::vector<found> all;
  for (std::size_t n = 0; n < std::min(most, starts.size()); ++n) {
    const auto end =
        minimise(task.one_step_loss, is_defined, starts[n].theta, task.free, task.max_iterations);
    if (!std::isfinite(end.loss) || !task.family->is_in_range(end.theta)) continue;
    all.push_back({{"one step", end.theta}, end.loss, task.loss(end.theta).value});
  }
  if (all.empty()) return {};
  const auto least = std::ranges::min_element(all, {}, &found::of_one_step);
  const auto best = std::ranges::min_element(all, {}, &found::loss);
  std::vector<named_parameters> result{least->at};
  if (best != least) result.push_back(best->at);
  return result;
}

/// Those with the least losses, from the least on; none without a finite one.
void keep_least(std::vector<named_parameters>& starts, const objective& loss, std::size_t most) {
  if (starts.size() <= most) return;
  std::vector<std::pair<double, named_parameters>> all;
  for (auto& start : starts) {
    const double value = loss(start.theta).value;
    if (std::isfinite(value)) all.emplace_back(value, std::move(start));
  }
  std::ranges::stable_sort(all, {}, &std::pair<double, named_parameters>::first);
  if (all.size() > most) all.resize(most, {0.0, {}});
  starts.clear();
  for (auto& [value, start] : all) starts.push_back(std::move(start));
}

/// Starts from which a search goes along the edge of stability, which takes many passes over the data: of
/// twelve, after some passes, the best three.
constexpr std::size_t most_at_edge = 12;
constexpr std::size_t most_to_the_end = 3;
constexpr int some_passes = 40;

}  // namespace

search_result search(const search_task& task, const std::vector<named_parameters>& given) {
  std::vector<named_parameters> starts = given;
  std::vector<std::size_t>
      most_of;  // minima that are carried on: three from the last stage, four times as many before
  for (std::size_t n = task.stages.size(), most = 3; n-- > 0; most *= 4) most_of.push_back(most);
  std::vector<named_parameters> of_one_step;
  for (const search_stage& stage : task.stages) {
    const std::size_t most = most_of.back();
    most_of.pop_back();
    if (starts.size() <= most) continue;
    auto [next, least] = most_promising(task, stage.loss, starts, most);
    if (least > stage.lost_above && task.kept.empty()) {
      search_result none{.best = {}, .unguarded = {}, .tried = static_cast<int>(given.size())};
      none.lost_after = stage.steps;
      return none;
    }
    if (!next.empty()) starts = std::move(next);
    if (task.one_step_loss && of_one_step.empty()) of_one_step = one_step_minima(task, starts);
  }
  starts.insert(starts.end(), of_one_step.begin(), of_one_step.end());
  starts.insert(starts.end(), task.kept.begin(), task.kept.end());
  const auto is_defined = [&](const Eigen::VectorXd& theta) { return task.family->is_defined(theta); };
  std::vector<candidate> all;
  for (const auto& start : starts) all.push_back(descend(task, is_defined, start));
  search_result result{.best = all.front(), .unguarded = {}, .tried = static_cast<int>(given.size())};

  if (starts.size() <
      given.size()) {  // what is left is near its minimum: it may take many steps to come there
    for (auto& one : all) one.in_valley = !one.converged;
  }
  std::erase_if(all, [](const candidate& c) { return !c.converged && !c.in_valley; });
  const auto sound = by_judgement(std::move(all), task.free);
  if (sound.empty()) return result;
  result.best = sound.front();
  const auto found = first_to_withstand(task, sound);
  const auto is_allowed = [&](const Eigen::VectorXd& theta) {
    const auto& admits = task.admits_at_edge ? task.admits_at_edge : task.admits;
    return is_defined(theta) && task.family->is_in_range(theta) && admits(theta);
  };
  // Where all minima that are admitted err by more than twice what a refused one does, or by more than a kept
  // start, there may be better ones at the edge.
  const bool is_best = found && found->theta == sound.front().theta;
  const auto found_is_above = [&](double judged) { return found && judged < found->judged; };
  constexpr double twofold = 4.0;  // of squared errors
  const bool edge_may_be_better =
      !is_best && (found_is_above(twofold * sound.front().judged) ||
                   std::ranges::any_of(task.kept, [&](const named_parameters& start) {
                     return found_is_above(task.judge(start.theta)) && is_allowed(start.theta);
                   }));
  if (!is_best) result.unguarded = sound.front();
  if (found && !edge_may_be_better) {
    result.best = *found;
    return result;
  }

  std::vector<candidate> held;
  std::vector<named_parameters> from = starts;
  if (starts.size() < given.size()) from.insert(from.end(), given.begin(), given.end());
  std::erase_if(from, [&](const named_parameters& start) { return !is_allowed(start.theta); });
  keep_least(from, task.loss, most_at_edge);
  if (from.size() > most_to_the_end) {
    for (auto& start : from) {
      start.theta = descend_at_edge(task.loss, is_allowed, start.theta, task.free, some_passes);
    }
    keep_least(from, task.loss, most_to_the_end);
  }
  if (task.most_stable_member && is_allowed(task.most_stable_member->theta))
    from.push_back(*task.most_stable_member);
  for (const auto& start : from) {
    candidate one{
        .from = start.name, .theta = start.theta, .hessian = {}, .free = task.free, .is_held = true};
    one.theta = descend_at_edge(task.loss, is_allowed, start.theta, task.free);
    one.loss = task.loss(one.theta).value;
    one.judged = task.judge(one.theta);
    held.push_back(one);
    ++result.tried;
  }
  held = by_judgement(std::move(held), task.free);
  const auto at_edge = first_to_withstand(task, held);
  constexpr double hardly = 0.99;  // a minimum, of which more is known, is as good
  if (found && !(at_edge && at_edge->judged < hardly * found->judged)) {
    result.best = *found;
  } else if (!held.empty()) {
    result.best = at_edge.value_or(held.front());
  }
  return result;
}

}  // namespace nysalt
