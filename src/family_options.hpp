// SPDX-License-Identifier: BSL-1.0
// What the command line says of learning, as the learner of a family takes it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

#include "catalogue.hpp"
#include "number.hpp"
#include "nysalt/learner.hpp"
#include "refusal.hpp"
#include "settings.hpp"

namespace nysalt::program {

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

/// Throws refusal, or std::invalid_argument where a fixed value is out of range.
template <Family F>
learn_options<F> options_for(const learn_settings& how, int threads) {
  learn_options<F> options;
  options.threads = threads;
  options.coordinates = coordinates_named(how.coordinates);
  for (const auto& text : how.fix) fix_parameter<F>(text, options);
  auto theta = options.start;
  for (std::size_t k = 0; k < theta.size(); ++k) theta[k] = options.fixed[k].value_or(theta[k]);
  require_in_range<F>(theta);
  return options;
}

}  // namespace nysalt::program
