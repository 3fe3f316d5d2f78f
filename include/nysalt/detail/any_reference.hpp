// SPDX-License-Identifier: BSL-1.0
// A reference flow without its type.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/method.hpp"
#include "nysalt/model.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/counted.hpp"

namespace nysalt::detail {

/// The flow over one length of time, prepared for many states.
template <class T>
class reference_run {
 public:
  using state = phase_point<T, Eigen::Dynamic>;
  using column = vector<T, Eigen::Dynamic>;

  virtual ~reference_run() = default;
  /// The trajectories in the first `count` lanes of x go on; xi are given the noise of as many equal parts of
  /// the time, in a bath. Returns their force evaluations together.
  virtual std::int64_t advance(state& x, int count, const path_place& at, std::span<column> xi) = 0;
};

class any_reference {
 public:
  virtual ~any_reference() = default;
  /// Refers to the model, which is that of the system that the reference was made for.
  virtual std::unique_ptr<reference_run<double>> prepare(const model& system, double t,
                                                         std::type_identity<double>) const = 0;
  virtual std::unique_ptr<reference_run<lanes>> prepare(const model& system, double t,
                                                        std::type_identity<lanes>) const = 0;
  virtual std::shared_ptr<const any_reference> finer() const = 0;
  virtual std::string description() const = 0;
  virtual bool gives_noise() const = 0;  ///< it follows paths of a system in a bath
};

/// Small steps of a method, and the same along paths.
std::shared_ptr<const any_reference> small_steps(const tabulated& method, double step,
                                                 const std::string& description);
std::shared_ptr<const any_reference> small_steps_on_paths(const tabulated& method, double step, int halvings,
                                                          const std::string& description);

/// A reference by its type, with the system by its own.
template <class S, class R>
class typed_reference final : public any_reference {
  static constexpr int N = S::dimension;

 public:
  typed_reference(const S& system, const R& reference) : system_(system), reference_(reference) {}

  std::unique_ptr<reference_run<double>> prepare(const model&, double t,
                                                 std::type_identity<double>) const override {
    return std::make_unique<run<double>>(system_, reference_, t);
  }
  std::unique_ptr<reference_run<lanes>> prepare(const model&, double t,
                                                std::type_identity<lanes>) const override {
    if constexpr (serves<S, lanes>) {
      return std::make_unique<run<lanes>>(system_, reference_, t);
    } else {
      refuse_kernel();
    }
  }
  std::shared_ptr<const any_reference> finer() const override {
    return std::make_shared<typed_reference>(system_, reference_.finer());
  }
  std::string description() const override { return reference_.description(); }
  bool gives_noise() const override { return PathReference<R, S>; }

 private:
  template <class T>
  class run final : public reference_run<T> {
   public:
    run(const S& system, const R& reference, double t)
        : watched_(system),
          reference_(reference),
          t_(t),
          x_{make_vector<T>(system), make_vector<T>(system)} {}

    std::int64_t advance(phase_point<T, Eigen::Dynamic>& x, int count, const path_place& at,
                         std::span<vector<T, Eigen::Dynamic>> xi) override {
      const std::int64_t before = watched_.evaluations;
      x_.q = x.q;
      x_.p = x.p;
      std::vector<vector<T, N>> noise(xi.size(), make_vector<T>(watched_));
      advance_lanes(watched_, reference_, x_, t_, count, at, std::span(noise));
      x.q = x_.q;
      x.p = x_.p;
      for (std::size_t k = 0; k < xi.size(); ++k) xi[k] = noise[k];
      // Evaluated over packs, a force is one of each lane's trajectory.
      constexpr bool in_lanes = AdvancesLanes<R, S, T> || PathReference<R, S>;
      return (watched_.evaluations - before) * (in_lanes ? count : 1);
    }

   private:
    counted<S> watched_;
    R reference_;
    double t_;
    phase_point<T, N> x_;
  };

  S system_;
  R reference_;
};

/// A reference of models, as a value.
class reference_value {
 public:
  explicit reference_value(std::shared_ptr<const any_reference> held) : held_(std::move(held)) {}

  /// Refers to the model.
  template <class T>
  std::unique_ptr<reference_run<T>> prepare(const model& system, double t) const {
    return held_->prepare(system, t, std::type_identity<T>());
  }
  template <Scalar T>
  void advance(const model& system, phase_point<T, Eigen::Dynamic>& x, double t, const path_place& at,
               std::span<vector<T, Eigen::Dynamic>> xi) const {
    prepare<T>(system, t)->advance(x, lanes_in<T>, at, xi);
  }
  reference_value finer() const { return reference_value(held_->finer()); }
  std::string description() const { return held_->description(); }
  bool gives_noise() const { return held_->gives_noise(); }  ///< it follows paths of a system in a bath
  const std::shared_ptr<const any_reference>& held() const { return held_; }

 private:
  std::shared_ptr<const any_reference> held_;
};

template <class R>
inline constexpr bool is_fine_steps = false;
template <class M>
inline constexpr bool is_fine_steps<fine_steps<M>> = std::is_constructible_v<tabulated, const M&>;
template <class R>
inline constexpr bool is_fine_paths = false;
template <class M>
inline constexpr bool is_fine_paths<fine_paths<M>> = true;

/// The library's own step words as data; any other keeps its type.
template <SeparableSystem S, Reference<S> R>
std::shared_ptr<const any_reference> reference_of(const S& system, const R& reference) {
  if constexpr (std::same_as<R, reference_value>) {
    return reference.held();
  } else if constexpr (is_fine_steps<R>) {
    require_suited<S>();
    return small_steps(reference.method(), reference.step(), reference.description());
  } else if constexpr (is_fine_paths<R>) {
    return small_steps_on_paths(reference.method(), reference.step(), reference.halvings(),
                                reference.description());
  } else {
    return std::make_shared<typed_reference<S, R>>(system, reference);
  }
}

}  // namespace nysalt::detail
