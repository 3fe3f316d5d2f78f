// SPDX-License-Identifier: BSL-1.0
// Losses of one's own, systems declared for the program, and sentences. The comments are explained in
// check.py.
#include "common.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/losses/own_loss.hpp"
#include "nysalt/plugin.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/pendulum.hpp"

// expect: nysalt: an own loss returns its residuals over the T of its states, at least one: a `T`, a
//   `std::array<T, n>` or a `vector<T, n>`; of an expression, say `-> vector<T, n>`
namespace own_loss_of_an_expression {
#ifdef NYSALT_CONTROL
using nysalt::phase_point;
using nysalt::vector;
auto place = []<class T>(const phase_point<T, 2>&, const phase_point<T, 2>& finish,
                         const phase_point<T, 2>& wanted) -> vector<T, 2> { return finish.q - wanted.q; };
#else
// [own_loss_of_an_expression]
auto place = [](const auto&, const auto& finish, const auto& wanted) { return finish.q - wanted.q; };
// [/own_loss_of_an_expression]
#endif
inline void use() { nysalt::own_error(nysalt::henon_heiles(), place); }
}  // namespace own_loss_of_an_expression

// expect: nysalt: an own loss is a function of (start, finish, wanted), each a `phase_point<T, N>` of the
//   system's dimension N, and const, for any scalar T
namespace own_loss_over_double_alone {
#ifdef NYSALT_CONTROL
auto place = []<class T>(const nysalt::phase_point<T, 2>&, const nysalt::phase_point<T, 2>& finish,
                         const nysalt::phase_point<T, 2>& wanted) -> T { return finish.q[0] - wanted.q[0]; };
#else
// [own_loss_over_double_alone]
using state = nysalt::phase_point<double, 2>;
auto place = [](const state&, const state& finish, const state& wanted) { return finish.q[0] - wanted.q[0]; };
// [/own_loss_over_double_alone]
#endif
inline void use() { nysalt::own_error(nysalt::henon_heiles(), place); }
}  // namespace own_loss_over_double_alone

// expect: nysalt: NYSALT_SYSTEM needs starts(...), once
namespace declaration_without_starts {
struct well {
  static constexpr int dimension = 1;
  double depth = 1.0;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return depth * q[0] * q[0];
  }
};
inline nysalt::normal_around<1> starts_of_well(const well&) {
  return {{nysalt::vector<double, 1>(0.0), nysalt::vector<double, 1>(0.0)}, 1.0, 1.0};
}
#ifdef NYSALT_CONTROL
NYSALT_SYSTEM(well, "depth q^2", starts(starts_of_well), parameter("depth", &well::depth, "of the well"));
#else
// [declaration_without_starts]
NYSALT_SYSTEM(well, "depth q^2", parameter("depth", &well::depth, "of the well"));
// [/declaration_without_starts]
#endif
}  // namespace declaration_without_starts

// expect: nysalt: a letter that a system declares must be invertible and reversible, as exact_flow states;
//   step the word by its type
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
  nysalt::declare_system<nysalt::pendulum>("swing", "a pendulum", nysalt::letters<own_drift>(),
                                           nysalt::starts([&](const nysalt::pendulum&) { return around; }));
}
}  // namespace declared_letter_that_is_one_way

// expect: there must be as many pieces as holes
namespace sentence_of_too_few_pieces {
#ifdef NYSALT_CONTROL
const auto words = nysalt::sentence("{} of {}", 1, 2);
#else
const auto words = nysalt::sentence("{} of {}", 1);
#endif
}  // namespace sentence_of_too_few_pieces

// expect: a hole is {}, without a format
namespace sentence_with_a_format {
#ifdef NYSALT_CONTROL
const auto words = nysalt::sentence("step {}", 0.1);
#else
const auto words = nysalt::sentence("step {:.3}", 0.1);
#endif
}  // namespace sentence_with_a_format
