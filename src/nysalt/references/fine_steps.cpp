// SPDX-License-Identifier: BSL-1.0
// References that take small steps by words as data.
#include <fmt/format.h>

#include <stdexcept>

#include "nysalt/detail/any_reference.hpp"
#include "nysalt/references/fine_steps.hpp"

namespace nysalt::detail {

namespace {

/// Cost of one trajectory's steps, and of those of `count`.
std::int64_t cost_of(const model& system, const run_time_word& word, std::int64_t steps, int count) {
  const std::int64_t all = word.evaluations_to_open + steps * word.evaluations_per_step;
  return count * evaluations_of(system, all, steps * word.force_derivatives);
}

template <class T>
class steps_run final : public reference_run<T> {
 public:
  steps_run(const model& system, const tabulated& method, double t, std::int64_t steps)
      : system_(system.separate()),
        word_(method.letters()),
        stepper_(make_stepper(system_, method, t / static_cast<double>(steps))),
        steps_(steps) {}

  std::int64_t advance(phase_point<T, Eigen::Dynamic>& x, int count, const path_place&,
                       std::span<vector<T, Eigen::Dynamic>>) override {
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
  stepper<model> stepper_;
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
  bool gives_noise() const override { return false; }

 private:
  template <class T>
  std::unique_ptr<reference_run<T>> prepared(const model& system, double t) const {
    const auto steps = whole_steps(t, step_);
    if (!steps) {
      throw std::invalid_argument(
          fmt::format("fine_steps: the time must be a multiple of the fine step, got {} and {}", t, step_));
    }
    return std::make_unique<steps_run<T>>(system, method_, t, *steps);
  }

  tabulated method_;
  double step_;
  std::string text_;
};

template <class T>
class paths_run final : public reference_run<T> {
 public:
  paths_run(const model& system, const tabulated& method, double step, int halvings, double t)
      : system_(system.separate()), method_(method), step_(step), halvings_(halvings), t_(t) {}

  std::int64_t advance(phase_point<T, Eigen::Dynamic>& x, int count, const path_place& at,
                       std::span<vector<T, Eigen::Dynamic>> xi) override {
    const std::int64_t before = system_.calls();
    const std::int64_t steps = advance_on_path(system_, method_, step_, halvings_, x, t_, at, xi);
    if (is_black_box(system_)) return (system_.calls() - before) * count;
    return cost_of(system_, method_.letters(), steps, count);
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
  bool gives_noise() const override { return true; }

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
