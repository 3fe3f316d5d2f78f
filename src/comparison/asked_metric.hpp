// SPDX-License-Identifier: BSL-1.0
// Metrics by which trajectories are judged.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace nysalt::program {

/// A metric, and of which observable, if it is of one.
struct asked_metric {
  std::string name;
  std::string observable = {};

  bool operator==(const asked_metric&) const = default;

  /// As it is typed: path:stiff_energy.
  std::string text() const {
    if (observable.empty()) return name;
    std::string typed = name;
    typed += ':';
    return typed += observable;
  }
  bool is_of_law() const { return name == "distribution" || name == "acf"; }
  bool is_acceptance() const { return name == "acceptance"; }
  bool is_along_paths() const { return !is_of_law() && !is_acceptance(); }
  /// Whether an error of the phase counts: of the state, or of a coordinate along a path.
  bool sees_phases() const;
  bool takes_observable() const { return name == "path" || name == "relative" || is_of_law(); }
  /// The name of its results.
  std::string value() const { return is_acceptance() ? "acceptance" : "error"; }
};

/// From NAME or NAME:OBSERVABLE; `otherwise` is the observable of a metric that names none. Throws refusal
/// where a metric takes no observable.
asked_metric metric_named(std::string_view text, const std::string& otherwise);

/// A sentence where all that is measured is of energies and methods are learned for states; else empty.
std::string advice_on_purpose(std::span<const asked_metric> metrics, const std::string& purpose);

}  // namespace nysalt::program
