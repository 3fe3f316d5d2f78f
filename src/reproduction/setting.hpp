// SPDX-License-Identifier: BSL-1.0
// The paper's settings for the FPU chain, and what is measured in them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "comparison/prepared_problem.hpp"
#include "comparison/sampled_run.hpp"
#include "comparison/settings.hpp"
#include "curves.hpp"
#include "exhibit.hpp"

namespace nysalt::program::paper {

inline constexpr double omega = 50.0;
inline constexpr double gap_step = 1e-4;  // the paper's fine step: a step is gap times it

/// The amount of computation: all that is needed, or (quick) only so much that everything runs once.
class setting {
 public:
  const common_settings& common;
  bool quick;

  setting(const common_settings& settings, bool is_quick) : common(settings), quick(is_quick) {}

  template <class T>
  T pick(T whole, T part) const {
    return quick ? part : whole;
  }
  /// The seed of a repetition, as a user would give it.
  std::uint64_t seed(std::uint64_t repetition = 0) const;
  /// The chain in the paper's bath, gamma = .01 and sigma = .05, with starts `gibbs` or `trajectory`, which
  /// are prepared once.
  const prepared_problem& in_bath(const std::string& start) const;
  /// The fits of the paper (M = 512, Ttr = 1, loss in q and p), once for each gap and placement.
  const method& learned_in_bath(const std::string& start, double gap, placement where) const;

 private:
  mutable std::map<std::string, std::unique_ptr<prepared_problem>> baths_;
  mutable std::map<std::tuple<std::string, double, placement>, method> learned_;
};

/// The chain of the paper, without a bath. The spread multiplies the deviation 1/omega of its starts.
std::unique_ptr<prepared_problem> chain(double frequency = omega, double spread = 1.0);
/// Starts of which the soft springs hold omega^2, half of it moving and half of it stretched.
std::unique_ptr<prepared_problem> soft_dominated_chain();

struct learning_setup {
  std::int64_t trajectories = 100;
  double horizon = 0.5;
  std::string coordinates = "qp";
  std::optional<placement> where{};
  std::optional<double> fine_step{};
  std::uint64_t repetition = 0;
};
/// M = 100, the paper's for the chain without a bath.
learning_setup usual_learning_setup(const setting& setup);
learned_scheme learn_at(const setting& setup, const prepared_problem& system, double step,
                        const learning_setup& how);

/// (b1, beta1) with the standard errors of the fit.
std::vector<estimate> theta_with_errors(const learned_scheme& learned);

method classical(const std::string& name, const prepared_problem& system);
method two_stages(double b1, double beta1);

/// Errors of several methods at one step, and the reference's own.
struct measured_errors {
  std::vector<method_error> methods;
  double of_reference;
};
struct judged {
  double horizon;
  std::int64_t trajectories;
  std::string metric = "relative";  // the paper's
  std::string observable = "stiff_energy";
  std::optional<double> fine_step{};  // empty: coarse enough to rank methods
};
measured_errors errors_at(const setting& setup, const prepared_problem& system,
                          const std::vector<method>& methods, double step, const judged& how);

/// Infinite if more than half of the trajectories diverged: the error of the others is that of a lucky few.
estimate error_of(const method_error& method);

/// Numbers along trajectories: rows[trajectory].values holds `observables` at the times 0, every, 2 every...
std::vector<record> followed(const setting& setup, const prepared_problem& system,
                             const nysalt::method& method, double step, double horizon, double sample,
                             std::int64_t trajectories, const std::vector<std::string>& observables);

/// The reference's step below omega h = .05 that divides `step`.
double reference_step(double step, double frequency = omega);

/// "--system fpu --friction 0.01 --sigma 0.05"
inline constexpr const char* bath_options = "--friction 0.01 --sigma 0.05";

}  // namespace nysalt::program::paper
