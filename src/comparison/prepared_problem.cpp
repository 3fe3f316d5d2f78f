// SPDX-License-Identifier: BSL-1.0
// A problem: its system, its initial states, and its stability.
#include "prepared_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "catalogue.hpp"
#include "checks.hpp"
#include "json.hpp"
#include "kept_answers.hpp"
#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/starts_to_judge.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/stepper.hpp"
#include "observables.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

using states_in_double = std::vector<phase_point<double, Eigen::Dynamic>>;

vector<double, Eigen::Dynamic> vector_of(std::span<const double> numbers) {
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), std::ssize(numbers));
}

/// What pilots may do until they are stationary where no bands say how stiff the system is, and there may be
/// no stationary distribution: some seconds.
std::int64_t most_steps_of_pilots(const model& system, const burn_in_options& options) {
  constexpr double work = 2e9;  // force evaluations times force_cost()
  const double of_a_step = 2.0 * options.pilots * std::max(1.0, force_cost(system));
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(work / of_a_step), 2048, options.most_steps);
}

/// What a part of a trial says: a verdict is of a whole one, whatever command shows it. No reason: no fault
/// was found.
judgement in_part(judgement found) {
  if (found.verdict == step_verdict::not_tried) return found;
  found.reason = found.verdict == step_verdict::good
                     ? ""
                     : fmt::format(
                           "before so short a run only a part of the trial is made, by which the step is {}; "
                           "stability tries it in full",
                           found.in_words());
  found.verdict = step_verdict::not_tried;
  return found;
}

/// What find() gives, found once. While it runs, a function of the user may ask for the same.
const auto& kept_in(auto& place, const auto& find) {
  if (!place) {
    auto found = find();
    if (!place) place = std::move(found);
  }
  return *place;
}

}  // namespace

std::string to_string(start where) {
  return where == start::law ? "law" : where == start::gibbs ? "gibbs" : "trajectory";
}

prepared_problem::prepared_problem(initial_value_problem definition, std::vector<named_value> parameters,
                                   const surroundings& conditions, std::string source)
    : made_(std::move(definition)),
      parameters_(std::move(parameters)),
      source_of_kind_(std::move(source)),
      start_(conditions.start),
      is_start_usual_(conditions.is_start_usual),
      frequency_asked_(conditions.frequency),
      examined_(conditions.examined),
      is_bundled_(conditions.is_bundled) {
  if (conditions.starts) made_.starts = conditions.starts(made_);
  letters_ = made_.system.facts().own_letters;
  if (made_.frequency == 0.0) made_.frequency = conditions.frequency.value_or(0.0);
  require_square_of_frequency(description(), made_.frequency);
  if (conditions.spread != 1.0) parameters_.push_back({"spread", conditions.spread});
  const bool is_unknown = detail::is_black_box(made_.system) && !made_.system.facts().has_bands;
  if (start_ == start::gibbs && is_start_usual_ && is_unknown) {
    take_law(fmt::format(
        "chains that find it would call the force of a black box some million times; take {} for it",
        spelled("start", "gibbs")));
  }
  if (start_ == start::law) starts_.emplace(made_.starts);
}

std::string prepared_problem::description() const { return describe(made_.system); }

std::string prepared_problem::kind() const {
  const std::string kind = made_.system.kind();
  if (kind == description()) return {};
  return source_of_kind_.empty() ? kind : kind + "; " + source_of_kind_;
}

std::int64_t prepared_problem::dimension() const { return size(made_.system); }

double prepared_problem::energy(std::span<const double> q, std::span<const double> p) const {
  return nysalt::energy<double>(made_.system, {vector_of(q), vector_of(p)});
}

void prepared_problem::force(std::span<const double> q, std::span<double> f) const {
  auto forces = detail::make_vector<double>(made_.system);
  nysalt::force<double>(made_.system, vector_of(q), forces);
  std::copy_n(forces.data(), forces.size(), f.begin());
}

nlohmann::ordered_json prepared_problem::parameters() const {
  json all;
  for (const auto& [name, value] : parameters_) {
    json& entry = all[name];
    std::visit([&](const auto& known) { entry = known; }, value);
  }
  if (!made_.system.bath().acts()) return all;
  all["friction"] = made_.system.bath().friction();
  all["sigma"] = made_.system.bath().sigma();
  return all;
}

const bath& prepared_problem::heat_bath() const { return made_.system.bath(); }

std::vector<frequency_band> prepared_problem::frequency_bands() const {
  return made_.system.frequency_bands();
}

std::string in_words(const fitted_frequency& frequency) {
  return fmt::format("the frequency {:.6g}, {}", frequency.value, frequency.source);
}

std::optional<fitted_frequency> prepared_problem::frequency_to_fit() const {
  if (frequency_asked_) return fitted_frequency{*frequency_asked_, "as given"};
  if (has_modes(made_.system) || made_.system.facts().has_bands)
    return fitted_frequency{nysalt::frequency_to_fit(made_.system), "declared"};
  const seen_frequencies& seen = highest_seen();
  if (!(seen.median > 0.0)) return std::nullopt;
  return fitted_frequency{seen.median, "the median of the highest " + seen.source};
}

bool prepared_problem::is_frequency_seen() const {
  return !frequency_asked_ && !has_modes(made_.system) && !made_.system.facts().has_bands;
}

std::optional<fitted_frequency> prepared_problem::frequency_to_cover() const {
  if (frequency_asked_) return fitted_frequency{*frequency_asked_, "as given"};
  if (const auto declared = highest_frequency(*this)) return fitted_frequency{*declared, "declared"};
  const seen_frequencies& seen = highest_seen();
  if (!(seen.largest > 0.0)) return std::nullopt;
  return fitted_frequency{seen.largest, "the highest " + seen.source};
}

std::vector<std::string> prepared_problem::observables() const { return observable_names(made_); }

void prepared_problem::require_observable(const std::string& name) const { observable(made_, name); }

std::string prepared_problem::default_observable() const { return made_.default_observable; }

std::string prepared_problem::starts() const {
  return starts_ ? starts_->description() : made_.starts.description();
}

std::optional<std::int64_t> prepared_problem::given_states() const {
  const std::int64_t count = starts_or_law().size();
  return count < std::numeric_limits<std::int64_t>::max() ? std::optional(count) : std::nullopt;
}

void prepared_problem::require_starts(const std::string& field, std::int64_t trajectories) const {
  const auto given = given_states();
  if (!given || trajectories <= *given) return;
  refuse_value(field,
               "must be at most {}, the number of states that are given to begin at, got {}; give {} for "
               "deviations of their starts, or {}",
               *given, trajectories, spelled("spread"), spelled(field, static_cast<double>(*given)));
}

void prepared_problem::take_law(const std::string& why) {
  start_ = start::law;
  starts_.emplace(made_.starts);
  warning_of_starts_ =
      fmt::format("trajectories begin at {}, not in the Gibbs distribution: {}", starts(), why);
}

void prepared_problem::prepare_starts(std::uint64_t seed) {
  if (starts_) return;
  const model base = made_.system.base();
  std::string why;
  try {
    if (start_ == start::gibbs && made_.has_exact_flow) {
      starts_.emplace(gibbs_of_modes<Eigen::Dynamic>(base, made_.system.bath().temperature()));
    } else if (start_ == start::gibbs) {
      burn_in_options options;
      if (!made_.system.facts().has_bands) options.most_steps = most_steps_of_pilots(made_.system, options);
      starts_.emplace(gibbs(made_.system, made_.starts, options));
    } else {
      starts_.emplace(one_long_trajectory<Eigen::Dynamic>(made_.system, made_.starts, {.seed = seed}));
    }
  } catch (const std::runtime_error& problem) {
    why = problem.what();
  } catch (const std::invalid_argument& problem) {
    why = problem.what();
  }
  if (why.empty()) return;
  // The remedy of a C++ program is none here; the description of a system may have "; " as well.
  const auto got = why.rfind(", got ");
  why.resize(std::min(why.size(), got == why.npos ? why.rfind("; ") : why.find("; ", got)));
  if (!is_start_usual_)
    refuse("cannot draw initial states: {}; take another temperature, or {}", why, spelled("start", "law"));
  take_law(fmt::format("{}; take {} to begin there without a search", why, spelled("start", "law")));
}

void prepared_problem::start_state(std::uint64_t seed, std::uint64_t n, std::span<double> q,
                                   std::span<double> p) const {
  const auto state = (*starts_)(seed, n);
  std::copy_n(state.q.data(), state.q.size(), q.begin());
  std::copy_n(state.p.data(), state.p.size(), p.begin());
}

int prepared_problem::lanes() const { return made_.system.facts().in_lanes ? pack<double>::lanes : 1; }

void prepared_problem::require_served(const nysalt::word& word) const {
  try {
    nysalt::require_served<model, double>(word, made_.system);
  } catch (const std::invalid_argument& problem) {
    refuse("{}", problem.what());
  }
}

namespace {

using state_in_double = phase_point<double, Eigen::Dynamic>;

Eigen::VectorXd column_of(const state_in_double& x) {
  Eigen::VectorXd all(2 * x.q.size());
  all << x.q, x.p;
  return all;
}

/// The rate at which a letter moves the state at x, by a central difference over 2 h, with a coefficient 1 in
/// one of its slots.
Eigen::VectorXd rate_of(const model& system, const nysalt::word& letter, std::size_t slot,
                        const state_in_double& x, double h) {
  std::vector<double> c(letter.slots);
  c[slot] = 1.0;
  const method one_letter("letter", letter, c, {1, false, false});
  state_in_double ahead = x;
  state_in_double behind = x;
  make_stepper(system, one_letter, h).step(ahead);
  make_stepper(system, one_letter, -h).step(behind);
  return (column_of(ahead) - column_of(behind)) / (2.0 * h);
}

/// Rates of q, or of p: the largest by which letters differ from H, the largest of H, and by how much
/// rounding may make two of them differ.
struct compared_rates {
  double off = 0.0;
  double of_h = 0.0;
  double rounding = 0.0;

  void take(const Eigen::VectorXd& sum, const Eigen::VectorXd& whole, double bound) {
    const Eigen::VectorXd apart = (sum - whole).cwiseAbs();
    off = apart.allFinite() ? std::max(off, apart.maxCoeff()) : std::numeric_limits<double>::infinity();
    of_h = std::max(of_h, whole.cwiseAbs().maxCoeff());
    rounding = std::max(rounding, bound);
  }
  /// Differences err by 1e-10 to 1e-7, a part that is missing by its share of H. Rates that are not
  /// finite are off.
  bool agree() const { return off <= 1e-5 * of_h + rounding; }
};

/// How the letters of a word move q and p, and how H does. A part of H acts once, however many letters have
/// its time.
std::array<compared_rates, 2> rates_of_sum(const model& system, const nysalt::word& word,
                                           const std::string& times,
                                           const std::vector<state_in_double>& states, double step) {
  const double h =
      1e-5 * step;  // the cube root of a rounding, at which both errors of a difference are small
  const Eigen::Index n = size(system);
  std::array<compared_rates, 2> result;
  for (const auto& x : states) {
    const Eigen::VectorXd whole =
        rate_of(system, nysalt::word("A"), 0, x, h) + rate_of(system, nysalt::word("B"), 0, x, h);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(2 * n);
    std::string known;
    for (std::size_t i = 0; i < word.length; ++i) {
      const nysalt::word letter = word.with_letters(std::string(1, word.letter(i)));
      for (std::size_t k = 0; k < word.slots_of(i); ++k) {
        const char part = times[word.first_slot(i) + k];
        if (known.find(part) != std::string::npos) continue;
        known += part;
        sum += rate_of(system, letter, k, x, h);
      }
    }
    // Two ends, each rounded by eps |x| after a few operations, over 2 h; of each letter, and of A and B.
    const double each =
        4.0 * std::numeric_limits<double>::epsilon() / h * static_cast<double>(known.size() + 2);
    result[0].take(sum.head(n), whole.head(n), each * x.q.cwiseAbs().maxCoeff());
    result[1].take(sum.tail(n), whole.tail(n), each * x.p.cwiseAbs().maxCoeff());
  }
  return result;
}

}  // namespace

void prepared_problem::require_sound_letters(const std::string& name, const nysalt::word& word,
                                             double step) const {
  constexpr Eigen::Index most = 2000;  // coordinates: the Jacobian of a letter has 4 times their square
  if (examined_ != examination::whole || !word.has_own_letters() || size(made_.system) > most) return;
  const std::string tried = fmt::format("{} {}", word.letters(), step);
  if (sound_.contains(tried)) return;
  const model base = made_.system.base();
  // Some moved by a part of a step: starts may be at rest, or at the minimum of V.
  const double moved_by = made_.frequency > 0.0 ? std::min(step, 0.1 / made_.frequency) : step;
  const auto mover = make_stepper(base, method(verlet()), moved_by);
  states_in_double states;
  for (std::int64_t n = 0; n < 4; ++n) {
    states.push_back(sound_start(base, made_.starts, 1, n));
    if (n % 2 == 1) mover.step(states.back());
  }
  for (const letter_facts& own : word.own()) {
    const letter_check found = check_letter(base, own.letter, states, step);
    if (!found.passed()) refuse("cannot take {}: {}", name, found.report());
  }
  std::string letters = word.letters();
  std::erase(letters, detail::bath_letter);
  const nysalt::word conservative = word.with_letters(letters);
  const auto rates = rates_of_sum(base, conservative, times_of_slots(conservative), states, step);
  for (const auto& [which, rate] : {std::pair("q", rates[0]), std::pair("p", rates[1])}) {
    if (rate.agree()) continue;
    refuse(
        "{}: the letters of the word {} must add up to H of {}, got a rate of {} that is off by {:.2g}, "
        "where H moves it by {:.2g} in unit time; take a letter for each part of H",
        name, conservative.letters(), description(), which, rate.off, rate.of_h);
  }
  sound_.insert(tried);
}

double prepared_problem::frequency_of_law() const { return made_.frequency; }

std::optional<double> prepared_problem::frequency_along_starts(std::uint64_t seed,
                                                               std::uint64_t count) const {
  constexpr Eigen::Index most = 1000;
  {
    if (size(made_.system) > most || !has_quadratic_kinetic(made_.system)) return std::nullopt;
    states_in_double states;
    for (std::uint64_t n = 0; n < count; ++n) {
      states.push_back(starts_ ? (*starts_)(seed, n) : made_.starts(seed, n));
    }
    try {
      return hessian_spectrum(made_.system, states).highest_frequency();
    } catch (const std::invalid_argument&) {  // the force is not finite there: the run will show it
      return std::nullopt;
    }
  }
}

bool prepared_problem::is_followed() const {
  return size(made_.system) <= detail::most_for_all_frequencies && !detail::is_black_box(made_.system) &&
         made_.frequency > 0.0 && std::isfinite(made_.frequency);
}

states_in_double prepared_problem::states_along_motion() const {
  const model system = made_.system.base();
  constexpr std::int64_t some = 64;
  auto begun = detail::typical_and_energetic_starts(system, made_.starts, 1, 0, some);
  if (!is_followed()) return begun;
  constexpr double angle = 0.1;  // of the fastest motion in a step
  constexpr std::int64_t steps = 500;
  constexpr int samples = 4;
  const auto stepper = make_stepper(system, method(verlet()), angle / made_.frequency);
  states_in_double states;
  for (const auto& start : begun) {
    auto run = stepper.open(start);
    for (int n = 0; n < samples; ++n) {
      stepper.advance(run, steps);
      const auto state = stepper.synchronous(run);
      if (state.q.allFinite() && state.p.allFinite()) states.push_back(state);
    }
  }
  return states;
}

const prepared_problem::seen_frequencies& prepared_problem::highest_seen() const {
  return kept_in(highest_seen_, [&]() -> seen_frequencies {
    std::vector<double> highest;
    try {
      const model system = made_.system.base();
      for (const auto& of_state : detail::frequencies_of_states(system, states_along_motion()).of_state) {
        if (!of_state.empty()) highest.push_back(of_state.back());
      }
    } catch (const std::invalid_argument&) {  // the force has no derivative there
    }
    if (highest.empty()) return {};
    std::ranges::sort(highest);
    return {highest[highest.size() / 2], highest.back(),
            is_followed() ? "along the motion" : "of the starts"};
  });
}

const std::vector<frequency_band>& prepared_problem::bands_along_motion() const {
  return kept_in(bands_along_motion_, [&]() -> std::vector<frequency_band> {
    const model system = made_.system.base();
    if (system.facts().has_bands || size(system) > detail::most_for_all_frequencies ||
        detail::is_black_box(system))
      return {};
    std::vector<frequency_band> bands;
    const states_in_double states = states_along_motion();
    try {
      if (!states.empty()) bands = detail::stability_guard(system, states, false).frequencies();
    } catch (const std::invalid_argument&) {  // the force has no derivative there: the run will show it
    }
    if (bands.size() == 1) bands.clear();
    return bands;
  });
}

detail::stability_guard prepared_problem::guard(const nysalt::word& word) const {
  const auto states = detail::typical_and_energetic_starts(made_.system, made_.starts, 1, 0, 64);
  return {made_.system, states, word};
}

const judgement& prepared_problem::judged(const method& method, double step, int threads) const {
  return judged_by(method, step, threads, detail::evaluations_of_trial(made_.system));
}

const judgement& prepared_problem::judged_before(const method& method, const trajectories_plan& run) const {
  const std::int64_t all = detail::evaluations_of_trial(made_.system);
  const auto taken =
      static_cast<double>(run.count) * static_cast<double>(run.steps) * method.letters().evaluations_per_step;
  // A trial of all evaluations is some tenths of a second in lanes, if a force costs what it is taken to
  // cost. The force of a user may be one of pairs, and cost its coordinates squared.
  const auto coordinates = static_cast<double>(dimension());
  const double cost = force_cost(made_.system);
  const bool is_stated = cost != coordinates && cost != 4.0 * coordinates * coordinates;
  constexpr double few = 16.0;  // coordinates, whose pairs cost little
  double dearer = 1.0;
  if (!is_bundled_ && !is_stated && made_.system.sites() == nullptr) dearer = coordinates / few;
  dearer = std::max(dearer, static_cast<double>(pack<double>::lanes) / lanes());
  const double least = static_cast<double>(all) / dearer;
  if (std::max(taken, least) >= static_cast<double>(all)) return judged(method, run.step, run.threads);
  return judged_by(method, run.step, run.threads, static_cast<std::int64_t>(std::max(taken, least)));
}

const judgement& prepared_problem::judged_by(const method& method, double step, int threads,
                                             std::int64_t evaluations) const {
  const std::string key = fmt::format("{} {} {} {}", method.letters().letters(),
                                      fmt::join(method.coefficients(), " "), step, evaluations);
  if (const auto known = judged_.find(key); known != judged_.end()) return known->second;
  const auto not_tried = [&](std::string reason) -> const judgement& {
    judgement found;
    found.step = step;
    found.reason = std::move(reason);
    return judged_.emplace(key, found).first->second;
  };
  // 500 steps of one trajectory would cost more than twice what a judge may do, as with 10^5 rows of data.
  constexpr double most_cost = 2e6;
  if (const double cost = force_cost(made_.system); cost > most_cost && !detail::is_black_box(made_.system)) {
    return not_tried(fmt::format(
        "an evaluation of the force costs as much as {:.1e} coordinates, too much for a trial", cost));
  }
  const std::int64_t all = detail::evaluations_of_trial(made_.system);
  const std::int64_t fewest = std::int64_t{500} * method.letters().evaluations_per_step;
  if (evaluations < all && fewest > 5 * evaluations / 2) {
    return not_tried(
        fmt::format("a trial takes {} force evaluations or more, too many before so short a run; stability "
                    "tries the step without a run",
                    fewest));
  }
  judgement found =
      once<judgement>(answers_, {"judge", key}, [&] { return tried(method, step, threads, evaluations); });
  if (evaluations < all) found = in_part(std::move(found));
  return judged_.emplace(key, std::move(found)).first->second;
}

judgement prepared_problem::tried(const method& method, double step, int threads,
                                  std::int64_t evaluations) const {
  const std::int64_t all = detail::evaluations_of_trial(made_.system);
  constexpr std::size_t most = 16;  // a judge keeps its starts
  if (judges_.size() == most) judges_.clear();
  const std::pair at(step, evaluations);
  auto judge = judges_.find(at);
  if (judge == judges_.end()) {
    judging_options options{.execution = {.threads = threads}};
    const double share = static_cast<double>(evaluations) / static_cast<double>(all);
    if (evaluations < all) options.work = std::llround(std::ceil(share * static_cast<double>(options.work)));
    const phase_points starts = starts_to_judge(made_.system, starts_or_law());
    judge = judges_.emplace(at, step_judge(made_.system, starts, step, options)).first;
  }
  return judge->second.of(method);
}

int prepared_problem::derivative_calls() const { return made_.system.facts().derivative_calls; }

std::optional<double> highest_frequency(const prepared_problem& system) {
  const auto bands = system.frequency_bands();
  return bands.empty() ? std::nullopt : std::optional(nysalt::highest_frequency(bands));
}

}  // namespace nysalt::program
