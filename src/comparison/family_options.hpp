// SPDX-License-Identifier: BSL-1.0
// Options of learning on the command line, as the learner of a family takes them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

#include "catalogue.hpp"
#include "number.hpp"
#include "nysalt/learn.hpp"
#include "refusal.hpp"
#include "settings.hpp"

namespace nysalt::program {

/// "b1=0.5" into the options. Throws refusal for what is not of that form, not a parameter, or named twice.
inline void fix_parameter(const family& family, const std::string& text, fit_options& options) {
  const auto& names = family.parameter_names;
  const auto equals = text.find('=');
  const auto name = text.substr(0, equals);
  const auto value = equals == std::string::npos ? std::nullopt : number_from(text.substr(equals + 1));
  if (!value) refuse_value("fix", "must be name=number, such as {}=0.5, got '{}'", names[0], text);
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) {
    refuse_value("fix", "must name a parameter of the family {}, got '{}': it has {}", family.name, name,
                 listed(names));
  }
  auto& fixed = options.fixed[static_cast<std::size_t>(at - names.begin())];
  if (fixed) refuse_value("fix", "must name different parameters, got {} twice", name);
  fixed = value;
}

/// Throws refusal, or std::invalid_argument where a fixed value is out of range.
inline fit_options options_for(const family& family, const learning_options& how, int threads) {
  fit_options options;
  options.execution.threads = threads;
  if (!how.coordinates.empty()) options.coordinates = coordinates_named(how.coordinates);
  if (!how.loss.empty()) options.loss = loss_named(how.loss);
  options.effort = effort_named(how.effort);
  if (how.random_starts) options.random_starts = static_cast<int>(*how.random_starts);
  options.fixed.resize(family.parameter_names.size());
  for (const auto& text : how.fix) fix_parameter(family, text, options);
  auto theta = family.starts.front().theta;
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    theta[k] = options.fixed[static_cast<std::size_t>(k)].value_or(theta[k]);
  }
  detail::require_in_range(family, theta);
  return options;
}

}  // namespace nysalt::program
