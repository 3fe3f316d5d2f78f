// SPDX-License-Identifier: BSL-1.0

#include "fill.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <stdexcept>

namespace nysalt::detail {

std::string fill(std::string_view text, const gap_texts& values) {
  std::string result;
  while (true) {
    const auto begin = text.find('@');
    result += text.substr(0, begin);
    if (begin == std::string_view::npos) return result;
    const auto end = text.find('@', begin + 1);
    if (end == std::string_view::npos) throw std::logic_error("fill: a gap without an end");
    const auto key = text.substr(begin + 1, end - begin - 1);
    const auto found =
        std::ranges::find(values, key, [](const auto& one) { return std::string_view(one.first); });
    if (found == values.end()) throw std::logic_error(fmt::format("fill: no value for {}", key));
    result += found->second;
    text.remove_prefix(end + 1);
  }
}

std::string digits(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string digits(const std::vector<double>& values, char exponent) {
  std::string result;
  for (const double value : values) {
    std::string text = digits(value);
    if (exponent != 'e') {
      const auto at = text.find('e');
      if (at == std::string::npos) text += fmt::format("{}0", exponent);
      if (at != std::string::npos) text[at] = exponent;
    }
    result += (result.empty() ? "" : ", ") + text;
  }
  return result;
}

std::string header(const exported_method& method, std::string_view mark) {
  std::string result;
  for (const auto& line : method.about) {
    std::string plain = line;
    for (char& c : plain) {
      if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~' || c == '\\')
        c = '?';  // a backslash would go on in the next line
    }
    result += fmt::format("{} {}\n", mark, plain);
  }
  return result;
}

namespace {

/// The end of each text in Python.
constexpr const char* main_in_python = R"(if __name__ == "__main__":
    off = self_test()
    print(f"@NAME@: off by {off:.1e}")
    raise SystemExit(not off < 1e-13)
)";

}  // namespace

gap_texts values_of_header(const exported_method& method, std::string_view mark, char exponent) {
  const exported_letters kernel = kernel_of(method);
  std::string explained =
      fmt::format("{} Letters act from left to right: A(a) is q += a h M^-1 p, B(b) is p += b h f(q)", mark);
  if (kernel.count('D') > 0)
    explained += fmt::format(", D(b, c) is B(b) with the\n{} force at q + c h^2 M^-1 f(q)", mark);
  if (kernel.count('O') > 0) {
    explained += fmt::format(
        ",\n{} O(c) is p = e p + sqrt((1 - e^2) kT M) N with e = exp(-friction c h) and standard normal N",
        mark);
  }
  const self_test end = self_test_of(method);
  return {{"NAME", method.name},          {"HEADER", header(method, mark)},
          {"EXPLAINED", explained + "."}, {"MAIN", fill(main_in_python, {{"NAME", method.name}})},
          {"Q", digits(end.q, exponent)}, {"P", digits(end.p, exponent)}};
}

gap_texts values_of(const exported_method& method, std::string_view mark, char exponent) {
  gap_texts result = values_of_header(method, mark, exponent);
  const auto add = [&](const std::string& key, const exported_letters& part) {
    result.emplace_back(key, part.letters);
    // Where there is none, one that nothing reads: a list must not be empty.
    const std::vector<double> none{0.0};
    result.emplace_back(key + "_COEFFICIENTS",
                        digits(part.letters.empty() ? none : part.coefficients, exponent));
    result.emplace_back(key + "_SLOTS", std::to_string(std::max<std::size_t>(part.coefficients.size(), 1)));
  };
  add("KERNEL", kernel_of(method));
  add("START", start_of(method));
  add("FINISH", finish_of(method));
  return result;
}

void add_bath(gap_texts& values, const exported_method& method, const gap_texts& of_bath) {
  for (const auto& [key, text] : of_bath) {
    values.emplace_back(key, has_bath(method) ? fill(text, {{"NAME", method.name}}) : "");
  }
}

}  // namespace nysalt::detail
