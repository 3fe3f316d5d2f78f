// SPDX-License-Identifier: BSL-1.0
// What any system with a law of starts can do for the commands.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "bundled_system.hpp"
#include "catalogue.hpp"
#include "json.hpp"
#include "number.hpp"
#include "nysalt/analysis/error_measures/energy.hpp"
#include "nysalt/analysis/error_measures/exchange.hpp"
#include "nysalt/analysis/error_measures/path.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/analysis/evaluations.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/learner.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "observables.hpp"
#include "refusal.hpp"

namespace nysalt::program {

struct model_facts {
  json parameters;   // as scheme files hold them
  double frequency;  // times a fine step it is 5e-3 at most: the error of srkn11b is rounding then
  std::string default_observable;
};

/// Systems whose flow is known exactly: it is the reference unless a fine step is asked for.
template <class S>
inline constexpr bool has_exact_flow =
    std::is_same_v<S, harmonic_oscillator> || std::is_same_v<S, linear_chain>;

/// "b1=0.5" into the options. Throws refusal for what is not of that form, not a parameter, or named twice.
template <Family F>
void fix_parameter(const std::string& text, learn_options<F>& options) {
  const auto equals = text.find('=');
  const auto name = text.substr(0, equals);
  const auto value = equals == std::string::npos ? std::nullopt : number_from(text.substr(equals + 1));
  if (!value) refuse("--fix takes name=number, such as {}=0.5, not '{}'", F::parameter_names[0], text);
  const auto at = std::find(F::parameter_names.begin(), F::parameter_names.end(), name);
  if (at == F::parameter_names.end()) {
    refuse("--fix: the family {} has no parameter '{}': it has {}", F::name, name,
           listed(F::parameter_names));
  }
  const auto k = static_cast<std::size_t>(at - F::parameter_names.begin());
  auto& fixed = options.fixed[k];
  if (fixed) refuse("--fix: the parameter {} is fixed twice", name);
  fixed = value;
}

template <class S, Ensemble<S> E>
class bundled_model final : public bundled_system {
  static constexpr int width = lanes_of<S>;
  using T = scalar_of_lanes<width>;
  using lanes_state = phase_point<T, S::dimension>;
  using measure_type = error_measure<S::dimension, width>;

 public:
  bundled_model(S system, E law, model_facts facts)
      : system_(std::move(system)), law_(std::move(law)), facts_(std::move(facts)) {}

  std::string description() const override { return describe(system_); }
  nlohmann::ordered_json parameters() const override { return facts_.parameters; }
  std::vector<frequency_band> frequency_bands() const override { return system_.frequency_bands(); }
  std::vector<std::string> observables() const override { return observable_names(system_); }
  std::string default_observable() const override { return facts_.default_observable; }
  std::string law() const override { return law_.description(); }
  int lanes() const override { return width; }

  void require_learnable(const std::string& family, const learn_settings& how, double step) const override {
    fine_step_for(step, how.fine_step);
    const auto which = coordinates_named(how.coordinates);
    if (which != coordinates::qp) {
      if constexpr (HasModes<S>) {
        const bool still = (system_.modes().frequencies.array() == 0.0).any();
        if (which == coordinates::energy && still) {
          refuse(
              "the energy coordinates of {} do not exist, as it has a mode of frequency zero: take modes or "
              "qp",
              description());
        }
      } else {
        refuse("the {} coordinates of {} are not known, as it declares no modes: take qp", how.coordinates,
               description());
      }
    }
    with_family(family, [&]<class F>(F) { options_for<F>(how, 1); });
  }

  learned_scheme learn(const learn_plan& plan, const counter& progress) const override {
    require_learnable(plan.family, plan.how, plan.step);
    std::optional<learned_scheme> result;
    const auto with_reference = [&](const auto& reference) {
      const auto pairs = [&](std::uint64_t seed) {
        return make_flow_map_data(system_, law_, reference,
                                  {.step = plan.step,
                                   .horizon = plan.how.horizon,
                                   .trajectories = plan.how.trajectories,
                                   .seed = seed,
                                   .threads = plan.threads,
                                   .progress = progress});
      };
      const auto data = pairs(plan.seed);
      const auto held_out = pairs(plan.held_out_seed);
      with_family(plan.family, [&]<class F>(F family) {
        auto [method, fit] =
            nysalt::learn(family, system_, data, held_out, options_for<F>(plan.how, plan.threads));
        result.emplace(learned_scheme{std::move(fit), tabulated(method.anywhere()), data.energies});
      });
    };
    reference_for(plan.step, plan.how.fine_step, with_reference);
    return std::move(*result);
  }

  void require_measure(const std::string& metric, const std::string& name, const trajectories_plan& plan,
                       std::optional<double> fine_step) const override {
    const auto measure = measure_named(metric, name);
    require_room(options_of(plan), 1, measure.width);
    if (measure.needs_reference) fine_step_for(plan.step, fine_step);
  }

  trajectory_errors_result errors(const std::vector<tabulated>& methods, const trajectories_plan& plan,
                                  const std::string& metric, const std::string& name,
                                  std::optional<double> fine_step, const counter& progress) const override {
    const auto measure = measure_named(metric, name);
    trajectory_errors_result result;
    reference_for(plan.step, fine_step, [&](const auto& reference) {
      result = trajectory_errors(system_, reference, law_, methods, measure, options_of(plan, progress));
    });
    return result;
  }

  void run(const tabulated& method, const trajectories_plan& plan,
           const std::vector<std::string>& observables, std::int64_t sample_every,
           const std::function<void(std::int64_t, const record&)>& take,
           const counter& progress) const override {
    // Few trajectories would leave most lanes empty, and lanes of a large system would leave the cache.
    if (plan.count < width / 4 || size(system_) > 20'000) {
      run_over<double>(method, plan, observables, sample_every, take, progress);
    } else {
      run_over<T>(method, plan, observables, sample_every, take, progress);
    }
  }

  std::int64_t count_evaluations(const tabulated& method, const trajectories_plan& plan) const override {
    return evaluations_of_run(system_, method, plan.step, plan.steps, law_(plan.seed, 0));
  }

  std::function<void()> timed_run(const tabulated& method, const trajectories_plan& plan) const override {
    std::vector<lanes_state> starts;
    for (std::int64_t m = 0; m < plan.count; m += width) {
      const auto count = static_cast<int>(std::min<std::int64_t>(width, plan.count - m));
      starts.push_back(sound_starts<T>(system_, law_, plan.seed, m, count));
    }
    const auto stepper = make_stepper(system_, method, plan.step);
    return [stepper, starts = std::move(starts), steps = plan.steps] {
      for (const auto& start : starts) {
        auto run = stepper.open(start);
        stepper.advance(run, steps);
        end_of_run = lane(stepper.synchronous(run).q[0], 0);
      }
    };
  }

 private:
  inline static volatile double end_of_run = 0.0;  // so that no run can be left out as useless

  template <class P>
  void run_over(const tabulated& method, const trajectories_plan& plan,
                const std::vector<std::string>& observables, std::int64_t sample_every,
                const std::function<void(std::int64_t, const record&)>& take, const counter& progress) const {
    using states = phase_point<P, S::dimension>;
    std::vector<std::function<P(const states&)>> watched;
    for (const auto& name : observables) watched.push_back(observable<P>(system_, name));
    const auto read = [&](const states& x, std::span<P> values) {
      for (std::size_t i = 0; i < watched.size(); ++i) values[i] = watched[i](x);
    };
    const auto stepper = make_stepper(system_, method, plan.step);
    // In memory at a time: a million numbers, or a few blocks of long trajectories.
    const std::int64_t numbers = (plan.steps / sample_every + 1) * std::ssize(observables);
    const std::int64_t at_a_time =
        std::max<std::int64_t>(plan.threads, 1'000'000 / numbers / lanes_in<P>) * lanes_in<P>;
    for (std::int64_t first = 0; first < plan.count; first += at_a_time) {
      const std::int64_t count = std::min(at_a_time, plan.count - first);
      std::vector<record> records(static_cast<std::size_t>(count));
      const auto keep = [&](std::int64_t m, std::int64_t, std::span<const double> values) {
        auto& its = records[static_cast<std::size_t>(m - first)].values;
        its.insert(its.end(), values.begin(), values.end());
      };
      const ensemble_options options{.trajectories = count,
                                     .steps = plan.steps,
                                     .every = sample_every,
                                     .seed = plan.seed,
                                     .threads = plan.threads,
                                     .first = first,
                                     .progress = [&](std::int64_t done) {
                                       if (progress) progress(first + done);
                                     }};
      const auto diverged_at = integrate_ensemble<P>(stepper, law_, options, watched.size(), read, keep);
      for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].diverged_at = diverged_at[i];
        take(first + static_cast<std::int64_t>(i), records[i]);
      }
    }
  }

  static trajectory_options options_of(const trajectories_plan& plan, const counter& progress = {}) {
    return {.step = plan.step,
            .steps = plan.steps,
            .trajectories = plan.count,
            .seed = plan.seed,
            .threads = plan.threads,
            .progress = progress};
  }

  /// That of the reference, which divides the step; nothing where the flow is known exactly.
  std::optional<double> fine_step_for(double step, std::optional<double> asked) const {
    if (has_exact_flow<S> && !asked) return std::nullopt;
    const double steps = std::ceil(step * facts_.frequency / 5e-3 - 1e-9);  // 100.00000000000001 is 100
    const double fine = asked.value_or(step / std::max(1.0, steps));
    const double ratio = step / fine;
    if (!(std::round(ratio) >= 1.0) || !(std::abs(ratio - std::round(ratio)) <= 1e-9 * ratio)) {
      refuse(
          "the step {} is not an integer multiple of the fine step {}: choose a --fine-step that divides it",
          step, fine);
    }
    constexpr double most = 1e6;  // a million for one step: the program would seem to hang
    if (ratio > most) {
      refuse("the step {} holds {:g} fine steps of {:g}, more than {:g}: take a larger --fine-step", step,
             ratio, fine, most);
    }
    return fine;
  }

  /// Calls f(reference).
  void reference_for(double step, std::optional<double> asked, const auto& f) const {
    const auto fine = fine_step_for(step, asked);
    if constexpr (has_exact_flow<S>) {
      if (!fine) return f(exact_linear(system_));
    }
    f(fine_steps<>(*fine));
  }

  template <Family F>
  learn_options<F> options_for(const learn_settings& how, int threads) const {
    learn_options<F> options;
    options.threads = threads;
    options.coordinates = coordinates_named(how.coordinates);
    for (const auto& text : how.fix) fix_parameter<F>(text, options);
    auto theta = options.start;
    for (std::size_t k = 0; k < theta.size(); ++k) theta[k] = options.fixed[k].value_or(theta[k]);
    require_in_range<F>(theta);
    return options;
  }

  measure_type measure_named(const std::string& metric, const std::string& name) const {
    if (metric == "path") return path_measure(system_, observable<T>(system_, name));
    if (metric == "state") return state_measure(system_);
    if (metric == "energy") return energy_measure(system_);
    if (metric != "exchange") {
      refuse("unknown metric '{}': it is one of path, state, exchange, energy", metric);
    }
    if constexpr (HasStiffEnergies<S>) {
      return exchange_measure(system_);
    } else {
      refuse("the metric exchange is of stiff springs, which {} has not: take path, state or energy",
             description());
    }
  }

  S system_;
  E law_;
  model_facts facts_;
};

}  // namespace nysalt::program
