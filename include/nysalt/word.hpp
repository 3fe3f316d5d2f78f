// SPDX-License-Identifier: BSL-1.0
// A word: the letters of a method in the order in which they act, and what follows from that order.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/letters.hpp"

namespace nysalt {

namespace detail {

/// Evaluation of force(q) before a letter acts: none, where the letter does not read the force or finds the
/// force known; unshared, for this letter only, so that the force need not be stored; or shared with later
/// letters.
enum class evaluation { none, unshared, shared };

// Refusals of words: a word that is a constant does not compile where it would call one of them.
[[noreturn]] inline void refuse_word_without_letters();
[[noreturn]] inline void refuse_too_long_word(std::string_view letters, std::size_t most);
[[noreturn]] inline void refuse_unknown_letter(std::string_view letters, char letter);
[[noreturn]] inline void refuse_two_splittings(std::string_view letters);
[[noreturn]] inline void refuse_word_of_bath_only(std::string_view letters);
[[noreturn]] inline void refuse_letters_of_processor(std::string_view letters, std::string_view processor);
[[noreturn]] inline void refuse_processor_in_bath(std::string_view letters);
[[noreturn]] inline void refuse_processor_of_rotations(std::string_view letters);
[[noreturn]] inline void refuse_too_many_own_letters(std::string_view letters, std::size_t most);
[[noreturn]] inline void refuse_coefficients(std::string_view letters, std::size_t length, std::size_t slots,
                                             std::size_t got);

}  // namespace detail

/// A method's letters, which act from left to right: word("BAB") is velocity Verlet. A word is a value: a
/// constant of a family, a template argument, or data of a file. A word that is a constant is checked while
/// it is compiled.
///
/// A run over many steps is held open: the first letter is already applied. Where the last letter is the
/// first one again (and additive), the two become one; and a force is reused while q has not moved.
class word {
 public:
  static constexpr std::size_t most_letters = 512;  ///< largest number of letters, with the processor
  static constexpr std::size_t most_own = 8;        ///< largest number of letters that are not the library's
  /// Separates the letters of a kernel from the letters of its processor.
  static constexpr char processor_mark = '|';

  /// Letters as in docs/notation.md, acting from left to right: "BAB" is velocity Verlet, and "ABA|BABA" the
  /// kernel ABA with the processor P = BABA. A run of a processed word begins with P(h)^-1, its steps are
  /// steps of the kernel, and what is observed is a copy on which P(-h) has acted. Letters of a system
  /// are added by their facts, from facts_of_letter() or model::facts().own_letters.
  /// Throws std::invalid_argument if there is no letter but O, or one that is not known, if some letters
  /// split H in one way and some in the other, if a processor is not made of letters A and B in turn, or
  /// belongs to a kernel with letters O or R, or if there are more than most_letters.
  constexpr explicit word(std::string_view letters, std::span<const letter_facts> own = {}) {
    take_text(letters, own);
    take_letters();
    take_plan();
    if (is_processed()) take_processor();
  }

  /// A word with other letters; letters of a system are taken from this word.
  constexpr word with_letters(std::string_view other) const { return word(other, own()); }

  constexpr std::string_view view() const { return {text.data(), text_size}; }  ///< letters as given
  std::string letters() const { return std::string(view()); }                   ///< letters as given
  constexpr char letter(std::size_t i) const { return text[i]; }                ///< name of letter i
  constexpr bool is_processed() const { return length < text_size; }  ///< whether the word has a processor
  /// The letters of the processor P; empty of a word that has none.
  constexpr std::string_view processor() const {
    return is_processed() ? view().substr(length + 1) : std::string_view();
  }

  /// Throws std::invalid_argument unless there are as many coefficients as slots.
  void require_one_for_each_slot(const auto& coefficients) const {
    if (coefficients.size() != slots) detail::refuse_coefficients(view(), length, slots, coefficients.size());
  }

  /// Properties of letter i.
  constexpr const letter_facts& facts(std::size_t i) const {
    if (const letter_facts* found = own_letter(text[i])) return *found;
    for (const letter_facts& known : detail::letter_table) {
      if (known.letter == text[i]) return known;
    }
    detail::refuse_unknown_letter(view(), text[i]);
  }
  /// Number of coefficients of letter i.
  constexpr std::size_t slots_of(std::size_t i) const { return facts(i).slots; }
  /// Index of the first coefficient of letter i; the coefficients of all letters are in one list, letter
  /// after letter.
  constexpr std::size_t first_slot(std::size_t i) const {
    std::size_t result = 0;
    for (std::size_t k = 0; k < i; ++k) result += slots_of(k);
    return result;
  }

  constexpr bool has_own_letters() const { return own_count > 0; }  ///< whether letters are of a system
  /// The letters that are of a system, each once.
  constexpr std::span<const letter_facts> own() const { return {own_facts.data(), own_count}; }
  /// A letter of a system; null where the letter is another one.
  constexpr const letter_facts* own_letter(char letter) const {
    for (std::size_t k = 0; k < own_count; ++k) {
      if (own_facts[k].letter == letter) return &own_facts[k];
    }
    return nullptr;
  }
  /// Whether the letters split off the quadratic part: R, S or H.
  constexpr bool rotates() const { return is_rotating; }
  /// First letter of a step of an open run: 1 if letter 0 merges with the last.
  constexpr std::size_t first_in_loop() const { return merges ? 1 : 0; }

  /// The evaluations of all letters.
  struct evaluation_plan {
    std::array<detail::evaluation, most_letters>
        in_step{};  ///< of a plain step, which starts from only q and p
    /// Of a step of an open run, if another one follows; from letter first_in_loop() on.
    std::array<detail::evaluation, most_letters> in_loop{};
    std::array<detail::evaluation, most_letters> in_last{};  ///< the same, if the run may be observed then
    bool is_known_when_open = false;                         ///< the force, whenever a run may be observed
  };
  /// Plan of force evaluations, in a plain step and in an open run.
  constexpr evaluation_plan plan() const {
    evaluation_plan result;
    const std::size_t first = first_in_loop();
    find_known(result.in_step, 0, false);
    find_needed(result.in_step, 0, false);
    const bool after_one_step = find_known(result.in_loop, first, false);
    find_known(result.in_loop, first, after_one_step);
    const bool by_next = find_needed(result.in_loop, first, false);
    result.in_last = result.in_loop;
    // The first letter may be taken back.
    result.is_known_when_open = by_next || (first > 0 && facts(0).reads != field::none);
    find_needed(result.in_loop, first, by_next);
    find_needed(result.in_last, first, result.is_known_when_open);
    return result;
  }

  bool operator==(const word&) const = default;  ///< the same letters

  std::array<char, most_letters> text{};           ///< letters, then zeros
  std::size_t text_size = 0;                       ///< number of characters of the text
  std::array<letter_facts, most_own> own_facts{};  ///< of own()
  std::size_t own_count = 0;                       ///< number of letters of a system
  std::size_t length = 0;                          ///< number of letters, without the processor's
  std::size_t slots = 0;           ///< number of coefficients: first the kernel's, then the processor's
  std::size_t kernel_slots = 0;    ///< number of coefficients without the processor
  field reads = field::none;       ///< the force that the letters read
  int force_derivatives = 0;       ///< f'(q) v in a step, one evaluation each
  int displaced_forces = 0;        ///< forces at displaced points in a step
  bool is_symplectic = true;       ///< whether every letter is symplectic
  bool is_rotating = false;        ///< rotates()
  bool reads_modes = false;        ///< whether the word has a letter R
  bool merges = false;             ///< last and first letter are applied as one
  bool merges_half_steps = false;  ///< first and last letter are of the bath
  int stochastic_letters = 0;      ///< number of letters O
  int evaluations_per_step = 0;    ///< force evaluations of a step of an open run
  int evaluations_to_open = 0;     ///< force evaluations to open a run, with the evaluations of P(h)^-1
  /// Force evaluations of each observation of a run: evaluations of P(-h), or of a first letter that is taken
  /// back and evaluates forces itself.
  int evaluations_to_observe = 0;
  int evaluations_of_plain_step = 0;  ///< force evaluations of a step from only q and p

 private:
  constexpr void take_text(std::string_view letters, std::span<const letter_facts> own) {
    if (letters.size() > most_letters) detail::refuse_too_long_word(letters, most_letters);
    text_size = letters.size();
    std::copy(letters.begin(), letters.end(), text.begin());
    length = std::min(letters.find(processor_mark), letters.size());
    if (length == 0) detail::refuse_word_without_letters();
    for (const char letter : letters) {  // in the order of the word, so that equal words are equal
      if (detail::is_known_letter(letter) || own_letter(letter)) continue;
      for (const letter_facts& one : own) {
        if (one.letter != letter) continue;
        if (own_count == most_own) detail::refuse_too_many_own_letters(letters, most_own);
        own_facts[own_count++] = one;
        break;
      }
    }
  }

  constexpr void take_letters() {
    bool is_of_k_and_v = false;
    for (std::size_t i = 0; i < length; ++i) {
      const letter_facts& one = facts(i);
      slots += one.slots;
      force_derivatives += one.force_derivatives;
      displaced_forces += one.displaced_forces;
      is_symplectic = is_symplectic && one.symplectic;
      if (one.reads != field::none) reads = one.reads;
      stochastic_letters += one.is_of_bath ? 1 : 0;
      is_of_k_and_v = is_of_k_and_v || one.splits == splitting::kinetic_and_potential;
      is_rotating = is_rotating || one.splits == splitting::quadratic_part_and_rest;
      reads_modes = reads_modes || one.reads_modes;
    }
    kernel_slots = slots;
    if (is_of_k_and_v && is_rotating) detail::refuse_two_splittings(view());
    if (stochastic_letters == static_cast<int>(length)) detail::refuse_word_of_bath_only(view());
    merges = length > 1 && text[0] == text[length - 1] && facts(0).additive;
    merges_half_steps = length > 1 && facts(0).is_of_bath && facts(length - 1).is_of_bath;
  }

  constexpr void take_plan() {
    const evaluation_plan found = plan();
    const auto count = [](const auto& all) {
      int result = 0;
      for (const detail::evaluation one : all) result += one != detail::evaluation::none ? 1 : 0;
      return result;
    };
    if (merges) evaluations_to_observe = facts(0).displaced_forces;  // once a run and observation
    const int by_letters = force_derivatives + displaced_forces;
    evaluations_per_step = count(found.in_loop) + by_letters - evaluations_to_observe;
    evaluations_to_open = (found.is_known_when_open ? 1 : 0) + evaluations_to_observe;
    evaluations_of_plain_step = count(found.in_step) + by_letters;
  }

  constexpr void take_processor() {
    const std::string_view letters = processor();
    const auto is_other = [](char a, char b) { return (a == 'A' && b == 'B') || (a == 'B' && b == 'A'); };
    bool are_in_turn = letters.starts_with('A') || letters.starts_with('B');
    int forces = 0;
    for (std::size_t i = 0; i < letters.size(); ++i) {
      are_in_turn = are_in_turn && (i == 0 || is_other(letters[i - 1], letters[i]));
      forces += letters[i] == 'B' ? 1 : 0;
    }
    if (!are_in_turn) detail::refuse_letters_of_processor(view(), letters);
    if (stochastic_letters > 0) detail::refuse_processor_in_bath(view());
    if (is_rotating) detail::refuse_processor_of_rotations(view());
    slots += letters.size();
    evaluations_to_observe = forces;
    evaluations_to_open += forces;
    evaluations_of_plain_step += 2 * forces;
  }

  /// A letter that does not find the force known evaluates it. Returns whether it is known after the last
  /// letter.
  constexpr bool find_known(std::array<detail::evaluation, most_letters>& found, std::size_t first,
                            bool known) const {
    for (std::size_t i = first; i < length; ++i) {
      const letter_facts& one = facts(i);
      const bool reads_force = one.reads != field::none;
      found[i] = reads_force && !known ? detail::evaluation::shared : detail::evaluation::none;
      known = (known || reads_force) && !one.moves_q;
    }
    return known;
  }
  /// Who evaluates it for others, if it is needed after the last letter or not. Returns whether it is needed
  /// before the first.
  constexpr bool find_needed(std::array<detail::evaluation, most_letters>& found, std::size_t first,
                             bool needed) const {
    for (std::size_t i = length; i-- > first;) {
      if (facts(i).reads == field::none) continue;
      if (found[i] != detail::evaluation::none)
        found[i] = needed ? detail::evaluation::shared : detail::evaluation::unshared;
      needed = found[i] == detail::evaluation::none;
    }
    return needed;
  }
};

/// The word of these flows, from left to right: flows of the library, and flows of a system.
template <Flow... L>
  requires(sizeof...(L) > 0)
constexpr word word_of() {
  constexpr auto are_told_apart = []<class One>(std::type_identity<One>) {
    return ((One::letter != L::letter || std::is_same_v<One, L>)&&...);
  };
  static_assert((are_told_apart(std::type_identity<L>()) && ...),
                "nysalt: letters of one's own must have different names; name one of them otherwise");
  static_assert(((detail::is_among<L, detail::known_letters> || !detail::is_known_letter(L::letter)) && ...),
                "nysalt: a letter of one's own takes a character that no known letter has");
  constexpr std::array letters{L::letter...};
  constexpr std::array facts{detail::facts_of_letter<L>()...};
  return word(std::string_view(letters.data(), letters.size()), facts);
}

/// First Second First ... of the given odd length: a word that reads the same from both ends.
template <Flow First, Flow Second, std::size_t Length>
  requires(Length % 2 == 1)
constexpr word alternating_word() {
  return []<std::size_t... I>(std::index_sequence<I...>) {
    return word_of<std::conditional_t<I % 2 == 0, First, Second>...>();
  }(std::make_index_sequence<Length>{});
}

namespace detail {

/// The coefficients x_1 y_1 x_2 y_2 ... y_2 x_2 y_1 x_1 of such a word from its first ones: the middle one
/// and its neighbour follow from consistency, sum x = sum y = 1. Symmetric, hence of even order.
template <std::size_t Length, class C = double>
  requires(Length % 2 == 1 && Length >= 3)
constexpr std::array<C, Length> palindrome(const std::array<C, (Length - 3) / 2>& free) {
  constexpr std::size_t middle = (Length - 1) / 2;
  std::array<C, Length> all{};
  C of_middle_letter(1.0);
  C of_neighbour(0.5);
  for (std::size_t i = 0; i + 1 < middle; ++i) {
    all[i] = free[i];
    if (i % 2 == middle % 2) {
      of_middle_letter = of_middle_letter - 2.0 * free[i];
    } else {
      of_neighbour = of_neighbour - free[i];
    }
  }
  all[middle - 1] = of_neighbour;
  all[middle] = of_middle_letter;
  for (std::size_t i = 0; i < middle; ++i) all[Length - 1 - i] = all[i];
  return all;
}

}  // namespace detail

/// Evaluations of the force of a part of V in a step of an open run, which a declared price multiplies.
/// Letters that do not say, such as drifts, evaluate none.
constexpr int evaluations_of_part(const word& letters, std::size_t part) {
  int all = 0;
  for (std::size_t i = letters.first_in_loop(); i < letters.length; ++i) {
    const std::string_view parts = letters.facts(i).parts.view();
    all += parts.find(static_cast<char>('0' + part)) != std::string_view::npos ? 1 : 0;
  }
  return all;
}

/// The declared cost of a step of an open run: the sum over parts of price times evaluations.
constexpr double declared_cost(const word& letters, std::span<const double> prices) {
  double all = 0.0;
  for (std::size_t part = 0; part < prices.size(); ++part) {
    all += prices[part] * evaluations_of_part(letters, part);
  }
  return all;
}

/// Whether the kernel of a method, which is all of it without a processor, reads the same from both ends,
/// letters and coefficients. A step back undoes a step then, with any processor.
inline bool is_palindrome(const word& letters, const std::vector<double>& coefficients);

/// The word without its letters O: what it is in a bath that does not act. Throws std::invalid_argument if
/// nothing is left.
inline word conservative_part(const word& letters);
/// The coefficients of the letters that are left. Throws std::invalid_argument unless there is one for each
/// slot.
template <class C>
std::vector<C> conservative_part(const word& letters, const std::vector<C>& all) {
  letters.require_one_for_each_slot(all);
  if (letters.stochastic_letters == 0) return all;
  std::vector<C> result;
  std::size_t slot = 0;
  for (std::size_t i = 0; i < letters.length; ++i) {
    for (std::size_t k = 0; k < letters.slots_of(i); ++k, ++slot) {
      if (letters.letter(i) != detail::bath_letter) result.push_back(all[slot]);
    }
  }
  return result;
}

namespace detail {

/// The word before the first step of a processed word, P(h)^-1: the letters of P from the last to the first.
inline word pre_processor(const word& letters);
/// The coefficients of P(h)^-1 from the coefficients of the whole word.
template <class C>
std::vector<C> pre_processor_coefficients(const word& letters, const std::vector<C>& all) {
  std::vector<C> result;
  for (std::size_t i = letters.slots; i-- > letters.kernel_slots;) result.push_back(C(-all[i]));
  return result;
}
/// The word on a copy that is observed, P(-h).
inline word post_processor(const word& letters);
/// The coefficients of P(-h) from the coefficients of the whole word.
template <class C>
std::vector<C> post_processor_coefficients(const word& letters, const std::vector<C>& all) {
  std::vector<C> result;
  for (std::size_t i = letters.kernel_slots; i < letters.slots; ++i) result.push_back(C(-all[i]));
  return result;
}

}  // namespace detail

// What a word that cannot be says, and functions of words.

namespace detail {

/// The letters of the library of which `is_meant` holds, joined by commas.
std::string listed_letters(const auto& is_meant) {
  std::string all;
  for (const letter_facts& one : letter_table) {
    if (is_meant(one)) (all += all.empty() ? "" : ", ") += one.letter;
  }
  return all;
}

inline void refuse_word_without_letters() {
  throw std::invalid_argument("word: letters must be one or more, got none");
}

inline void refuse_too_long_word(std::string_view letters, std::size_t most) {
  throw std::invalid_argument(sentence("word: letters must be at most {}, got {} in {}...; split the step",
                                       most, letters.size(), letters.substr(0, 16)));
}

inline void refuse_unknown_letter(std::string_view letters, char letter) {
  throw std::invalid_argument(
      sentence("word: letters must be known, got {} with the letter {}; known letters are {}", letters,
               letter, listed_letters([](const letter_facts&) { return true; })));
}

inline void refuse_two_splittings(std::string_view letters) {
  const auto letters_of = [](splitting of_h) {
    return listed_letters([=](const letter_facts& one) { return one.splits == of_h; });
  };
  throw std::invalid_argument(sentence(
      "the word {}: letters must be of one splitting, either {} of H into K and V or {} of H into "
      "its quadratic part and the rest",
      letters, letters_of(splitting::kinetic_and_potential), letters_of(splitting::quadratic_part_and_rest)));
}

inline void refuse_word_of_bath_only(std::string_view letters) {
  throw std::invalid_argument(sentence("word: a word must have a letter other than O, got {}", letters));
}

inline void refuse_letters_of_processor(std::string_view letters, std::string_view processor) {
  throw std::invalid_argument(
      sentence("the word {}: the letters of its processor must be A and B in turn, as in BABA, got {}",
               letters, processor));
}

inline void refuse_processor_in_bath(std::string_view letters) {
  throw std::invalid_argument(
      sentence("the word {} must not have both letters O and a processor; leave one of them away, as a "
               "kernel that is made for a processor gives the modes another temperature",
               letters));
}

inline void refuse_processor_of_rotations(std::string_view letters) {
  throw std::invalid_argument(
      sentence("the word {}: the kernel of a processor must be of the letters A, B, D and G, as the "
               "letters A and B of a processor do not mix with R, S and H; take another kernel",
               letters));
}

inline void refuse_too_many_own_letters(std::string_view letters, std::size_t most) {
  throw std::invalid_argument(
      sentence("the word {} must have at most {} letters of a system; leave some away", letters, most));
}

inline void refuse_coefficients(std::string_view letters, std::size_t length, std::size_t slots,
                                std::size_t got) {
  const std::string two = slots > length ? sentence(" and {} coefficients", slots) : "";
  throw std::invalid_argument(
      sentence("word: coefficients must fit the word {} with {} letters{}, got {} coefficients", letters,
               length, two, got));
}

inline word pre_processor(const word& letters) {
  const std::string_view p = letters.processor();
  return word(std::string(p.rbegin(), p.rend()));
}

inline word post_processor(const word& letters) { return word(letters.processor()); }

}  // namespace detail

inline bool is_palindrome(const word& letters, const std::vector<double>& coefficients) {
  for (std::size_t i = 0, j = letters.length; i < j--; ++i) {
    if (letters.letter(i) != letters.letter(j)) return false;
    for (std::size_t k = 0; k < letters.slots_of(i); ++k) {
      if (coefficients[letters.first_slot(i) + k] != coefficients[letters.first_slot(j) + k]) return false;
    }
  }
  return true;
}

inline word conservative_part(const word& letters) {
  std::string kept = letters.letters();
  std::erase(kept, detail::bath_letter);
  return letters.with_letters(kept);
}

}  // namespace nysalt
