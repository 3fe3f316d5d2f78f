// SPDX-License-Identifier: BSL-1.0
// Linear stability of a word at a step, on the frequencies that a system has.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/derivatives/word_on_parts.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

namespace detail {

/// Frequencies of a stability criterion: all that were met, or those that are declared or met in a tenth of
/// the states. A rare one lasts for a part of its period, as the frequency of a close pair of atoms; what it
/// does to a run only a trial run shows.
enum class met { ever, often };

/// Knows the frequencies of a system: the union of its frequency_bands() and of the frequencies of its
/// linearised motion along some states, with 2 % more on either side. Where no bands are declared the first
/// is from 0 on, and there are others where frequencies along 64 states or more lie in ranges far apart.
/// Outside of the bands a word may be unstable: gaps() lists where. Words with rotations are stable on the
/// quadratic part at any step. The guard computes how much such words magnify each of its modes under soft
/// forces of any positive stiffness up to the largest along the states, and at pairs of modes that the soft
/// forces couple.
///
/// Words with kicks of parts of V, whose Hessians do not commute, are examined on the linearised motion along
/// the states as a whole, if the guard was made for the word: whether a step of it is strongly stable
/// [krein_1950], [gelfand_lidskii_1955], how much its powers magnify, and whether it pushes a mode always in
/// one phase. So sum resonances of the outer step with fast modes are found
/// [schlick_mandziuk_skeel_srinivas_1998]. Words with letters that are neither drifts nor kicks are admitted,
/// and trial runs decide; description() says so.
class stability_guard {
 public:
  /// Share by which frequencies() are wider on either side than what is declared or was met.
  static constexpr double widened = 0.02;

  /// Bounds growth over this number of steps: less than a factor e is admitted. Of words with rotations, if
  /// there will be some, only where there are states. Cost: one frequencies_of_states(), or two
  /// where the system has a quadratic part. Throws what frequencies_of_states() does, and
  /// std::invalid_argument if no bands are declared and there are no states.
  ///
  /// The first `typical` states show what is met often; those after them were chosen as extreme.
  stability_guard(const model& system, const phase_points& states, bool rotations = true,
                  std::int64_t steps = 10'000, std::size_t typical = std::numeric_limits<std::size_t>::max());

  /// A guard for one word, whose letters are examined where they are kicks of parts. Cost: beside, of such a
  /// word, one word_on_parts.
  stability_guard(const model& system, const phase_points& states, const nysalt::word& word,
                  std::int64_t steps = 10'000, std::size_t typical = std::numeric_limits<std::size_t>::max());

  /// Whether there is no objection() to the word with these coefficients at this step.
  bool admits(const nysalt::word& word, const std::vector<double>& coefficients, double step,
              met which = met::ever) const;

  /// Objection to a word, one sentence; empty if the word is stable. Cost: some 5 us for 9 evaluations; with
  /// rotations some 20 us a mode, and 1 us a pair of modes and state. Throws std::invalid_argument unless
  /// there is a coefficient for each slot, and of a word with kicks of parts if the guard was made for
  /// another such word.
  std::string objection(const nysalt::word& word, const std::vector<double>& coefficients, double step,
                        met which = met::ever) const;

  /// Unstable intervals of z = step omega between 0 and the system's highest frequency: outside its bands, if
  /// the word is admitted. None for words with rotations. Cost: one stability_windows().
  std::vector<stability_window> gaps(const nysalt::word& word, const std::vector<double>& coefficients,
                                     double step) const;

  /// A mode and the transient growth of this mode.
  struct magnified_mode {
    double frequency;  ///< omega
    double factor;     ///< largest |M^n|, see transient_growth()
  };
  /// The mode with the largest transient growth in a word with rotations, or the first with a growth above
  /// `enough`. Factor 1 where no modes are known. Cost: some 20 us a mode.
  magnified_mode most_magnified(const nysalt::word& word, const std::vector<double>& coefficients,
                                double step, double enough = std::numeric_limits<double>::infinity()) const;

  /// Two modes that soft forces couple, and the transient growth of the pair.
  struct resonant_pair {
    double first;   ///< frequency of the one
    double second;  ///< frequency of the other
    double growth;  ///< logarithm of the factor in steps() steps
  };
  /// The pair of modes that a word with rotations lets grow most, under the mean of the soft forces'
  /// derivatives along the states, or in the mean over them. Growth 0 where no pair grows, or none is known.
  /// Cost: some 1 us a pair of modes and state.
  resonant_pair most_resonant(const nysalt::word& word, const std::vector<double>& coefficients,
                              double step) const;

  /// The bands, with 2 % more on either side.
  const std::vector<frequency_band>& frequencies(met which = met::ever) const {
    return which == met::ever ? bands_ : often_;
  }
  double highest_along() const {
    return highest_along_;
  }  ///< highest frequency along the states; 0 if not known
  /// Number of the state with that frequency.
  std::size_t state_of_highest() const { return state_of_highest_; }
  /// Frequencies on which words with rotations are watched: none, or the frequencies of the quadratic part.
  const std::vector<double>& modes() const { return modes_; }
  /// The linearised motion of a word with kicks of parts; null for other words, and for a guard without a
  /// word.
  const word_on_parts* parts() const { return parts_.get(); }
  /// Number of steps over which growth is bounded.
  std::int64_t steps() const { return steps_; }
  const std::string& description() const { return description_; }  ///< known frequencies, and their origin

 private:
  void declare(const std::vector<frequency_band>& bands);

  /// Adds the frequencies along a number of states, where these are known.
  void scan_along(const frequencies_along& along, std::size_t count, std::size_t typical,
                  bool has_quadratic_kinetic);

  /// Bands where none are declared, from the frequencies of all states and of typical ones.
  void estimate(const frequencies_along& along, std::size_t typical);

  /// Raises the end of the nearest band where frequencies lie beyond it; frequencies below all bands make one
  /// of their own.
  void extend(const frequencies_along& along, std::size_t typical);

  /// Modes that a decomposition found equal but for rounding are one.
  void add_mode(double omega);

  /// The modes of the quadratic part, under soft forces of frequencies up to the highest.
  void watch_modes(const std::vector<double>& frequencies, double highest);

  void watch_rotations(const model& system, const phase_points& states);

  std::string unstable(const nysalt::word& word, const std::vector<double>& coefficients, double step,
                       met which) const;

  std::string magnified(const nysalt::word& word, const std::vector<double>& coefficients, double step) const;

  std::string resonant(const nysalt::word& word, const std::vector<double>& coefficients, double step) const;

  std::string grown_on_parts(const std::vector<double>& coefficients, double step) const;

  std::vector<frequency_band> bands_;
  std::vector<frequency_band> often_;
  std::vector<double> modes_;
  std::vector<double> all_modes_;
  std::vector<Eigen::MatrixXd> soft_;  // in the coordinates of the modes, at some states
  Eigen::MatrixXd mean_soft_;
  double highest_along_ = 0.0;
  std::size_t state_of_highest_ = 0;
  double stiffest_soft_ = 0.0;
  std::int64_t steps_;
  std::string description_;
  std::shared_ptr<const word_on_parts> parts_;  // of a word with kicks of parts, else null
};

}  // namespace detail

}  // namespace nysalt
