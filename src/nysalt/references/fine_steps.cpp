// SPDX-License-Identifier: BSL-1.0
#include "nysalt/references/fine_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/noises/recorded_path.hpp"

namespace nysalt {

namespace {

/// The number of steps in each of `parts` equal parts of the time t; nothing unless it is a positive integer,
/// to 1e-9 relative.
std::optional<std::int64_t> whole_steps(double t, double step, std::int64_t parts = 1) {
  const double ratio = t / step / static_cast<double>(parts);
  const double steps = std::round(ratio);
  if (!(steps >= 1.0) || !(steps < 1e18) || !(std::abs(ratio - steps) <= 1e-9 * steps)) return std::nullopt;
  return static_cast<std::int64_t>(steps);
}

std::int64_t steps_in_interval(double t, double step) {
  if (const auto steps = whole_steps(t, step)) return *steps;
  throw std::invalid_argument(
      fmt::format("fine_steps: the time must be a multiple of the fine step, got {} and {}", t, step));
}

std::int64_t steps_in_part(double t, double step, std::int64_t parts) {
  if (const auto steps = whole_steps(t, step, parts)) return *steps;
  throw std::invalid_argument(
      fmt::format("fine_paths: the time {} in the {} equal parts of the noise must be a multiple of "
                  "the fine step {}",
                  t, parts, step));
}

/// The force evaluations of `count` trajectories in an interval.
class evaluations_of_interval {
 public:
  evaluations_of_interval(const nysalt::word& word, std::int64_t steps, int count)
      : all_(word.evaluations_to_open + steps * word.evaluations_per_step),
        derivatives_(steps * word.force_derivatives),
        count_(count) {}

  /// A black box counts its own since there were `before` of them.
  std::int64_t operator()(const model& system, std::int64_t before) const {
    if (detail::is_black_box(system)) return (system.calls() - before) * count_;
    return count_ * detail::evaluations_of(system, all_, derivatives_);
  }

 private:
  std::int64_t all_;
  std::int64_t derivatives_;
  int count_;
};

/// Each interval is a run of the stepper of its own, so that its end has the bits of a run that ends there:
/// steps of two intervals do not merge.
template <class T>
class steps_run final : public detail::reference_run<T> {
 public:
  steps_run(const model& system, const nysalt::method& method, double step,
            const phase_point<T, Eigen::Dynamic>& start, const detail::reference_intervals& intervals)
      : detail::reference_run<T>(start, intervals),
        steps_(steps_in_interval(intervals.length, step)),
        evaluations_(method.letters(), steps_, intervals.count),
        system_(system.separate()),
        stepper_(make_stepper(system_, method, intervals.length / static_cast<double>(steps_))) {}

 private:
  std::int64_t follow(phase_point<T, Eigen::Dynamic>& x, const path_place&,
                      std::span<vector<T, Eigen::Dynamic>>) override {
    const std::int64_t before = system_.calls();
    auto run = stepper_.open(x);
    stepper_.advance(run, steps_);
    x = stepper_.synchronous(run);
    return evaluations_(system_, before);
  }

  std::int64_t steps_;
  evaluations_of_interval evaluations_;
  model system_;
  stepper<model> stepper_;
};

/// A noise source that sums the noise it returns, over each part of a time.
template <class T>
struct summing_noise {
  static constexpr bool is_memoryless = false;
  const finer_noise* path;
  const detail::coarse_graining* coarse;
  vector<T, Eigen::Dynamic>* const* sum;

  void normals(const noise_place& at, vector<T, Eigen::Dynamic>& xi) const {
    path->normals(at, xi);
    if (*sum != nullptr) coarse->next(**sum, xi);
  }
};

/// Steps along a path whose noise was halved `halvings` times; as steps_run, each interval by itself.
template <class T>
class path_run final : public detail::reference_run<T> {
 public:
  path_run(const model& system, const nysalt::method& method, double step, int halvings,
           const phase_point<T, Eigen::Dynamic>& start, const detail::reference_intervals& intervals)
      : detail::reference_run<T>(start, intervals),
        parts_(std::max(intervals.noise_parts, 1)),
        steps_of_part_(steps_in_part(intervals.length, step, parts_)),
        evaluations_(method.letters(), steps_of_part_ * parts_, intervals.count),
        system_(system.separate()),
        step_(intervals.length / (static_cast<double>(steps_of_part_) * static_cast<double>(parts_))),
        path_(intervals.at.seed, std::ldexp(system.bath().friction() * step_, halvings), halvings),
        coarse_(system.bath().friction() * step_),
        stepper_(make_stepper(system_, method, step_, summing_noise<T>{&path_, &coarse_, &sum_})) {}

 private:
  std::int64_t follow(phase_point<T, Eigen::Dynamic>& x, const path_place& at,
                      std::span<vector<T, Eigen::Dynamic>> xi) override {
    const std::int64_t before = system_.calls();
    auto run = stepper_.open(x, at.trajectory);
    run.step = at.step * steps_of_part_ * parts_;
    for (std::int64_t k = 0; k < parts_; ++k) {
      sum_ = xi.empty() ? nullptr : &xi[static_cast<std::size_t>(k)];
      if (sum_ != nullptr) coarse_.first(*sum_);
      stepper_.advance(run, steps_of_part_);
      if (sum_ != nullptr) coarse_.last(*sum_, steps_of_part_);
    }
    x = stepper_.synchronous(run);
    return evaluations_(system_, before);
  }

  std::int64_t parts_;
  std::int64_t steps_of_part_;
  evaluations_of_interval evaluations_;
  model system_;
  double step_;
  finer_noise path_;
  detail::coarse_graining coarse_;
  vector<T, Eigen::Dynamic>* sum_ = nullptr;
  stepper<model, double, summing_noise<T>> stepper_;
};

/// Small steps; along paths if there is a number of halvings of the step with fresh noise.
class small_steps final : public detail::reference_kind {
 public:
  small_steps(double step, nysalt::method method, std::optional<int> halvings)
      : step_(step), method_(std::move(method)), halvings_(halvings) {}

  std::unique_ptr<detail::reference_run<double>> open(
      const model& system, const start_of_one& start,
      const detail::reference_intervals& intervals) const override {
    return opened<double>(system, start, intervals);
  }
  std::unique_ptr<detail::reference_run<detail::lanes>> open(
      const model& system, const start_of_lanes& start,
      const detail::reference_intervals& intervals) const override {
    return opened<detail::lanes>(system, start, intervals);
  }
  std::shared_ptr<const reference_kind> finer() const override {
    return std::make_shared<small_steps>(0.5 * step_, method_,
                                         halvings_ ? std::optional(*halvings_ + 1) : std::nullopt);
  }
  std::string description() const override {
    return fmt::format("{} with step {:.12g}", method_.name(), step_);
  }
  bool gives_noise() const override { return halvings_.has_value(); }

 private:
  template <class T>
  std::unique_ptr<detail::reference_run<T>> opened(const model& system,
                                                   const phase_point<T, Eigen::Dynamic>& start,
                                                   const detail::reference_intervals& intervals) const {
    if (halvings_) {
      return std::make_unique<path_run<T>>(system, method_, step_, *halvings_, start, intervals);
    }
    return std::make_unique<steps_run<T>>(system, method_, step_, start, intervals);
  }

  double step_;
  nysalt::method method_;
  std::optional<int> halvings_;
};

void require_step(const std::string& who, double step) {
  if (step > 0.0 && std::isfinite(step)) return;
  throw std::invalid_argument(fmt::format("{}: the step must be positive and finite, got {}", who, step));
}

}  // namespace

reference fine_steps(double step) { return fine_steps(step, method(srkn11b())); }

reference fine_steps(double step, const method& method) {
  require_step("fine_steps", step);
  return reference(std::make_shared<small_steps>(step, method, std::nullopt));
}

reference fine_paths(double step) { return fine_paths(step, method(baoab())); }

reference fine_paths(double step, const method& method) {
  require_step("fine_paths", step);
  if (const int letters = method.letters().stochastic_letters; letters != 1) {
    throw std::invalid_argument(
        fmt::format("fine_paths: the method must have one letter O, got {} with {}; take baoab or aboba",
                    method.name(), letters));
  }
  return reference(std::make_shared<small_steps>(step, method, 0));
}

}  // namespace nysalt
