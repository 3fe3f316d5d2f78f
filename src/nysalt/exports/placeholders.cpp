// SPDX-License-Identifier: BSL-1.0

#include "placeholders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace nysalt::detail {

namespace {

using subject = template_subject;

/// The number so that reading it gives the same bits, with a decimal point or an exponent.
std::string digits(double value, std::string_view exponent) {
  std::string text = fmt::format("{}", value);
  const auto at = text.find('e');
  if (exponent != "e") {
    if (at == std::string::npos) return fmt::format("{}{}0", digits(value, "e"), exponent);
    return text.replace(at, 1, exponent);
  }
  if (at == std::string::npos && text.find('.') == std::string::npos) text += ".0";
  return text;
}

/// Numbers of any kind, joined.
template <class Number>
std::string joined(const std::vector<Number>& numbers, const auto& text_of) {
  std::string result;
  for (const Number number : numbers) result += (result.empty() ? "" : ", ") + text_of(number);
  return result;
}

std::string listed(const std::vector<double>& numbers, const subject& of) {
  return joined(numbers, [&](double number) { return digits(number, of.host.exponent); });
}

/// The lines about the method, each as a comment of the host.
std::string header(const subject& of) {
  std::string result;
  for (const auto& line : of.method.about) {
    std::string plain = line;
    for (char& c : plain) {
      if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~' || c == '\\')
        c = '?';  // a backslash would go on in the next line
    }
    const std::string_view never = of.host.uncommented;
    for (std::size_t at = 0; !never.empty() && (at = plain.find(never, at)) != std::string::npos;)
      plain.insert(++at, 1, ' ');
    result += fmt::format("{}{} {}", result.empty() ? "" : "\n", of.host.comment, plain);
  }
  return result;
}

/// What the letters of the method do, as a comment of the host.
std::string explained(const subject& of) {
  const std::string letters = letters_written(kernel_of(of.method));
  const std::string_view mark = of.host.comment;
  std::string result =
      fmt::format("{} Letters act from left to right: A(a) is q += a h M^-1 p, B(b) is p += b h f(q)", mark);
  if (letters.find('D') != std::string::npos)
    result += fmt::format(", D(b, c) is B(b) with the\n{} force at q + c h^2 M^-1 f(q)", mark);
  if (letters.find('O') != std::string::npos) {
    result += fmt::format(
        ",\n{} O(c) is p = e p + sqrt((1 - e^2) kT M) N with e = exp(-friction c h) and standard normal N",
        mark);
  }
  return result + ".";
}

/// Coefficients of schemes are sums, whose rounding differs.
bool is_equal(double a, double b) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  return std::abs(a - b) <= rounding;
}

bool is_symmetric(const exported_method& method) {
  const exported_word word = composition_of(method);
  const std::size_t n = word.size();
  for (std::size_t i = 0; i < n / 2; ++i) {
    const exported_letter& a = word[i];
    const exported_letter& b = word[n - 1 - i];
    if (a.letter != b.letter || !is_equal(a.c, b.c) || !is_equal(a.d, b.d)) return false;
  }
  return n % 2 == 1 && n > 1;
}

bool is_two_stage(const exported_method& method) {
  const exported_word word = composition_of(method);
  return letters_written(word) == "BABAB" && is_symmetric(method) && is_equal(word[1].c, 0.5) &&
         is_equal(2.0 * word[0].c + word[2].c, 1.0);
}

bool has_drifts_and_kicks_only(const exported_method& method) {
  return letters_written(composition_of(method)).find_first_not_of("AB") == std::string::npos;
}

/// Letters before the first kick after each drift.
std::vector<std::size_t> force_places(const exported_word& word) {
  std::vector<std::size_t> result;
  bool has_moved = false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char letter = word[i].letter;
    if (letter == 'A') has_moved = true;
    if (!has_moved || (letter != 'B' && letter != 'D')) continue;
    result.push_back(i);
    has_moved = false;
  }
  return result;
}

/// Whether no drift comes after the last kick.
template <exported_word (*Word)(const exported_method&)>
bool ends_with_known_force(const exported_method& method) {
  const std::string letters = letters_written(Word(method));
  const auto kick = letters.find_last_of("BD"), drift = letters.find_last_of('A');
  return kick != std::string::npos && (drift == std::string::npos || drift < kick);
}

/// Coefficients of a letter in stages of a letter `first` and one of another kind, zero where there is none.
std::vector<double> in_stages(const exported_word& word, char first, char asked) {
  std::vector<double> result;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (word[i].letter == first || i == 0) result.push_back(0.0);
    if (word[i].letter == asked) result.back() = word[i].c;
  }
  return result;
}

template <char First, char Asked>
std::string stages(const subject& of) {
  return listed(in_stages(composition_of(of.method), First, Asked), of);
}
template <char First>
std::string stage_count(const subject& of) {
  return std::to_string(in_stages(composition_of(of.method), First, First).size());
}

/// The first half of a symmetric word without its last two, which follow from the sums of drifts and of
/// kicks.
std::vector<double> free_coefficients(const exported_method& method) {
  std::vector<double> result = coefficients_of(composition_of(method));
  result.resize((result.size() + 1) / 2 - 2);
  return result;
}

/// The first half of a symmetric word with half of its centre, and zero where the number would be odd.
std::vector<double> there_and_back(const exported_method& method) {
  std::vector<double> result = coefficients_of(composition_of(method));
  result.resize(result.size() / 2 + 1);
  result.back() *= 0.5;
  if (result.size() % 2 == 1) result.push_back(0.0);
  return result;
}

/// Coefficients of a word; without letters one zero that nothing reads, as a list must not be empty.
std::vector<double> never_empty(const exported_word& word) {
  return word.empty() ? std::vector<double>{0.0} : coefficients_of(word);
}

template <exported_word (*Word)(const exported_method&)>
std::string letters(const subject& of) {
  return letters_written(Word(of.method));
}
template <exported_word (*Word)(const exported_method&)>
std::string coefficients(const subject& of) {
  return listed(never_empty(Word(of.method)), of);
}
template <exported_word (*Word)(const exported_method&)>
std::string slots(const subject& of) {
  return std::to_string(never_empty(Word(of.method)).size());
}

constexpr std::array all_placeholders{
    placeholder{"name", "", [](const subject& of) { return of.method.name; }},
    placeholder{"method", "", [](const subject& of) { return of.method.method.name(); }},
    placeholder{"order", "", [](const subject& of) { return std::to_string(of.method.method.order); }},
    placeholder{"header", "", header},
    placeholder{"explained", "", explained},
    placeholder{"end_q", "", [](const subject& of) { return listed(self_test_of(of.method).q, of); }},
    placeholder{"end_p", "", [](const subject& of) { return listed(self_test_of(of.method).p, of); }},
    placeholder{"kernel", "", letters<kernel_of>},
    placeholder{"kernel_coefficients", "", coefficients<kernel_of>},
    placeholder{"kernel_slots", "", slots<kernel_of>},
    placeholder{"start", "", letters<start_of>},
    placeholder{"start_coefficients", "", coefficients<start_of>},
    placeholder{"start_slots", "", slots<start_of>},
    placeholder{"finish", "", letters<finish_of>},
    placeholder{"finish_coefficients", "", coefficients<finish_of>},
    placeholder{"finish_slots", "", slots<finish_of>},
    placeholder{"letters", "", letters<composition_of>},
    placeholder{"coefficients", "", coefficients<composition_of>},
    placeholder{"first", "",
                [](const subject& of) { return letters_written(composition_of(of.method)).substr(0, 1); }},
    placeholder{"kicks", "",
                [](const subject& of) {
                  return std::to_string(std::ranges::count(letters_written(composition_of(of.method)), 'B'));
                }},
    placeholder{
        "forces", "",
        [](const subject& of) { return std::to_string(force_places(composition_of(of.method)).size()); }},
    placeholder{"force_places", "",
                [](const subject& of) {
                  return joined(force_places(composition_of(of.method)),
                                [](std::size_t place) { return std::to_string(place); });
                }},
    placeholder{"ab_stages", "drifts_and_kicks", stage_count<'A'>},
    placeholder{"ab_drifts", "drifts_and_kicks", stages<'A', 'A'>},
    placeholder{"ab_kicks", "drifts_and_kicks", stages<'A', 'B'>},
    placeholder{"ba_stages", "drifts_and_kicks", stage_count<'B'>},
    placeholder{"ba_kicks", "drifts_and_kicks", stages<'B', 'B'>},
    placeholder{"ba_drifts", "drifts_and_kicks", stages<'B', 'A'>},
    placeholder{"free_coefficients", "symmetric and drifts_and_kicks",
                [](const subject& of) { return listed(free_coefficients(of.method), of); }},
    placeholder{"free_count", "symmetric and drifts_and_kicks",
                [](const subject& of) { return std::to_string(free_coefficients(of.method).size()); }},
    placeholder{"there_and_back", "symmetric and drifts_and_kicks",
                [](const subject& of) { return listed(there_and_back(of.method), of); }},
    placeholder{
        "lambda", "two_stage",
        [](const subject& of) { return digits(composition_of(of.method).front().c, of.host.exponent); }},
    placeholder{"letter", "loop", [](const subject& of) { return std::string(1, of.letter->letter); }},
    placeholder{"c", "loop", [](const subject& of) { return digits(of.letter->c, of.host.exponent); }},
    placeholder{"d", "loop", [](const subject& of) { return digits(of.letter->d, of.host.exponent); }},
    placeholder{"index", "loop", [](const subject& of) { return std::to_string(of.index); }}};

constexpr std::array all_conditions{
    named_condition{"processed",
                    [](const exported_method& method) { return method.method.letters().is_processed(); }},
    named_condition{"drifts_and_kicks", has_drifts_and_kicks_only},
    named_condition{"symmetric", is_symmetric},
    named_condition{"two_stage", is_two_stage},
    named_condition{"force_at_end", ends_with_known_force<composition_of>},
    named_condition{"kernel_force_at_end", ends_with_known_force<kernel_of>}};

constexpr std::array all_words{named_word{"letters", composition_of}, named_word{"kernel", kernel_of},
                               named_word{"start", start_of}, named_word{"finish", finish_of}};

}  // namespace

std::span<const placeholder> placeholders() { return all_placeholders; }

std::span<const named_condition> conditions() { return all_conditions; }

std::span<const named_word> words() { return all_words; }

}  // namespace nysalt::detail
