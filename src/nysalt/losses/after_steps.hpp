// SPDX-License-Identifier: BSL-1.0
// The loss over windows of steps, a pass over the data.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/family.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"
#include "nysalt/stepper.hpp"
#include "windows.hpp"

namespace nysalt {

/// The residuals of one window, and their derivatives by theta.
template <Scalar R>
struct residuals_of_window {
  std::size_t parameters;  ///< number of parameters
  std::vector<R> values;   ///< r_k, in the lanes of R; those of an earlier time first
  std::vector<R> slopes;   ///< derivatives of residual k by parameter i at [k parameters + i]

  /// The derivative of residual k by parameter i.
  const R& slope(std::size_t k, std::size_t i) const { return slopes[k * parameters + i]; }
};

/// The terms that are made of the residuals: as many as were asked for. Called from several threads at a
/// time.
template <Scalar R>
using terms_of_window = std::function<void(const residuals_of_window<R>& r, std::vector<R>& terms)>;

/// The mean over all windows and over some times of each of the sum over residuals of r^2; a window_error
/// says what they are.
///
/// Windows of a trajectory depend on each other, trajectories do not. R, double or a pack, carries the
/// windows; neither its lanes nor the threads change a bit of a sum. Of trajectories that ranks share, each
/// rank has its own.
template <Scalar R = detail::lanes>
class after_steps : public loss_on_data {
  using C = dual<R, detail::directions_at_a_time>;
  static constexpr int N = Eigen::Dynamic;

 public:
  /// Refers to what the error refers to, and copies the data. Throws std::invalid_argument
  /// if no trajectory is as long, if R is a pack and the system is stepped over double only, or if the
  /// system is in a noisy bath and the data do not hold the noise that the letters O of the word need.
  after_steps(const nysalt::family& family, const model& system, const flow_map_data& data,
              window_error<R> error, const after_steps_options& options = {})
      : family_(family),
        system_(system),
        error_(std::move(error)),
        step_(data.step),
        options_(options),
        share_(data.share()),
        starts_(data, last_of(options), static_cast<std::size_t>(std::max(options.apart, 1)),
                std::max(options.every, 1)) {
    if (1 < lanes_in<R> && !system.facts().in_lanes_with_slopes) {
      throw std::invalid_argument(
          sentence("after_steps: a system must allow several lanes for a loss over packs, got {}; take "
                   "after_steps<double>, and an error over double",
                   describe(system)));
    }
    const std::int64_t windows = data.share().ranks().sum(std::ssize(starts_.pairs));
    if (windows == 0) {
      throw std::invalid_argument(
          sentence("after_steps: trajectories must have at least the {} steps of the loss; take a "
                   "longer horizon, or fewer steps",
                   options.steps.back()));
    }
    weight_ = 1.0 / static_cast<double>(windows * std::ssize(options.steps));
    parts_ =
        std::make_shared<const parts>(gather_windows<R>(data, starts_, options.steps, noise_wanted(data)));
  }

  /// The loss of another family over the same windows, which both share. The other word must have its
  /// letters O where this one has.
  after_steps(const after_steps& same, const nysalt::family& family)
      : family_(family),
        system_(same.system_),
        error_(same.error_),
        step_(same.step_),
        weight_(same.weight_),
        options_(same.options_),
        share_(same.share_),
        starts_(same.starts_),
        parts_(same.parts_),
        rooms_(same.rooms_) {}

  squares at(const Eigen::VectorXd& theta) const override;
  std::vector<double> by_trajectory(const Eigen::VectorXd& theta) const override;
  Eigen::VectorXd by_residual(const Eigen::VectorXd& theta) const override;
  std::vector<Eigen::MatrixXd> gradients(const Eigen::VectorXd& theta) const override;
  bool has_estimated_weights() const override { return error_.weight_deviations != nullptr; }
  std::unique_ptr<const loss_on_data> of_family(const nysalt::family& family) const override {
    return std::make_unique<const after_steps>(*this, family);
  }
  const shard& share() const override { return share_; }
  /// As `counted` counts the force evaluations for one window after the other.
  std::int64_t evaluations() const override { return evaluations_; }

  Eigen::Index parameters() const { return family_.parameters(); }          ///< length of theta
  std::size_t trajectories() const { return starts_.first_of.size() - 1; }  ///< number of trajectories here
  std::size_t residuals() const override { return error_.residuals * options_.steps.size(); }

  /// A pass over the data: each trajectory's mean over all windows of the `terms` terms that of_window(r,
  /// terms) makes of the residuals, added in the order of time. Rethrows exceptions of the user's loss on
  /// every rank. Never throws otherwise; inadmissible theta yield non-finite values. Cost: a plain step, or a
  /// run of K steps, over dual<R, 2> for each window and two parameters.
  std::vector<Eigen::VectorXd> sums(const Eigen::VectorXd& theta, bool with_slopes, Eigen::Index terms,
                                    const terms_of_window<R>& of_window) const {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(terms);
    std::vector<Eigen::VectorXd> result(trajectories(), zero);
    const auto coefficients = in_directions(theta, with_slopes);
    const nysalt::word& word = family_.letters;
    const std::int64_t steps = options_.steps.back();
    const std::int64_t evaluations_of_window =
        detail::evaluations_of(system_,
                               steps == 1 ? word.evaluations_of_plain_step
                                          : word.evaluations_to_open + steps * word.evaluations_per_step +
                                                std::ssize(options_.steps) * word.evaluations_to_observe,
                               steps * word.force_derivatives);
    const auto visit = [&](std::int64_t index) {
      const auto& part = (*parts_)[static_cast<std::size_t>(index)];
      if (part.entries.empty()) return;  // trajectories that are too short
      const model watched = system_.separate();
      std::vector<stepper_type> steppers;
      for (const auto& c : coefficients) {
        steppers.emplace_back(watched, family_.letters, c, step_,
                              noise_of_entries<R>{&part.entries, family_.letters.stochastic_letters});
      }
      auto x = make_state(watched);
      auto y = make_state(watched);
      const auto taken = rooms_->take();
      auto& [r, of_directions] = *taken;
      r.parameters = static_cast<std::size_t>(parameters());
      r.values.resize(residuals());
      r.slopes.resize(with_slopes ? residuals() * r.parameters : 0);
      of_directions.resize(residuals());
      std::vector<R> added(static_cast<std::size_t>(terms));
      std::size_t trajectory = part.first_trajectory;
      std::size_t window = starts_.first_of[trajectory];
      Eigen::VectorXd sum = zero;  // of one trajectory
      for (std::size_t entry = 0; entry < part.entries.size(); ++entry) {
        for (std::size_t d = 0; d < steppers.size(); ++d) {
          residuals_after(steppers[d], part.entries[entry], entry, x, y, of_directions);
          take(of_directions, d, with_slopes, r);
        }
        of_window(r, added);
        for (int k = 0; k < lanes_in<R> && window < part.end;) {
          for (; window == starts_.first_of[trajectory + 1]; ++trajectory) {
            result[trajectory] = sum * weight_;
            sum = zero;
          }
          const std::size_t left = starts_.first_of[trajectory + 1] - window;
          const int end =
              static_cast<int>(std::min<std::size_t>(lanes_in<R>, static_cast<std::size_t>(k) + left));
          add_lanes(added, k, end, sum);
          window += static_cast<std::size_t>(end - k);
          k = end;
        }
      }
      result[trajectory] = sum * weight_;
      const std::int64_t of_each = detail::is_black_box(watched)
                                       ? watched.calls() / std::ssize(part.entries)
                                       : std::ssize(steppers) * evaluations_of_window;
      evaluations_ += of_each * static_cast<std::int64_t>(part.end - part.begin);
      rooms_->give(taken);
    };
    const auto pass = [&] {
      for_each_trajectory(std::ssize(*parts_), {.threads = options_.execution.threads}, visit);
    };
    if (error_.may_throw) {
      collectively(share_.ranks(), pass);
    } else {
      pass();
    }
    return result;
  }

 private:
  using stepper_type = stepper<model, C, noise_of_entries<R>>;
  using parts = std::vector<windows_in_lanes<R>>;

  /// Room for the residuals of a window, some megabytes for long windows.
  struct room {
    residuals_of_window<R> r;
    std::vector<C> of_directions;
  };

  /// Rooms that one pass leaves to the next: where the allocator gives such blocks back to the system, to ask
  /// for new ones takes a third of a pass. Not one a thread: a thread that waits within a force of many
  /// threads may begin another window.
  class rooms {
   public:
    std::shared_ptr<room> take() {
      const std::scoped_lock lock(guard_);
      if (free_.empty()) return std::make_shared<room>();
      auto last = std::move(free_.back());
      free_.pop_back();
      return last;
    }
    void give(std::shared_ptr<room> one) {
      const std::scoped_lock lock(guard_);
      free_.push_back(std::move(one));
    }

   private:
    std::mutex guard_;
    std::vector<std::shared_ptr<room>> free_;
  };

  static std::size_t last_of(const after_steps_options& options) {
    const auto& steps = options.steps;
    const bool are_rising = std::ranges::adjacent_find(steps, std::greater_equal<>()) == steps.end();
    if (steps.empty() || steps.front() < 1 || !are_rising) {
      std::string given;
      for (const int k : steps) given += (given.empty() ? "" : ", ") + std::to_string(k);
      throw std::invalid_argument(
          sentence("after_steps: steps must be rising numbers from 1 on, got {}", given));
    }
    return static_cast<std::size_t>(steps.back());
  }

  static flow_state<C, N> make_state(const model& system) {
    return {{detail::make_vector<C>(system), detail::make_vector<C>(system)}, detail::make_vector<C>(system)};
  }

  /// The coefficients with their derivatives along two parameters at a time, in all lanes.
  std::vector<std::vector<C>> in_directions(const Eigen::VectorXd& theta, bool with_slopes) const {
    const auto c = family_.coefficients(theta);
    const Eigen::MatrixXd slopes = family_.jacobian(theta);
    std::vector<std::vector<C>> result;
    for (Eigen::Index first = 0; first == 0 || first < parameters(); first += detail::directions_at_a_time) {
      result.emplace_back(c.begin(), c.end());
      if (!with_slopes) return result;
      for (std::size_t i = 0; i < c.size(); ++i) {
        for (Eigen::Index k = 0;
             k < std::min<Eigen::Index>(detail::directions_at_a_time, parameters() - first); ++k) {
          result.back()[i].derivative[static_cast<std::size_t>(k)] =
              R(slopes(static_cast<Eigen::Index>(i), first + k));
        }
      }
    }
    return result;
  }

  void residuals_after(const stepper_type& stepper, const auto& entry, std::size_t number,
                       flow_state<C, N>& x, flow_state<C, N>& y, std::vector<C>& r) const {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x.q[i] = C(entry.start.q[i]);
      x.p[i] = C(entry.start.p[i]);
    }
    if (options_.steps.back() == 1) {
      stepper.step(x, number);
      error_.of(entry.start, x, entry.finish.front(), r.data());
      return;
    }
    stepper.run(x, y, options_.steps, number, [&](std::size_t k) {
      error_.of(entry.start, y, entry.finish[k], r.data() + k * error_.residuals);
    });
  }

  /// Adds lanes begin .. end - 1 of each term to its sum, one after the other.
  static void add_lanes(const std::vector<R>& terms, int begin, int end, Eigen::VectorXd& sums) {
    for (Eigen::Index i = 0; i < sums.size(); ++i) {
      const R& term = terms[static_cast<std::size_t>(i)];
      double sum = sums[i];
      if (begin == 0 && end == lanes_in<R>) {  // known when compiling: unrolled
        for (int k = 0; k < lanes_in<R>; ++k) sum += lane(term, k);
      } else {
        for (int k = begin; k < end; ++k) sum += lane(term, k);
      }
      sums[i] = sum;
    }
  }

  static void take(const std::vector<C>& of_directions, std::size_t d, bool with_slopes,
                   residuals_of_window<R>& r) {
    for (std::size_t k = 0; k < r.values.size(); ++k) {
      r.values[k] = of_directions[k].value;
      if (!with_slopes) continue;
      for (std::size_t i = 0; i < detail::directions_at_a_time; ++i) {
        const std::size_t parameter = d * detail::directions_at_a_time + i;
        if (parameter < r.parameters) r.slopes[k * r.parameters + parameter] = of_directions[k].derivative[i];
      }
    }
  }

  wanted_noise noise_wanted(const flow_map_data& data) const {
    const bath& in = system_.bath();
    const nysalt::word& word = family_.letters;
    if (in.sigma() == 0.0 || word.stochastic_letters == 0) return {};
    const auto needed = detail::intervals_of_noise(word, family_.coefficients(family_.starts.front().theta));
    if (data.noise_parts == 0 || data.noise_parts % needed.parts != 0) {
      throw std::invalid_argument(
          sentence("noise_parts of the data must be a multiple of {} for the word {}, got {}; make the data "
                   "with noise_parts = {}",
                   needed.parts, word.letters(), data.noise_parts, needed.parts));
    }
    return {needed.in_parts(data.noise_parts), in.friction() * data.step / data.noise_parts};
  }

  nysalt::family family_;
  model system_;
  window_error<R> error_;
  double step_;
  double weight_ = 1.0;  // of a window
  after_steps_options options_;
  shard share_;
  window_starts starts_;
  std::shared_ptr<const parts> parts_;
  std::shared_ptr<rooms> rooms_ = std::make_shared<rooms>();
  mutable std::atomic<std::int64_t> evaluations_ = 0;
};

extern template class after_steps<detail::lanes>;
extern template class after_steps<double>;

}  // namespace nysalt
