// SPDX-License-Identifier: BSL-1.0
#include "learned_row.hpp"

#include <cctype>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "judging.hpp"
#include "method_file.hpp"

namespace nysalt::program {

namespace {

double number_at(const json& document, const char* name) {
  const json& value = document.at(name);
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}
std::string text_at(const json& document, const char* name) {
  const json& value = document.at(name);
  return value.is_null() ? std::string() : value.get<std::string>();
}

}  // namespace

std::vector<double> learned_row::theta() const {
  std::vector<double> result;
  for (const auto& [name, value] : parameters) result.push_back(value);
  return result;
}

std::string learned_row::scheme() const {
  const json& scheme = document.at("scheme");
  return scheme.is_null() ? std::string() : text_of(scheme);
}

std::string scheme_file(const std::string& method, double step) {
  std::string name = method.substr(method.find(':') + 1);
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '+') c = '_';
  }
  return fmt::format("{}_{}.json", name, step);
}

learned_row learned_row_of(const std::string& method, const fit_summary& fit, json scheme) {
  learned_row row{.method = method,
                  .step = fit.step,
                  .one_step_error = fit.one_step_error,
                  .evaluations = static_cast<double>(fit.learning_evaluations),
                  .seconds = fit.data_seconds + fit.fit_seconds,
                  .usable = fit.usable,
                  .gains_nothing = fit.verdict() == verdict::nothing_gained,
                  .rival = fit.rival,
                  .reason = fit.usable ? std::string() : fit.reason,
                  .document = {{"method", method}}};
  for (const auto& parameter : fit.parameters) row.parameters.emplace_back(parameter.name, parameter.value);
  row.document.update(fit_json(fit));
  row.document["scheme"] = std::move(scheme);
  return row;
}

learned_row learned_row_from(const json& document, const std::string& method, const family& family) {
  learned_row row{.method = text_at(document, "method"),
                  .step = number_at(document, "step"),
                  .one_step_error = number_at(document, "one_step_error"),
                  .evaluations = number_at(document, "learning_evaluations"),
                  .seconds = number_at(document, "seconds"),
                  .usable = document.at("usable").get<bool>(),
                  .gains_nothing = text_at(document, "verdict") == to_string(verdict::nothing_gained),
                  .rival = text_at(document, "rival"),
                  .reason = text_at(document, "reason"),
                  .document = document};
  if (const json& scheme = document.at("scheme"); row.usable) {
    method_file_in(text_of(scheme), "scheme");  // whole, by its own checksum
  } else if (!scheme.is_null()) {
    throw std::out_of_range("scheme");
  }
  const json& parameters = document.at("parameters");
  if (row.method != method || std::ssize(parameters) != family.parameters()) {
    throw std::out_of_range("parameters");
  }
  for (const auto& name : family.parameter_names) {
    row.parameters.emplace_back(name, parameters.at(name).get<double>());
  }
  const auto theta = row.theta();
  detail::require_in_range(family, Eigen::Map<const Eigen::VectorXd>(theta.data(), std::ssize(theta)));
  return row;
}

json by_name(const fit_summary& fit, double fit_summary::fitted_parameter::*field) {
  json result = json::object();
  for (const auto& parameter : fit.parameters) result[parameter.name] = parameter.*field;
  return result;
}

json fit_json(const fit_summary& fit) {
  const bool is_of_trajectories = fit.trajectory_steps > 1;
  return {
      {"family", fit.family},
      {"parameters", by_name(fit, &fit_summary::fitted_parameter::value)},
      {"standard_errors", by_name(fit, &fit_summary::fitted_parameter::standard_error)},
      {"standard_errors_withheld", fit.errors_withheld.empty() ? json(nullptr) : json(fit.errors_withheld)},
      {"step", fit.step},
      {"objective", fit.loss_name},
      {"loss", fit.loss},
      {"held_out_loss", fit.is_of_data ? json(fit.held_out_loss) : json(nullptr)},
      {"one_step_error", fit.one_step_error},
      {"trajectory_error", fit.trajectory_error},
      {"followed_steps", is_of_trajectories ? json(fit.follows ? fit.loss_steps : 0) : json(nullptr)},
      {"trajectory_steps", is_of_trajectories ? json(fit.trajectory_steps) : json(nullptr)},
      {"samples", fit.samples},
      {"usable", fit.usable},
      {"verdict", std::string(to_string(fit.verdict()))},
      {"rival", fit.rival.empty() ? json(nullptr) : json(fit.rival)},
      {"rival_step", fit.rival_step > 0.0 ? json(fit.rival_step) : json(nullptr)},
      {"loss_beside_rival", fit.rival.empty() ? json(nullptr) : json(fit.loss_beside_rival)},
      {"failing_rival", fit.failing_rival.name.empty() ? json(nullptr)
                                                       : json{{"method", fit.failing_rival.name},
                                                              {"step", fit.failing_rival.step},
                                                              {"times_less", fit.failing_rival.times_less},
                                                              {"reason", fit.failing_rival.reason}}},
      {"rival_loss", fit.rival.empty() ? json(nullptr) : json(fit.rival_loss)},
      {"rival_loss_noise", fit.rival.empty() ? json(nullptr) : json(fit.rival_noise)},
      {"judgement", to_json(fit.judgement)},
      {"reason", fit.usable ? json(nullptr) : json(fit.reason)},
      {"seconds", fit.data_seconds + fit.fit_seconds},
      {"data_seconds", fit.data_seconds},
      {"fit_seconds", fit.fit_seconds},
      {"learning_evaluations", fit.learning_evaluations},
      {"expected_excess", fit.is_of_data ? json(fit.expected_excess) : json(nullptr)},
      {"excess_share", fit.is_of_data ? json(fit.excess_share()) : json(nullptr)},
      {"deciding_trajectories", fit.is_of_data ? json(fit.deciding_trajectories) : json(nullptr)}};
}

}  // namespace nysalt::program
