// SPDX-License-Identifier: BSL-1.0
// Answers of long computations as a work file keeps them: lists of their members, to the bit.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "json.hpp"
#include "nysalt/analysis/acceptance.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/judgement.hpp"
#include "nysalt/learning/fit_summary.hpp"
#include "work_file.hpp"

namespace nysalt::program {

/// What is kept of a fit: the family has the rest of its method.
struct kept_fit {
  fit_summary fit;
  std::vector<double> coefficients;
  std::optional<energy_range> energies;
};

/// The members of a value, in their order.
template <class T>
constexpr auto members_of(T& x) {
  using type = std::remove_const_t<T>;
  if constexpr (std::same_as<type, estimate>) {
    return std::tie(x.mean, x.standard_error);
  } else if constexpr (std::same_as<type, diverged_trajectory>) {
    return std::tie(x.trajectory, x.step);
  } else if constexpr (std::same_as<type, energy_range>) {
    return std::tie(x.low, x.high);
  } else if constexpr (std::same_as<type, tail>) {
    return std::tie(x.count, x.skewness, x.deciding);
  } else if constexpr (std::same_as<type, timed_job>) {
    return std::tie(x.least, x.median, x.rounds);
  } else if constexpr (std::same_as<type, acceptance_step>) {
    return std::tie(x.step, x.log_step, x.log_of_each, x.is_longest);
  } else if constexpr (std::same_as<type, acceptance_result>) {
    return std::tie(x.probability, x.of_each, x.diverged_at, x.evaluations_per_time);
  } else if constexpr (std::same_as<type, method_error::distribution>) {
    return std::tie(x.largest, x.median, x.quantiles);
  } else if constexpr (std::same_as<type, method_error>) {
    return std::tie(x.error, x.diverged, x.diverged_at, x.evaluations_per_time, x.of_each, x.own, x.spread);
  } else if constexpr (std::same_as<type, trajectory_errors_result>) {
    return std::tie(x.methods, x.reference_error, x.reference, x.null_model, x.predictable_until, x.unit);
  } else if constexpr (std::same_as<type, judgement::energy_errors>) {
    return std::tie(x.median, x.most, x.nearly_all, x.largest);
  } else if constexpr (std::same_as<type, judgement>) {
    return std::tie(x.step, x.trajectories, x.unconfined, x.steps, x.lost, x.diverged, x.exceeding,
                    x.first_lost, x.kinetic_energy, x.energy_was_watched, x.energy_error, x.drift, x.growth,
                    x.farthest, x.highest_frequency, x.frequencies, x.linear_objection, x.margin, x.resonance,
                    x.verdict, x.reason);
  } else if constexpr (std::same_as<type, fit_summary::fitted_parameter>) {
    return std::tie(x.name, x.value, x.standard_error, x.free);
  } else if constexpr (std::same_as<type, fit_summary::gap>) {
    return std::tie(x.low, x.high);
  } else if constexpr (std::same_as<type, fit_summary::failing_method>) {
    return std::tie(x.name, x.step, x.times_less, x.reason);
  } else if constexpr (std::same_as<type, fit_summary>) {
    return std::tie(x.family, x.system, x.reference, x.ensemble, x.coordinates, x.derivatives, x.step, x.seed,
                    x.held_out_seed, x.held_out_is_new, x.loss_name, x.loss_steps, x.trajectory_steps,
                    x.follows, x.is_of_data, x.parameters, x.errors_withheld, x.loss, x.held_out_loss,
                    x.held_out_start_loss, x.held_out_noise, x.samples, x.trajectories, x.held_out_samples,
                    x.expected_excess, x.deciding_trajectories, x.condition, x.flat_directions,
                    x.coordinates_used, x.dropped, x.starts_tried, x.from, x.iterations, x.guard, x.unguarded,
                    x.is_in_valley, x.is_at_no_bound, x.is_held_by_guard, x.gaps, x.one_step_error,
                    x.trajectory_error, x.reference_error, x.reference_checked, x.judgement,
                    x.highest_frequency, x.fitted_frequency, x.source_of_frequency, x.rival, x.rival_step,
                    x.rival_loss, x.loss_beside_rival, x.rival_noise, x.gains_nothing, x.failing_rival,
                    x.data_seconds, x.fit_seconds, x.learning_evaluations, x.usable, x.reason);
  } else {
    static_assert(std::same_as<type, kept_fit>, "a type whose members are not listed");
    return std::tie(x.fit, x.coefficients, x.energies);
  }
}

/// Converts into a member of any type; never called.
struct any_member {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor): an initialiser
};

/// Whether a type has more members than `Members`, which would be lost.
template <class T, class... Members>
consteval bool has_more_members(std::tuple<Members&...>*) {
  return requires {
    T{static_cast<std::conditional_t<true, any_member, Members>>(any_member())..., any_member()};
  };
}

template <class T>
inline constexpr bool is_list = false;
template <class T>
inline constexpr bool is_list<std::vector<T>> = true;
template <class T, std::size_t N>
inline constexpr bool is_list<std::array<T, N>> = true;
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

/// JSON has no number that is not finite: these are texts.
template <class T>
json written(const T& value) {
  if constexpr (std::floating_point<T>) {
    return std::isfinite(value) ? json(value) : json(fmt::format("{}", value));
  } else if constexpr (std::is_enum_v<T>) {
    return static_cast<int>(value);
  } else if constexpr (std::is_arithmetic_v<T> || std::same_as<T, std::string>) {
    return value;
  } else if constexpr (is_optional<T>) {
    return value ? json::array({written(*value)}) : json::array();
  } else {
    json all = json::array();
    if constexpr (is_list<T>) {
      for (const auto& one : value) all.push_back(written(one));
    } else {
      std::apply([&](const auto&... member) { (all.push_back(written(member)), ...); }, members_of(value));
    }
    return all;
  }
}

/// The value that was kept. Throws std::exception for what is not whole.
template <class T>
void read_back(const json& from, T& value) {
  if constexpr (std::floating_point<T>) {
    value =
        from.is_string() ? std::strtod(from.get_ref<const std::string&>().c_str(), nullptr) : from.get<T>();
  } else if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>(from.get<int>());
  } else if constexpr (std::is_arithmetic_v<T> || std::same_as<T, std::string>) {
    value = from.get<T>();
  } else if constexpr (is_optional<T>) {
    value.reset();
    if (!from.empty()) read_back(from.at(0), value.emplace());
  } else if constexpr (is_list<T>) {
    if constexpr (requires { value.resize(from.size()); }) value.resize(from.size());
    for (std::size_t i = 0; i < value.size(); ++i) read_back(from.at(i), value[i]);
  } else {
    static_assert(!has_more_members<T>(static_cast<decltype(members_of(value))*>(nullptr)),
                  "a member is not listed in members_of()");
    std::size_t i = 0;
    std::apply([&](auto&... member) { (read_back(from.at(i++), member), ...); }, members_of(value));
  }
}

/// What a work file keeps of a value of any of these types.
template <class T>
struct answer {
  T value;
};
template <class T>
json as_json(const answer<T>& one) {
  return written(one.value);
}

/// The answer to a question that decides all of it: that of work(), or what was kept of it in the work file,
/// if there is one.
template <class T>
T once(work_file* kept_in, const json& question, const auto& work) {
  if (kept_in == nullptr) return work();
  const auto read = [](const json& document) {
    answer<T> found;
    read_back(document, found.value);
    return found;
  };
  return kept_in
      ->once(question.dump(-1, ' ', false, json::error_handler_t::replace), read,
             [&] { return answer<T>{work()}; })
      .value;
}

}  // namespace nysalt::program
