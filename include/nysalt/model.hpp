// SPDX-License-Identifier: BSL-1.0
// A system as a value: the boundary between templates and the compiled library.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/kernels/typed_system.hpp"

namespace nysalt {

namespace detail {
/// In the library there is one, for its own default_lanes: a program that is compiled for a processor with
/// other lanes does not link, and the linker names both this function and the lanes that are missing.
template <int Lanes>
void library_is_compiled_for();
}  // namespace detail

/// A type-erased system, with its bath if any: the argument of the compiled library. Any system converts to a
/// model. Copies share the system. The dimension is known at run time. A model is a System, and is
/// stepped with the bits of the system that it was made of.
///
/// The system's functions are compiled where a model is made of it, for one trajectory and for as many as
/// suit the processor, each with and without derivatives by two parameters. A system with `lanes = 1` is
/// stepped one trajectory at a time.
class model {
 public:
  static constexpr int dimension = Eigen::Dynamic;     ///< known at run time
  static constexpr int lanes = detail::default_lanes;  ///< most trajectories side by side
  static constexpr bool is_erased = true;  ///< true: the members that the system offers are known at run time
  static constexpr bool may_have_quadratic_kinetic = true;  ///< true: K is known at run time

  /// The model of a system, which is copied; it converts by itself. Cost: a copy, and one description.
  template <class S>
    requires(!std::same_as<S, model> && SeparableSystem<S>)
  model(const S& system)  // NOLINT(google-explicit-constructor)
      : system_(detail::erased(system)),
        facts_(std::make_shared<detail::model_facts>(detail::model_facts_of(system))),
        base_kind_(detail::kind_without_bath(system)) {
    detail::library_is_compiled_for<detail::default_lanes>();
  }

  Eigen::Index size() const { return facts_->size; }                      ///< degrees of freedom
  const std::string& description() const { return facts_->description; }  ///< the system's
  /// The description without the size, see kind_of().
  std::string kind() const {
    return facts_->in.acts() ? base_kind_ + " in " + facts_->in.description() : base_kind_;
  }
  const nysalt::bath& bath() const {
    return facts_->in;
  }  ///< bath of the system; without one, a bath that does not act
  /// The system without its bath.
  model base() const {
    auto facts = std::make_shared<detail::model_facts>(*facts_);
    facts->description = facts->base_description;
    facts->in = nysalt::bath::of_sigma(0.0, 0.0);
    model result = *this;
    result.facts_ = std::move(facts);
    result.is_in_bath_ = false;
    return result;
  }
  /// The system in another bath; its frequency_bands() are those that it has without one.
  model in(const nysalt::bath& other) const {
    model result = base();
    auto facts = std::make_shared<detail::model_facts>(*result.facts_);
    facts->in = other;
    if (other.acts()) facts->description = facts->base_description + " in " + other.description();
    result.facts_ = std::move(facts);
    return result;
  }
  /// A model whose steps `threads` threads share if it is a LocalSystem; of another system they do not. The
  /// bits are the same as on one thread. Throws std::invalid_argument unless threads >= 1.
  model on_threads(int threads) const {
    if (threads < 1)
      throw std::invalid_argument(sentence("model: threads must be at least 1, got {}", threads));
    auto facts = std::make_shared<detail::model_facts>(*facts_);
    facts->threads = threads;
    model result = *this;
    result.facts_ = std::move(facts);
    return result;
  }
  int threads() const { return facts_->threads; }  ///< number of threads that share a step of one trajectory
  /// The system, as the letters that it declares find it.
  const void* held() const { return system_->held(); }
  /// Functions of the sites of a LocalSystem, else null.
  const detail::site_kernels* sites() const { return system_->sites(); }
  /// A model with an own copy of the system, for a thread whose system may change while it computes.
  model separate() const {
    model result = *this;
    result.system_ = system_->clone();
    return result;
  }
  /// The model for one block of trajectories: of a black box, which counts its calls and may keep scratch of
  /// its own, a separate one; else the same.
  friend model own_copy(const model& system) { return system.facts().is_locked ? system.separate() : system; }
  /// Members that the system offers.
  const detail::model_facts& facts() const { return *facts_; }
  /// Force evaluations of this copy so far, of a black box.
  std::int64_t calls() const { return system_->calls(); }

  /// 1/m_i.
  double inverse_mass(Eigen::Index i) const {
    return facts_->inverse_masses.empty() ? 1.0 : facts_->inverse_masses[static_cast<std::size_t>(i)];
  }
  bool has_unit_mass() const { return facts_->has_unit_mass; }  ///< no masses are declared
  /// The square root of the mass of coordinate i.
  friend double root_mass(const model& system, Eigen::Index i) {
    const auto& roots = system.facts_->inverse_root_masses;
    return roots.empty() ? 1.0 : roots[static_cast<std::size_t>(i)];
  }
  normal_modes modes() const { return system_->modes(); }   ///< modes of the quadratic part, if has_modes()
  bool has_modes() const { return facts_->has_modes; }      ///< the modes of a quadratic part are declared
  double force_cost() const { return facts_->force_cost; }  ///< what a force costs, see nysalt::force_cost()
  /// Frequency bands that the system declares, or none.
  std::vector<frequency_band> frequency_bands() const {
    return system_->frequency_bands(is_in_bath_ ? &facts_->in : nullptr);
  }

  /// The system's functions over T.
  template <detail::Served T>
  const detail::kernels<T>& kernels() const {
    return system_->template over<T>();
  }
  /// f = -grad V(q).
  template <detail::Served T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    kernels<T>().force(field::whole, q, f);
  }
  /// The force of V without its quadratic part.
  template <detail::Served T>
  void soft_force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    kernels<T>().force(field::soft, q, f);
  }
  /// Force over numbers with one derivative: two derivatives are carried, the second zero.
  void force(const vector<dual<double, 1>, dimension>& q, vector<dual<double, 1>, dimension>& f) const {
    with_one_slope(q, f, [this](const auto& x, auto& result) { force(x, result); });
  }
  /// Soft force over numbers with one derivative.
  void soft_force(const vector<dual<double, 1>, dimension>& q, vector<dual<double, 1>, dimension>& f) const {
    with_one_slope(q, f, [this](const auto& x, auto& result) { soft_force(x, result); });
  }
  /// g = f'(q) v.
  template <detail::Served T>
  void force_derivative(const vector<T, dimension>& q, const vector<T, dimension>& v,
                        vector<T, dimension>& g) const {
    detail::lifted_room<T, dimension> room(size());
    kernels<T>().force_along(field::whole, q, v, g, room, detail::part_of_displacement);
  }
  /// V(q), if the system has a potential.
  template <detail::Served T>
  T potential(const vector<T, dimension>& q) const {
    return kernels<T>().potential(q);
  }
  /// v = grad K(p).
  template <detail::Served T>
  void velocity(const vector<T, dimension>& p, vector<T, dimension>& v) const {
    kernels<T>().velocity(p, v);
  }
  /// Velocity over numbers with one derivative.
  void velocity(const vector<dual<double, 1>, dimension>& p, vector<dual<double, 1>, dimension>& v) const {
    with_one_slope(p, v, [this](const auto& x, auto& result) { velocity(x, result); });
  }
  /// K(p), if H can be evaluated.
  template <detail::Served T>
  T kinetic_energy(const vector<T, dimension>& p) const {
    return kernels<T>().kinetic_energy(p);
  }
  /// H(q, p), by one call of the kernel.
  template <detail::Served T>
  friend T energy(const model& system, const phase_point<T, dimension>& x) {
    return system.kernels<T>().energy(x.q, x.p);
  }

  /// g = f'(q) v of a black box, where f = f(q) is known.
  friend void directional_derivative(const model& system, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                     const Eigen::VectorXd& f, Eigen::VectorXd& g) {
    system.system_->directional_derivative(q, v, f, g);
  }
  /// g = f'(q) v of a field, as of the system by its type.
  template <field F, detail::Served T>
  friend void force_along(const model& system, const vector<T, dimension>& q, const vector<T, dimension>& v,
                          vector<T, dimension>& g, auto& room, double s = detail::part_of_displacement) {
    system.kernels<T>().force_along(F, q, v, g, room, s);
  }
  /// K''(p), of a kinetic energy of the system's own.
  Eigen::MatrixXd kinetic_hessian(const Eigen::VectorXd& p) const;
  /// Kicks by the system's own kick.
  void own_kick(const Eigen::VectorXd& q, Eigen::VectorXd& p, double c) const { system_->own_kick(q, p, c); }

 private:
  static void with_one_slope(const vector<dual<double, 1>, dimension>& q,
                             vector<dual<double, 1>, dimension>& f, const auto& function) {
    using T = detail::slopes;
    vector<T, dimension> lifted(q.size());
    vector<T, dimension> found(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      lifted[i] = T(q[i].value);
      lifted[i].derivative[0] = q[i].derivative[0];
    }
    function(lifted, found);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      f[i].value = found[i].value;
      f[i].derivative[0] = found[i].derivative[0];
    }
  }

  std::shared_ptr<const detail::any_system> system_;
  std::shared_ptr<const detail::model_facts> facts_;
  std::string base_kind_;  // without a bath
  bool is_in_bath_ = true;
};

namespace detail {

/// The letters of a model, whose system is behind its kernels.
template <>
class letters_on<model> {
 public:
  explicit letters_on(const model& system) : system_(&system) {}

  const std::vector<letter_facts>& declared() const { return system_->facts().own_letters; }
  template <Served T>
  bool serves(char name) const {
    return system_->facts().serves<T>(name);
  }
  /// Throws std::logic_error where coefficients are not those of a kernel over T.
  template <Served T, class C>
  applied_letter<T> over(char name, const C* c, double h) const {
    if constexpr (std::same_as<C, coefficient_of<T>>) {
      return system_->kernels<T>().letter(name, c, h);
    } else {
      throw std::logic_error("letters_on: a model has its letters over the scalars of its kernels");
    }
  }
  const void* held() const { return system_->held(); }

 private:
  const model* system_;
};

/// The force evaluations of a number of evaluations of which some are f'(q) v.
inline std::int64_t evaluations_of(const auto& erased, std::int64_t all, std::int64_t derivatives) {
  return all + derivatives * (erased.facts().derivative_calls - 1);
}

}  // namespace detail

}  // namespace nysalt
