// SPDX-License-Identifier: BSL-1.0
#include "learned_row.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "method_file.hpp"

namespace nysalt::program {

std::vector<double> learned_row::theta() const {
  std::vector<double> result;
  for (const auto& [name, value] : parameters) result.push_back(value);
  return result;
}

std::string scheme_file(const std::string& method, double step) {
  std::string name = method.substr(method.find(':') + 1);
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '+') c = '_';
  }
  return fmt::format("{}_{}.json", name, step);
}

learned_row learned_row_of(const learned_fit& fit, const json& scheme) {
  learned_row row{
      {}, {as_json(fit)}, as_kept(scheme)};  // the checksum of a scheme is of null, not of infinities
  read_json(row.fit.document, static_cast<facts_of_fit&>(row));
  return row;
}

learned_row learned_row_from(const json& kept, const std::string& method, const family& family) {
  auto row = from_json<learned_row>(kept);
  read_json(row.fit.document, static_cast<facts_of_fit&>(row));
  if (row.usable) {
    method_file_in(text_of(row.scheme), "scheme");  // whole, by its own checksum
  } else if (!row.scheme.is_null()) {
    throw std::out_of_range("scheme");
  }
  const auto name_of = [](const auto& parameter) { return parameter.first; };
  if (row.method != method || !std::ranges::equal(row.parameters, family.parameter_names, {}, name_of)) {
    throw std::out_of_range("parameters");
  }
  const auto theta = row.theta();
  detail::require_in_range(family, Eigen::Map<const Eigen::VectorXd>(theta.data(), std::ssize(theta)));
  return row;
}

std::vector<std::pair<std::string, double>> by_name(const fit_summary& fit,
                                                    double fit_summary::fitted_parameter::*field) {
  std::vector<std::pair<std::string, double>> result;
  for (const auto& parameter : fit.parameters) result.emplace_back(parameter.name, parameter.*field);
  return result;
}

learned_fit fit_of(const learned_scheme& learned, const learning_options& how, std::optional<placement> where,
                   const std::string& method) {
  return {{learned.fit},    method,        how.horizon_at(learned.fit.step), where, how.purpose,
          learned.energies, learned.course};
}

}  // namespace nysalt::program
