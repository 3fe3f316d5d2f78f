// SPDX-License-Identifier: BSL-1.0
// Measures of the error of a trajectory.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/kernels/kernels.hpp"
#include "nysalt/model.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Averaging of errors e of samples to one number. Means over times come first, those over trajectories last:
///   mean           mean of e
///   root_of_each   mean over trajectories of sqrt(mean over times of e)
///   root_of_all    sqrt(mean over trajectories and times of e)
enum class averaging { mean, root_of_each, root_of_all };

/// A measure reads a few numbers of a state and compares the numbers of a method with the numbers of a
/// reference: the exact state at the same time, or the state at the start. It is a value that is chosen at
/// run time; the measures of the library are below. Its functions take one trajectory, over double, and
/// trajectories side by side, over packs: lambdas of `auto` do. They may be called from several threads at
/// once, and with lanes that hold no sound trajectory.
struct error_measure {
  std::string name;   ///< name in reports
  std::size_t width;  ///< numbers that are read of a state
  /// read(x, result) writes the `width` numbers of a state to a span.
  detail::over_scalars<detail::reads_numbers> read;
  /// error(seen, reference): the error of one sample, from spans of the numbers.
  detail::over_scalars<detail::of_two_samples> error;
  averaging how;                ///< makes one number of all errors
  bool needs_reference = true;  ///< false: the reference is the start
  /// The divisor of `error`, sample by sample, from the numbers of the reference. Where that is 0 there is
  /// no error, and where its sign is not the same everywhere its mean does not exist: `no_scale` says so. Not
  /// given: nothing.
  detail::over_scalars<detail::of_sample> scale = {};
  std::string no_scale = {};  ///< the sentence that is thrown where there is no scale
  /// The scale that errors are relative to, >= 0 and in the units of `error`, from the numbers of the
  /// reference: the mean error is divided by the mean of this over all trajectories and times, which is a
  /// property of their distribution, and positive unless all is 0 (`no_scale` then). Not given: absolute.
  detail::over_scalars<detail::of_sample> relative_to = {};
  Eigen::Index dimension = 0;  ///< degrees of freedom of the measured systems; 0: any number

  /// The contribution of a trajectory whose errors, weighted by time, add up to `sum`.
  double score(double sum, double weights) const;
  /// The divisor of errors: 1, or the mean of `sizes`, the means over time of what they are relative to,
  /// one a trajectory; its root where errors are of squares. Without sizes errors are absolute.
  double unit(std::span<const double> sizes) const;
  /// The error over all trajectories and its standard error, from their scores (NaN: does not count) and
  /// sizes, of which there may be more. A root has the standard error of the mean below it times 1/(2 root),
  /// a ratio follows from its parts by the delta method.
  estimate average(std::span<const double> scores, std::span<const double> sizes = {}) const;
  /// The part of each trajectory in that error: numbers of which it is the mean, and whose scatter makes its
  /// standard error (linearised about the mean where it is a root or a ratio). On the same trajectories two
  /// methods differ by the mean of the differences of theirs.
  std::vector<double> parts(std::span<const double> scores, std::span<const double> sizes = {}) const;
  /// The error of each trajectory by itself, in the unit of the whole: of these there are quantiles.
  std::vector<double> of_each(std::span<const double> scores, std::span<const double> sizes = {}) const;

  /// The values that read() writes of a state.
  template <class T, int N>
  std::vector<T> numbers_of(const phase_point<T, N>& x) const {
    std::vector<T> result(width);
    read(phase_point<T, Eigen::Dynamic>{x.q, x.p}, std::span<T>(result));
    return result;
  }
};

/// The error of the state in the energy norm, e^2 = sum_k w_k^2 dx_k^2 + dy_k^2 in the system's modes
/// x = U^T M^{1/2} q, y = U^T M^{-1/2} p: sqrt(mean over trajectories and times of e^2), absolute. A mode of
/// frequency zero has weight 1; a system without modes() is measured in mass-weighted coordinates, all
/// weights 1. Throws std::invalid_argument if modes() has not the system's size. Cost of a sample: a product
/// with each entry of 2 N modes that is not zero.
error_measure state_measure(const model& system);

namespace detail {
error_measure energy_measure(const model& system);
}  // namespace detail

/// The relative error of the energy, sqrt(mean over trajectories and times of (H - H_0)^2) over the root mean
/// square of H_0 over trajectories: what each H_0 is divided by is the same for all, as one may pass through
/// 0. It needs no reference. The system is copied. There is no such error where H_0 is 0 on all trajectories.
template <HasEnergy S>
error_measure energy_measure(const S& system) {
  return detail::energy_measure(system);
}

/// A function of a state over T.
template <class F, class T, int N>
concept IsObservable = requires(const F& f, const phase_point<T, N>& x) {
  { f(x) } -> std::convertible_to<T>;
};

namespace detail {

/// An observable of states of N coordinates, of states whose dimension is known at run time.
template <int N, class Observable>
struct observable_of_any_dimension {
  Observable observable;

  template <class T>
  T operator()(const phase_point<T, Eigen::Dynamic>& x) const {
    return value_in_lanes<T>(observable, of_dimension<N>(x));
  }
};

error_measure path_measure(const over_scalars<of_state>& observable, Eigen::Index dimension);

}  // namespace detail

/// The error of an observable o along the path: the mean over trajectories of sqrt(mean over times of
/// (o - o_ref)^2), over the root mean square of o_ref over trajectories and times, which is the same for all:
/// o may pass through 0. The observable is copied, and called as observable(x) for one trajectory after the
/// other, or for all lanes at a time if it is marked by over_lanes. There is no such error where o_ref is 0
/// on all trajectories at all times.
template <System S, class Observable>
  requires IsObservable<Observable, double, S::dimension>
error_measure path_measure(const S& system, Observable observable) {
  const detail::observable_of_any_dimension<S::dimension, Observable> of_any{std::move(observable)};
  return detail::path_measure(of_any, size(system));
}

namespace detail {
error_measure relative_measure(error_measure path);
}  // namespace detail

/// The paper's average relative error of an observable o: the mean over trajectories of sqrt(mean over times
/// of
/// ((o - o_ref)/o_ref)^2). It is for observables that keep away from 0: where o_ref is 0, or has both signs,
/// its mean does not exist, and it is refused; where o_ref comes near to 0, few trajectories decide it
/// (tail_of). The observable is copied, and called as in path_measure. Source: [li_lu_tao_ye_2023,
/// equations (5.6-7)].
template <System S, class Observable>
error_measure relative_measure(const S& system, Observable observable) {
  return detail::relative_measure(path_measure(system, std::move(observable)));
}

/// A system with pairs() stiff springs and the energy of spring j, stiff_energy(x, j) >= 0.
template <class S, class T>
concept HasStiffEnergiesOver =
    System<S> && requires(const S& system, const phase_point<T, S::dimension>& x, Eigen::Index j) {
      { system.pairs() } -> std::convertible_to<Eigen::Index>;
      { system.stiff_energy(x, j) } -> std::same_as<T>;
    };
/// Stiff energies over double, see HasStiffEnergiesOver.
template <class S>
concept HasStiffEnergies = HasStiffEnergiesOver<S, double>;

/// Error of the exchange of energies I_j between the stiff springs, relative to their sum I: the mean over
/// trajectories and times of sum_j |I_j - I_j^ref|, over the mean of I^ref. The system is copied. There is no
/// such error where I^ref is 0 on all trajectories at all times.
template <HasStiffEnergies S>
error_measure exchange_measure(const S& system) {
  constexpr int N = S::dimension;
  const auto read = [system]<class T>(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) {
    const auto& same = detail::of_dimension<N>(x);
    for (std::size_t j = 0; j < result.size(); ++j) {
      const auto energy = [&](const auto& y) { return system.stiff_energy(y, static_cast<Eigen::Index>(j)); };
      if constexpr (detail::lanes_of<S> == 1) {  // packs are not even tried
        result[j] = value_in_lanes<T>(energy, same);
      } else if constexpr (HasStiffEnergiesOver<S, T>) {
        result[j] = energy(same);
      } else {
        result[j] = value_in_lanes<T>(energy, same);
      }
    }
  };
  const auto whole = []<class T>(std::span<const T> expected) {
    T total(0.0);
    for (const T& energy : expected) total += energy;
    return total;
  };
  const auto error = []<class T>(std::span<const T> seen, std::span<const T> expected) {
    using std::abs;
    T differences(0.0);
    for (std::size_t j = 0; j < expected.size(); ++j) differences += abs(seen[j] - expected[j]);
    return differences;
  };
  return {.name = "exchange",
          .width = static_cast<std::size_t>(system.pairs()),
          .read = read,
          .error = error,
          .how = averaging::mean,
          .no_scale =
              "the exchange error: the stiff energy on the reference, to which the error is relative, must "
              "not be 0; take starts at which the stiff springs move, or measure states",
          .relative_to = whole,
          .dimension = size(system)};
}

// The errors along trajectories side by side, added up.

namespace detail {

/// The errors of one trajectory in each lane, accumulated in the order of time. None is kept.
template <class T>
class errors_along {
 public:
  using numbers = std::span<const T>;  ///< residuals of one state

  /// Refers to the measure. The start, where all errors are 0, may have a weight too.
  explicit errors_along(const error_measure& measure, double weight_of_start = 0.0)
      : measure_(&measure), weights_(weight_of_start) {}

  /// Takes the error of sample i = 1, 2, ..., in this order, in the lanes that are live.
  void see(std::int64_t i, numbers seen, numbers reference, const condition_of<T>& live,
           double weight = 1.0) {
    sum_ = select(live, sum_ + measure_->error(seen, reference) * weight, sum_);
    weights_ += weight;
    lost_at_.take(both(!(sum_ - sum_ == T(0.0)), live), i);
  }

  /// The sum of the errors so far, in each lane.
  const T& sum() const { return sum_; }
  /// The first sample at which the error of lane k was not finite.
  std::optional<std::int64_t> lost_at(int k) const { return lost_at_[k]; }
  /// The contribution of the trajectory in lane k, see error_measure::score(); NaN if it was lost.
  double score(int k) const { return lost_at_[k] ? std::nan("") : measure_->score(lane(sum_, k), weights_); }

 private:
  const error_measure* measure_;
  double weights_;
  T sum_{0.0};
  first_in_lanes<T> lost_at_{};
};

}  // namespace detail

}  // namespace nysalt
