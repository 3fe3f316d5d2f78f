// SPDX-License-Identifier: BSL-1.0
// The kernels of a system by its type: what a user's own source compiles.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/gradient_kick.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/kernels/kernels.hpp"
#include "nysalt/kernels/tiled_steps.hpp"
#include "nysalt/stepping/take_steps.hpp"
#include "nysalt/systems/counted.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/word.hpp"

namespace nysalt::detail {

[[noreturn]] void refuse_kernel();  // what the facts of a model say that it does not serve

/// What a drift changes, and what it reads.
template <class T, int N>
struct positions_in_place {
  using scalar_type = T;
  vector<T, N>& q;
  const vector<T, N>& p;
};

/// The room of letters: of a fixed dimension on the stack, not initialised, as few letters need it.
template <class T, int N>
struct room_of_letters {
  explicit room_of_letters(flow_room<T, Eigen::Dynamic>&) {}
  union {
    flow_room<T, N> room;
  };
};
template <class T>
struct room_of_letters<T, Eigen::Dynamic> {
  explicit room_of_letters(flow_room<T, Eigen::Dynamic>& given) : room(given) {}
  flow_room<T, Eigen::Dynamic>& room;
};

template <class T>
inline constexpr bool is_in_lanes = lanes_in<T> > 1;
template <class T, int N>
inline constexpr bool is_in_lanes<dual<T, N>> = is_in_lanes<T>;

/// The force of S can be evaluated over T: where S asks for one lane, packs are not even tried.
template <class S, class T>
consteval bool serves_force() {
  if constexpr (is_in_lanes<T> && lanes_of<S> == 1) {
    return false;
  } else {
    return SystemOver<S, T>;
  }
}
/// S can be stepped over T.
template <class S, class T>
consteval bool serves_steps() {
  if constexpr (serves_force<S, T>()) return DriftsOver<S, T>;
  return false;
}
template <class S, class T>
inline constexpr bool serves = serves_steps<S, T>();
/// Its energy can be evaluated over T.
template <class S, class T>
consteval bool serves_energy() {
  if constexpr (serves_force<S, T>()) return HasEnergy<S, T>;
  return false;
}

/// What a model holds of a system: a black box is counted.
template <class S>
using held_system = typename std::conditional_t<BlackBoxForce<S>, std::type_identity<counted<S>>,
                                                std::type_identity<S>>::type;

/// In place of a mutex, where threads may share a system.
struct no_mutex {
  void lock() {}
  void unlock() {}
};

/// A black box may have memory: threads that share a copy call its functions one at a time. Not so where all
/// callers hold another lock already.
template <class S>
inline constexpr bool needs_lock = BlackBoxForce<S>;
template <class S>
using lock_of = std::conditional_t<needs_lock<S>, std::mutex, no_mutex>;

/// The functions of S over T, under the lock that all kernels of the system share. To be stepped, each thread
/// has a copy of its own, without a lock.
template <class S, class T>
class typed_kernels final : public kernels<T> {
  static constexpr int N = S::dimension;
  using column = vector<T, Eigen::Dynamic>;
  using C = coefficient_of<T>;
  static constexpr bool serves = detail::serves<S, T>;
  static constexpr bool serves_force = detail::serves_force<S, T>();
  static constexpr bool serves_kinetic = [] {
    if constexpr (serves_force) return HasKineticEnergy<S, T>;
    return false;
  }();
  static constexpr bool serves_potential = [] {
    if constexpr (serves_force) return HasPotential<S, T>;
    return false;
  }();

 public:
  /// Refers to both.
  typed_kernels(const held_system<S>& system, lock_of<S>& guard) : system_(&system), guard_(&guard) {}

  void advance(column& q, column& p, column& f, flow_room<T, Eigen::Dynamic>& room,
               const step_program<C>& letters, std::int64_t steps, int threads, const callback& other,
               const watch<T>& watched) const final {
    if constexpr (std::same_as<T, double> && N == Eigen::Dynamic && LocalSystem<S>) {
      const typed_site_kernels<S> sites(*system_);
      const std::int64_t steps_at_once = watched.observe == nullptr ? steps : std::min(steps, watched.every);
      const std::int64_t kicks = steps_at_once * std::ssize(letters.pairs);
      const int at_tiles = threads_in_tiles(sites.layout(), threads, kicks);
      if (!letters.pairs.empty() && at_tiles > 0) {
        tiled_steps tiles(sites, at_tiles, kicks);
        state_in_place<T, N> x{q, p, f};
        return watch_steps(
            steps, watched,
            [&](std::int64_t count) { tiles.advance(q.data(), p.data(), f.data(), letters, count); },
            [&] { show<field::whole, S, T, C>(*system_, x, room, letters, watched); });
      }
    }
    if constexpr (serves) {
      room_of_letters<T, N> own(room);
      state_in_place<T, N> x{as_fixed<N>(q), as_fixed<N>(p), as_fixed<N>(f)};
      take_steps_of_word((*system_), x, own.room, letters, steps, other, watched);
    } else {
      refuse_kernel();
    }
  }
  void force(field of, const column& q, column& f) const final {
    if constexpr (serves_force) {
      const auto one_at_a_time = lock();
      if constexpr (HasSoftForce<S, T>) {
        if (of == field::soft) return system_->soft_force(as_fixed<N>(q), as_fixed<N>(f));
      }
      nysalt::force<T>((*system_), as_fixed<N>(q), as_fixed<N>(f));
    } else {
      refuse_kernel();
    }
  }
  void force_along(field of, const column& q, const column& v, column& g,
                   lifted_room<T, Eigen::Dynamic>& room, double reach) const final {
    const auto one_at_a_time = lock();
    if constexpr (serves_force) {
      if constexpr (ForceDerivativeOver<S, T, field::soft>) {
        if (of == field::soft) return along<field::soft>(q, v, g, room, reach);
      }
      if constexpr (ForceDerivativeOver<S, T, field::whole>) {
        return along<field::whole>(q, v, g, room, reach);
      }
    }
    refuse_kernel();
  }
  void drift(column& q, const column& p, const C& c) const final {
    const auto one_at_a_time = lock();
    if constexpr (serves) {
      positions_in_place<T, N> x{as_fixed<N>(q), as_fixed<N>(p)};
      no_room room;
      nysalt::drift::apply((*system_), c, x, room);
    } else {
      refuse_kernel();
    }
  }
  void velocity(const column& p, column& v) const final {
    const auto one_at_a_time = lock();
    if constexpr (serves) {
      nysalt::velocity<T>((*system_), as_fixed<N>(p), as_fixed<N>(v));
    } else {
      refuse_kernel();
    }
  }
  T kinetic_energy(const column& p) const final {
    const auto one_at_a_time = lock();
    if constexpr (serves_kinetic) {
      return system_->kinetic_energy(as_fixed<N>(p));
    } else if constexpr (serves_energy<S, T>()) {
      return nysalt::kinetic_energy<T>((*system_), as_fixed<N>(p));
    } else if constexpr (serves_force && HasEnergy<S> && lanes_in<T> > 1) {
      return in_each_lane(p, p,
                          [&](const auto& x) { return nysalt::kinetic_energy<double>((*system_), x.p); });
    } else {
      refuse_kernel();
    }
  }
  T potential(const column& q) const final {
    const auto one_at_a_time = lock();
    if constexpr (serves_potential) {
      return system_->potential(as_fixed<N>(q));
    } else if constexpr (serves_force && HasPotential<S, double> && lanes_in<T> > 1) {
      return in_each_lane(q, q, [&](const auto& x) { return system_->potential(x.q); });
    } else {
      refuse_kernel();
    }
  }
  T energy(const column& q, const column& p) const final {
    const auto one_at_a_time = lock();
    if constexpr (serves_energy<S, T>()) {
      return nysalt::kinetic_energy<T>((*system_), as_fixed<N>(p)) + system_->potential(as_fixed<N>(q));
    } else if constexpr (serves_force && HasEnergy<S> && lanes_in<T> > 1) {
      return in_each_lane(q, p, [&](const auto& x) { return nysalt::energy<double>((*system_), x); });
    } else {
      refuse_kernel();
    }
  }
  applied_letter<T> letter(char name, const C* c, double h) const final {
    if constexpr (serves) return letter_of_system<held_system<S>, T>(name, c, h);
    return {};
  }

 private:
  template <field F>
  void along(const column& q, const column& v, column& g, lifted_room<T, Eigen::Dynamic>& room,
             double reach) const {
    if constexpr (N == Eigen::Dynamic) {
      nysalt::detail::force_along<F, T>((*system_), q, v, g, room, reach);
    } else {
      lifted_room<T, N> own;
      nysalt::detail::force_along<F, T>((*system_), as_fixed<N>(q), as_fixed<N>(v), as_fixed<N>(g), own,
                                        reach);
    }
  }
  static T in_each_lane(const column& q, const column& p, const auto& value) {
    T result(0.0);
    phase_point<double, N> x{vector<double, N>(q.size()), vector<double, N>(p.size())};
    for (int k = 0; k < lanes_in<T>; ++k) {
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        x.q[i] = lane(q[i], k);
        x.p[i] = lane(p[i], k);
      }
      set_lane(result, k, value(x));
    }
    return result;
  }

  std::lock_guard<lock_of<S>> lock() const { return std::lock_guard(*guard_); }

  const held_system<S>* system_;
  lock_of<S>* guard_;
};

/// S as an any_system.
template <class S>
class typed_system final : public any_system {
 public:
  explicit typed_system(const S& system)
      : any_system(of_one_, of_lanes_, of_slopes_, of_lanes_with_slopes_), system_(system) {}

  std::int64_t calls() const override {
    const auto one_at_a_time = lock();
    if constexpr (BlackBoxForce<S>) return system_.evaluations;
    return 0;
  }
  std::unique_ptr<any_system> clone() const override {
    const auto one_at_a_time = lock();
    return std::make_unique<typed_system>(system_);
  }
  void directional_derivative(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& f,
                              Eigen::VectorXd& g) const override {
    const auto one_at_a_time = lock();
    if constexpr (BlackBoxForce<S>) {
      constexpr int N = S::dimension;
      nysalt::detail::directional_derivative(system_, as_fixed<N>(q), as_fixed<N>(v), as_fixed<N>(f),
                                             as_fixed<N>(g));
    } else {
      refuse_kernel();
    }
  }
  normal_modes modes() const override {
    const auto one_at_a_time = lock();
    if constexpr (HasModes<S>) {
      return system_.modes();
    } else {
      refuse_kernel();
    }
  }
  std::vector<frequency_band> frequency_bands(const bath* in) const override {
    const auto one_at_a_time = lock();
    if constexpr (HasBath<S>) {
      if constexpr (requires {
                      { system_.base() } -> HasFrequencyBands;
                    }) {
        if (!in) return system_.base().frequency_bands();
      }
      if constexpr (HasFrequencyBands<S>) return system_.frequency_bands();
    } else if constexpr (HasFrequencyBands<S>) {
      return in ? frequency_bands_in(static_cast<const S&>(system_), *in) : system_.frequency_bands();
    }
    return {};
  }
  const site_kernels* sites() const override {
    if constexpr (LocalSystem<S>) return &sites_;
    return nullptr;
  }
  const void* held() const override { return &system_; }
  void own_kick(const Eigen::VectorXd& q, Eigen::VectorXd& p, double c) const override {
    const auto one_at_a_time = lock();
    if constexpr (HasKick<S, double>) {
      system_.kick(as_fixed<S::dimension>(q), as_fixed<S::dimension>(p), c);
    } else {
      refuse_kernel();
    }
  }

 private:
  std::lock_guard<lock_of<S>> lock() const { return std::lock_guard(guard_); }

  held_system<S> system_;
  [[no_unique_address]] mutable lock_of<S> guard_;
  struct not_local {
    explicit not_local(const held_system<S>&) {}
  };
  static auto sites_of() {
    if constexpr (LocalSystem<S>) {
      return std::type_identity<typed_site_kernels<S>>();
    } else {
      return std::type_identity<not_local>();
    }
  }
  [[no_unique_address]] typename decltype(sites_of())::type sites_{system_};
  typed_kernels<S, double> of_one_{system_, guard_};
  typed_kernels<S, lanes> of_lanes_{system_, guard_};
  typed_kernels<S, slopes> of_slopes_{system_, guard_};
  typed_kernels<S, lanes_with_slopes> of_lanes_with_slopes_{system_, guard_};
};

/// The system without its type: its kernels do not depend on the bath that it is in.
template <class S>
std::shared_ptr<const any_system> erased(const S& system) {
  return std::make_shared<typed_system<S>>(system);
}
template <class S>
std::shared_ptr<const any_system> erased(const in_bath<S>& system) {
  return erased<S>(system.base());
}

template <class S, class T>
std::string letters_served() {
  std::string result;
  if constexpr (serves<S, T>) {
    std::apply([&]<class... L>(
                   const L&...) { ((L::template serves<S, T> ? void(result += L::letter) : void()), ...); },
               std::tuple_cat(known_letters{}, letters_of<S>{}));
  }
  return result;
}

/// The kind of the system without its bath.
template <class S>
std::string kind_without_bath(const S& system) {
  if constexpr (HasBath<S> && requires { kind_of(system.base()); }) return kind_of(system.base());
  return kind_of(system);
}

/// What the concepts say of S, and what the system itself does.
template <class S>
model_facts model_facts_of(const S& system) {
  model_facts facts{facts_of_type<S>};
  facts.is_locked = needs_lock<S>;
  facts.size = nysalt::size(system);
  facts.force_cost = nysalt::force_cost(system);
  facts.description = facts.base_description = describe(system);
  if constexpr (requires { describe(system.base()); }) facts.base_description = describe(system.base());
  if constexpr (HasBath<S>) facts.in = static_cast<const bath&>(system.bath());
  if constexpr (HasInverseMass<S>) {
    for (Eigen::Index i = 0; i < facts.size; ++i) {
      facts.inverse_masses.push_back(system.inverse_mass(i));
      facts.inverse_root_masses.push_back(1.0 / std::sqrt(facts.inverse_masses.back()));
    }
  }
  facts.in_lanes = serves<S, lanes>;
  facts.in_lanes_with_slopes = serves<S, lanes_with_slopes>;
  facts.has_potential = HasPotential<S, double>;
  facts.has_energy_over_slopes =
      HasEnergy<S> &&
      (serves<S, lanes_with_slopes> ? serves_energy<S, lanes_with_slopes>() : serves_energy<S, slopes>());
  facts.has_differentiable_velocity =
      NystromSystem<S> || HasVelocity<S, dual<double, 1>> ||
      (HasKineticEnergy<S, double> && HasKineticEnergy<S, dual<dual<double, 1>, sweep<S::dimension>>>);
  facts.has_modes = has_modes(system);
  facts.has_quadratic_part = HasQuadraticPart<S>;
  facts.has_bands = HasFrequencyBands<S>;
  facts.has_own_kick = HasKick<S, double>;
  facts.has_own_derivative = HasForceDerivative<S>;
  facts.has_own_velocity = HasVelocity<S, double>;
  facts.has_own_kinetic_energy = HasKineticEnergy<S, double>;
  facts.has_potential_over_slopes = HasPotential<S, slopes>;
  facts.has_kinetic_energy_over_slopes = HasKineticEnergy<S, slopes>;
  facts.has_velocity_over_slopes = HasVelocity<S, slopes>;
  facts.may_be_wrong = force_may_be_wrong<S>;
  facts.own_letters = letters_on(system).declared();
  facts.derivative_calls = derivative_calls<S>;
  facts.derivative_source = derivative_source<S>();
  facts.letters_over_double = letters_served<S, double>();
  facts.letters_over_lanes = letters_served<S, lanes>();
  facts.letters_over_slopes = letters_served<S, slopes>();
  facts.letters_over_lanes_with_slopes = letters_served<S, lanes_with_slopes>();
  return facts;
}

}  // namespace nysalt::detail
