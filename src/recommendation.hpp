// SPDX-License-Identifier: BSL-1.0
// Which method to take: learned families and classical methods at one cost, or at one error.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bundled_system.hpp"
#include "json.hpp"
#include "method_source.hpp"
#include "nysalt/run_time_family.hpp"
#include "progress.hpp"
#include "settings.hpp"

namespace nysalt::program {

/// Where on the grid of steps the error was below the one asked for, and where above.
struct bracket {
  std::optional<int> below;
  int above;
  bool has_failed = false;  // `above` was tried; else it is the end of the grid
  bool is_fine = false;     // all trajectories, and searches from all starts
  bool is_found = false;
  std::map<int, std::vector<double>> thetas;  // that were learned
};

/// A method that may win, and what was found of it at its step.
struct candidate {
  method_source source;
  std::optional<placement> where;  // of the letters O of a family that is learned
  int order = 0;
  bool symmetric = false;
  bool rotates = false;
  double step = 0.0;
  std::optional<learned_scheme> learned{};
  std::optional<tabulated> method{};
  bracket search{};
  std::string reason{};  // why it cannot win
  estimate error{};
  std::vector<double> of_each{};  // trajectory
  std::int64_t diverged = 0;
  double evaluations_per_time = std::numeric_limits<double>::quiet_NaN();
  double seconds_per_time = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> reference_error{};
  std::string reference{};

  bool is_learned() const { return source.family.has_value(); }
  /// It stayed with the reference on every trajectory.
  bool stands() const { return reason.empty() && diverged == 0; }
};

class recommendation {
 public:
  /// Plans who takes part. Throws refusal for whatever cannot be, before any work is done.
  recommendation(const recommend_command& command, const common_settings& common);

  void learn_and_rank();

  bool has_result() const { return best_of(true) != nullptr || best_of(false) != nullptr; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  json document() const;
  std::string readable() const;
  /// The winner's scheme; nothing if none that is learned wins.
  std::optional<std::string> scheme() const;

 private:
  void require_sound_command() const;
  void plan_classical();
  void plan_families();
  void consider(candidate one);
  bool is_fixed_in(const run_time_family& family) const;

  // At one error.
  void find_steps();
  static const double grid_ratio;
  double grid_step(const candidate& its, int k) const;
  void prepare_search(candidate& its) const;
  /// The point of the grid to try next; nothing if there is none.
  static std::optional<int> next_of(const bracket& search);
  void probe(candidate& its, int k);
  void judge(candidate& its, int k) const;

  asked_metric metric() const { return {command_.metric, command_.observable}; }
  learn_settings learning_at(double step) const;
  trajectories_plan plan_at(double step, std::int64_t count, std::uint64_t seed) const;
  /// Coefficients at its step; of a family with the optimum of a step nearby as one more start, or the only.
  void prepare(candidate& its, const std::vector<double>& from = {}, bool from_there_alone = false);
  void measure(const std::vector<candidate*>& all, std::int64_t count, std::uint64_t seed);
  void measure_at(double step, const std::vector<candidate*>& group, std::int64_t count, std::uint64_t seed);
  void measure_seconds();
  void rank();
  void warn_of_reference();

  /// The best of those that stand; null if none does.
  const candidate* best_of(bool learned) const;
  bool is_better(const candidate& a, const candidate& b) const;
  /// The winner, or null where the best of both kinds cannot be told apart.
  const candidate* winner() const;
  estimate advantage() const;  // of the best learned over the best classical, in the error
  std::string verdict() const;
  std::string advice() const;
  std::string as_options(const candidate& its) const;
  std::string quantity() const;

  recommend_command command_;
  common_settings common_;
  std::unique_ptr<bundled_system> system_;
  std::vector<candidate> all_;
  std::vector<std::pair<std::string, std::string>> left_out_;  // name and reason
  std::vector<std::string> warnings_;
  progress shown_;
};

}  // namespace nysalt::program
