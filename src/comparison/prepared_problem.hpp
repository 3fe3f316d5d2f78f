// SPDX-License-Identifier: BSL-1.0
// A system in its surroundings, with starts to try methods on: what commands, comparisons and recommendations
// do with it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "examination.hpp"
#include "nysalt/analysis/acceptance.hpp"
#include "nysalt/analysis/ensemble_statistics.hpp"
#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/bath.hpp"
#include "nysalt/judgement.hpp"
#include "nysalt/system_declaration.hpp"
#include "plans.hpp"

namespace nysalt::detail {
class stability_guard;
}  // namespace nysalt::detail

namespace nysalt {
class family;
}  // namespace nysalt

namespace nysalt::program {

class model_reference;  // model_reference.hpp
class work_file;        // work_file.hpp

/// Name or parameter of a system, as scheme files hold it.
struct named_value {
  std::string name;
  std::variant<std::int64_t, double, std::string> value;
};

/// The bath of a system, and the initial distribution.
enum class start { law, gibbs, trajectory };
std::string to_string(start where);
struct surroundings {
  nysalt::bath bath;
  program::start start;
  double spread = 1.0;                   // factor of the standard deviations of the initial distribution
  std::optional<double> frequency = {};  // to which methods are fitted; nothing: declared, or seen
  /// Makes the starts that are taken in the place of the system's own distribution; empty: none are.
  std::function<initial_states(const initial_value_problem&)> starts = {};
  bool is_start_usual = false;  // `start` is the default: where it cannot be sampled, the law is
  examination examined = examination::whole;  // of a user's system
  bool is_bundled = false;                    // the system is one of ours: its force costs what it says
};

/// The angular frequency that a method is fitted to, and where it is known from.
struct fitted_frequency {
  double value;
  std::string source;
};
/// "the frequency 20.1, seen along the motion".
std::string in_words(const fitted_frequency& frequency);

class prepared_problem {
 public:
  /// Throws refusal if there is no distribution of such starts. `source` is what makes two kinds of one name
  /// different.
  prepared_problem(initial_value_problem definition, std::vector<named_value> parameters,
                   const surroundings& conditions, std::string source = {});

  /// The definition of the problem.
  const initial_value_problem& definition() const { return made_; }
  start start_law() const { return start_; }
  /// Throws refusal if there are fewer starts than trajectories.
  void require_starts(const std::string& field, std::int64_t trajectories) const;
  /// Number of states that were given to begin at; nothing: starts are drawn.
  std::optional<std::int64_t> given_states() const;
  /// The starts, once they are prepared.
  const initial_states& prepared_starts() const { return *starts_; }

  std::string description() const;
  /// The description without the size, and what else a method that was learned at another size must agree
  /// with; empty where the system declares no kind.
  std::string kind() const;
  /// Degrees of freedom.
  std::int64_t dimension() const;
  /// H(q, p), and f = -grad V(q), with dimension() numbers in each of q, p and f. Cost: one evaluation.
  double energy(std::span<const double> q, std::span<const double> p) const;
  void force(std::span<const double> q, std::span<double> f) const;
  /// Name and parameters, as scheme files hold them.
  nlohmann::ordered_json parameters() const;
  /// Empty if there is no bound.
  std::vector<frequency_band> frequency_bands() const;
  /// The frequency whose phase is kept by phase-fitted methods: the one that was given; else the highest of
  /// the modes, or of the bands, that are declared; else the median, over states along the motion, of the
  /// highest at a state, as a phase is gained at the mean rate and not at the largest; nothing if there is
  /// none. Cost: at the first call, where none is given or declared, that of bands_along_motion().
  std::optional<fitted_frequency> frequency_to_fit() const;
  /// The frequency up to which s-AIA methods are made to err little: the one that was given; else the end of
  /// the declared bands, or the highest that was seen along the motion.
  std::optional<fitted_frequency> frequency_to_cover() const;
  /// Whether they are estimates: neither given nor declared.
  bool is_frequency_seen() const;
  std::vector<std::string> observables() const;
  /// Throws refusal for one that there is not, before any work is done.
  void require_observable(const std::string& name) const;
  std::string default_observable() const;
  const bath& heat_bath() const;

  /// Where trajectories start. Before starts are prepared this is what is known without work.
  std::string starts() const;
  /// Finds the burn-in, or runs the one long trajectory, whose seed it is. To be called before anything below
  /// runs.
  void prepare_starts(std::uint64_t seed);
  /// Why trajectories begin at the law where they usually begin elsewhere; empty otherwise.
  const std::string& warning_of_starts() const { return warning_of_starts_; }
  /// Trajectories begin there from now on.
  void take_starts(const initial_states& starts) { starts_ = starts; }
  /// The start of trajectory n, by the seed of a role.
  void start_state(std::uint64_t seed, std::uint64_t n, std::span<double> q, std::span<double> p) const;

  /// Trajectories that are stepped at a time.
  int lanes() const;

  /// Of a small system that declares no bands: those in which frequencies lie along some 200 rad of the
  /// fastest motion from some starts, where they lie far apart; else none. Cost: 4 10^5 evaluations at the
  /// first call.
  const std::vector<frequency_band>& bands_along_motion() const;
  /// For a word, of its bands, or of the frequencies along some states of the initial distribution, and of
  /// kicks of parts of V as a fit has it.
  detail::stability_guard guard(const nysalt::word& word) const;
  /// The judgement of a method at a step, on starts of its own, see starts_to_judge(): equal for equal
  /// coefficients, whatever the method is called and whichever command asks. Cost: that of step_judge::of();
  /// of a method that was judged at the step before none.
  const judgement& judged(const nysalt::method& method, double step, int threads) const;
  /// The same before a run, by a trial of no more force evaluations than the run takes, or than take some
  /// tenths of a second if these are more; nothing is tried where they are too few. The verdict of less than
  /// a whole trial is `not_tried`: its reason is the fault that was found, and is empty if there was none.
  /// Counted, not measured: equal runs have equal judgements.
  const judgement& judged_before(const nysalt::method& method, const trajectories_plan& run) const;
  /// Throws refusal for a word that the system does not serve.
  void require_served(const nysalt::word& word) const;
  /// Letters of one's own that the system has, by name.
  const std::vector<letter_facts>& letters() const { return letters_; }
  /// Tries the letters of one's own in a word by check_letter(), over the step from four states, and whether
  /// its letters add up to H there. Throws refusal, which begins with the name of the method, for the first
  /// that is not what it states. Nothing is tried above 2000 coordinates. Cost: of letters that passed before
  /// none.
  void require_sound_letters(const std::string& name, const nysalt::word& word, double step) const;
  /// Throws refusal for what cannot be learned, before any work is done.
  void require_learnable(const std::string& family, std::optional<placement> where,
                         const learning_options& how, double step) const;
  /// Trajectories to learn from that fit into memory.
  std::int64_t most_trajectories(const learn_plan& plan) const;
  /// Makes the data, and learns from them.
  learned_scheme learn(const learn_plan& plan, const counter& progress) const;

  /// From now on a work file, if there is one, keeps what learn(), errors(), acceptance() and the judgements
  /// find, and what is there is not done again.
  void keep_answers_in(work_file* file) { answers_ = file; }
  work_file* answers() const { return answers_; }  ///< null: nothing is kept

  /// Throws refusal if there is no such measure of this system, the fine step does not divide the step, whose
  /// noise is wanted in parts, or scores and samples do not fit into memory; before any work is done.
  void require_measure(const asked_metric& metric, const trajectories_plan& plan,
                       std::optional<double> fine_step, int noise_parts) const;

  /// Errors of several methods at one step against one reference, by each metric.
  std::vector<trajectory_errors_result> errors(const std::vector<nysalt::method>& methods,
                                               const errors_plan& plan, const counter& progress) const;

  /// Of Hybrid Monte Carlo, by trajectories that are as long as those of the plan.
  acceptance_result acceptance(const nysalt::method& method, const trajectories_plan& plan,
                               double temperature, const counter& progress) const;

  /// Of an observable at the first thousand starts of a plan, or all if they are fewer, and at those that
  /// fill the lanes.
  std::vector<double> values_at_starts(const trajectories_plan& plan, const std::string& observable) const;
  /// Statistics of a method, and of the reference: small steps, and in a bath BAOAB.
  gathered_statistics statistics(const nysalt::method& method, const statistics_plan& plan,
                                 const std::string& observable, const counter& progress) const;
  gathered_statistics reference_statistics(const statistics_plan& plan, const std::string& observable,
                                           std::optional<double> fine_step, const counter& progress) const;
  /// The rate of the fastest motion that the reference resolves: an angular frequency or the friction.
  double fastest_rate() const;
  /// A larger fine step than the usual, where many methods are ranked; nothing: the usual one.
  std::optional<double> fine_step_for_ranking(double step) const;
  std::string reference_of_statistics(double step, std::optional<double> fine_step) const;

  /// Calls of the system that one f'(q) v takes in a gradient kick.
  int derivative_calls() const;
  /// Force evaluations of one whole trajectory, start-up included: counted over the first two steps, as every
  /// step after them costs the same.
  std::int64_t count_evaluations(const nysalt::method& method, const trajectories_plan& plan) const;

  /// The steps only, on this thread, for timing: nothing is observed, and what diverges runs on. Refers to
  /// this.
  std::function<void()> timed_run(const nysalt::method& method, const trajectories_plan& plan) const;

  /// Highest angular frequency that motion from the initial distribution may meet, rare initial states
  /// included.
  double frequency_of_law() const;
  /// Highest angular frequency along the first `count` starts of a seed, to a relative accuracy of 1 %;
  /// nothing for more than a thousand coordinates, and for a kinetic energy that is not quadratic.
  std::optional<double> frequency_along_starts(std::uint64_t seed, std::uint64_t count) const;

 private:
  /// Trajectories begin at the law, and warning_of_starts() says why.
  void take_law(const std::string& why);
  /// By a trial of some evaluations.
  const judgement& judged_by(const nysalt::method& method, double step, int threads,
                             std::int64_t evaluations) const;
  judgement tried(const nysalt::method& method, double step, int threads, std::int64_t evaluations) const;
  model_reference reference() const;
  error_measure measure_named(const asked_metric& metric) const;
  /// In which noise is wanted to learn with.
  int noise_parts(const nysalt::family& family) const;
  const initial_states& starts_or_law() const { return starts_ ? *starts_ : made_.starts; }
  /// States along some 200 rad of the fastest motion from some starts; only the starts of a black box, of a
  /// system of many coordinates and of one whose fastest motion is not known.
  std::vector<phase_point<double, Eigen::Dynamic>> states_along_motion() const;
  bool is_followed() const;
  /// Of the highest frequencies at these states: the median, and the largest.
  struct seen_frequencies {
    double median;  // 0: none is known
    double largest;
    std::string source;
  };
  const seen_frequencies& highest_seen() const;

  learned_scheme learn_from_data(const learn_plan& plan, const nysalt::family& family,
                                 const counter& progress) const;

  initial_value_problem made_;
  work_file* answers_ = nullptr;
  std::vector<named_value> parameters_;
  std::string source_of_kind_;
  start start_;
  bool is_start_usual_;
  std::string warning_of_starts_;
  std::optional<double> frequency_asked_;
  examination examined_;
  bool is_bundled_;
  std::optional<initial_states> starts_;
  mutable std::optional<seen_frequencies> highest_seen_;
  mutable std::optional<std::vector<frequency_band>> bands_along_motion_;
  std::vector<letter_facts> letters_;
  mutable std::map<std::pair<double, std::int64_t>, step_judge> judges_;  // by step and evaluations
  mutable std::map<std::string, judgement> judged_;  // by letters, coefficients, step and evaluations
  mutable std::set<std::string> sound_;              // by letters and step
};

/// Highest angular frequency that the system declares; nothing if it declares none.
std::optional<double> highest_frequency(const prepared_problem& system);

}  // namespace nysalt::program
