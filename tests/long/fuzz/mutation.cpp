// SPDX-License-Identifier: BSL-1.0
#include "mutation.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <utility>

namespace nysalt::fuzz {

namespace {

/// Half open: text.substr(first, last - first).
struct span {
  std::size_t first;
  std::size_t last;
};

struct dice {
  std::mt19937_64& bits;
  const std::vector<std::string>& corpus;
  /// 0 .. n - 1. The bias of the remainder does not matter here.
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits() % n); }
  const auto& one_of(const auto& all) { return all[below(std::size(all))]; }
  auto place_in(auto& all) { return all.begin() + static_cast<long>(below(all.size())); }
};

std::vector<span> words_of(const std::string& text, auto&& belongs) {
  std::vector<span> found;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!belongs(static_cast<unsigned char>(text[i]))) continue;
    const std::size_t first = i;
    while (i < text.size() && belongs(static_cast<unsigned char>(text[i]))) ++i;
    found.push_back({first, i});
  }
  return found;
}

std::vector<span> numbers_in(const std::string& text) {
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  auto found = words_of(
      text, [&](unsigned char c) { return is_digit(c) || c == '.' || c == '-' || c == '+' || c == 'e'; });
  std::erase_if(found, [&](const span& word) {
    return std::ranges::none_of(text.substr(word.first, word.last - word.first), is_digit);
  });
  return found;
}

std::vector<span> names_in(const std::string& text) {
  return words_of(text, [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; });
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t end = std::min(text.find('\n', from), text.size() - 1) + 1;
    lines.push_back(text.substr(from, end - from));
    from = end;
  }
  return lines;
}

void flip_bit(std::string& text, dice& random) {
  if (text.empty()) return;
  char& c = text[random.below(text.size())];
  c = static_cast<char>(c ^ (1 << random.below(8)));
}

void insert_byte(std::string& text, dice& random) {
  constexpr std::array telling{'"', '\'', '{', '}', '[', ']', ',', ':', '=', '#', '-', '@', '\\', '\n', '\0'};
  const std::size_t where = random.below(text.size() + 1);
  text.insert(where, 1, random.below(2) == 0 ? random.one_of(telling) : static_cast<char>(random.below(256)));
}

void cut_off(std::string& text, dice& random) { text.resize(random.below(text.size() + 1)); }

void cut_out(std::string& text, dice& random) {
  if (text.empty()) return;
  const std::size_t first = random.below(text.size());
  text.erase(first, 1 + random.below(std::min<std::size_t>(text.size() - first, 16)));
}

/// Changes the lines of a text that has any.
void change_lines(std::string& text, auto&& change) {
  auto lines = lines_of(text);
  if (lines.empty()) return;
  change(lines);
  text.clear();
  for (const auto& line : lines) text += line;
}

void lose_line(std::string& text, dice& random) {
  change_lines(text, [&](auto& lines) { lines.erase(random.place_in(lines)); });
}

void double_line(std::string& text, dice& random) {
  change_lines(text, [&](auto& lines) {
    const std::string again = random.one_of(lines);
    lines.insert(random.place_in(lines), again);
  });
}

void swap_lines(std::string& text, dice& random) {
  change_lines(text, [&](auto& lines) { std::iter_swap(random.place_in(lines), random.place_in(lines)); });
}

void take_line(std::string& text, dice& random) {
  const auto others = lines_of(random.one_of(random.corpus));
  if (others.empty()) return;
  const std::string line = random.one_of(others);
  change_lines(text, [&](auto& lines) {
    lines.insert(lines.begin() + static_cast<long>(random.below(lines.size() + 1)), line);
  });
}

void replace_number(std::string& text, dice& random) {
  static const std::vector<std::string> strange = [] {
    std::istringstream all(
        "nan inf -inf 1e999 -0 0 -1 1 1e308 1e-308 5e-324 0.5 -0.5 2 3 9223372036854775807 "
        "9223372036854775808 18446744073709551616 1e17 0x10 1e null");
    std::vector<std::string> words{""};
    for (std::string word; all >> word;) words.push_back(word);
    return words;
  }();
  const auto numbers = numbers_in(text);
  if (numbers.empty()) return;
  const auto [first, last] = random.one_of(numbers);
  text.replace(first, last - first, random.one_of(strange));
}

void swap_names(std::string& text, dice& random) {
  const auto names = names_in(text);
  if (names.empty()) return;
  auto one = random.one_of(names);
  auto other = random.one_of(names);
  if (one.first > other.first) std::swap(one, other);
  if (one.first == other.first) return;
  const std::string first = text.substr(one.first, one.last - one.first);
  const std::string second = text.substr(other.first, other.last - other.first);
  text.replace(other.first, second.size(), first);  // the later one first, so that the earlier stays in place
  text.replace(one.first, first.size(), second);
}

// Numbers twice as often: they are where the program computes.
constexpr std::array changes{flip_bit,   insert_byte, cut_off,    cut_out,        lose_line,     double_line,
                             swap_lines, take_line,   swap_names, replace_number, replace_number};

}  // namespace

std::string mutated(std::string text, const std::vector<std::string>& corpus, std::mt19937_64& bits) {
  dice random{bits, corpus};
  for (std::size_t left = 1 + random.below(4); left > 0; --left) random.one_of(changes)(text, random);
  return text;
}

}  // namespace nysalt::fuzz
