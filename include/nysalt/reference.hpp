// SPDX-License-Identifier: BSL-1.0
// Accurate flows with a measured error, as values that are opened once and held open.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/model.hpp"

namespace nysalt {

/// Trajectory and position of the noise of a path: after `step` intervals of equal length.
struct path_place {
  std::uint64_t seed = 0;        ///< seed of the noise
  std::uint64_t trajectory = 0;  ///< trajectory number of the noise
  std::int64_t step = 0;         ///< number of preceding intervals of that length
};

namespace detail {

/// The equal intervals of time in which trajectories follow a reference, one trajectory in each lane.
struct reference_intervals {
  double length;        ///< time of an interval
  int count = 1;        ///< lanes that hold a trajectory, from lane 0 on
  path_place at{};      ///< path of lane 0, in a bath; each further lane has the path of the next trajectory
  int noise_parts = 0;  ///< equal parts of an interval of which the noise is kept, in a bath
};

/// Trajectories that follow a reference, interval by interval; one in each lane of T.
template <class T>
class reference_run {
 public:
  using state_type = phase_point<T, Eigen::Dynamic>;  ///< states of all lanes
  using column = vector<T, Eigen::Dynamic>;           ///< a number of each lane for each degree of freedom

  /// A run that begins at the start.
  reference_run(const state_type& start, const reference_intervals& intervals)
      : state_(start),
        noise_(static_cast<std::size_t>(intervals.noise_parts), column(start.size())),
        at_(intervals.at) {}
  virtual ~reference_run() = default;
  reference_run(const reference_run&) = delete;
  reference_run& operator=(const reference_run&) = delete;

  /// Follows the reference through the next interval.
  void advance() {
    evaluations_ += follow(state_, at_, noise_);
    ++at_.step;
  }
  const state_type& state() const { return state_; }  ///< present states
  /// Standard normal numbers of the noise over each part of the last interval, if the reference gives noise.
  std::span<const column> noise() const { return noise_; }
  std::int64_t evaluations() const { return evaluations_; }  ///< force evaluations of all trajectories so far

 private:
  /// x becomes the state at the end of an interval, which begins at a place of the path, and xi become the
  /// noise of its parts. Returns the force evaluations of all trajectories.
  virtual std::int64_t follow(state_type& x, const path_place& at, std::span<column> xi) = 0;

  state_type state_;
  std::vector<column> noise_;
  path_place at_;
  std::int64_t evaluations_ = 0;
};

template <class R, class T>
concept FlowOver = requires(const R& flow, const model& system, phase_point<T, Eigen::Dynamic>& x) {
  { flow.advance(system, x, 1.0) } -> std::convertible_to<std::int64_t>;
};
template <class R, class T>
concept FlowOnPathsOver = requires(const R& flow, const model& system, phase_point<T, Eigen::Dynamic>& x,
                                   std::span<vector<T, Eigen::Dynamic>> xi) {
  { flow.advance(system, x, 1.0, path_place{}, xi) } -> std::convertible_to<std::int64_t>;
};

/// What a reference is made of. Threads share it.
class reference_kind {
 public:
  using start_of_one = phase_point<double, Eigen::Dynamic>;
  using start_of_lanes = phase_point<lanes, Eigen::Dynamic>;

  virtual ~reference_kind() = default;
  virtual std::unique_ptr<reference_run<double>> open(const model& system, const start_of_one& start,
                                                      const reference_intervals& intervals) const = 0;
  virtual std::unique_ptr<reference_run<lanes>> open(const model& system, const start_of_lanes& start,
                                                     const reference_intervals& intervals) const = 0;
  virtual std::shared_ptr<const reference_kind> finer() const = 0;
  virtual std::string description() const = 0;
  virtual bool gives_noise() const = 0;
};

}  // namespace detail

/// A flow of one's own that is as good as exact, or as a path in a bath can be followed; it converts to a
/// reference:
/// advance(system, x, t)          x becomes the state a time t later; returns the force evaluations. Over
///                                packs, x holds a trajectory in each lane, and evaluations of one are
///                                returned
/// advance(system, x, t, at, xi)  in its stead, for a system in a bath: x goes on along the path from a
/// place,
///                                and xi, a span, become the noise of as many equal parts of t; over packs
///                                too
/// finer()                        the same flow, or path, with a much smaller error: the difference measures
///                                the error of this one
/// description()                  what it is, with its step or tolerance
/// The system is a const model&, x a phase_point<T, Eigen::Dynamic>& with T = double or a pack.
template <class R>
concept ReferenceFlow =
    (detail::FlowOver<R, double> || detail::FlowOnPathsOver<R, double>)&&requires(const R& flow) {
      { flow.finer() } -> std::same_as<R>;
      { flow.description() } -> std::convertible_to<std::string>;
    };

namespace detail {

template <ReferenceFlow R, class T>
class run_of_flow final : public reference_run<T> {
 public:
  run_of_flow(const R& flow, const model& system, const phase_point<T, Eigen::Dynamic>& start,
              const reference_intervals& intervals)
      : reference_run<T>(start, intervals),
        flow_(flow),
        system_(system.separate()),
        length_(intervals.length),
        count_(intervals.count) {}

 private:
  std::int64_t follow(phase_point<T, Eigen::Dynamic>& x, const path_place& at,
                      std::span<vector<T, Eigen::Dynamic>> xi) override {
    if constexpr (FlowOnPathsOver<R, T>) {
      return count_ * flow_.advance(system_, x, length_, at, xi);
    } else if constexpr (FlowOver<R, T>) {
      return count_ * flow_.advance(system_, x, length_);
    } else {
      std::int64_t evaluations = 0;
      for (int k = 0; k < count_; ++k) {
        auto one = lane(x, k);
        evaluations += flow_.advance(system_, one, length_);
        set_lane(x, k, one);
      }
      return evaluations;
    }
  }

  R flow_;
  model system_;
  double length_;
  int count_;
};

template <ReferenceFlow R>
class kind_of_flow final : public reference_kind {
 public:
  explicit kind_of_flow(const R& flow) : flow_(flow) {}

  std::unique_ptr<reference_run<double>> open(const model& system, const start_of_one& start,
                                              const reference_intervals& intervals) const override {
    return std::make_unique<run_of_flow<R, double>>(flow_, system, start, intervals);
  }
  std::unique_ptr<reference_run<lanes>> open(const model& system, const start_of_lanes& start,
                                             const reference_intervals& intervals) const override {
    return std::make_unique<run_of_flow<R, lanes>>(flow_, system, start, intervals);
  }
  std::shared_ptr<const reference_kind> finer() const override {
    return std::make_shared<kind_of_flow>(flow_.finer());
  }
  std::string description() const override { return flow_.description(); }
  bool gives_noise() const override { return FlowOnPathsOver<R, double>; }

 private:
  R flow_;
};

}  // namespace detail

/// An accurate flow with a measured error, of a system in no bath, or along the paths of one in a bath: what
/// data and errors come from. Copies share what the reference is made of, and so may threads.
class reference {
 public:
  /// A reference by a flow of one's own, which is copied; it converts by itself.
  template <class R>
    requires(!std::same_as<R, reference> && ReferenceFlow<R>)
  reference(const R& flow)  // NOLINT(google-explicit-constructor)
      : kind_(std::make_shared<detail::kind_of_flow<R>>(flow)) {}
  explicit reference(std::shared_ptr<const detail::reference_kind> kind) : kind_(std::move(kind)) {}

  /// A run from the start, with its own copy of the system; T is double or detail::lanes. Throws
  /// std::invalid_argument where the reference cannot follow the system in such intervals. Cost: the
  /// preparation of the reference, once for all intervals.
  template <class T>
  std::unique_ptr<detail::reference_run<T>> open(const model& system,
                                                 const phase_point<T, Eigen::Dynamic>& start,
                                                 const detail::reference_intervals& intervals) const {
    return kind_->open(system, start, intervals);
  }
  /// x becomes the state a time t later, in each lane of T; in a bath, on the path of a place. Returns the
  /// force evaluations.
  template <class T, int N>
  std::int64_t advance(const model& system, phase_point<T, N>& x, double t, const path_place& at = {}) const {
    const phase_point<T, Eigen::Dynamic> start{x.q, x.p};
    const auto run = open(system, start, {.length = t, .count = lanes_in<T>, .at = at});
    run->advance();
    x = {run->state().q, run->state().p};
    return run->evaluations();
  }

  reference finer() const { return reference(kind_->finer()); }  ///< the same with a much smaller error
  std::string description() const {
    return kind_->description();
  }  ///< what it is, with its step or tolerance
  bool gives_noise() const {
    return kind_->gives_noise();
  }  ///< whether it follows paths of a system in a bath

 private:
  std::shared_ptr<const detail::reference_kind> kind_;
};

namespace detail {

/// The error of a path in small steps, over its difference from the same path in half the step: 4/3 of order
/// two, which BAOAB has where friction is weak, and sqrt(4/3) = 1.15 where noise makes the errors of
/// successive halvings independent; 1.33 at friction .01 and 1.20 to 1.24 at 1 are measured against a 64th of
/// the step (tests/references/fine_paths_test.cpp). The larger of both: an error is not estimated too small.
inline constexpr double error_over_difference = 4.0 / 3.0;

}  // namespace detail

/// Largest coordinate of the difference between a reference and its finer self after a time t from x.
template <int N>
double reference_error(const model& system, const reference& accurate, const phase_point<double, N>& x,
                       double t) {
  auto a = x;
  auto b = x;
  accurate.advance(system, a, t);
  accurate.finer().advance(system, b, t);
  return std::max((a.q - b.q).cwiseAbs().maxCoeff(), (a.p - b.p).cwiseAbs().maxCoeff());
}

}  // namespace nysalt
