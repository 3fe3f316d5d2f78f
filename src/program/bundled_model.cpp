// SPDX-License-Identifier: BSL-1.0
#include "bundled_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "catalogue.hpp"
#include "family_options.hpp"
#include "json.hpp"
#include "learnable.hpp"
#include "model_reference.hpp"
#include "nysalt/analysis/ensemble_statistics.hpp"
#include "nysalt/analysis/error_measures/energy.hpp"
#include "nysalt/analysis/error_measures/exchange.hpp"
#include "nysalt/analysis/error_measures/path.hpp"
#include "nysalt/analysis/error_measures/relative.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/analysis/evaluations.hpp"
#include "nysalt/derivatives/stiffness_along.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/gibbs_of_modes.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/one_long_trajectory.hpp"
#include "nysalt/ensembles/typical_and_energetic.hpp"
#include "nysalt/learning/make_problem.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "observables.hpp"
#include "refusal.hpp"
#include "run_in_waves.hpp"
#include "world.hpp"

namespace nysalt::program {

namespace {

constexpr int dynamic = Eigen::Dynamic;

class bundled_model final : public bundled_system {
  using states_in_double = std::vector<phase_point<double, dynamic>>;

 public:
  bundled_model(const made_system& made, const std::vector<named_value>& parameters,
                const surroundings& conditions)
      : system_(made.system),
        made_(made),
        parameters_(parameters),
        start_(conditions.start),
        law_(made.starts) {
    if (conditions.spread != 1.0) parameters_.push_back({"spread", conditions.spread});
    if (start_ != start::law && !has_frequency_bands(system_)) {
      refuse(
          "{}: its frequencies have no bound, and its motion in a bath no stationary law: take --start law",
          description());
    }
    if (start_ == start::law) starts_.emplace(law_);
  }

  std::string description() const override { return describe(system_); }
  std::int64_t dimension() const override { return size(system_); }
  double energy(std::span<const double> q, std::span<const double> p) const override {
    return nysalt::energy<double>(system_, state_of(q, p));
  }
  void force(std::span<const double> q, std::span<double> f) const override {
    auto forces = make_vector<double>(system_);
    nysalt::force<double>(system_, vector_of(q), forces);
    std::copy_n(forces.data(), forces.size(), f.begin());
  }
  nlohmann::ordered_json parameters() const override {
    json all;
    for (const auto& [name, value] : parameters_) {
      json& entry = all[name];
      std::visit([&](const auto& known) { entry = known; }, value);
    }
    if (!system_.bath().acts()) return all;
    all["friction"] = system_.bath().friction();
    all["sigma"] = system_.bath().sigma();
    return all;
  }
  const bath& heat_bath() const override { return system_.bath(); }
  std::vector<frequency_band> frequency_bands() const override { return system_.frequency_bands(); }
  std::optional<double> frequency_to_fit() const override {
    if (!has_modes(system_) && !has_frequency_bands(system_)) return std::nullopt;
    return detail::frequency_to_fit(system_);
  }
  std::vector<std::string> observables() const override { return observable_names(made_); }
  void require_observable(const std::string& name) const override { observable(made_, name); }
  std::string default_observable() const override { return made_.default_observable; }
  std::string starts() const override { return starts_ ? starts_->description() : law_.description(); }
  void prepare_starts(std::uint64_t seed) override {
    if (starts_) return;
    const model alone = system_.alone();
    try {
      if (start_ == start::gibbs && made_.has_exact_flow) {
        starts_.emplace(gibbs_of_modes<dynamic>(alone, system_.bath().temperature()));
      } else if (start_ == start::gibbs) {
        starts_.emplace(gibbs(system_, law_));
      } else {
        starts_.emplace(one_long_trajectory<dynamic>(system_, law_, {.seed = seed}));
      }
    } catch (const std::runtime_error& problem) {
      refuse("{}; take another temperature, or --start law", problem.what());
    }
  }
  void start_state(std::uint64_t seed, std::uint64_t n, std::span<double> q,
                   std::span<double> p) const override {
    const auto state = (*starts_)(seed, n);
    std::copy_n(state.q.data(), state.q.size(), q.begin());
    std::copy_n(state.p.data(), state.p.size(), p.begin());
  }
  int lanes() const override { return system_.facts().in_lanes ? default_lanes : 1; }

  void require_served(const run_time_word& word) const override {
    try {
      nysalt::require_served<model, double>(word, system_);
    } catch (const std::invalid_argument& problem) {
      refuse("{}", problem.what());
    }
  }

  double frequency_of_law() const override { return made_.frequency; }
  std::optional<double> frequency_along_starts(std::uint64_t seed, std::uint64_t count) const override {
    constexpr Eigen::Index most = 1000;
    {
      if (size(system_) > most || !has_quadratic_kinetic(system_)) return std::nullopt;
      states_in_double states;
      for (std::uint64_t n = 0; n < count; ++n) {
        states.push_back(starts_ ? (*starts_)(seed, n) : law_(seed, n));
      }
      try {
        return stiffness_along(system_, states).highest_frequency();
      } catch (const std::invalid_argument&) {  // the force is not finite there: the run will tell
        return std::nullopt;
      }
    }
  }

  stability_guard guard(bool rotations) const override {
    const auto states = typical_and_energetic_starts(system_, law_, 1, 0, 64);
    return stability_guard(system_, states, rotations);
  }

  trial_result trial(const tabulated& method, const trajectories_plan& plan) const override {
    states_in_double states = starts_
                                  ? typical_and_energetic_starts(system_, *starts_, plan.seed, 0, plan.count)
                                  : typical_and_energetic_starts(system_, law_, plan.seed, 0, plan.count);
    if (std::ssize(states) > plan.count) states.resize(static_cast<std::size_t>(plan.count));
    return trial_run(system_, method, plan.step, repeated_in_bath(system_, states),
                     {.steps = plan.steps, .seed = plan.seed, .threads = plan.threads});
  }

  void require_learnable(const std::string& name, std::optional<placement> where, const learn_settings& how,
                         double step) const override {
    const run_time_family family = placed(name, where);
    require_served(family.letters);
    reference().fine_step(step, how.fine_step, noise_parts(family));
    const auto which = coordinates_named(how.coordinates);
    if (which != coordinates::qp) {
      if (has_modes(system_)) {
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
    const auto options = options_for(family, how, 1);
    const bool of_law = options.loss.of == loss_choice::kind::covariance;
    const double horizon = how.horizon_at(step);
    if (!of_law && static_cast<double>(options.loss.steps) * step > horizon * (1.0 + 1e-9)) {
      refuse("a loss over {} steps of {} does not fit into trajectories of length {}: take a longer horizon",
             options.loss.steps, step, horizon);
    }
    if (of_law && !has_modes(system_))
      refuse("the covariance loss needs modes, which {} does not declare", description());
    if (of_law && !system_.bath().has_temperature()) {
      refuse(
          "the covariance loss is that of a law: it needs a bath, --friction with --temperature or --sigma");
    }
  }

  std::int64_t most_trajectories(const learn_plan& plan) const override {
    const data_options options{.step = plan.step,
                               .horizon = plan.how.horizon_at(plan.step),
                               .noise_parts = noise_parts(placed(plan.family, plan.where))};
    return nysalt::most_trajectories(options, size(system_));
  }

  learnable make_learnable(const learn_plan& plan, const counter& progress) const override {
    require_learnable(plan.family, plan.where, plan.how, plan.step);
    const run_time_family family = placed(plan.family, plan.where);
    const int parts = noise_parts(family);
    fit_options options = options_for(family, plan.how, plan.threads);
    options.seed = plan.seed;
    if (!plan.from.empty()) {
      const Eigen::VectorXd theta =
          Eigen::Map<const Eigen::VectorXd>(plan.from.data(), std::ssize(plan.from));
      if (plan.from_there_alone) {
        options.start = theta;
        options.random_starts = 0;
      } else {
        options.further_starts.push_back({"a step nearby", theta});
      }
    }
    using two_sets = std::array<flow_map_data, 2>;
    two_sets fresh;
    auto* kept = plan.kept ? std::any_cast<two_sets>(plan.kept.get()) : nullptr;
    if (plan.kept && kept == nullptr) kept = &plan.kept->template emplace<two_sets>();
    auto& data = (kept != nullptr ? *kept : fresh)[0];
    auto& held_out = (kept != nullptr ? *kept : fresh)[1];
    const auto reference_solution = reference().at(plan.step, plan.how.fine_step, parts);
    const auto make = [&](auto& pairs, std::uint64_t seed) {
      detail::extend_data(system_, *starts_, reference_solution.held(),
                          {.step = plan.step,
                           .horizon = plan.how.horizon_at(plan.step),
                           .trajectories = plan.how.trajectories,
                           .seed = seed,
                           .noise_parts = parts,
                           .threads = plan.threads,
                           .ranks = &world(),
                           .progress = progress},
                          pairs);
    };
    make(data, plan.seed);
    make(held_out, plan.held_out_seed);
    return {make_learning_problem(family, system_, data, held_out, options), data.energies};
  }

  void require_measure(const asked_metric& metric, const trajectories_plan& plan,
                       std::optional<double> fine_step, int noise_parts) const override {
    if (metric.is_of_law()) {
      observable(made_, metric.observable);
      reference().fine_step_for_statistics(plan.step, fine_step);
      return;
    }
    if (metric.is_acceptance()) {
      if (system_.bath().acts()) {
        refuse("the metric acceptance says nothing in a bath, which changes H: leave --friction away");
      }
      require_room(options_of(plan), 1, 1);
      return;
    }
    const auto measure = measure_named(metric);
    require_room(options_of(plan), 1, measure.width);
    if (measure.needs_reference) reference().fine_step(plan.step, fine_step, noise_parts);
  }

  std::vector<trajectory_errors_result> errors(const std::vector<tabulated>& methods, const errors_plan& plan,
                                               const counter& progress) const override {
    std::vector<error_measure> measures;
    for (const auto& metric : plan.metrics) measures.push_back(measure_named(metric));
    trajectory_options options = options_of(plan.trajectories, progress);
    options.null_model = plan.null_model;
    options.perturbation = plan.perturbation;
    const int parts = nysalt::detail::parts_of_noise(system_, methods);
    const auto reference_solution = reference().at(plan.trajectories.step, plan.fine_step, parts);
    return trajectory_errors(system_, reference_solution, *starts_, methods,
                             std::span<const error_measure>(measures), options);
  }

  acceptance_result acceptance(const tabulated& method, const trajectories_plan& plan, double temperature,
                               const counter& progress) const override {
    return nysalt::acceptance(system_, method, *starts_, options_of(plan, progress), temperature);
  }

  std::vector<double> values_at_starts(const trajectories_plan& plan,
                                       const std::string& name) const override {
    const auto value = observable(made_, name);
    constexpr std::int64_t enough = 1000;
    std::vector<double> values;
    nysalt::detail::with_scalar_of(system_, [&]<class T>(T) {
      for (std::int64_t m = 0; m < std::min(plan.count, enough); m += lanes_in<T>) {
        const auto x = sound_starts<T>(system_, *starts_, plan.seed, m, lanes_in<T>);
        for (int k = 0; k < lanes_in<T>; ++k) values.push_back(value(lane(x, k)));
      }
    });
    return values;
  }

  gathered_statistics statistics(const tabulated& method, const statistics_plan& plan,
                                 const std::string& name, const counter& progress) const override {
    const auto& trajectories = plan.trajectories;
    const auto stepper = make_stepper(system_, method, trajectories.step, counter_noise(trajectories.seed));
    const ensemble_options options{.trajectories = trajectories.count,
                                   .steps = trajectories.steps,
                                   .every = plan.every,
                                   .seed = trajectories.seed,
                                   .threads = trajectories.threads,
                                   .first = plan.first,
                                   .progress = progress,
                                   .ranks = &world()};
    // Half a step on is where B(1/2) at the beginning of a word leads.
    const bool leaps = method.letters().letters().front() == kick::letter && method.coefficients()[0] == 0.5;
    const statistics_wanted wanted{.histogram = plan.bins,
                                   .lags = plan.lags,
                                   .moments = true,
                                   .kinetic_temperature = plan.bins.has_value(),
                                   .half_step_kinetic_temperature = plan.bins && leaps};
    return ensemble_statistics(stepper, *starts_, options, over_lanes(observable(made_, name)), wanted);
  }

  gathered_statistics reference_statistics(const statistics_plan& plan, const std::string& name,
                                           std::optional<double> fine_step,
                                           const counter& progress) const override {
    const double fine = reference().fine_step_for_statistics(plan.trajectories.step, fine_step);
    const auto finer = std::llround(plan.trajectories.step / fine) * plan.finer;
    statistics_plan fine_plan = plan;
    fine_plan.trajectories.step = plan.trajectories.step / static_cast<double>(finer);
    fine_plan.trajectories.steps *= finer;
    fine_plan.every *= finer;
    return statistics(method_of_reference(), fine_plan, name, progress);
  }
  double fastest_rate() const override { return reference().fastest(); }
  std::optional<double> fine_step_for_ranking(double step) const override {
    return reference().fine_step_for_ranking(step);
  }
  std::string reference_of_statistics(double step, std::optional<double> fine_step) const override {
    return fmt::format("{} with step {:.12g}", method_of_reference().name(),
                       reference().fine_step_for_statistics(step, fine_step));
  }

  void run(const tabulated& method, const sampled_plan& plan,
           const std::function<void(std::int64_t, const record&)>& take,
           const counter& progress) const override {
    run_from(*starts_, method, plan, take, progress);
  }

  void integrate(const tabulated& method, const trajectories_plan& plan, std::span<double> q,
                 std::span<double> p, const counter& progress) const override {
    const auto n = static_cast<std::size_t>(size(system_));
    const auto count = static_cast<std::size_t>(plan.count);
    states_in_double states;
    for (std::size_t m = 0; m < count; ++m) {
      states.push_back(state_of(q.subspan(m * n, n), p.subspan(m * n, n)));
      if (!is_finite(states.back())) {
        refuse("the state of trajectory {} is not finite: {}", m, detail::not_finite_in(states.back()));
      }
    }
    sampled_plan sampled{.trajectories = plan, .observables = {}, .every = plan.steps};
    for (std::size_t i = 1; i <= n; ++i) sampled.observables.push_back(fmt::format("q{}", i));
    for (std::size_t i = 1; i <= n; ++i) sampled.observables.push_back(fmt::format("p{}", i));
    sampled.stretch = short_stretch(size(system_));
    sampled.reached = [](const standing&) {};
    std::ranges::fill(q, std::numeric_limits<double>::quiet_NaN());
    std::ranges::fill(p, std::numeric_limits<double>::quiet_NaN());
    const auto take = [&](std::int64_t m, const record& segment) {
      const auto sample =
          std::ssize(segment.values) / std::ssize(sampled.observables) - 1;  // the last sample of the segment
      if (segment.first + sample * plan.steps < plan.steps) return;
      const auto from = segment.values.end() - std::ssize(sampled.observables);
      std::copy_n(from, n, q.begin() + m * static_cast<std::ptrdiff_t>(n));
      std::copy_n(from + static_cast<std::ptrdiff_t>(n), n, p.begin() + m * static_cast<std::ptrdiff_t>(n));
    };
    run_from(nysalt::listed<dynamic>(std::move(states)), method, sampled, take, progress);
  }

  int derivative_calls() const override { return system_.facts().derivative_calls; }

  std::int64_t count_evaluations(const tabulated& method, const trajectories_plan& plan) const override {
    return evaluations_of_run(system_, method, plan.step, plan.steps, (*starts_)(plan.seed, 0));
  }

  std::function<void()> timed_run(const tabulated& method, const trajectories_plan& plan) const override {
    const auto stepper = make_stepper(system_, method, plan.step, counter_noise(plan.seed));
    return nysalt::detail::with_scalar_of(system_, [&]<class T>(T) -> std::function<void()> {
      std::vector<phase_point<T, dynamic>> starts;
      for (std::int64_t m = 0; m < plan.count; m += lanes_in<T>) {
        const auto count = static_cast<int>(std::min<std::int64_t>(lanes_in<T>, plan.count - m));
        starts.push_back(sound_starts<T>(system_, *starts_, plan.seed, m, count));
      }
      return [stepper, starts = std::move(starts), steps = plan.steps] {
        for (const auto& start : starts) {
          auto run = stepper.open(start);
          stepper.advance(run, steps);
          end_of_run = lane(stepper.synchronous(run).q[0], 0);
        }
      };
    });
  }

 private:
  vector<double, dynamic> vector_of(std::span<const double> numbers) const {
    auto result = make_vector<double>(system_);
    std::copy_n(numbers.begin(), result.size(), result.data());
    return result;
  }
  phase_point<double, dynamic> state_of(std::span<const double> q, std::span<const double> p) const {
    return {vector_of(q), vector_of(p)};
  }

  void run_from(const initial_states& starts, const tabulated& method, const sampled_plan& plan,
                const std::function<void(std::int64_t, const record&)>& take, const counter& progress) const {
    // Few trajectories would leave most lanes empty, and lanes of a large system would leave the cache.
    const bool fills_lanes = plan.trajectories.count >= default_lanes / 4 && size(system_) <= 20'000;
    if (!fills_lanes || !system_.facts().in_lanes) {
      run_in_waves<double>(made_, starts, method, plan, take, progress, world());
    } else {
      run_in_waves<nysalt::detail::lanes>(made_, starts, method, plan, take, progress, world());
    }
  }

  inline static volatile double end_of_run = 0.0;  // so that no run can be left out as useless

  static trajectory_options options_of(const trajectories_plan& plan, const counter& progress = {}) {
    return {.step = plan.step,
            .steps = plan.steps,
            .trajectories = plan.count,
            .seed = plan.seed,
            .threads = plan.threads,
            .progress = progress,
            .ranks = &world(),
            .horizon = plan.horizon};
  }

  model_reference reference() const {
    return {system_.bath(), made_.frequency, made_.fine_angle, made_.has_exact_flow, made_.exact};
  }
  tabulated method_of_reference() const {
    return system_.bath().acts() ? tabulated(baoab{}) : tabulated(srkn11b{});
  }

  /// In which noise is wanted to learn with.
  int noise_parts(const run_time_family& family) const {
    if (system_.bath().sigma() == 0.0) return 0;
    return intervals_of_noise(family.letters, family.coefficients(family.starts.front().theta)).parts;
  }

  error_measure measure_named(const asked_metric& metric) const {
    if (metric.name == "path") return path_measure(system_, over_lanes(observable(made_, metric.observable)));
    if (metric.name == "relative")
      return relative_measure(system_, over_lanes(observable(made_, metric.observable)));
    if (metric.name == "state") return state_measure(system_);
    if (metric.name == "energy") {
      if (system_.bath().acts())
        refuse("the metric energy says nothing in a bath, which changes H: take path");
      return energy_measure(system_);
    }
    if (metric.name != "exchange") {
      refuse(
          "unknown metric '{}': it is one of path, relative, state, exchange, energy, acceptance, "
          "distribution, acf",
          metric.name);
    }
    if (made_.springs.pairs > 0) {
      return exchange_measure(sprung_system{made_.springs});
    } else {
      refuse("the metric exchange is of stiff springs, which {} has not: take path, state or energy",
             description());
    }
  }

  /// What exchanges of energies ask of a system.
  struct sprung_system {
    static constexpr int dimension = dynamic;
    nysalt::detail::stiff_springs springs;

    Eigen::Index size() const { return 0; }
    template <class U>
    void force(const vector<U, dynamic>&, vector<U, dynamic>&) const {}  // stepped by nobody
    Eigen::Index pairs() const { return springs.pairs; }
    template <class U>
    U stiff_energy(const phase_point<U, dynamic>& x, Eigen::Index j) const {
      return springs.energy(x, j);
    }
  };

  model system_;
  made_system made_;
  std::vector<named_value> parameters_;
  start start_;
  initial_states law_;
  std::optional<initial_states> starts_;
};

}  // namespace

std::unique_ptr<bundled_system> make_bundled(const made_system& made,
                                             const std::vector<named_value>& parameters,
                                             const surroundings& conditions) {
  return std::make_unique<bundled_model>(made, parameters, conditions);
}

}  // namespace nysalt::program
