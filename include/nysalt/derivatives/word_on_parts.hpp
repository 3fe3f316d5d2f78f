// SPDX-License-Identifier: BSL-1.0
// A word that kicks with parts of V, on the linearised motion.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

namespace detail {

/// Transient growth of the linearised motion of a word, as energies.
struct growth_of_energy {
  /// Largest (|M^n|^2 - 1) of up to early_steps steps: the energy error of oscillations, relative to their
  /// energy.
  double early = 0.0;
  double late = 0.0;      ///< largest |M^n|^2 - 1 over all steps
  std::size_t state = 0;  ///< number of the state where late is largest

  static constexpr std::int64_t early_steps = 64;  ///< some periods of fast motion, one of slow
  /// Smallest relevant growth of the energy: less does not show in results of runs.
  static constexpr double smallest = 0.05;
  /// Threefold is much: a stable motion whose energy swings by nine.
  static constexpr double too_much = 8.0;
  /// Smallest relevant factor: growth by less than this is not distinguished from a motion that has not yet
  /// shown all of its error.
  static constexpr double factor = 3.0;

  /// Whether late is too much, or has grown since early.
  bool is_refused() const { return late > too_much || (late > smallest && late > factor * early); }

  /// Whether this is refused and the other is not, or, if both are or neither is, is the larger.
  bool is_worse_than(const growth_of_energy& other) const {
    return is_refused() != other.is_refused() ? is_refused() : late > other.late;
  }
};

/// A word of drifts and kicks, each kick with a force of its own, on the linearised motion about some states.
/// Hessians of parts do not commute, so that one frequency does not say what a step does: M is the product of
/// its letters, each linearised at the same state, a symplectic matrix in coordinates (q, p) in which |x|^2/2
/// is the energy of the linearised motion. Directions in which the linearised motion does not oscillate are
/// left out, as the motion itself leaves there. Letters are examined by dual numbers and must be of one of
/// two kinds: q += c h K''p', or p -= c h V_i''q; words with others are not known.
class word_on_parts {
 public:
  /// Modes that turn by less in a step, in radian, are too slow to meet a fast one, and are left out of M.
  static constexpr double least_turn = 0.01;

  /// A word on the parts of a system of at most most_for_all_frequencies degrees of freedom. The mean is that
  /// of up to 8 of the states, evenly spread; M is examined at as many of them as take some milliseconds
  /// together, and at half as many if has_mean(). Cost: a Jacobian of each letter at each of these states.
  word_on_parts(const model& system, const phase_points& states, const nysalt::word& word);

  bool is_known() const { return why_not_.empty(); }       ///< M can be computed
  const std::string& why_not() const { return why_not_; }  ///< M cannot be computed; else empty
  const std::string& word() const { return word_; }        ///< letters of the word
  std::size_t states() const { return at_.size(); }        ///< number of states that are examined
  /// Whether Hessians are near enough to their mean for that to be one of a motion: they differ from it by
  /// less than half of its largest eigenvalue.
  bool has_mean() const { return has_mean_; }

  /// M at a state, or, of number states(), in the mean. Throws std::invalid_argument unless there is a
  /// coefficient for each slot.
  Eigen::MatrixXd step(const std::vector<double>& coefficients, double step, std::size_t state) const;

  /// Growth in the mean, if has_mean() and that is refused; else that or the mean over states of the growth
  /// at each, of the two the worse. Cost: some log2(steps) products of matrices for each state.
  growth_of_energy growth(const std::vector<double>& coefficients, double step, std::int64_t steps) const;

  /// Displacement of the equilibrium by a step, in the norm of the energy, relative to the motion along the
  /// states: kicks that are one period of a mode apart push it always in one phase. 0 without a mean.
  double displacement(const std::vector<double>& coefficients, double step) const;

 private:
  /// A letter of the word that is not of the bath.
  struct letter {
    std::size_t kind;  // number of the letter among those that differ
    std::size_t first_slot;
    std::size_t slots;
  };
  struct kind {
    bool drifts = false;
    std::size_t first_kick = 0;  // number of the first Hessian
  };
  struct motion;
  /// The linearised step in the coordinates in which the whole Hessian is diagonal.
  struct linearised {
    Eigen::VectorXd squares;                 // of frequencies, from low to high
    std::vector<Eigen::MatrixXd> stiffness;  // of each slot of a kick
    std::vector<Eigen::VectorXd> force;      // of each slot of a kick, about the equilibrium
  };

  static linearised diagonal(const motion& about);
  /// Each letter that differs from those before it, as a word by itself. This and the two functions below
  /// throw std::invalid_argument where the linearised motion is not known, and say why.
  std::vector<nysalt::word> kinds_of(const model& system, const nysalt::word& word);
  /// Finds of which kind a letter is, and adds what it does about a state, root root^T = K''.
  static void add_letter(const model& system, const nysalt::word& single, kind& of,
                         const phase_point<double, Eigen::Dynamic>& at, const Eigen::MatrixXd& root,
                         motion& to);
  void examine(const model& system, const phase_points& states, const std::vector<nysalt::word>& kinds);
  const linearised& of_state(std::size_t state) const { return state < at_.size() ? at_[state] : mean_; }
  void apply(const linearised& at, const std::vector<double>& coefficients, double step,
             Eigen::Ref<Eigen::MatrixXd> x, Eigen::VectorXd* affine) const;

  std::string word_;
  std::vector<letter> letters_;
  std::vector<kind> kinds_;
  std::size_t slots_ = 0;
  std::vector<linearised> at_;
  linearised mean_;
  bool has_mean_ = false;
  double amplitude_ = 0.0;  // root mean square of (q, p) in the norm of the energy
  std::string why_not_;
};

}  // namespace detail

}  // namespace nysalt
