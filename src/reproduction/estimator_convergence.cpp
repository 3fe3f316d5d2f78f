// SPDX-License-Identifier: BSL-1.0
#include "estimator_convergence.hpp"

#include <cmath>

namespace nysalt::program::paper {

namespace {

std::vector<double> values(const learned_scheme& learned) {
  std::vector<double> result;
  for (const auto& p : learned.fit.parameters) result.push_back(p.value);
  return result;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  return 0.5 * (std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]));
}

/// errors[k][repetition] at M = 2^(least + k).
estimate exponent_of(const std::vector<double>& trajectories,
                     const std::vector<std::vector<double>>& errors) {
  std::vector<double> slopes;
  for (std::size_t r = 0; r < errors.front().size(); ++r) {
    std::vector<double> of_one;
    for (const auto& at : errors) of_one.push_back(at[r]);
    slopes.push_back(exponent(trajectories, of_one).mean);
  }
  return mean_and_error(slopes);
}

std::vector<estimate> means_of(const std::vector<std::vector<double>>& errors) {
  std::vector<estimate> result;
  for (const auto& at : errors) result.push_back(mean_and_error(at));
  return result;
}

}  // namespace

estimator_errors errors_of_estimators(const setting& setup, const estimator_study& study) {
  const auto learned = [&](int power, std::uint64_t repetition) {
    learning_setup how = study.how;
    how.trajectories = std::int64_t{1} << power;
    how.repetition = repetition;
    return values(learn_at(setup, study.system, study.step, how));
  };
  const auto sizes = static_cast<std::size_t>(study.most - study.least + 1);
  std::vector<std::vector<double>> from_others(sizes);
  std::vector<std::vector<double>> nested(sizes);
  estimator_errors found;
  for (int r = 0; r < study.repetitions; ++r) {
    // Trajectories are numbered, so that a larger sample of one seed holds the smaller.
    const auto seed = static_cast<std::uint64_t>(2 * r);
    const auto reference = learned(study.most + 1, seed);
    const auto other_reference = learned(study.most + 1, seed + 1);
    for (std::size_t k = 0; k < sizes; ++k) {
      const auto theta = learned(study.least + static_cast<int>(k), seed);
      nested[k].push_back(distance(theta, reference));
      from_others[k].push_back(distance(theta, other_reference));
    }
  }
  for (std::size_t k = 0; k < sizes; ++k) {
    found.trajectories.push_back(std::ldexp(1.0, study.least + static_cast<int>(k)));
  }
  found.from_others = means_of(from_others);
  found.nested = means_of(nested);
  found.exponent_from_others = exponent_of(found.trajectories, from_others);
  found.exponent_nested = exponent_of(found.trajectories, nested);
  found.at_least = found.from_others.front();
  return found;
}

exhibit exhibit_of(const estimator_errors& found, const std::string& printed, double exponent,
                   const std::string& name) {
  table rows({"M", "error, reference from other data", "error, reference from the same data and more"}, 0);
  for (std::size_t k = 0; k < found.trajectories.size(); ++k) {
    rows.add({fmt::format("{:g}", found.trajectories[k]), with_error(found.from_others[k]),
              with_error(found.nested[k])});
  }
  const std::vector<reading> readings{
      {"a reference estimator from other data", agrees(found.exponent_from_others, exponent, 0.01)},
      {"one from the same data and more", agrees(found.exponent_nested, exponent, 0.01)}};
  const auto curve_of = [&](const char* label, const std::vector<estimate>& errors, bool first) {
    const error_curve all{found.trajectories, errors};
    return curve{label, found.trajectories, all.means(), all.bars(), first};
  };
  const panel picture{"",
                      "M",
                      "mean error of b1 and beta1",
                      true,
                      {curve_of("reference from other data", found.from_others, true),
                       curve_of("reference from the same data and more", found.nested, false)}};
  return {"",
          "",
          {{"the error of the estimators decays as M^" + printed,
            "exponent, mean over repetitions with its error",
            fmt::format("{} with a reference from other data, {} with one from the same data and more",
                        with_error(found.exponent_from_others), with_error(found.exponent_nested)),
            verdict_of("whether the reference estimator shares the data", readings),
            summary_of(readings) +
                "; within two standard errors and half the last digit. An exact reference would "
                "give -0.5; one with an error of its own flattens the end of the curve, and one "
                "that shares the data steepens it",
            ""}},
          {},
          {{"Mean over repetitions of (|b1 - b1'| + |beta1 - beta1'|)/2:", rows}},
          {{figure{"convergence_in_M_" + name, {picture}},
            "Error of the estimators against the number of trajectories."}}};
}

}  // namespace nysalt::program::paper
