// SPDX-License-Identifier: BSL-1.0

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "after_steps.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/losses/stationary_covariance.hpp"
#include "nysalt/losses/window_error.hpp"

namespace nysalt {

std::vector<after_steps_options> detail::after_each_step(int K, int shortest) {
  return {{.steps = {K}, .apart = std::max(1, shortest / 4)}, {.steps = {K}}};
}

namespace {

using made_loss = std::unique_ptr<const loss_on_data>;

template <Scalar R>
made_loss after_steps_of(const loss_kind::inputs& from, const window_error<R>& error) {
  return std::make_unique<const after_steps<R>>(from.family, from.system, from.data, error, from.how);
}

// state:K, the state's error after K steps.

made_loss of_states(const loss_kind::inputs& from) {
  return from.in_lanes ? after_steps_of(from, state_error<detail::lanes>(from.measure))
                       : after_steps_of(from, state_error<double>(from.measure));
}

}  // namespace

// energy:K, the energy's error after K steps.

namespace detail {

double scale_of_energies(const model& system, const flow_map_data& data) {
  if (!system.facts().has_energy_over_slopes) {
    throw std::invalid_argument(
        fmt::format("an energy loss: the potential must be a template over any scalar, got that of {}",
                    describe(system)));
  }
  std::vector<double> squares(data.trajectories(), 0.0);
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
      const double k = kinetic_energy<double>(system, data.start[n].p);
      squares[m] += k * k;
    }
  }
  return 1.0 / std::sqrt(data.share().sum(squares) / static_cast<double>(data.all_pairs()));
}

}  // namespace detail

namespace {

made_loss of_energies(const loss_kind::inputs& from) {
  return from.in_lanes ? after_steps_of(from, energy_error<detail::lanes>(from.system, from.data))
                       : after_steps_of(from, energy_error<double>(from.system, from.data));
}

// trajectory, the state's error at several times of whole trajectories.

/// Of the first stages, which find where minima lie and should cost little: two windows a trajectory.
after_steps_options at_first(std::vector<int> steps, int shortest) {
  const int apart = std::max(steps.back(), shortest / 2);
  return {.steps = std::move(steps), .apart = apart};
}

/// A step does not see the phase that errors add up to, and the end of a long trajectory sees it only
/// up to whole turns: so times grow from stage to stage, and all times of a stage count.
std::vector<after_steps_options> stages_of_trajectory(int, int shortest) {
  constexpr int times = 16;
  after_steps_options last;
  last.steps.clear();
  for (int k = 1; k <= times; ++k) {
    const int steps = std::max(1, static_cast<int>(std::lround(static_cast<double>(k) * shortest / times)));
    if (last.steps.empty() || last.steps.back() < steps) last.steps.push_back(steps);
  }
  last.apart = shortest;
  std::vector<after_steps_options> result;
  for (const auto& first : {std::vector{1, 2, 4}, std::vector{1, 4, 9, 16}}) {
    if (first.back() < shortest) result.push_back(at_first(first, shortest));
  }
  result.push_back(std::move(last));
  return result;
}

// covariance, the loss of the stationary distribution of a thermostatted word: no data are needed.

objective of_law(const model& system, const family& family, double step) {
  return detail::objective_of(stationary_covariance(system, family.letters, step), family);
}
// acceptance, the energy's error at several times of whole trajectories: what Metropolis' rule rejects by.

/// Lengths of proposals are random: up to the length of the data, each of several counts as much. Of
/// stationary starts so is every state of a trajectory, and proposals begin at four of them where they are
/// short enough.
std::vector<after_steps_options> stages_of_acceptance(int /*K*/, int shortest) {
  constexpr int times = 8;
  std::vector<after_steps_options> result;
  for (const int length : {std::max(1, shortest / 8), shortest}) {
    after_steps_options stage;
    stage.steps.clear();
    for (int k = 1; k <= times; ++k) {
      const int steps = std::max(1, static_cast<int>(std::lround(static_cast<double>(k) * length / times)));
      if (stage.steps.empty() || stage.steps.back() < steps) stage.steps.push_back(steps);
    }
    stage.apart = std::max(1, shortest / 4);
    if (length == shortest) stage.apart = shortest;
    result.push_back(std::move(stage));
  }
  return result;
}

// gaussian_acceptance, the mean energy error of proposals where forces are linear: no data are asked.

/// Number of oscillators by frequency: the modes; where none are declared, as many as there
/// are degrees of freedom, spread evenly over the bands.
std::map<double, double> spectrum_of(const model& system) {
  std::map<double, double> count_of;
  if (has_modes(system)) {
    for (const double omega : system.modes().frequencies) {
      if (omega > 0.0) count_of[omega] += 1.0;
    }
  } else if (system.facts().has_bands) {
    constexpr int points = 16;  // of a band, its midpoints
    const auto bands = system.frequency_bands();
    const double share = static_cast<double>(size(system)) / static_cast<double>(points * bands.size());
    for (const auto& [low, high] : bands) {
      for (int k = 0; k < points; ++k) {
        const double omega = low + (high - low) * (k + 0.5) / points;
        if (omega > 0.0 && std::isfinite(omega)) count_of[omega] += share;
      }
    }
  }
  if (count_of.empty()) {
    throw std::invalid_argument(fmt::format(
        "the loss gaussian_acceptance: the system must declare frequencies, got {}; take the loss "
        "acceptance, which asks states",
        describe(system)));
  }
  return count_of;
}

/// The argument of acceptance_at(): half of rho at h omega for each oscillator.
objective of_spectrum(const model& system, const family& family, double step) {
  if (!family.symmetric || family.letters.rotates() || family.letters.is_processed()) {
    throw std::invalid_argument(
        fmt::format("gaussian_acceptance: the family must be symmetric, without rotations and "
                    "processors, got {}; "
                    "take the loss acceptance, or a family such as bab3",
                    family.name));
  }
  return [family, step, count_of = spectrum_of(system)](const Eigen::VectorXd& theta) {
    const Eigen::Index parameters = theta.size();
    squares sum{0.0, Eigen::VectorXd::Zero(parameters), Eigen::MatrixXd::Zero(parameters, parameters)};
    const auto coefficients = family.coefficients(theta);
    const Eigen::MatrixXd jacobian = family.jacobian(theta);
    for (const auto& [omega, count] : count_of) {
      const auto defect = detail::energy_defect_on_oscillator(family.letters, coefficients, step * omega);
      const Eigen::VectorXd slope = jacobian.transpose() * defect.slopes;
      const double weight = 0.5 * count;
      sum.value += weight * defect.value * defect.value;
      sum.half_gradient += weight * defect.value * slope;
      sum.normal_matrix += weight * slope * slope.transpose();
    }
    return sum;
  };
}

std::shared_ptr<const loss_kind> row(loss_kind kind) {
  return std::make_shared<const loss_kind>(std::move(kind));
}

}  // namespace

// The table of all losses.

std::span<const std::shared_ptr<const loss_kind>> losses() {
  static const std::vector<std::shared_ptr<const loss_kind>> all{
      row({.name = "trajectory",
           .counts_steps = false,
           .judge = loss_kind::judge_of_minima::training_loss,
           .is_of_energy_norm = true,
           .is_shortened = true,
           .stages = stages_of_trajectory,
           .over_data = of_states}),
      row({.name = "state", .judge = loss_kind::judge_of_minima::held_out_end, .over_data = of_states}),
      row({.name = "energy", .is_for_sampling = true, .over_data = of_energies}),
      row({.name = "acceptance",
           .counts_steps = false,
           .is_of_proposals = true,
           .is_for_sampling = true,
           .stages = stages_of_acceptance,
           .over_data = of_energies}),
      row({.name = "gaussian_acceptance",
           .counts_steps = false,
           .is_of_proposals = true,
           .is_for_sampling = true,
           .stages = stages_of_acceptance,
           .over_data = of_energies,
           .without_data = of_spectrum}),
      row({.name = "covariance",
           .counts_steps = false,
           .needs_modes = true,
           .needs_bath = true,
           .over_data = of_states,
           .without_data = of_law})};
  return all;
}

// A loss of the user's.

namespace {

/// A summary must not take one loss for another, and names it in a line.
void require_name(const std::string& name) {
  std::vector<std::string_view> taken;
  for (const auto& kind : losses()) taken.push_back(kind->name);
  const bool is_taken = std::ranges::find(taken, name) != taken.end();
  if (!name.empty() && !is_taken && name.find_first_of("\n\r") == std::string::npos) return;
  const auto last = taken.back();
  taken.pop_back();
  throw std::invalid_argument(
      fmt::format("learn: the name of an own loss must be one line and none of {1} and {2}, got '{0}'", name,
                  fmt::join(taken, ", "), last));
}

template <Scalar R>
loss_choice choice_by_residuals(const std::string& name, int steps, const window_error<R>& error) {
  require_name(name);
  const auto over_data = [error](const loss_kind::inputs& from) { return after_steps_of(from, error); };
  return {row({.name = name, .is_for_sampling = true, .over_data = over_data}), steps};
}

}  // namespace

namespace detail {

loss_choice own_choice(const std::string& name, int steps, const window_error<lanes>& error) {
  return choice_by_residuals(name, steps, error);
}
loss_choice own_choice(const std::string& name, int steps, const window_error<double>& error) {
  return choice_by_residuals(name, steps, error);
}

}  // namespace detail

// A loss as text, and from it.

namespace {

/// The number K of steps, of decimal digits only; nothing for any other text.
std::optional<int> steps_in(std::string_view text) {
  int steps = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), steps);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || steps < 1 || text.front() == '0') return std::nullopt;
  return steps;
}

}  // namespace

std::string loss_choice::description() const {
  return kind->counts_steps ? fmt::format("{}:{}", kind->name, steps) : kind->name;
}

std::optional<loss_choice> detail::find_loss(std::string_view text) {
  const auto colon = text.find(':');
  for (const auto& kind : losses()) {
    if (kind->name != text.substr(0, colon)) continue;
    if (colon == std::string_view::npos) return loss_choice{kind, 1};
    const auto steps = kind->counts_steps ? steps_in(text.substr(colon + 1)) : std::nullopt;
    if (steps) return loss_choice{kind, *steps};
  }
  return std::nullopt;
}

loss_choice usual_loss(const bath& around) { return around.acts() ? loss_named("state:1") : loss_choice{}; }

loss_choice loss_named(std::string_view text) {
  if (const auto found = detail::find_loss(text)) return *found;
  throw std::invalid_argument(
      fmt::format("unknown loss '{}': it is one of {} with the number K of steps, and {}", text,
                  detail::loss_patterns(true), detail::loss_patterns(false)));
}

std::string detail::loss_patterns(bool count_steps) {
  std::string all;
  for (const auto& kind : losses()) {
    if (kind->counts_steps != count_steps) continue;
    all += fmt::format("{}{}{}", all.empty() ? "" : ", ", kind->name, count_steps ? ":K" : "");
  }
  return all;
}

}  // namespace nysalt
