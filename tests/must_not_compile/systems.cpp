// SPDX-License-Identifier: BSL-1.0
// Systems that offer too little, or not in the required form, losses of one's own, systems declared for the
// program, and sentences. The comments are explained in check.py.
#include "common.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/flows/sum_of_parts.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/plugin.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/stepping/lockstep.hpp"
#include "nysalt/systems/lennard_jones.hpp"
#include "nysalt/systems/textbook.hpp"

// expect: nysalt: a separable system offers `template <class T> T potential(q)`, or `force(q, f)` as a
//   template or over double, const all of them; see nysalt/system.hpp
namespace potential_over_double_alone {
struct not_differentiable {
  static constexpr int dimension = 1;
  // [potential_over_double_alone]
  double potential(const nysalt::vector<double, 1>& q) const { return q[0] * q[0]; }
  // [/potential_over_double_alone]
};
inline void use(const either<well, not_differentiable>& system) {
  nysalt::make_stepper(system, nysalt::verlet(), 0.1);
}
}  // namespace potential_over_double_alone

// expect GNU: required for the satisfaction of 'System<S>' [with S = of_unknown_size]
// expect GNU: 'dimension' is not a member of 'of_unknown_size'
// expect Clang: because 'of_unknown_size' does not satisfy 'System'
// expect Clang: no member named 'dimension' in 'of_unknown_size'
namespace system_without_dimension {
struct of_unknown_size {
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
};
inline void use(const either<well, of_unknown_size>& system) {
  nysalt::make_stepper(system, nysalt::verlet(), 0.1);
}
}  // namespace system_without_dimension

// expect GNU: required for the satisfaction of 'SeparableSystem<S>' [with S = incomplete]
// expect Clang: because 'incomplete' does not satisfy 'SeparableSystem'
namespace model_of_a_system_without_force {
struct incomplete {
  static constexpr int dimension = 1;
};
inline void use(const either<well, incomplete>& system) { nysalt::model{system}; }
}  // namespace model_of_a_system_without_force

// std::cos is for double alone; an unqualified cos finds that of dual numbers too.
// expect GNU: no matching function for call to 'cos(const nysalt::dual<double, 1>&)'
// expect Clang: no matching function for call to 'cos'
namespace function_of_std {
struct pendulum {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
#ifdef NYSALT_CONTROL
    using std::cos;
    return -cos(q[0]);
#else
    // [function_of_std]
    return -std::cos(q[0]);
    // [/function_of_std]
#endif
  }
};
inline void use(const pendulum& system) {
  nysalt::phase_point<double, 1> x{nysalt::vector<double, 1>(1.0), nysalt::vector<double, 1>(0.0)};
  nysalt::make_stepper(system, nysalt::verlet(), 0.1).step(x);
}
}  // namespace function_of_std

// One trajectory is beyond the wall and its neighbour is not: no branch serves both.
// expect: nysalt: lanes may differ in a comparison, so it cannot choose a branch: write
//   nysalt::select(condition, a, b), or let the system say `static constexpr int lanes = 1;`
namespace branch_between_lanes {
struct wall {
  static constexpr int dimension = 1;
#ifdef NYSALT_CONTROL
  static constexpr int lanes = 1;
#endif
  template <class T>
  void force(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& f) const {
    // [branch_between_lanes]
    if (q[0] < 0.0) {
      f[0] = q[0] * -100.0;
    } else {
      f[0] = T(0.0);
    }
    // [/branch_between_lanes]
  }
};
inline void use(const wall& system) {
  const auto stepper = nysalt::make_stepper(system, nysalt::verlet(), 0.01);
  using T = nysalt::detail::scalar_of_lanes<nysalt::detail::lanes_of<wall>>;
  const nysalt::phase_point<T, 1> start{nysalt::vector<T, 1>(T(1.0)), nysalt::vector<T, 1>(T(-1.0))};
  nysalt::detail::lockstep<nysalt::stepper<wall>, T>(stepper, start, 1).go_on(100);
}
}  // namespace branch_between_lanes

// expect: nysalt: inverse_mass is not of the form `double inverse_mass(Eigen::Index i) const`
// expect: nysalt: kinetic_energy is not of the form `template <class T> T kinetic_energy(p) const`, as K
//   depends on p alone
// expect: nysalt: kick is not of the form `template <class T, class C> void kick(q, p, c) const`
// expect: nysalt: frequency_bands is not of the form `std::vector<nysalt::frequency_band> frequency_bands()
//   const`
// expect: nysalt: force_cost is not of the form `double force_cost() const`
// expect: nysalt: bath is not of the form `const nysalt::bath& bath() const`; see systems/in_bath.hpp
// expect: nysalt: velocity(p, v) must be differentiable, and takes double only; make it a template
// expect: nysalt: force is not of the form `template <class T> void force(q, f) const`, which writes its
//   value into f
// expect: nysalt: description is not of the form `std::string description() const`
// expect: nysalt: kind is not of the form `std::string kind() const`
// expect: nysalt: modes is not of the form `nysalt::normal_modes modes() const`
// expect: nysalt: has_modes is not of the form `bool has_modes() const`
// expect: nysalt: soft_force is not of the form `template <class T> void soft_force(q, f) const`
// expect: nysalt: force_derivative is not of the form `void force_derivative(q, v, g) const`
// expect: nysalt: velocity is not of the form `template <class T> void velocity(p, v) const`
// expect: nysalt: kinetic_energy(p) must be differentiable, and takes double only; make it a template
namespace members_of_another_form {
struct valued : well {
  // [force_by_value]
  template <class T>
  nysalt::vector<T, 1> force(const nysalt::vector<T, 1>& q) const {
    return q * -2.0;
  }
  // [/force_by_value]
};
struct named : well {
  std::string description = "a well";
};
struct of_a_kind : well {
  std::string kind = "a well";
};
struct with_modes : well {
  std::vector<double> modes() const { return {1.0}; }
};
struct counting_modes : well {
  int has_modes() const { return 1; }
};
struct soft : well {
  double soft_force(double q) const { return -q; }
};
struct derived : well {
  double force_derivative(double) const { return -2.0; }
};
struct fast : well {
  double velocity(double p) const { return p; }
};
struct mass : well {
  // [inverse_mass_not_const]
  double inverse_mass(Eigen::Index) { return 0.5; }
  // [/inverse_mass_not_const]
};
struct kinetic : well {
  // [kinetic_energy_not_const]
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 1>& p) {
    return p[0] * p[0];
  }
  // [/kinetic_energy_not_const]
};
struct kicked : well {
  // [kick_not_const]
  template <class T, class C>
  void kick(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& p, const C& c) {
    p[0] -= q[0] * 2.0 * c;
  }
  // [/kick_not_const]
};
struct banded : well {
  // [frequency_bands_of_another_type]
  std::vector<double> frequency_bands() const { return {1.0}; }
  // [/frequency_bands_of_another_type]
};
struct priced : well {
  // [force_cost_of_another_type]
  int force_cost() const { return 5; }
  // [/force_cost_of_another_type]
};
struct in_a_bath : well {
  // [bath_of_another_type]
  double bath() const { return 0.1; }
  // [/bath_of_another_type]
};
struct half_differentiable : well {
  // [velocity_over_double_alone]
  void velocity(const nysalt::vector<double, 1>& p, nysalt::vector<double, 1>& v) const { v[0] = p[0] * 2.0; }
  // [/velocity_over_double_alone]
};
struct energetic : well {
  double kinetic_energy(const nysalt::vector<double, 1>& p) const { return p[0] * p[0]; }
};
template <class... Systems>
void step_all() {
  const auto step = [](const auto& system) { nysalt::make_stepper(system, nysalt::verlet(), 0.1); };
  (step(either<well, Systems>()), ...);
}
inline void use(const nysalt::phase_point<double, 1>& x) {
  step_all<mass, kinetic, kicked, banded, priced, in_a_bath, valued, named, of_a_kind>();
  step_all<with_modes, counting_modes, soft, derived, fast, energetic>();
  nysalt::symplecticity_defect(either<well, half_differentiable>(), nysalt::verlet(), 0.1, x);
}
}  // namespace members_of_another_form

// expect: nysalt: a member of a name such as mass or masses is not used; give masses by `double
//   inverse_mass(Eigen::Index i) const`, or rename it
// expect: nysalt: a member of a name near to kinetic_energy is not used; write `template <class T> T
//   kinetic_energy(p) const`, or rename it
// expect: nysalt: a member of a name such as hamiltonian is not used; H is K(p) + V(q), of `potential` and of
//   `inverse_mass`, `kinetic_energy` or else p^2/2: write these, or rename it
// expect: nysalt: a member of a name near to force or gradient is not used; write `template <class T> void
//   force(q, f) const`, f = -grad V, or rename it
// expect: nysalt: a member of a name near to velocity is not used; write `template <class T> void velocity(p,
//   v) const`, or rename it
// expect: nysalt: a member of a name near to potential is not used; write `template <class T> T potential(q)
//   const`, or rename it
// expect: nysalt: a member of a name near to force_derivative, soft_force, kick, modes, frequency_bands,
//   force_cost, description, kind or bath is not used; see docs/concepts/system.md, or rename it
namespace members_of_another_name {
struct heavy : well {
  // [mass]
  double mass(Eigen::Index) const { return 2.0; }
  // [/mass]
};
struct moving : well {
  // [kinetic]
  template <class T>
  T kinetic(const nysalt::vector<T, 1>& p) const {
    return p[0] * p[0];
  }
  // [/kinetic]
};
struct whole : well {
  // [hamiltonian]
  template <class T>
  T hamiltonian(const nysalt::vector<T, 1>& q, const nysalt::vector<T, 1>& p) const {
    return q[0] * q[0] + p[0] * p[0];
  }
  // [/hamiltonian]
};
struct sloped : well {
  // [gradient]
  double gradient(double q) const { return 2.0 * q; }
  // [/gradient]
};
struct flowing : well {
  double velocities(double p) const { return p; }
};
struct by_force {
  static constexpr int dimension = 1;
  template <class T>
  void force(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& f) const {
    f[0] = q[0] * -2.0;
  }
  double potential_energy(double q) const { return q * q; }
};
struct described : well {
  std::string describe() const { return "a well"; }
};
inline void use() {
  members_of_another_form::step_all<heavy, moving, whole, sloped, flowing, by_force, described>();
}
}  // namespace members_of_another_name

// The parts of a sum, and what derives from one, are asked too.
// expect: nysalt: a member of a name such as mass or masses is not used; give masses by `double
//   inverse_mass(Eigen::Index i) const`, or rename it
// expect: nysalt: a member of a name near to force or gradient is not used; write `template <class T> void
//   force(q, f) const`, f = -grad V, or rename it
// expect: nysalt: kick is not of the form `template <class T, class C> void kick(q, p, c) const`
namespace members_of_a_sum {
struct sloped : well {
  double gradient(double q) const { return 2.0 * q; }
};
struct kicked : well {
  void kick(double c) const;
};
struct heavy : nysalt::sum_of_parts<well, well> {
  explicit heavy(const well& part) : sum_of_parts(part, part) {}
  double mass(Eigen::Index) const { return 2.0; }
};
inline void use(const either<nysalt::sum_of_parts<well>, heavy>& sum) {
  nysalt::sum_of_parts(well(), either<well, sloped>());
  nysalt::sum_of_parts(well(), either<well, kicked>());
  nysalt::make_stepper(sum, nysalt::verlet(), 0.1);
}
}  // namespace members_of_a_sum

// What models nothing is refused by the name of the concept, wherever it is handed over.
// expect: Scalar
// expect: System
// expect: Flow
// expect: Family
// expect: NoiseSource
// expect: Ensemble
// expect: ReferenceFlow
namespace concepts_by_name {
struct nothing {};
using state = nysalt::phase_point<either<double, float>, 1>;
constexpr nysalt::word letters = nysalt::word_of<either<nysalt::drift, nothing>, nysalt::kick>();

inline void everything(const nysalt::pendulum& system, const either<nysalt::pendulum, nothing>& any_system,
                       const either<nysalt::nystrom, nothing>& family,
                       const either<nysalt::no_noise, nothing>& noise,
                       const either<nysalt::listed<1>, nothing>& starts,
                       const either<nysalt::reference, nothing>& accurate) {
  nysalt::make_stepper(any_system, nysalt::verlet(), 0.1);
  const nysalt::family erased(family);
  nysalt::make_stepper(system, nysalt::verlet(), 0.1, noise);
  nysalt::sound_start(system, starts, 1, 0);
  nysalt::reference{accurate};
}
}  // namespace concepts_by_name

// expect: nysalt: an own loss returns its residuals over the T of its states, at least one: a `T`, a
//   `std::array<T, n>` or a `vector<T, n>`; of an expression, say `-> vector<T, n>`
// expect: nysalt: an own loss is a function of (start, finish, wanted), each a `phase_point<T, N>` of the
//   system's dimension N, and const, for any scalar T
namespace own_losses {
#ifdef NYSALT_CONTROL
using nysalt::phase_point;
using nysalt::vector;
auto place = []<class T>(const phase_point<T, 2>&, const phase_point<T, 2>& finish,
                         const phase_point<T, 2>& wanted) -> vector<T, 2> { return finish.q - wanted.q; };
auto over_double = place;
#else
// [own_loss_of_an_expression]
auto place = [](const auto&, const auto& finish, const auto& wanted) { return finish.q - wanted.q; };
// [/own_loss_of_an_expression]
namespace alone {
// [own_loss_over_double_alone]
using state = nysalt::phase_point<double, 2>;
auto place = [](const state&, const state& finish, const state& wanted) { return finish.q[0] - wanted.q[0]; };
// [/own_loss_over_double_alone]
}  // namespace alone
auto over_double = alone::place;
#endif
inline void use(const nysalt::henon_heiles& system) {
  nysalt::detail::own_error(system, place);
  nysalt::detail::own_error(system, over_double);
}
}  // namespace own_losses

// expect: nysalt: NYSALT_SYSTEM needs starts(...), once
namespace declaration_without_starts {
struct well : ::well {
  double depth = 1.0;
};
nysalt::normal_around<1> starts_of_well(const well&);
#ifdef NYSALT_CONTROL
NYSALT_SYSTEM(well, "depth q^2", starts(starts_of_well), parameter("depth", &well::depth, "of the well"));
#else
// [declaration_without_starts]
NYSALT_SYSTEM(well, "depth q^2", parameter("depth", &well::depth, "of the well"));
// [/declaration_without_starts]
#endif
}  // namespace declaration_without_starts

// expect: nysalt: a letter that a system declares must be invertible and reversible, as exact_flow states;
//   step the word by the system's type
namespace declared_letter_that_is_one_way {
struct own_drift : nysalt::exact_flow<'a'> {
  static void apply(const auto&, const auto&, auto&, auto&) {}
#ifndef NYSALT_CONTROL
  // [declared_letter_that_is_one_way]
  static constexpr bool reversible = false;
  // [/declared_letter_that_is_one_way]
#endif
};
inline void use(const nysalt::normal_around<1>& around) {
  nysalt::detail::declare_system<nysalt::pendulum>(
      "swing", "a pendulum", nysalt::letters<own_drift>(),
      nysalt::starts([&](const nysalt::pendulum&) { return around; }));
}
}  // namespace declared_letter_that_is_one_way

// expect: nysalt: frequency(...) may be given once
// expect: nysalt: a declared system needs a default constructor: give each member a value
// expect: nysalt: a declared system must not be final: it is counted by deriving
namespace declarations {
struct deep : well {
  explicit deep(double) {}
};
struct last final : well {};
nysalt::normal_around<1> starts_of_well(const well&);
template <class S>
void declare(auto... further) {
  nysalt::detail::declare_system<S>("well", "q^2", nysalt::starts(starts_of_well), further...);
}
inline void use() {
  const auto highest = nysalt::frequency([](const well&) { return 1.0; });
#ifdef NYSALT_CONTROL
  declare<well>(highest);
#else
  declare<well>(highest, highest);
#endif
  declare<either<well, deep>>();
  declare<either<well, last>>();
}
}  // namespace declarations

// expect: nysalt: name the parameters of so large a family
// expect: nysalt: lanes of a system must lie in 1..16
// expect: nysalt: lennard_jones in 2D or 3D
namespace numbers_that_are_too_large {
struct wide : well {
  static constexpr int lanes = 17;
};
constexpr int parameters = std::is_same_v<either<int, void>, int> ? 12 : 13;
constexpr int space = std::is_same_v<either<int, void>, int> ? 3 : 4;
constexpr auto names = nysalt::composition<parameters>::parameter_names;
constexpr int lanes = nysalt::detail::lanes_of<either<well, wide>>;
inline auto use(const nysalt::lennard_jones<space, 2>& atoms) { return atoms.description(); }
}  // namespace numbers_that_are_too_large

// expect: nysalt: a system is copyable and has `static constexpr int dimension`, positive, or Eigen::Dynamic
//   with a `size()`
namespace asked_beforehand {
struct of_no_size {
  static constexpr int dimension = 0;
};
inline void use() { nysalt::require_suited<either<well, of_no_size>>(); }
}  // namespace asked_beforehand

// expect: there must be as many pieces as holes
// expect: a hole is {}, without a format
namespace sentences {
#ifdef NYSALT_CONTROL
const auto whole = nysalt::sentence("{} of {}", 1, 2);
const auto plain = nysalt::sentence("step {}", 0.1);
#else
const auto whole = nysalt::sentence("{} of {}", 1);
const auto plain = nysalt::sentence("step {:.3}", 0.1);
#endif
}  // namespace sentences
