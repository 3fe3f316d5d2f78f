// SPDX-License-Identifier: BSL-1.0
// Report of the fit behind a learned row of a comparison.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "json.hpp"
#include "nysalt/family.hpp"
#include "nysalt/learning/fit_summary.hpp"

namespace nysalt::program {

struct learned_row {
  std::string method;  // as typed
  double step = 0.0;
  std::vector<std::pair<std::string, double>> parameters{};
  double one_step_error = 0.0;
  double evaluations = 0.0;  // of data and search
  double seconds = 0.0;
  bool usable = false;
  bool gains_nothing = false;
  std::string rival{};   // the formula that is as good; empty: none
  std::string reason{};  // why it is not usable
  json document{};       // all that results and work files hold of the fit

  std::vector<double> theta() const;
  /// The scheme file; null of a fit that is not usable.
  const json& scheme() const { return document.at("scheme"); }
};

/// The name of the scheme file of a method that is learned at a step: "bab3_0.045.json".
std::string scheme_file(const std::string& method, double step);

/// `scheme` is the document of the scheme file; null of a fit that is not usable.
learned_row learned_row_of(const std::string& method, const fit_summary& fit, json scheme);
/// Of what a work file holds of the method, which people may have edited. Throws std::exception for what is
/// not whole, of another method, or not of the family.
learned_row learned_row_from(const json& document, const std::string& method, const family& family);
inline json to_json(const learned_row& row) { return row.document; }

/// A field of each parameter, by its name.
json by_name(const fit_summary& fit, double fit_summary::fitted_parameter::*field);

/// The report of a fit that all commands share.
json fit_json(const fit_summary& fit);

}  // namespace nysalt::program
