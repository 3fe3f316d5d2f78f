// SPDX-License-Identifier: BSL-1.0
// A method's letters as data: for coefficients that come from a file.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/detail/known_letters.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// A word whose letters are known at run time. The constructor finds what word<...> finds at compile time:
/// which letters merge, where the force is known, and the number of force evaluations.
class run_time_word {
 public:
  /// Coefficients, one for each slot; C is double or the scalar of the states.
  template <class C>
  using coefficients = std::vector<C>;

  /// Separates the letters of a kernel from those of its processor.
  static constexpr char processor_mark = '|';

  /// Letters as in docs/notation.md, acting from left to right: "BAB" is velocity Verlet, and "ABA|BABA" the
  /// kernel ABA with the processor P = BABA. A run of a processed word begins with P(h)^-1, its steps are
  /// those of the kernel, and what is observed is a copy on which P(-h) has acted.
  /// Throws std::invalid_argument if there is no letter but O, or one that is not known, if some letters
  /// split H in one way and some in the other, or if a processor is not made of letters A and B in turn, or
  /// belongs to a kernel with letters O or R.
  explicit run_time_word(std::string letters) : run_time_word(std::move(letters), own_letters()) {}
  /// The word of a type, whose letters are known_letters.
  template <TypeLevelWord W>
  explicit run_time_word(W) : run_time_word(W::letters()) {}
  /// A word with letters of the user's own, as they act on this system, which is copied: the word steps no
  /// other, over double and packs, and their derivatives by two parameters.
  template <TypeLevelWord W, System S>
  run_time_word(W, const S& system) : run_time_word(W::letters(), detail::bound_letters<W>(system)) {}

  /// A word with other letters; the user's own letters are those of this word.
  run_time_word with_letters(std::string letters) const { return {std::move(letters), own_letters_}; }

 private:
  using own_letters = detail::own_letters;

 public:
  /// A word by its letters, of which those of one's own are taken from a list, such as that of a system.
  /// Throws std::invalid_argument as above.
  run_time_word(std::string letters, own_letters own)
      : length(std::min(letters.find(processor_mark), letters.size())),
        letters_(std::move(letters)),
        own_letters_(std::move(own)) {
    if (length == 0) throw std::invalid_argument("run_time_word: letters must be one or more, got none");
    std::erase_if(own_letters_,
                  [&](const auto& own) { return letters_.find(own->facts.letter) == std::string::npos; });
    bool additive = false;
    bool is_of_k_and_v = false;
    std::vector<bool> reads;
    std::vector<bool> moves;
    std::vector<bool> is_of_bath;
    for (std::size_t i = 0; i < length; ++i) {
      const detail::letter_facts letter = facts_at(i);
      first_slots_.push_back(slots);
      slots += letter.slots;
      force_derivatives += letter.force_derivatives;
      displaced_forces += letter.displaced_forces;
      is_symplectic = is_symplectic && letter.symplectic;
      if (letter.reads != field::none) this->reads = letter.reads;
      reads.push_back(letter.reads != field::none);
      moves.push_back(letter.moves_q);
      is_of_bath.push_back(letter.is_of_bath);
      is_of_k_and_v = is_of_k_and_v || letter.splits == splitting::kinetic_and_potential;
      rotates_ = rotates_ || letter.splits == splitting::quadratic_part_and_rest;
      reads_modes = reads_modes || letter.reads_modes;
      if (i == 0) additive = letter.additive;
    }
    if (is_of_k_and_v && rotates_) {
      const auto letters_of = [](splitting of_h) {
        return listed([=](auto flow) { return flow.splits == of_h; });
      };
      throw std::invalid_argument(
          sentence("the word {}: letters must be of one splitting, either {} of H into K and V or {} of H "
                   "into its quadratic part and the rest",
                   letters_, letters_of(splitting::kinetic_and_potential),
                   letters_of(splitting::quadratic_part_and_rest)));
    }
    merges = length > 1 && letters_.front() == letters_[length - 1] && additive;
    merges_half_steps = length > 1 && is_of_bath.front() && is_of_bath.back();
    stochastic_letters = static_cast<int>(std::count(is_of_bath.begin(), is_of_bath.end(), true));
    if (stochastic_letters == static_cast<int>(length)) {
      throw std::invalid_argument(
          sentence("run_time_word: a word must have a letter other than O, got {}", letters_));
    }
    plan_ = {reads, moves, first_in_loop(), std::vector<evaluation>(length)};
    if (merges)
      evaluations_to_observe = facts_at(0).displaced_forces;  // once a run and observation, not in each step
    evaluations_per_step =
        plan_.count(plan_.in_loop) + force_derivatives + displaced_forces - evaluations_to_observe;
    evaluations_to_open = (plan_.is_known_when_open ? 1 : 0) + evaluations_to_observe;
    evaluations_of_plain_step = plan_.count(plan_.in_step) + force_derivatives + displaced_forces;
    kernel_slots = slots;
    if (is_processed()) take_processor();
  }

  bool is_processed() const { return length < letters_.size(); }  ///< whether the word has a processor
  /// The letters of the processor P; empty of a word that has none.
  std::string processor() const { return is_processed() ? letters_.substr(length + 1) : std::string(); }

  /// Throws std::invalid_argument unless there are as many coefficients as slots.
  void require_one_for_each_slot(const auto& coefficients) const {
    if (coefficients.size() == slots) return;
    const std::string two = slots > length ? sentence(" and {} coefficients", slots) : "";
    throw std::invalid_argument(
        sentence("run_time_word: coefficients must fit the word {} with {} letters{}, got {} "
                 "coefficients",
                 letters_, length, two, coefficients.size()));
  }

  /// Index of the first coefficient of letter i.
  std::size_t first_slot(std::size_t i) const { return first_slots_[i]; }
  /// Number of coefficients of letter i.
  std::size_t slots_of(std::size_t i) const {
    return (i + 1 < length ? first_slots_[i + 1] : kernel_slots) - first_slots_[i];
  }

  const std::string& letters() const { return letters_; }         ///< letters as given
  bool has_own_letters() const { return !own_letters_.empty(); }  ///< whether the word was made with a system
  /// A letter of the user's own; null where the letter is another one.
  const detail::own_letter* own_letter(char letter) const {
    for (const auto& own : own_letters_) {
      if (own->facts.letter == letter) return own.get();
    }
    return nullptr;
  }
  /// Whether the letters are those of a quadratic part and the rest, R, S or H.
  bool rotates() const { return rotates_; }
  /// First letter of a step of an open run: 1 if letter 0 merges with the last.
  std::size_t first_in_loop() const { return merges ? 1 : 0; }
  /// Plan of force evaluations, in a plain step and in an open run.
  const detail::evaluation_plan<std::vector<evaluation>>& plan() const { return plan_; }

  std::size_t length;            ///< number of letters, those of a processor left out
  std::size_t slots = 0;         ///< number of coefficients: those of the kernel, then those of the processor
  std::size_t kernel_slots = 0;  ///< number of coefficients without the processor
  field reads = field::none;     ///< the force that its letters read
  int force_derivatives = 0;     ///< f'(q) v in a step, one evaluation each
  int displaced_forces = 0;      ///< forces at displaced points in a step
  bool is_symplectic = true;     ///< whether every letter is symplectic
  bool reads_modes = false;      ///< whether the word has a letter R
  bool merges;                   ///< last and first letter are applied as one
  bool merges_half_steps;        ///< first and last letter are of the bath
  int stochastic_letters;        ///< number of letters O
  int evaluations_per_step;      ///< force evaluations of a step of an open run
  int evaluations_to_open;       ///< force evaluations to open a run, those of P(h)^-1 among them
  /// Force evaluations of each observation of a run: those of P(-h), or of a first letter that is taken
  /// back and evaluates forces itself.
  int evaluations_to_observe = 0;
  int evaluations_of_plain_step;  ///< force evaluations of a step from only q and p

 private:
  void take_processor() {
    const std::string letters = processor();
    const auto is_other = [](char a, char b) { return (a == 'A' && b == 'B') || (a == 'B' && b == 'A'); };
    bool are_in_turn = letters.starts_with('A') || letters.starts_with('B');
    for (std::size_t i = 1; i < letters.size(); ++i) {
      are_in_turn = are_in_turn && is_other(letters[i - 1], letters[i]);
    }
    if (!are_in_turn) {
      throw std::invalid_argument(
          sentence("the word {}: the letters of its processor must be A and B in turn, as in BABA, got {}",
                   letters_, letters));
    }
    if (stochastic_letters > 0) {
      throw std::invalid_argument(
          sentence("the word {} must not have both letters O and a processor; leave one of them away, as a "
                   "kernel that is made for a processor gives the modes another temperature",
                   letters_));
    }
    if (rotates_) {
      throw std::invalid_argument(sentence(
          "the word {}: the kernel of a processor must be of the letters A, B, D and G, as the letters A "
          "and B of a processor do not mix with R, S and H; take another kernel",
          letters_));
    }
    slots += letters.size();
    evaluations_to_observe = static_cast<int>(std::count(letters.begin(), letters.end(), 'B'));
    evaluations_to_open += evaluations_to_observe;
    evaluations_of_plain_step += 2 * evaluations_to_observe;
  }

  /// The known letters of which `is_meant` holds.
  static std::string listed(const auto& is_meant) {
    std::string all;
    const auto add = [&](auto flow) {
      if (is_meant(flow)) (all += all.empty() ? "" : ", ") += flow.letter;
    };
    std::apply([&](auto... flow) { (add(flow), ...); }, known_letters{});
    return all;
  }

  /// Properties of letter i. Throws std::invalid_argument if it is not known.
  detail::letter_facts facts_at(std::size_t i) const {
    if (const auto* own = own_letter(letters_[i])) return own->facts;
    detail::letter_facts result{};
    const bool is_known = detail::with_letter(
        letters_[i], known_letters{}, [&](auto flow) { result = detail::facts_of_letter<decltype(flow)>(); });
    if (is_known) return result;
    throw std::invalid_argument(
        sentence("run_time_word: letters must be known, got {} with the letter {}; known letters are "
                 "{}",
                 letters_, letters_[i], listed([](auto) { return true; })));
  }

  std::string letters_;
  own_letters own_letters_;
  bool rotates_ = false;
  std::vector<std::size_t> first_slots_;
  detail::evaluation_plan<std::vector<evaluation>> plan_;
};

namespace detail {

/// The word before the first step of a processed word, P(h)^-1: the letters of P from the last to the first.
inline run_time_word pre_processor(const run_time_word& word) {
  const std::string letters = word.processor();
  return run_time_word(std::string(letters.rbegin(), letters.rend()));
}
/// The coefficients of P(h)^-1 from those of the whole word.
template <class C>
std::vector<C> pre_processor_coefficients(const run_time_word& word, const std::vector<C>& all) {
  std::vector<C> result;
  for (std::size_t i = word.slots; i-- > word.kernel_slots;) result.push_back(C(-all[i]));
  return result;
}
/// The word on a copy that is observed, P(-h).
inline run_time_word post_processor(const run_time_word& word) { return run_time_word(word.processor()); }
/// The coefficients of P(-h) from those of the whole word.
template <class C>
std::vector<C> post_processor_coefficients(const run_time_word& word, const std::vector<C>& all) {
  std::vector<C> result;
  for (std::size_t i = word.kernel_slots; i < word.slots; ++i) result.push_back(C(-all[i]));
  return result;
}

}  // namespace detail

/// Whether the kernel of a method, which is all of it without a processor, reads the same from both ends,
/// letters and coefficients. A step back undoes a step then, with any processor.
inline bool is_palindrome(const run_time_word& word, const std::vector<double>& coefficients) {
  for (std::size_t i = 0, j = word.length; i < j--; ++i) {
    if (word.letters()[i] != word.letters()[j]) return false;
    for (std::size_t k = 0; k < word.slots_of(i); ++k) {
      if (coefficients[word.first_slot(i) + k] != coefficients[word.first_slot(j) + k]) return false;
    }
  }
  return true;
}

/// A word as a type or as data: what a stepper takes.
template <class W>
concept Word = TypeLevelWord<W> || std::same_as<W, run_time_word>;

namespace detail {
/// Whether a word as a type has letters that are not known_letters.
template <Word W>
consteval bool has_own_letters() {
  if constexpr (TypeLevelWord<W>) {
    return !are_known_letters<W>();
  } else {
    return false;
  }
}
/// Whether a word may have a letter of known_letters.
template <Word W>
consteval bool has_known_letters() {
  if constexpr (TypeLevelWord<W>) {
    return []<std::size_t... I>(std::index_sequence<I...>) {
      return (is_known_letter<typename W::template letter<I>> || ...);
    }(std::make_index_sequence<W::length>());
  } else {
    return true;
  }
}
}  // namespace detail

}  // namespace nysalt
