// SPDX-License-Identifier: BSL-1.0
// Burn-in of chains: length, friction and step with which they forget their starts.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"
#include "nysalt/stepping/lockstep.hpp"
#include "nysalt/systems/modal_coordinates.hpp"
#include "step_of_motion.hpp"

namespace nysalt {

/// Mean over independent numbers and its standard error.
burn_in_report::discrepancy mean_over_chains(const std::vector<double>& x);

/// Chains over an interval of time.
struct watched_interval {
  double duration = 0.0;  ///< how long it is
  double zero = 0.0;      ///< the potential of which potentials are differences, an energy
  detail::of_watched<std::vector<double>> begin;   ///< at its beginning, one number a chain
  detail::of_watched<std::vector<double>> mean;    ///< over time, one a chain
  detail::of_watched<std::vector<double>> square;  ///< mean square over time, one a chain
  std::vector<Eigen::VectorXd> force_square;       ///< mean square over time of each force, a vector a chain
  std::vector<double> way_to_begin;                ///< |q - q_0|^2 at the beginning, one a chain
  double way_to_end = 0.0;                         ///< its mean at the end

  /// A random walk doubles its variance over an interval that begins where half the time is over.
  bool confined() const { return way_to_end < 1.5 * mean_over_chains(way_to_begin).mean; }
  /// Mean potential energy of the half of the chains that have gone farther, less that of the other half.
  /// Where the motion is not confined it is 0 if the potential is the same wherever chains go, as that of
  /// angles and of a centre of mass. Where chains leave the potential behind there is no Gibbs distribution.
  burn_in_report::discrepancy potential_of_the_far() const;
  /// Largest share of chains, over all coordinates, that met no force there while others did. A random walk
  /// along a half-line does not return within an interval that doubles its time with the probability
  /// 2/pi arcsin(1/sqrt(2)) = 1/2; along a direction that repeats itself all chains meet the same forces.
  double share_without_force() const;
  /// Whether number i is meaningful: the virial is where the motion is confined.
  bool counts(std::size_t i) const {
    return i != static_cast<std::size_t>(burn_in_report::watched::virial) || confined();
  }

  /// Whether the bath still cools what began at higher energies, all chains alike, which tau() does not see:
  /// the kinetic temperature, or the virial, is above that of the bath, and falls. Numbers that have
  /// overflowed do.
  bool is_cooling() const;
  /// Largest potential energy or virial at the beginning, in kT for each coordinate.
  double largest_at_begin() const;

  /// Longest of T Var(mean over T)/Var: the integrated autocorrelation time, if it is much shorter than T,
  /// and T if nothing is forgotten. Its relative error is sqrt(2/chains).
  double tau() const;
};

// Langevin chains of a temperature whose friction is ours to choose.

/// BAOAB with noise of its own purpose: the numbers of (seed, chain, step) and no other run's. Momenta are
/// drawn from Maxwell's distribution p_i ~ N(0, m_i kT) where that is asked for.
class burn_in_chains {
 public:
  /// BAOAB on the system in the chains' bath.
  using stepper_type = stepper<model, double, counter_noise>;

  /// Chains of a system, which comes without its bath, in another bath.
  burn_in_chains(const model& base, const bath& heat_bath, double step, std::uint64_t seed)
      : system_(own_copy(base).in(heat_bath)),
        stepper_(make_stepper(system_, method(baoab{}), step, counter_noise(seed, noise_purpose::burn_in))) {}
  burn_in_chains(const burn_in_chains&) = delete;  // the stepper refers to the system
  burn_in_chains& operator=(const burn_in_chains&) = delete;

  const model& system() const { return system_; }                      ///< the system in the chains' bath
  double step() const { return stepper_.step_size(); }                 ///< h of BAOAB
  double temperature() const { return system_.bath().temperature(); }  ///< kT, an energy

  /// Chains under way in the lanes of T, from these positions; lane 0 sees the noise of chain `first`.
  template <class T>
  detail::lockstep<stepper_type, T> open(phase_point<T, Eigen::Dynamic> start, std::int64_t first,
                                         int count) const {
    draw_momenta(start, first, 0);
    return {stepper_, start, count, first};
  }

  /// Draws momenta from Maxwell's distribution, with the noise of a step; lane 0 is chain `first`.
  template <class T>
  void draw_momenta(phase_point<T, Eigen::Dynamic>& x, std::int64_t first, std::int64_t step) const {
    constexpr int after_the_letter = 1;
    stepper_.noise().normals(noise_place{static_cast<std::uint64_t>(first), step, after_the_letter}, x.p);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      double square = temperature();
      if (!system_.has_unit_mass()) square /= system_.inverse_mass(i);
      x.p[i] = x.p[i] * std::sqrt(square);
    }
  }

 private:
  model system_;
  stepper_type stepper_;
};

// Some chains that are watched, to learn how long they remember.

/// A chain ran away: the motion is not confined, or the step is too large.
struct chain_diverged : std::runtime_error {
  chain_diverged(const std::string& text, std::int64_t at) : std::runtime_error(text), step(at) {}
  std::int64_t step;  // number of the step
};

/// Chains of a pilot: how many, in which bath, at which step.
struct pilot_plan {
  bath heat_bath;            ///< friction and temperature of the chains
  double step;               ///< h of BAOAB
  int count;                 ///< number of chains
  std::int64_t first_noise;  ///< number of chain 0 in the noise
};

/// Chains 0, 1, ... from starts of their numbers, with noise from `first_noise` on.
template <class T>
class burn_in_pilot {
  using state = phase_point<T, Eigen::Dynamic>;
  static constexpr int width = lanes_in<T>;

  struct block {
    std::shared_ptr<const burn_in_chains> chains;
    int first;
    int count;
    state start;
    detail::lockstep<burn_in_chains::stepper_type, T> run;
  };

  /// Sums over an interval of time, as a Measure. Forces are not among the numbers that are read: these are
  /// kept for some steps, of which forces would take much.
  struct sums_over_time {
    const burn_in_pilot& pilot;
    const burn_in_chains& chains;
    vector<T, Eigen::Dynamic> of_forces;
    detail::of_watched<T> sum{};
    detail::of_watched<T> squares{};
    double observations = 0.0;

    static std::size_t width() { return detail::watched_numbers; }
    void read(const state& x, std::span<T> out) { pilot.read(chains, x, out, of_forces); }
    void see(std::int64_t, std::span<const T> seen, const detail::condition_of<T>&) {
      observations += 1.0;
      for (std::size_t i = 0; i < detail::watched_numbers; ++i) {
        sum[i] += seen[i];
        squares[i] += seen[i] * seen[i];
      }
    }
    double mean(const T& of, int k) const { return lane(of, k) / observations; }
  };

 public:
  /// Refers to the weights of the slowest mode, which may be empty.
  burn_in_pilot(const model& base, const initial_states& from, const pilot_plan& plan,
                const burn_in_options& options, const Eigen::VectorXd& slowest)
      : threads_(options.execution.threads), count_(plan.count), slowest_(&slowest) {
    for (int first = 0; first < plan.count; first += width) {
      const int here = std::min(width, plan.count - first);
      const state start = detail::sound_starts<T>(base, from, options.seed, first, here);
      const auto own = std::make_shared<const burn_in_chains>(base, plan.heat_bath, plan.step, options.seed);
      blocks_.push_back({own, first, here, start, own->open(start, plan.first_noise + first, here)});
    }
  }

  /// Goes on to step `end`, watching from here on. Throws chain_diverged, naming the first that did.
  watched_interval watch(std::int64_t end, std::int64_t every) {
    watched_interval result;
    const auto all = static_cast<std::size_t>(count_);
    for (auto* numbers : {&result.begin, &result.mean, &result.square})
      numbers->fill(std::vector<double>(all));
    result.force_square.assign(all, Eigen::VectorXd());
    std::vector<double> begin(all);
    std::vector<double> finish(all);
    const std::int64_t before = blocks_.front().run.step();
    result.duration = static_cast<double>(end - before) * chains().step();
    result.zero = zero_ = lane(potential_of(chains(), blocks_.front().run.synchronous()), 0);
    for_each_trajectory(std::ssize(blocks_), {.threads = threads_}, [&](std::int64_t b) {
      block& here = blocks_[static_cast<std::size_t>(b)];
      read_way(here, begin);
      follow(here, end, every, result);
      read_way(here, finish);
    });
    require_all_alive();
    result.way_to_begin = std::move(begin);
    result.way_to_end = mean_over_chains(finish).mean;
    return result;
  }

 private:
  const burn_in_chains& chains() const { return *blocks_.front().chains; }

  /// What is watched; adds the square of each force to a sum.
  void read(const burn_in_chains& chains, const state& x, std::span<T> out,
            vector<T, Eigen::Dynamic>& squares_of_forces) const {
    const model& system = chains.system();
    auto f = detail::make_vector<T>(system);
    auto p = x.p;
    force<T>(system, x.q, f);
    T virial(0.0);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      virial -= x.q[i] * f[i];
      squares_of_forces[i] += f[i] * f[i];
      p[i] += f[i] * (0.5 * chains.step());
    }
    velocity<T>(system, p, f);
    T twice_kinetic(0.0);
    for (Eigen::Index i = 0; i < x.size(); ++i) twice_kinetic += p[i] * f[i];
    const double each = 1.0 / (chains.temperature() * static_cast<double>(x.size()));
    out[0] = twice_kinetic * each;
    out[1] = virial * each;
    out[2] = (potential_of(chains, x) - zero_) * each;
    T of_mode(0.0);
    for (Eigen::Index i = 0; i < slowest_->size(); ++i) of_mode += x.q[i] * (*slowest_)[i];
    out[3] = of_mode * of_mode / chains.temperature();
  }
  /// 0 where the system knows no potential.
  static T potential_of(const burn_in_chains& chains, const state& x) {
    const model& system = chains.system();
    return system.facts().has_potential ? system.kernels<T>().potential(x.q) : T(0.0);
  }

  void follow(block& here, std::int64_t end, std::int64_t every, watched_interval& result) {
    detail::of_watched<T> begin;
    sums_over_time sums{*this, *here.chains, detail::make_vector<T>(here.chains->system())};
    sums.read(here.run.synchronous(), begin);
    for (T& square : sums.of_forces) square = T(0.0);
    here.run.go_on(end, every, sums);
    for (int k = 0; k < here.count; ++k) {
      const auto chain = static_cast<std::size_t>(here.first + k);
      for (std::size_t i = 0; i < detail::watched_numbers; ++i) {
        result.begin[i][chain] = lane(begin[i], k);
        result.mean[i][chain] = sums.mean(sums.sum[i], k);
        result.square[i][chain] = sums.mean(sums.squares[i], k);
      }
      auto& forces = result.force_square[chain];
      forces.resize(sums.of_forces.size());
      for (Eigen::Index i = 0; i < forces.size(); ++i) forces[i] = sums.mean(sums.of_forces[i], k);
    }
  }

  void read_way(const block& here, std::vector<double>& way) const {
    const state x = here.run.synchronous();
    T sum(0.0);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const T d = x.q[i] - here.start.q[i];
      sum += d * d;
    }
    for (int k = 0; k < here.count; ++k) way[static_cast<std::size_t>(here.first + k)] = lane(sum, k);
  }

  void require_all_alive() const {
    for (const block& here : blocks_) {
      for (int k = 0; k < here.count; ++k) {
        const auto lost = here.run.diverged_at(k);
        if (!lost) continue;
        const std::string text = sentence(
            "gibbs: the motion of {} must be confined and the step small enough, got pilot chain {} that "
            "diverged at time {} with the step {}",
            describe(chains().system().base()), here.first + k,
            detail::in_digits(static_cast<double>(*lost) * chains().step(), 6),
            detail::in_digits(chains().step(), 6));
        throw chain_diverged(text, *lost);
      }
    }
  }

  int threads_;
  int count_;
  const Eigen::VectorXd* slowest_;
  std::vector<block> blocks_;
  double zero_ = 0.0;  // of the potential: a large constant in it, or a hot start, would drown what varies
};

/// w with w . q = omega x of the mode that is slowest, so that (w . q)^2 is kT in the mean: what all other
/// means would hide in a system of many modes. Empty where the system declares no modes, or some without a
/// frequency: then the slowest motion is none of them. Cost: that of modes().
inline Eigen::VectorXd slowest_mode(const model& system) {
  if (!has_modes(system)) return {};
  const auto modes = detail::modal_coordinates::of(system);
  const auto omega = std::ranges::min_element(modes->frequencies());
  if (!(*omega > 0.0)) return {};
  const auto slowest = omega - modes->frequencies().begin();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(modes->size());
  for (const auto& [i, k, heavy, light] : modes->entries()) {
    if (k == slowest) weights[i] = *omega * heavy;
  }
  return weights;
}

// Burn-in of chains: length, friction and step with which they forget their starts.

namespace detail {

/// Throws std::invalid_argument if an option is out of range.
void require_burn_in(const burn_in_options& options);
/// Throws std::runtime_error where the potential of chains that have gone far is another than that of the
/// others, or no chain met a force.
void refuse_escape(const watched_interval& later, const model& system);
/// Throws std::runtime_error where a discrepancy of number i shows; `what` says what it is.
void refuse_discrepancy(const burn_in_report::discrepancy& found, std::size_t i, const char* what,
                        const burn_in_report& report);

}  // namespace detail

/// The search for a burn-in.
template <class T>
class burn_in_search {
 public:
  /// Of chains that start at states of `from`, of a system that comes without its bath; refers to both.
  /// Throws std::invalid_argument if an option is out of range.
  burn_in_search(const model& base, double temperature, const initial_states& from,
                 const burn_in_options& options)
      : base_(&base), temperature_(temperature), from_(&from), options_(options) {
    detail::require_burn_in(options);
    slowest_ = slowest_mode(base);
  }

  /// Throws std::runtime_error where a chain diverges, nothing becomes stationary, or a check fails.
  burn_in_report find() {
    const auto began = std::chrono::steady_clock::now();
    burn_in_report report;
    report.step =
        options_.step > 0.0 ? options_.step : step_of_motion(*base_, *from_, temperature_, 0.5, "gibbs");
    while (!settle(report)) {
      report.step *= 0.5;
      ++report.halvings;
    }
    const double length = options_.length > 0.0 ? options_.length : times_of_tau() * report.tau;
    report.steps = std::max<std::int64_t>(1, std::llround(std::ceil(length / report.step)));
    report.length = static_cast<double>(report.steps) * report.step;
    check(report);
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return report;
  }

 private:
  static constexpr int most_biased = 6;  // halvings because of a bias

  /// Over tau energies fall to a part 1/e^2 of what the starts had above those of the bath: the starts of a
  /// bath that is 10^4 times colder and more take longer.
  double times_of_tau() const {
    constexpr double most = std::numeric_limits<double>::max();
    return std::max(20.0, 10.0 + std::log(std::clamp(hottest_, 1.0, most)));
  }

  burn_in_pilot<T> pilot(double friction, double step, int count) {
    // Far from the numbers of chains that anybody uses, and from those of other pilots.
    const std::int64_t noise = (std::int64_t{1} << 47) + (pilots_++ << 24);
    return {*base_,
            *from_,
            {bath::of_temperature(friction, temperature_), step, count, noise},
            options_,
            slowest_};
  }

  /// Chains that are watched for 32 times what they remember, after as long a time unwatched; nothing where
  /// that would take longer than `most`.
  std::optional<watched_interval> stationary(double friction, double step, int count, double most) {
    constexpr std::int64_t observations = 256;
    auto chains = pilot(friction, step, count);
    hottest_ = std::max(hottest_, chains.watch(observations, observations).largest_at_begin());
    for (std::int64_t every = 1; 2 * every * observations <= options_.most_steps; every *= 2) {
      const auto interval = chains.watch(2 * every * observations, every);
      if (interval.duration >= 32.0 * interval.tau() && !interval.is_cooling()) return interval;
      if (interval.duration > 32.0 * most) return std::nullopt;
    }
    throw std::runtime_error(sentence(
        "gibbs: {} must become stationary within {} steps of {} with the friction {}; give another "
        "friction or more steps",
        describe(*base_), options_.most_steps, detail::in_digits(step, 6), detail::in_digits(friction, 6)));
  }

  /// The friction with the least tau, of omega/4, omega/16, ... with the highest frequency omega: strong
  /// friction makes slow motion creep, weak friction leaves energies what they were.
  double best_friction(double step) {
    const double declared = highest_frequency(base_->frequency_bands());
    const double omega = declared > 0.0 ? declared : 0.5 / step;
    double best = 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (const double part : {1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0 / 256}) {
      const auto interval = stationary(part * omega, step, std::min(64, options_.pilots), least);
      if (!interval || interval->tau() >= least) continue;
      best = part * omega;
      least = interval->tau();
    }
    return best;
  }

  /// Whether the step shows no bias against half of it. A step at which chains diverge is too large as well.
  bool settle(burn_in_report& report) {
    constexpr double forever = std::numeric_limits<double>::infinity();
    try {
      report.friction = options_.friction > 0.0 ? options_.friction : best_friction(report.step);
      const auto coarse = *stationary(report.friction, report.step, options_.pilots, forever);
      const auto fine = *stationary(report.friction, 0.5 * report.step, options_.pilots, forever);
      report.tau = std::max(coarse.tau(), fine.tau());
      report.confined = coarse.confined() && fine.confined();
      bool sound = true;
      for (std::size_t i = 0; i < detail::watched_numbers; ++i) {
        const burn_in_report::discrepancy a = mean_over_chains(coarse.mean[i]);
        const burn_in_report::discrepancy b = mean_over_chains(fine.mean[i]);
        report.bias[i] = {a.mean - b.mean, std::hypot(a.standard_error, b.standard_error)};
        if (i == static_cast<std::size_t>(burn_in_report::watched::potential))
          report.bias[i].mean +=
              (coarse.zero - fine.zero) / (temperature_ * static_cast<double>(size(*base_)));
        // The momenta of the chains are not used.
        if (i != static_cast<std::size_t>(burn_in_report::watched::kinetic) && counts(report, i))
          sound = sound && !report.bias[i].shows();
      }
      if (sound) return true;
    } catch (const chain_diverged& one) {
      // Starts may be much colder than the bath, and their frequency much too low: then chains diverge at
      // once, and halving costs little. A motion that is not confined takes its time, however small the step.
      // What is met now and then, as where a valley is narrow far out, takes some thousand steps to show, and
      // few halvings.
      constexpr std::int64_t at_once = 10'000;
      constexpr std::int64_t now_and_then = 100'000;
      constexpr int few = 3;
      constexpr int most_halvings = 60;
      const bool is_late = one.step > at_once && (one.step > now_and_then || late_++ == few);
      if (is_late || report.halvings == most_halvings) throw;
      return false;
    }
    if (biased_++ < most_biased) return false;
    throw std::runtime_error(
        sentence("gibbs: the step must have no bias that shows, got {}; give a smaller one",
                 detail::in_digits(report.step, 6)));
  }

  static bool counts(const burn_in_report& report, std::size_t i) {
    return i != static_cast<std::size_t>(burn_in_report::watched::virial) || report.confined;
  }

  /// Fresh pilots at the end of the burn-in against equipartition, and against themselves later.
  void check(burn_in_report& report) {
    auto chains = pilot(report.friction, report.step, options_.pilots);
    chains.watch(report.steps, report.steps);
    const auto later = chains.watch(2 * report.steps, std::max<std::int64_t>(1, report.steps / 256));
    for (std::size_t i = 0; i < detail::watched_numbers; ++i) {
      std::vector<double> difference = later.begin[i];
      for (std::size_t k = 0; k < difference.size(); ++k) difference[k] -= later.mean[i][k];
      report.to_forget[i] = mean_over_chains(difference);
      if (i < static_cast<std::size_t>(burn_in_report::watched::potential)) {
        report.excess[i] = mean_over_chains(later.begin[i]);
        report.excess[i].mean -= 1.0;
      }
      if (!counts(report, i)) continue;
      detail::refuse_discrepancy(report.excess[i], i, "be that of equipartition", report);
      detail::refuse_discrepancy(report.to_forget[i], i, "not change afterwards", report);
    }
    if (!report.confined) detail::refuse_escape(later, *base_);
  }

  const model* base_;
  double temperature_;
  const initial_states* from_;
  burn_in_options options_;
  Eigen::VectorXd slowest_;
  std::int64_t pilots_ = 0;
  int biased_ = 0;        // steps that showed a bias
  int late_ = 0;          // steps at which a chain diverged late
  double hottest_ = 0.0;  // kT for each coordinate: the highest energy at a start
};

}  // namespace nysalt
