// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/counted.hpp"
#include "nysalt/ensemble_loop.hpp"
#include "nysalt/family.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/losses/metric.hpp"
#include "nysalt/losses/pairs_in_lanes.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt {

/// The paper's loss [li_lu_tao_ye_2023, equation (3.5)]: the mean over all pairs of
/// sum over coordinates of r^2 / Sigma, with r the error of one step from `start` to `finish`.
///
/// Pairs of a trajectory depend on each other, trajectories do not. R, double or a pack, carries the pairs;
/// neither its lanes nor the threads change a bit of a sum.
/// What a loss offers the learner: family, scalar, trajectories(), residuals(), sums(theta, zero, of_pair).
template <Family F, SeparableSystem S, Scalar R = scalar_of_passes<F, S>>
class one_step {
 public:
  using family = F;
  using scalar = R;

  /// Refers to system and metric, and copies the data. Throws std::invalid_argument if the system is in a
  /// noisy bath and the data do not hold the noise that the letters O of the word need.
  one_step(const S& system, const flow_map_data<S::dimension>& data, const metric<S::dimension>& measure,
           int threads = 1, const F& family = {})
      : family_(family),
        system_(&system),
        metric_(&measure),
        step_(data.step),
        share_(1.0 / static_cast<double>(data.pairs())),
        threads_(threads),
        first_of_(data.first_of),
        parts_(gather_pairs<R>(data, noise_wanted(data))) {}

  std::size_t trajectories() const { return first_of_.size() - 1; }
  /// Of each pair.
  std::size_t residuals() const { return static_cast<std::size_t>(metric_->residuals()); }
  /// Force evaluations of all passes so far, as `counted` counts them for one pair after the other.
  std::int64_t evaluations() const { return evaluations_; }

  /// A pass over the data: each trajectory's mean over all pairs of what of_pair(r, terms) makes of the
  /// residuals, added in the order of time. `zero` says how many terms there are. C is R or a dual of R,
  /// which carries derivatives by theta. Throws nothing: inadmissible theta give what arithmetic gives.
  template <Scalar C, class Sum>
  std::vector<Sum> sums(const std::array<C, static_cast<std::size_t>(F::parameters)>& theta, const Sum& zero,
                        const auto& of_pair) const {
    std::vector<Sum> result(trajectories(), zero);
    const auto coefficients = family_.coefficients(theta);
    const auto word = word_of(family_);
    const auto visit = [&](std::int64_t index) {
      const auto& part = parts_[static_cast<std::size_t>(index)];
      if (part.entries.empty()) return;  // trajectories without a pair
      const counted<S> watched(*system_);
      const noise_of_entries<R, S::dimension> noise{&part.entries};
      const stepper<counted<S>, typename F::word, C, noise_of_entries<R, S::dimension>> one(
          watched, word, coefficients, step_, noise);
      flow_state<C, S::dimension> x{{make_vector<C>(watched), make_vector<C>(watched)},
                                    make_vector<C>(watched)};
      std::vector<C> r(residuals());
      std::vector<R> terms(static_cast<std::size_t>(zero.size()));
      std::size_t trajectory = part.first_trajectory;
      std::size_t pair = first_of_[trajectory];
      Sum sum = zero;  // of one trajectory: local, so that it may stay in registers
      std::int64_t entry = 0;
      for (const auto& [start, finish, its_noise] : part.entries) {
        for (Eigen::Index i = 0; i < start.size(); ++i) {
          x.q[i] = C(start.q[i]);
          x.p[i] = C(start.p[i]);
        }
        one.step(x, 0, entry++);
        metric_->residual(x.q, x.p, finish, r.data());
        of_pair(r, terms);
        for (int k = 0; k < lanes_in<R> && pair < part.end; ++k, ++pair) {
          for (; pair == first_of_[trajectory + 1]; ++trajectory) {
            result[trajectory] = sum * share_;
            sum = zero;
          }
          for (Eigen::Index i = 0; i < sum.size(); ++i) {
            sum.data()[i] += lane(terms[static_cast<std::size_t>(i)], k);
          }
        }
      }
      result[trajectory] = sum * share_;
      const std::int64_t of_each = watched.evaluations / std::ssize(part.entries);
      evaluations_ += of_each * static_cast<std::int64_t>(part.end - part.begin);
    };
    for_each_trajectory(std::ssize(parts_), threads_, visit);
    return result;
  }

 private:
  wanted_noise noise_wanted(const flow_map_data<S::dimension>& data) const {
    if constexpr (HasBath<S>) {
      const bath& its = system_->bath();
      const auto word = word_of(family_);
      if (its.sigma() == 0.0 || word.stochastic_letters == 0) return {};
      const auto needed = intervals_of_noise(word, family_.coefficients(F::start()));
      if (data.noise_parts == 0 || data.noise_parts % needed.parts != 0) {
        throw std::invalid_argument(
            fmt::format("the data hold the noise of a step in {} parts, but the word {} needs it in {} or a "
                        "multiple: make "
                        "them with noise_parts = {}",
                        data.noise_parts, word.letters(), needed.parts, needed.parts));
      }
      return {needed.in_parts(data.noise_parts), its.friction() * data.step / data.noise_parts};
    }
    return {};
  }

  F family_;
  const S* system_;
  const metric<S::dimension>* metric_;
  double step_;
  double share_;
  int threads_;
  std::vector<std::size_t> first_of_;
  std::vector<pairs_in_lanes<R, S::dimension>> parts_;
  mutable std::atomic<std::int64_t> evaluations_ = 0;
};

}  // namespace nysalt
