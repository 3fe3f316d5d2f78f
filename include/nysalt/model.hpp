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

  /// The model of a system, which is copied; it converts by itself. Cost: a copy, and one description.
  template <class S>
    requires(!std::same_as<S, model> && SeparableSystem<S>)
  model(const S& system)  // NOLINT(google-explicit-constructor)
      : system_(detail::erased(system)),
        facts_(std::make_shared<detail::model_facts>(detail::facts_of(system))),
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
    model result = *this;
    result.threads_ = threads;
    return result;
  }
  int threads() const { return threads_; }  ///< number of threads that share a step of one trajectory
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
  /// Members that the system offers.
  const detail::model_facts& facts() const { return *facts_; }
  /// Force evaluations of this copy so far, of a black box.
  std::int64_t calls() const { return system_->calls(); }

  /// 1/m_i.
  double inverse_mass(Eigen::Index i) const {
    return facts_->inverse_masses.empty() ? 1.0 : facts_->inverse_masses[static_cast<std::size_t>(i)];
  }
  bool has_unit_mass() const { return facts_->inverse_masses.empty(); }  ///< no masses are declared
  /// The square root of the mass of coordinate i.
  double root_mass(Eigen::Index i) const {
    return facts_->inverse_root_masses.empty() ? 1.0
                                               : facts_->inverse_root_masses[static_cast<std::size_t>(i)];
  }
  normal_modes modes() const { return system_->modes(); }  ///< modes of the quadratic part, if has_modes()
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
    with_one_slope(field::whole, q, f);
  }
  /// Soft force over numbers with one derivative.
  void soft_force(const vector<dual<double, 1>, dimension>& q, vector<dual<double, 1>, dimension>& f) const {
    with_one_slope(field::soft, q, f);
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

  /// g = f'(q) v of a black box, where f = f(q) is known.
  void directional_derivative(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& f,
                              Eigen::VectorXd& g) const {
    system_->directional_derivative(q, v, f, g);
  }
  /// K''(p), of a kinetic energy of the system's own.
  Eigen::MatrixXd kinetic_hessian(const Eigen::VectorXd& p) const;
  /// Kicks by the system's own kick.
  void own_kick(const Eigen::VectorXd& q, Eigen::VectorXd& p, double c) const { system_->own_kick(q, p, c); }

 private:
  void with_one_slope(field of, const vector<dual<double, 1>, dimension>& q,
                      vector<dual<double, 1>, dimension>& f) const {
    using T = detail::slopes;
    vector<T, dimension> lifted(q.size());
    vector<T, dimension> found(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      lifted[i] = T(q[i].value);
      lifted[i].derivative[0] = q[i].derivative[0];
    }
    kernels<T>().force(of, lifted, found);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      f[i].value = found[i].value;
      f[i].derivative[0] = found[i].derivative[0];
    }
  }

  std::shared_ptr<const detail::any_system> system_;
  std::shared_ptr<const detail::model_facts> facts_;
  std::string base_kind_;  // without a bath
  bool is_in_bath_ = true;
  int threads_ = 1;
};

namespace detail {

/// The force evaluations of a number of evaluations of which some are f'(q) v.
inline std::int64_t evaluations_of(const auto& erased, std::int64_t all, std::int64_t derivatives) {
  return all + derivatives * (erased.facts().derivative_calls - 1);
}

}  // namespace detail

}  // namespace nysalt
