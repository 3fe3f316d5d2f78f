// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/logistic_regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "comparison/did_you_mean.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/system_declaration.hpp"
#include "program/csv_file.hpp"

namespace nysalt::program {

namespace {

struct labelled_rows {
  Eigen::MatrixXd predictors;
  Eigen::VectorXd labels;
};

/// All columns are numbers; the label is the column of that name, or the last.
labelled_rows rows_of(const std::string& file, const std::string& label) {
  std::size_t at = 0;
  std::vector<std::string> names;
  std::vector<double> values;  // row by row
  const auto header = [&](const std::vector<std::string>& found) {
    names = found;
    if (names.size() < 2) {
      refuse_value(
          "data",
          "{}: it must have a predictor and a label, got one column '{}'; separate columns by commas, "
          "semicolons or tabs",
          file, names.front());
    }
    const auto named = std::ranges::find(names, label);
    if (!label.empty() && named == names.end()) {
      refuse("unknown label '{}' of {}: {}", label, file,
             did_you_mean(label, names, "it must be a name in the first line"));
    }
    at = label.empty() ? names.size() - 1 : static_cast<std::size_t>(named - names.begin());
  };
  read_csv(spelled("data"), file, header, [&](csv_row& row) {
    for (std::size_t j = 0; j < row.size(); ++j) values.push_back(row.number(j));
    const double found = values[values.size() - row.size() + at];
    if (found != 0.0 && found != 1.0) {
      refuse("{} must be 0 or 1 as a label, got {}", row.place(at), row.text(at));
    }
  });
  if (values.empty()) refuse_value("data", "{}: it must have a row beside the line of names", file);
  const auto columns = std::ssize(names);
  const auto label_at = static_cast<Eigen::Index>(at);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> all(
      values.data(), std::ssize(values) / columns, columns);
  const Eigen::Index behind = columns - 1 - label_at;
  labelled_rows result{Eigen::MatrixXd(all.rows(), columns - 1), all.col(label_at)};
  result.predictors.leftCols(label_at) = all.leftCols(label_at);
  result.predictors.rightCols(behind) = all.rightCols(behind);
  return result;
}

/// Where there is no file: 500 rows of 24 predictors that share a factor, and labels drawn by coefficients
/// that are normal with the deviation 1/2.
labelled_rows example_rows() {
  constexpr Eigen::Index rows = 500;
  constexpr Eigen::Index columns = 24;
  labelled_rows result{Eigen::MatrixXd(rows, columns), Eigen::VectorXd(rows)};
  Eigen::VectorXd normals(columns + 2);
  const auto draw = [&](Eigen::Index row) {
    standard_normals(
        1, {.trajectory = static_cast<std::uint64_t>(row), .purpose = noise_purpose::initial_state}, normals);
  };
  draw(rows);
  const Eigen::VectorXd coefficients = 0.5 * normals.head(columns);
  for (Eigen::Index r = 0; r < rows; ++r) {
    draw(r);
    result.predictors.row(r) = (0.8 * normals.head(columns)).array() + 0.6 * normals[columns];
    const double uniform = detail::uniform_by_normal(normals[columns + 1]);
    const double score = result.predictors.row(r) * coefficients;
    result.labels[r] = uniform * (1.0 + std::exp(-score)) < 1.0 ? 1.0 : 0.0;
  }
  return result;
}

/// Mean 0 and deviation 1 of each column. Throws refusal for one that is constant but for rounding.
void standardise(Eigen::MatrixXd& predictors) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  for (Eigen::Index j = 0; j < predictors.cols(); ++j) {
    auto column = predictors.col(j).array();
    // By a power of two, so that the largest magnitude is in [1/2, 1): squares neither overflow nor vanish.
    int exponent = 0;
    std::frexp(column.abs().maxCoeff(), &exponent);
    for (double& x : column) x = std::ldexp(x, -exponent);
    // Values of one constant, each of at most four roundings by eps/2, differ by at most 4 eps.
    if (!(column.maxCoeff() - column.minCoeff() > 4.0 * eps)) {
      refuse(
          "{}: predictor {} must vary, and all its values are equal but for rounding; leave the column away",
          spelled("standardise"), j + 1);
    }
    column -= column.mean();
    // A mean beyond what n roundings by eps/2 make of 0, twice that to be sure, is that of the first mean.
    const double rest = column.mean();
    if (std::abs(rest) > static_cast<double>(column.size()) * eps * column.abs().maxCoeff()) column -= rest;
    column /= std::sqrt(column.square().mean());
  }
}

}  // namespace

system_declaration declare_logistic_regression() {
  system_declaration result{.name = "logistic_regression",
                            .title = "posterior of Bayesian logistic regression on the rows of a CSV file"};
  result.parameters = {
      {.name = "data",
       .usual = std::string(),
       .meaning = "CSV file of numbers under a line of names, else 500 rows of an example"},
      {.name = "label",
       .usual = std::string(),
       .meaning = "name of the column of labels 0 and 1, else the last one"},
      {.name = "variance", .usual = 1.0, .meaning = "variance of the normal prior", .is_positive = true},
      {.name = "standardise",
       .usual = 1,
       .meaning = "whether predictors get mean 0 and deviation 1, 1 or 0",
       .least = 0,
       .most = 1}};
  result.make = [](const parameter_values& values, const bath& in, double spread) {
    const std::string& file = values.text("data");
    labelled_rows all = file.empty() ? example_rows() : rows_of(file, values.text("label"));
    if (values.whole("standardise") == 1) standardise(all.predictors);
    Eigen::MatrixXd with_intercept(all.predictors.rows(), all.predictors.cols() + 1);
    with_intercept << Eigen::VectorXd::Ones(all.predictors.rows()), all.predictors;
    const logistic_regression system(with_intercept, all.labels, values.real("variance"));
    const double fastest = system.frequency_bands().back().high;
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(system.size());
    const normal_around<Eigen::Dynamic> law({rest, rest}, spread / fastest, spread);
    return detail::made_of(system, in, law, fastest);
  };
  result.source = "gelman_and_others_2013";
  return result;
}

}  // namespace nysalt::program
