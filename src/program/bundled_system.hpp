// SPDX-License-Identifier: BSL-1.0
// A bundled system behind a name: what the commands do with it, whatever its type.
#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "asked_metric.hpp"
#include "nysalt/analysis/acceptance.hpp"
#include "nysalt/analysis/gathered_statistics.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/bath.hpp"
#include "nysalt/ensemble_run.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/learning/until_enough.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/trial_run.hpp"
#include "settings.hpp"

namespace nysalt {
class stability_guard;
struct system_declaration;
}  // namespace nysalt

namespace nysalt::program {

/// Told how much is done; what it throws ends the work.
using counter = std::function<void(std::int64_t)>;

/// Trajectories from the system's starts: `count` of them, `steps` steps each.
struct trajectories_plan {
  double step;
  std::int64_t steps;
  std::int64_t count;
  std::uint64_t seed;
  int threads;
  std::optional<double> horizon = {};  // within the last step: errors are means up to there
};

struct learn_plan {
  std::string family;
  std::optional<placement> where;  // of the letters O, in a bath
  double step;
  learn_settings how;
  std::uint64_t seed;
  std::uint64_t held_out_seed;
  int threads;
  std::vector<double> from = {};              // the optimum at a step nearby: one more start
  bool from_there_alone = false;              // and no other
  std::optional<enough_options> enough = {};  // as many trajectories as it takes, from those of `how` on
  // Where what is made for few trajectories is kept for the same plan with more; nothing: nowhere.
  std::shared_ptr<std::any> kept = {};
};

struct learnable;  // learnable.hpp: what it takes is dear to compile

struct learned_scheme {
  fit_summary fit;
  tabulated method;                      // with its letters O
  std::optional<energy_range> energies;  // of the training data
  std::optional<enough_course> course = {};
};

/// Samples of a trajectory: values of all observables at steps first, first + every, ...
struct record {
  std::int64_t first = 0;
  std::vector<double> values = {};
  std::optional<std::int64_t> diverged_at = {};  // beyond `first`
};

/// How far a run is: trajectories before `first` are finished; those after it are as they were saved, and if
/// none were, they have not begun.
struct standing {
  std::int64_t first = 0;
  saved_runs wave = {};

  bool is_new() const { return first == 0 && wave.diverged_at.empty(); }
};

/// What is sampled along the trajectories of a plan.
struct sampled_plan {
  trajectories_plan trajectories;
  std::vector<std::string> observables;
  std::int64_t every = 1;
  std::optional<std::int64_t> stretch = {};  // steps after which to hand over what there is; nothing: all
  // Of rank 0 alone:
  standing from = {};
  std::function<void(const standing&)> reached = {};  // told after each stretch, if there are stretches
};

/// What is gathered along the trajectories of a plan, sampled every so many steps.
struct statistics_plan {
  trajectories_plan trajectories;
  std::int64_t every = 1;
  std::int64_t first = 0;  // number of the first trajectory
  std::optional<equal_bins> bins = {};
  std::optional<int> lags = {};
  int finer = 1;  // the reference takes so many fine steps for each of its usual
};

/// Errors along the trajectories of a plan.
struct errors_plan {
  trajectories_plan trajectories;
  std::vector<asked_metric> metrics;
  std::optional<double> fine_step = {};  // of the reference; nothing: the usual
  bool null_model = false;
  std::optional<double> perturbation = {};  // of the starts, to see how far they can be followed
};

class bundled_system {
 public:
  virtual ~bundled_system() = default;

  virtual std::string description() const = 0;
  /// Degrees of freedom.
  virtual std::int64_t dimension() const = 0;
  /// H, and -grad V, at a state of so many numbers each. Cost: one evaluation.
  virtual double energy(std::span<const double> q, std::span<const double> p) const = 0;
  virtual void force(std::span<const double> q, std::span<double> f) const = 0;
  /// Name and parameters, as scheme files hold them.
  virtual nlohmann::ordered_json parameters() const = 0;
  /// Empty if there is no bound.
  virtual std::vector<frequency_band> frequency_bands() const = 0;
  /// The frequency whose phase is kept by phase-fitted methods; nothing if neither modes nor bands are
  /// declared.
  virtual std::optional<double> frequency_to_fit() const = 0;
  virtual std::vector<std::string> observables() const = 0;
  /// Throws refusal for one that there is not, before any work is done.
  virtual void require_observable(const std::string& name) const = 0;
  virtual std::string default_observable() const = 0;
  virtual const bath& heat_bath() const = 0;

  /// Where trajectories start. Before starts are prepared this is what is known without work.
  virtual std::string starts() const = 0;
  /// Finds the burn-in, or runs the one long trajectory, whose seed it is. To be called before anything below
  /// runs.
  virtual void prepare_starts(std::uint64_t seed) = 0;
  /// That of trajectory n, by the seed of a role.
  virtual void start_state(std::uint64_t seed, std::uint64_t n, std::span<double> q,
                           std::span<double> p) const = 0;

  /// Trajectories that are stepped at a time.
  virtual int lanes() const = 0;

  /// Of its bands, or of the frequencies along some starts by its law.
  virtual stability_guard guard(bool rotations) const = 0;
  /// Runs a method for long from as many starts as the plan says, 192 at most: typical ones, then energetic
  /// ones.
  virtual trial_result trial(const tabulated& method, const trajectories_plan& plan) const = 0;
  /// Throws refusal for a word that the system does not serve.
  virtual void require_served(const run_time_word& word) const = 0;
  /// Throws refusal for what cannot be learned, before any work is done.
  virtual void require_learnable(const std::string& family, std::optional<placement> where,
                                 const learn_settings& how, double step) const = 0;
  /// Trajectories to learn from that fit into memory.
  virtual std::int64_t most_trajectories(const learn_plan& plan) const = 0;
  /// Makes the data. What is made refers to this.
  virtual learnable make_learnable(const learn_plan& plan, const counter& progress) const = 0;
  /// Compiled once, and not for each system.
  learned_scheme learn(const learn_plan& plan, const counter& progress) const;

  /// Throws refusal if there is no such measure of this system, the fine step does not divide the step, whose
  /// noise is wanted in parts, or scores and samples do not fit into memory; before any work is done.
  virtual void require_measure(const asked_metric& metric, const trajectories_plan& plan,
                               std::optional<double> fine_step, int noise_parts) const = 0;

  /// Errors of several methods at one step against one reference, by each metric.
  virtual std::vector<trajectory_errors_result> errors(const std::vector<tabulated>& methods,
                                                       const errors_plan& plan,
                                                       const counter& progress) const = 0;

  /// Of Hybrid Monte Carlo, by trajectories that are as long as those of the plan.
  virtual acceptance_result acceptance(const tabulated& method, const trajectories_plan& plan,
                                       double temperature, const counter& progress) const = 0;

  /// Of an observable at the first thousand starts of a plan, or all if they are fewer, and at those that
  /// fill the lanes.
  virtual std::vector<double> values_at_starts(const trajectories_plan& plan,
                                               const std::string& observable) const = 0;
  /// Statistics of a method, and of the reference: small steps, and in a bath BAOAB.
  virtual gathered_statistics statistics(const tabulated& method, const statistics_plan& plan,
                                         const std::string& observable, const counter& progress) const = 0;
  virtual gathered_statistics reference_statistics(const statistics_plan& plan, const std::string& observable,
                                                   std::optional<double> fine_step,
                                                   const counter& progress) const = 0;
  /// What resolves the fastest motion, as the reference takes it: an angular frequency or the friction.
  virtual double fastest_rate() const = 0;
  /// A larger fine step than the usual, where many methods are ranked; nothing: the usual one.
  virtual std::optional<double> fine_step_for_ranking(double step) const = 0;
  virtual std::string reference_of_statistics(double step, std::optional<double> fine_step) const = 0;

  /// Hands records over at rank 0, wave by wave of as many trajectories as fit into memory; in a wave stretch
  /// by stretch, and in that in the order of the trajectories. Progress is told in thousandths. Collective.
  virtual void run(const tabulated& method, const sampled_plan& plan,
                   const std::function<void(std::int64_t, const record&)>& take,
                   const counter& progress) const = 0;

  /// Takes given states, instead of starts, to the end of a plan: each of dimension() numbers, one trajectory
  /// after the other. With the bits of run(); where that is lost all of q and p become NaN. Throws
  /// refusal for a state that is not finite; then all are as they were.
  virtual void integrate(const tabulated& method, const trajectories_plan& plan, std::span<double> q,
                         std::span<double> p, const counter& progress) const = 0;

  /// Calls of the system that one f'(q) v takes in a gradient kick.
  virtual int derivative_calls() const = 0;
  /// Force evaluations of one whole trajectory, start-up included: counted over the first two steps, as every
  /// step after them costs the same.
  virtual std::int64_t count_evaluations(const tabulated& method, const trajectories_plan& plan) const = 0;

  /// The steps alone, on this thread, for timing: no one watches, and what diverges runs on. Refers to this.
  virtual std::function<void()> timed_run(const tabulated& method, const trajectories_plan& plan) const = 0;

  /// Highest angular frequency that motion from its law of starts may meet, rare starts included.
  virtual double frequency_of_law() const = 0;
  /// The highest along so many of its starts, known to 1 %; nothing where there are more than a thousand
  /// coordinates, or the kinetic energy is not quadratic.
  virtual std::optional<double> frequency_along_starts(std::uint64_t seed, std::uint64_t count) const = 0;
};

/// Highest angular frequency that the system declares; nothing if it declares none.
std::optional<double> highest_frequency(const bundled_system& system);

/// The system that the settings name. Throws refusal for what it does not have.
std::unique_ptr<bundled_system> make_system(const system_settings& settings);

/// A bundled system, or one that a file declares, which is loaded. Throws refusal if there is none of that
/// name, or what the file holds cannot be used.
const system_declaration& declaration_of(const std::string& name);
/// "--pairs 3 --omega 50 --spread 1"
std::string options_of(const system_declaration& system);
/// A name that is the path of a file.
bool is_path_of_system(std::string_view name);

}  // namespace nysalt::program
