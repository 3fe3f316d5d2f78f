// SPDX-License-Identifier: BSL-1.0
// References that take small steps by words as data.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nysalt/detail/any_reference.hpp"
#include "nysalt/noises/finer_noise.hpp"
#include "nysalt/noises/recorded_path.hpp"

namespace nysalt::detail {

namespace {

constexpr int dynamic = Eigen::Dynamic;

/// What one trajectory's steps cost, and those of `count`.
std::int64_t cost_of(const model& system, const run_time_word& word, std::int64_t steps, int count) {
  const std::int64_t all = word.evaluations_to_open + steps * word.evaluations_per_step;
  return count * evaluations_of(system, all, steps * word.force_derivatives);
}

std::int64_t whole_steps(double t, double step, std::int64_t parts, const char* refusal) {
  const double ratio = t / step / static_cast<double>(parts);
  const double steps = std::round(ratio);
  if (steps >= 1.0 && steps < 1e18 && std::abs(ratio - steps) <= 1e-9 * steps) {
    return static_cast<std::int64_t>(steps);
  }
  throw std::invalid_argument(fmt::format(fmt::runtime(refusal), t, parts, step));
}

template <class T>
class steps_run final : public reference_run<T> {
 public:
  steps_run(const model& system, const tabulated& method, double t, std::int64_t steps)
      : system_(system.separate()),
        word_(method.letters()),
        stepper_(make_stepper(system_, method, t / static_cast<double>(steps))),
        steps_(steps) {}

  std::int64_t advance(phase_point<T, dynamic>& x, int count, const path_place&,
                       std::span<vector<T, dynamic>>) override {
    const std::int64_t before = system_.calls();
    auto run = stepper_.open(x);
    stepper_.advance(run, steps_);
    x = stepper_.synchronous(run);
    if (is_black_box(system_)) return (system_.calls() - before) * count;
    return cost_of(system_, word_, steps_, count);
  }

 private:
  model system_;
  run_time_word word_;
  stepper<model, run_time_word> stepper_;
  std::int64_t steps_;
};

class steps_reference final : public any_reference {
 public:
  steps_reference(tabulated method, double step, std::string text)
      : method_(std::move(method)), step_(step), text_(std::move(text)) {}

  std::unique_ptr<reference_run<double>> prepare(const model& system, double t,
                                                 std::type_identity<double>) const override {
    return prepared<double>(system, t);
  }
  std::unique_ptr<reference_run<lanes>> prepare(const model& system, double t,
                                                std::type_identity<lanes>) const override {
    return prepared<lanes>(system, t);
  }
  std::shared_ptr<const any_reference> finer() const override {
    return small_steps(method_, 0.5 * step_,
                       fmt::format("{} with step {:.12g}", method_.name(), 0.5 * step_));
  }
  std::string description() const override { return text_; }
  bool tells_noise() const override { return false; }

 private:
  template <class T>
  std::unique_ptr<reference_run<T>> prepared(const model& system, double t) const {
    const auto steps =
        whole_steps(t, step_, 1, "fine_steps: the time {0} is not a multiple of the fine step {2}");
    return std::make_unique<steps_run<T>>(system, method_, t, steps);
  }

  tabulated method_;
  double step_;
  std::string text_;
};

/// Adds up the noise that it hands out.
template <class T>
struct recorder {
  static constexpr bool draws_freely = false;
  const finer_noise* path;
  const coarse_graining* coarse;
  vector<T, dynamic>* const* sum;

  void normals(const noise_place& at, vector<T, dynamic>& xi) const {
    path->normals(at, xi);
    if (*sum != nullptr) coarse->next(**sum, xi);
  }
};

template <class T>
class paths_run final : public reference_run<T> {
 public:
  paths_run(const model& system, const tabulated& method, double step, int halvings, double t)
      : system_(system.separate()), method_(method), step_(step), halvings_(halvings), t_(t) {}

  std::int64_t advance(phase_point<T, dynamic>& x, int count, const path_place& at,
                       std::span<vector<T, dynamic>> xi) override {
    const std::int64_t before = system_.calls();
    const std::int64_t parts = std::max<std::int64_t>(std::ssize(xi), 1);
    const std::int64_t of_a_part = whole_steps(
        t_, step_, parts,
        "fine_paths: the time {} in {} equal parts, as the noise is wanted, is not a multiple of the fine "
        "step {}");
    const double h = t_ / static_cast<double>(of_a_part * parts);
    const double friction = system_.bath().friction();
    const finer_noise path(at.seed, std::ldexp(friction * h, halvings_), halvings_);
    const coarse_graining coarse(friction * h);
    vector<T, dynamic>* sum = nullptr;
    const auto fine = make_stepper(system_, method_, h, recorder<T>{&path, &coarse, &sum});
    auto run = fine.open(x, at.trajectory);
    run.step = at.step * parts * of_a_part;
    for (std::int64_t k = 0; k < parts; ++k) {
      sum = xi.empty() ? nullptr : &xi[static_cast<std::size_t>(k)];
      if (sum != nullptr) coarse.first(*sum);
      fine.advance(run, of_a_part);
      if (sum != nullptr) coarse.last(*sum, of_a_part);
    }
    x = fine.synchronous(run);
    if (is_black_box(system_)) return (system_.calls() - before) * count;
    return cost_of(system_, method_.letters(), parts * of_a_part, count);
  }

 private:
  model system_;
  tabulated method_;
  double step_;
  int halvings_;
  double t_;
};

class paths_reference final : public any_reference {
 public:
  paths_reference(tabulated method, double step, int halvings, std::string text)
      : method_(std::move(method)), step_(step), halvings_(halvings), text_(std::move(text)) {}

  std::unique_ptr<reference_run<double>> prepare(const model& system, double t,
                                                 std::type_identity<double>) const override {
    return std::make_unique<paths_run<double>>(system, method_, step_, halvings_, t);
  }
  std::unique_ptr<reference_run<lanes>> prepare(const model& system, double t,
                                                std::type_identity<lanes>) const override {
    return std::make_unique<paths_run<lanes>>(system, method_, step_, halvings_, t);
  }
  std::shared_ptr<const any_reference> finer() const override {
    return small_steps_on_paths(method_, 0.5 * step_, halvings_ + 1,
                                fmt::format("{} with step {:.12g}", method_.name(), 0.5 * step_));
  }
  std::string description() const override { return text_; }
  bool tells_noise() const override { return true; }

 private:
  tabulated method_;
  double step_;
  int halvings_;
  std::string text_;
};

}  // namespace

std::shared_ptr<const any_reference> small_steps(const tabulated& method, double step,
                                                 const std::string& description) {
  return std::make_shared<steps_reference>(method, step, description);
}

std::shared_ptr<const any_reference> small_steps_on_paths(const tabulated& method, double step, int halvings,
                                                          const std::string& description) {
  return std::make_shared<paths_reference>(method, step, halvings, description);
}

}  // namespace nysalt::detail
