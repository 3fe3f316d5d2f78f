// SPDX-License-Identifier: BSL-1.0
#include "nysalt/word.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <stdexcept>

namespace nysalt {

namespace {

/// The letters of the library of which `is_meant` holds.
std::string listed(const auto& is_meant) {
  std::string all;
  for (const letter_facts& one : detail::letter_table) {
    if (is_meant(one)) (all += all.empty() ? "" : ", ") += one.letter;
  }
  return all;
}

}  // namespace

namespace detail {

void refuse_word_without_letters() {
  throw std::invalid_argument("word: letters must be one or more, got none");
}

void refuse_too_long_word(std::string_view letters, std::size_t most) {
  throw std::invalid_argument(fmt::format("word: letters must be at most {}, got {} in {}...; split the step",
                                          most, letters.size(), letters.substr(0, 16)));
}

void refuse_unknown_letter(std::string_view letters, char letter) {
  throw std::invalid_argument(
      fmt::format("word: letters must be known, got {} with the letter {}; known letters are {}", letters,
                  letter, listed([](const letter_facts&) { return true; })));
}

void refuse_two_splittings(std::string_view letters) {
  const auto letters_of = [](splitting of_h) {
    return listed([=](const letter_facts& one) { return one.splits == of_h; });
  };
  throw std::invalid_argument(fmt::format(
      "the word {}: letters must be of one splitting, either {} of H into K and V or {} of H into "
      "its quadratic part and the rest",
      letters, letters_of(splitting::kinetic_and_potential), letters_of(splitting::quadratic_part_and_rest)));
}

void refuse_word_of_bath_only(std::string_view letters) {
  throw std::invalid_argument(fmt::format("word: a word must have a letter other than O, got {}", letters));
}

void refuse_letters_of_processor(std::string_view letters, std::string_view processor) {
  throw std::invalid_argument(
      fmt::format("the word {}: the letters of its processor must be A and B in turn, as in BABA, got {}",
                  letters, processor));
}

void refuse_processor_in_bath(std::string_view letters) {
  throw std::invalid_argument(
      fmt::format("the word {} must not have both letters O and a processor; leave one of them away, as a "
                  "kernel that is made for a processor gives the modes another temperature",
                  letters));
}

void refuse_processor_of_rotations(std::string_view letters) {
  throw std::invalid_argument(
      fmt::format("the word {}: the kernel of a processor must be of the letters A, B, D and G, as the "
                  "letters A and B of a processor do not mix with R, S and H; take another kernel",
                  letters));
}

void refuse_too_many_own_letters(std::string_view letters, std::size_t most) {
  throw std::invalid_argument(
      fmt::format("the word {} must have at most {} letters of a system; leave some away", letters, most));
}

void refuse_coefficients(std::string_view letters, std::size_t length, std::size_t slots, std::size_t got) {
  const std::string two = slots > length ? fmt::format(" and {} coefficients", slots) : "";
  throw std::invalid_argument(
      fmt::format("word: coefficients must fit the word {} with {} letters{}, got {} coefficients", letters,
                  length, two, got));
}

word pre_processor(const word& letters) {
  const std::string_view p = letters.processor();
  return word(std::string(p.rbegin(), p.rend()));
}

word post_processor(const word& letters) { return word(letters.processor()); }

}  // namespace detail

bool is_palindrome(const word& letters, const std::vector<double>& coefficients) {
  for (std::size_t i = 0, j = letters.length; i < j--; ++i) {
    if (letters.letter(i) != letters.letter(j)) return false;
    for (std::size_t k = 0; k < letters.slots_of(i); ++k) {
      if (coefficients[letters.first_slot(i) + k] != coefficients[letters.first_slot(j) + k]) return false;
    }
  }
  return true;
}

word conservative_part(const word& letters) {
  std::string kept = letters.letters();
  std::erase(kept, detail::bath_letter);
  return letters.with_letters(kept);
}

}  // namespace nysalt
