// SPDX-License-Identifier: BSL-1.0
#include "nysalt/system_declaration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "nysalt/core/sentence.hpp"

namespace nysalt {

namespace {

double as_real(const parameter_value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::get<double>(value);
}

std::string text_of(const parameter_value& value) {
  return std::visit([](const auto& known) { return sentence("{}", known); }, value);
}

std::string text_of_bound(const detail::declared_parameter& parameter, double bound) {
  return parameter.is_whole() ? sentence("{}", static_cast<std::int64_t>(bound)) : sentence("{}", bound);
}

}  // namespace

void detail::declared_parameter::require(const parameter_value& value) const {
  if (is_text()) return;  // what makes the system judges it
  const double x = as_real(value);
  const auto refuse = [&](const std::string& condition) {
    throw std::invalid_argument(sentence("{} must be {}, got {}", name, condition, text_of(value)));
  };
  if (!std::isfinite(x)) refuse("finite");
  if (is_positive && !(x > 0.0)) refuse("positive");
  const std::string precise = "0 or at least " + text_of_bound(*this, std::numeric_limits<double>::min());
  if (std::fpclassify(x) == FP_SUBNORMAL) refuse(precise);
  if (!(x < below)) refuse("below " + text_of_bound(*this, below));
  if (x >= least && x <= most) return;
  std::string condition;
  if (std::isfinite(least)) condition = "at least " + text_of_bound(*this, least);
  if (std::isfinite(least) && std::isfinite(most)) condition += " and ";
  if (std::isfinite(most)) condition += "at most " + text_of_bound(*this, most);
  refuse(condition);
}

const parameter_value& parameter_values::operator[](std::string_view name) const {
  const auto found = std::ranges::find_if(all_, [&](const auto& one) { return one.first == name; });
  if (found == all_.end()) throw std::invalid_argument(sentence("parameter must be declared, got {}", name));
  return found->second;
}

double parameter_values::real(std::string_view name) const { return as_real((*this)[name]); }

void detail::refuse_bath(const std::string& system) {
  throw std::invalid_argument(
      sentence("{}: the kinetic energy must be a sum of p_i^2/(2 m_i) for a bath", system));
}

}  // namespace nysalt
