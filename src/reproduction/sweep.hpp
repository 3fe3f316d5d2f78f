// SPDX-License-Identifier: BSL-1.0
// Errors of the learned scheme and its rivals against the step, as curves over the gap.
#pragma once

#include <functional>

#include "parts.hpp"

namespace nysalt::program::paper {

struct named_curve {
  std::string name;
  error_curve curve;
};
/// Throws if there is none.
const error_curve& curve_named(const std::string& name, const std::vector<named_curve>& all);

struct sweep {
  std::vector<named_curve> methods;
  std::vector<double> of_reference;  // error of the reference itself, by gap

  const error_curve& of(const std::string& name) const { return curve_named(name, methods); }
};

/// A method of the sweep, by its name and the step.
struct rival {
  std::string name;
  std::function<method(double gap)> at;
};
sweep errors_against_gap(const setting& setup, const prepared_problem& system,
                         const std::vector<rival>& rivals, const std::vector<double>& gaps,
                         const judged& how);

/// A row for each gap, a column for each method, and the reference's own error.
table table_of(const sweep& all);
panel panel_of(const sweep& all, const std::string& title, const std::string& y_label);

/// The least factor by which b is above a at points up to `most`.
double least_ratio(const error_curve& a, const error_curve& b, double most);
/// The last point up to which a is below b, at it and all before.
double below_up_to(const error_curve& a, const error_curve& b);
/// "10,20,50" gaps as steps of the command line.
std::string steps_text(const std::vector<double>& gaps);

}  // namespace nysalt::program::paper
