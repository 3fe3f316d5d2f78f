// SPDX-License-Identifier: BSL-1.0
#include "nysalt/method.hpp"

#include <fmt/format.h>
#include <cmath>

namespace nysalt {

method::method(std::string name, const word& letters, std::vector<double> coefficients,
               const method_properties& properties, std::optional<method_validity> validity)
    : method_properties(properties),
      name_(std::move(name)),
      letters_(letters),
      coefficients_(std::move(coefficients)),
      validity_(std::move(validity)) {
  if (coefficients_.size() != letters_.slots) {
    throw std::invalid_argument(
        fmt::format("{}: coefficients must fit the letters, got {} coefficients for the {} letters {}{}",
                    name_, coefficients_.size(), letters_.length, letters_.view(),
                    letters_.slots > letters_.length ? " (G and H take two)" : ""));
  }
  for (std::size_t i = 0; i < coefficients_.size(); ++i) {
    if (std::isfinite(coefficients_[i])) continue;
    throw std::invalid_argument(
        fmt::format("{}: coefficient {} must be finite, got {}", name_, i + 1, coefficients_[i]));
  }
}

method method::anywhere() const {
  method result = *this;
  result.validity_.reset();
  return result;
}

void method::require_validity(const std::string& system, double step) const {
  if (!validity_) return;
  if (std::abs(step - validity_->step) > 1e-9 * std::abs(validity_->step)) {
    throw std::invalid_argument(
        fmt::format("learned:{} must run at the step {}, at which it was learned, got {}; learn it there, or "
                    "use anywhere()",
                    name_, validity_->step, step));
  }
  if (system != validity_->system) {
    throw std::invalid_argument(fmt::format(
        "learned:{} must run on {}, for which it was learned, got {}; learn it there, or use anywhere()",
        name_, validity_->system, system));
  }
}

method repeated(const method& method, int times) {
  const word& letters = method.letters();
  if (times == 1) return method;
  if (times < 1 || letters.stochastic_letters > 0 || letters.is_processed()) {
    throw std::invalid_argument(
        fmt::format("repeated: the number of steps must be at least 1 and the word without letters O and "
                    "processor, got {} steps of {}; place the letters O afterwards",
                    times, letters.view()));
  }
  const double part = 1.0 / times;
  std::string text;
  std::vector<double> coefficients;
  for (int n = 0; n < times; ++n) {
    text += letters.view();
    std::size_t slot = 0;
    for (std::size_t i = 0; i < letters.length; ++i) {
      for (std::size_t k = 0; k < letters.slots_of(i); ++k, ++slot) {
        double factor = part;
        for (int power = 1; k > 0 && power < letters.facts(i).power_of_second; ++power) factor *= part;
        coefficients.push_back(method.coefficients()[slot] * factor);
      }
    }
  }
  return {fmt::format("{} x {}", times, method.name()), letters.with_letters(text), coefficients, method};
}

method thermostat(const method& method, placement where) {
  if (method.validity()) {
    throw std::invalid_argument(fmt::format(
        "thermostat: the method must not be of one system, got {}, which was learned for {}; take "
        "its anywhere()",
        method.name(), method.validity()->system));
  }
  const word letters = thermostatted(method.letters(), where);
  return nysalt::method(method.name(), letters,
                        detail::thermostatted_coefficients(method.letters(), where, method.coefficients()),
                        {detail::thermostatted_order(where, method.order, method.symmetric),
                         where != placement::end && method.symmetric, method.requires_quadratic_kinetic});
}

}  // namespace nysalt
